/* SPDX-License-Identifier: BSD-2-Clause */
/* See recipe.h. Lines before the mesh or the scan only set things; either opens the builder. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/bank_file.h"
#include "common/file.h"
#include "databank/build/recipe_state.h"
#include "shape/number.h"

enum { MAX_RECIPE = 1 << 20, MAX_MESH = 1 << 30, PATH_SIZE = 4096 };

static const char first_line[] = "fapbank recipe";

int recipe_is(const char *path)
{
    char line[sizeof first_line] = "";
    FILE *f = strcmp(path, "-") ? fopen(path, "rb") : NULL;

    if (!f)
        return 0;
    const size_t n = fread(line, 1, sizeof first_line - 1, f);
    fclose(f);
    return n == sizeof first_line - 1 && !memcmp(line, first_line, n);
}

static fap_err take_scale(recipe *r, const char *rest)
{
    r->scaled = 1;
    return !r->builder && fap_read_floats(rest, &r->scale, 1) && r->scale > 0 ? FAP_OK : FAP_E_SYNTAX;
}

static fap_err take_neck(recipe *r, const char *rest)
{
    return !r->builder && fap_read_floats(rest, r->neck_y, 2) ? FAP_OK : FAP_E_SYNTAX;
}

static fap_err take_name(recipe *r, const char *rest)
{
    snprintf(r->name, sizeof r->name, "%s", rest);
    return FAP_OK;
}

/* "8.4 1207" or "3.5 12 13 14". */
static fap_err take_point(recipe *r, const char *rest)
{
    uint32_t vertex[64], count = 0;
    char name[8];
    int used;

    if (sscanf(rest, "%7s%n", name, &used) != 1)
        return FAP_E_SYNTAX;
    for (char *end; count < 64; count++) {
        const unsigned long v = strtoul(rest + used, &end, 10);
        if (end == rest + used)
            break;
        vertex[count] = v > UINT32_MAX ? UINT32_MAX : (uint32_t)v;
        used = (int)(end - rest);
    }
    const fap_err err = fap_bank_builder_point(r->builder, fap_point_by_name(name), vertex, count);
    return err == FAP_E_ARG || rest[used] ? FAP_E_SYNTAX : err;
}

/* "7.1 x y z" in the mesh's own unit. */
static fap_err take_place(recipe *r, const char *rest)
{
    float p[3];
    char name[8];
    int used;

    if (sscanf(rest, "%7s%n", name, &used) != 1 || !fap_read_floats(rest + used, p, 3))
        return FAP_E_SYNTAX;
    for (int axis = 0; axis < 3; axis++)
        p[axis] *= r->scale;
    const fap_err err = fap_bank_builder_place(r->builder, fap_point_by_name(name), p);
    return err == FAP_E_ARG ? FAP_E_SYNTAX : err;
}

/* "left x y z radius" in the mesh's own unit. */
static fap_err take_eye(recipe *r, const char *rest)
{
    const int right = !strncmp(rest, "right ", 6);
    float p[4];

    if ((!right && strncmp(rest, "left ", 5)) || !fap_read_floats(rest + (right ? 6 : 5), p, 4) ||
        !(p[3] > 0))
        return FAP_E_SYNTAX;
    for (int i = 0; i < 4; i++)
        p[i] *= r->scale;
    fap_bank_builder_eye(r->builder, right, p, p[3]);
    return FAP_OK;
}

/* -1: none. */
static int small_number(const char *text)
{
    char *end;
    const long n = strtol(text, &end, 10);

    return end > text && !*end && n >= 0 && n < 100 ? (int)n : -1;
}

/* A number or a name. */
static int number_of(fap_key_kind kind, const char *text)
{
    const char *(*const name_of)(int) = kind == FAP_KEY_VISEME ? fap_viseme_name : fap_expression_name;
    const int number = small_number(text);

    for (int i = 1; number < 0 && name_of(i); i++)
        if (!strcmp(text, name_of(i)))
            return i;
    return number;
}

/* "jawOpen jaw.obj", a kind before it where it is no unit: "viseme 1 pp.obj", "expression sadness sad.obj", "extra
 * wink w.obj". A scan has its landmarks behind it. */
static fap_err take_key(recipe *r, fap_key_kind kind, const char *rest)
{
    char name[RECIPE_NAME_SIZE], file[512];

    if (sscanf(rest, "%31s %511[^\n]", name, file) != 2)
        return FAP_E_SYNTAX;
    const int numbered = kind == FAP_KEY_VISEME || kind == FAP_KEY_EXPRESSION;
    const int number = numbered ? number_of(kind, name) : 0;
    const char *called = kind == FAP_KEY_VISEME       ? fap_viseme_name(number)
                         : kind == FAP_KEY_EXPRESSION ? fap_expression_name(number)
                                                      : name;
    if (!called)
        return FAP_E_SYNTAX;
    float(*delta)[3] = calloc(recipe_vertex_count(r) + 1u, sizeof *delta);
    fap_err err = !delta           ? FAP_E_NOMEM
                  : r->person.rest ? recipe_scan_motion(r, kind, called, file, delta)
                                   : recipe_read_motion(r, file, delta);
    if (!err)
        err = fap_bank_builder_key(r->builder, kind, number, called, (const float(*)[3])delta);
    free(delta);
    return err == FAP_E_ARG ? FAP_E_SYNTAX : err;
}

static fap_err take_unit(recipe *r, const char *rest)
{
    return take_key(r, FAP_KEY_UNIT, rest);
}

static fap_err take_viseme(recipe *r, const char *rest)
{
    return take_key(r, FAP_KEY_VISEME, rest);
}

static fap_err take_expression(recipe *r, const char *rest)
{
    return take_key(r, FAP_KEY_EXPRESSION, rest);
}

static fap_err take_extra(recipe *r, const char *rest)
{
    return take_key(r, FAP_KEY_EXTRA, rest);
}

static fap_err take_models(recipe *r, const char *rest)
{
    return *rest ? FAP_E_SYNTAX : fap_bank_builder_models(r->builder);
}

static const struct word {
    const char *word;
    fap_err (*take)(recipe *r, const char *rest);
    int needs_mesh;
} words[] = {
    { "name", take_name, 0 },
    { "scale", take_scale, 0 },
    { "neck", take_neck, 0 },
    { "group", recipe_take_group, 0 },
    { "mesh", recipe_take_mesh, 0 },
    { "like", recipe_take_like, 0 },
    { "method", recipe_take_method, 0 },
    { "alignment", recipe_take_alignment, 0 },
    { "alone", recipe_take_alone, 0 },
    { "scan", recipe_take_scan, 0 },
    { "point", take_point, 1 },
    { "place", take_place, 1 },
    { "eye", take_eye, 1 },
    { "masks", recipe_take_masks, 1 },
    { "unit", take_unit, 1 },
    { "viseme", take_viseme, 1 },
    { "extra", take_extra, 1 },
    { "models", take_models, 1 },
    { "expression", take_expression, 1 },
};

static fap_err take_line(recipe *r, char *line)
{
    line[strcspn(line, "\r")] = '\0';
    line += strspn(line, " \t");
    if (!*line || *line == '#')
        return FAP_OK;
    const size_t length = strcspn(line, " \t");
    char *rest = line + length + strspn(line + length, " \t");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i].word) == length && !strncmp(words[i].word, line, length))
            return words[i].needs_mesh && !r->builder ? FAP_E_SYNTAX : words[i].take(r, rest);
    return FAP_E_SYNTAX;
}

static fap_err take_lines(recipe *r, char *text)
{
    for (int n = 1; *text; n++) {
        char *end = text + strcspn(text, "\n"), *next = end + (*end == '\n');
        *end = '\0';
        const fap_err err = n > 1 ? take_line(r, text) : FAP_OK;
        if (err) {
            r->outcome->line = n;
            return err;
        }
        text = next;
    }
    return r->builder ? FAP_OK : FAP_E_DATA;
}

fap_err recipe_parse(fap_bank_builder **out, char *text, const recipe_files *files, const recipe_watch *watch,
                     recipe_outcome *outcome)
{
    recipe r = { .files = files, .watch = watch, .outcome = outcome, .name = "face", .scale = 1 };

    *outcome = (recipe_outcome){ 0 };
    fap_expression_config_init(&r.person.config);
    const fap_err err = take_lines(&r, text);
    fap_obj_free(&r.mesh);
    recipe_person_close(&r.person);
    if (err)
        fap_bank_builder_close(&r.builder);
    *out = r.builder;
    return err;
}

/* The file beside the recipe; "default" is the default face, wherever that is. */
static fap_err read_beside(void *user, const char *name, uint8_t **data, size_t *size)
{
    char path[PATH_SIZE];
    const char *recipe_path = user, *slash = strrchr(recipe_path, '/');
    const int folder = slash && *name != '/' ? (int)(slash - recipe_path) + 1 : 0;

    if (!strcmp(name, "default"))
        return bank_file_default(path) ? file_read(path, MAX_MESH, data, size) : FAP_E_NOT_FOUND;
    const int n = snprintf(path, sizeof path, "%.*s%s", folder, recipe_path, name);
    return n < 0 || (size_t)n >= sizeof path ? FAP_E_ARG : file_read(path, MAX_MESH, data, size);
}

fap_err recipe_make(fap_bank_builder **out, const char *path, const recipe_watch *watch,
                    recipe_outcome *outcome, char *bad, size_t bad_size)
{
    const recipe_files files = { read_beside, (char *)(uintptr_t)path };
    uint8_t *text;
    size_t size;

    *out = NULL;
    snprintf(bad, bad_size, "%s", path);
    fap_err err = file_read(path, MAX_RECIPE, &text, &size);
    if (err)
        return err;
    err = recipe_parse(out, (char *)text, &files, watch, outcome);
    free(text);
    if (outcome->line)
        snprintf(bad, bad_size, "%s:%d", path, outcome->line);
    return err;
}
