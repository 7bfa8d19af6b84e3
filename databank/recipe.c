/* SPDX-License-Identifier: BSD-2-Clause */
/* See recipe.h. Lines before the mesh only set things; the first line that needs the builder opens it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "databank/recipe.h"
#include "shape/number.h"
#include "shape/obj.h"
#include "shape/target.h"

enum { MAX_RECIPE = 1 << 20, MAX_MESH = 64 << 20, MAX_GROUPS = 64 };

static const char first_line[] = "fapbank recipe";

static const char *const part_names[FAP_PART_COUNT] = { "skin",        "eye_left", "eye_right", "teeth_upper",
                                                        "teeth_lower", "tongue",   "lashes" };

typedef struct group_style {
    char group[64];
    uint8_t part, colour[4];
} group_style;

typedef struct recipe {
    const recipe_files *files;
    char name[64];
    float scale, neck_y[2]; /* heights where the head weight is 0 and 1 */
    group_style group[MAX_GROUPS];
    int group_count;
    fap_obj mesh;
    fap_bank_builder *builder;
} recipe;

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

static fap_err read_obj(const recipe *r, const char *name, fap_obj *out)
{
    uint8_t *text;
    size_t size;
    fap_err err = r->files->read(r->files->user, name, &text, &size);

    if (!err) {
        err = fap_obj_parse(out, (const char *)text, size, NULL);
        free(text);
    }
    return err;
}

static const group_style *style_of(const recipe *r, const char *group)
{
    static const group_style plain = { "", FAP_PART_SKIN, { 204, 157, 131, 36 } };

    for (int i = 0; i < r->group_count; i++)
        if (!strcmp(r->group[i].group, group))
            return &r->group[i];
    return &plain;
}

/* Arrays of a mesh on its way into the builder. */
typedef struct arrays {
    float (*position)[3], (*uv)[2];
    uint8_t *part, *weight, (*colour)[4];
    uint32_t (*triangle)[3], triangle_count;
} arrays;

static int arrays_open(arrays *a, const fap_obj *o)
{
    a->position = calloc(o->position_count + 1u, sizeof *a->position);
    a->uv = calloc(o->position_count + 1u, sizeof *a->uv);
    a->part = calloc(o->position_count + 1u, 1);
    a->weight = calloc(o->position_count + 1u, 1);
    a->colour = calloc(o->position_count + 1u, sizeof *a->colour);
    a->triangle = calloc(o->corner_count + 1u, sizeof *a->triangle);
    return a->position && a->uv && a->part && a->weight && a->colour && a->triangle;
}

static void arrays_close(arrays *a)
{
    free(a->position);
    free(a->uv);
    free(a->part);
    free(a->weight);
    free(a->colour);
    free(a->triangle);
}

static void add_face(arrays *a, const recipe *r, const fap_obj_face *f)
{
    const fap_obj *o = &r->mesh;
    const group_style *style = style_of(r, o->group[f->group]);

    for (uint32_t i = 0; i < f->count; i++) {
        const uint32_t v = o->vertex[f->first + i], uv = o->corner_uv[f->first + i];
        a->part[v] = style->part;
        memcpy(a->colour[v], style->colour, sizeof *a->colour);
        if (uv != FAP_OBJ_NO_UV)
            memcpy(a->uv[v], o->uv[uv], sizeof *a->uv);
    }
    for (uint32_t i = 1; i + 1 < f->count; i++) {
        uint32_t *t = a->triangle[a->triangle_count++];
        t[0] = o->vertex[f->first], t[1] = o->vertex[f->first + i], t[2] = o->vertex[f->first + i + 1];
    }
}

static void fill(arrays *a, const recipe *r)
{
    const float rise = r->neck_y[1] - r->neck_y[0];

    for (uint32_t v = 0; v < r->mesh.position_count; v++) {
        for (int axis = 0; axis < 3; axis++)
            a->position[v][axis] = r->mesh.position[v][axis] * r->scale;
        const float t = rise > 0 ? fminf(1, fmaxf(0, (a->position[v][1] - r->neck_y[0]) / rise)) : 1;
        a->weight[v] = (uint8_t)lrintf(255 * t);
    }
    for (uint32_t f = 0; f < r->mesh.face_count; f++)
        add_face(a, r, &r->mesh.face[f]);
}

static fap_err take_mesh(recipe *r, const char *rest)
{
    arrays a = { 0 };

    if (r->builder)
        return FAP_E_SYNTAX;
    fap_err err = read_obj(r, rest, &r->mesh);
    if (!err && !arrays_open(&a, &r->mesh))
        err = FAP_E_NOMEM;
    if (!err) {
        fill(&a, r);
        const fap_build_mesh mesh = { r->mesh.position_count,
                                      a.triangle_count,
                                      (const float(*)[3])a.position,
                                      r->mesh.uv_count ? (const float(*)[2])a.uv : NULL,
                                      a.part,
                                      a.weight,
                                      (const uint8_t(*)[4])a.colour,
                                      (const uint32_t(*)[3])a.triangle };
        err = fap_bank_builder_open(&r->builder, r->name, &mesh);
    }
    arrays_close(&a);
    return err;
}

static fap_err take_group(recipe *r, const char *rest)
{
    group_style g = { .part = FAP_PART_COUNT };
    char part[32];
    unsigned c[4] = { 204, 157, 131, 36 };
    const int n = sscanf(rest, "%63s %31s %u %u %u %u", g.group, part, &c[0], &c[1], &c[2], &c[3]);

    for (int p = 0; n >= 2 && p < FAP_PART_COUNT; p++)
        if (!strcmp(part, part_names[p]))
            g.part = (uint8_t)p;
    if ((n != 2 && n != 6) || g.part == FAP_PART_COUNT || r->group_count == MAX_GROUPS || r->builder)
        return FAP_E_SYNTAX;
    for (int i = 0; i < 4; i++) {
        if (c[i] > 255)
            return FAP_E_SYNTAX;
        g.colour[i] = (uint8_t)c[i];
    }
    r->group[r->group_count++] = g;
    return FAP_OK;
}

static fap_err take_scale(recipe *r, const char *rest)
{
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

static int ends_with(const char *s, const char *end)
{
    const size_t n = strlen(s), m = strlen(end);
    return n >= m && !strcmp(s + n - m, end);
}

/* Motion out of a .target, or as the difference of another OBJ of the same topology. */
static fap_err read_motion(const recipe *r, const char *file, float (*delta)[3])
{
    const uint32_t n = r->mesh.position_count;
    fap_obj posed;
    uint8_t *text;
    size_t size;
    int line;

    if (ends_with(file, ".target")) {
        fap_err err = r->files->read(r->files->user, file, &text, &size);
        if (!err) {
            err = fap_target_add((const char *)text, r->scale, delta, n, &line);
            free(text);
        }
        return err;
    }
    fap_err err = read_obj(r, file, &posed);
    if (err)
        return err;
    if (posed.position_count != n)
        err = FAP_E_DATA;
    for (uint32_t v = 0; !err && v < n; v++)
        for (int axis = 0; axis < 3; axis++)
            delta[v][axis] = (posed.position[v][axis] - r->mesh.position[v][axis]) * r->scale;
    fap_obj_free(&posed);
    return err;
}

/* -1: none. */
static int small_number(const char *text)
{
    char *end;
    const long n = strtol(text, &end, 10);

    return end > text && !*end && n >= 0 && n < 100 ? (int)n : -1;
}

/* "jawOpen jaw.obj", a kind before it where it is no unit: "viseme 1 pp.obj", "expression 2 sad.obj", "extra
 * wink w.obj". */
static fap_err take_key(recipe *r, fap_key_kind kind, const char *rest)
{
    char name[32], file[256];

    if (sscanf(rest, "%31s %255[^\n]", name, file) != 2)
        return FAP_E_SYNTAX;
    const int numbered = kind == FAP_KEY_VISEME || kind == FAP_KEY_EXPRESSION;
    const int number = numbered ? small_number(name) : 0;
    const char *called = kind == FAP_KEY_VISEME       ? fap_viseme_name(number)
                         : kind == FAP_KEY_EXPRESSION ? fap_expression_name(number)
                                                      : name;
    if (!called)
        return FAP_E_SYNTAX;
    float(*delta)[3] = calloc(r->mesh.position_count + 1u, sizeof *delta);
    fap_err err = delta ? read_motion(r, file, delta) : FAP_E_NOMEM;
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
    { "group", take_group, 0 },
    { "mesh", take_mesh, 0 },
    { "point", take_point, 1 },
    { "place", take_place, 1 },
    { "eye", take_eye, 1 },
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

static fap_err take_lines(recipe *r, char *text, int *line)
{
    for (int n = 1; *text; n++) {
        char *end = text + strcspn(text, "\n"), *next = end + (*end == '\n');
        *end = '\0';
        const fap_err err = n > 1 ? take_line(r, text) : FAP_OK;
        if (err) {
            *line = n;
            return err;
        }
        text = next;
    }
    return r->builder ? FAP_OK : FAP_E_DATA;
}

fap_err recipe_parse(fap_bank_builder **out, char *text, const recipe_files *files, int *line)
{
    recipe r = { .files = files, .name = "face", .scale = 1 };

    *line = 0;
    const fap_err err = take_lines(&r, text, line);
    fap_obj_free(&r.mesh);
    if (err)
        fap_bank_builder_close(&r.builder);
    *out = r.builder;
    return err;
}

/* The file beside the recipe. */
static fap_err read_beside(void *user, const char *name, uint8_t **data, size_t *size)
{
    char path[1024];
    const char *recipe_path = user, *slash = strrchr(recipe_path, '/');
    const int folder = slash && *name != '/' ? (int)(slash - recipe_path) + 1 : 0;

    const int n = snprintf(path, sizeof path, "%.*s%s", folder, recipe_path, name);
    return n < 0 || (size_t)n >= sizeof path ? FAP_E_ARG : file_read(path, MAX_MESH, data, size);
}

fap_err recipe_make(fap_bank_builder **out, const char *path, char *bad, size_t bad_size)
{
    const recipe_files files = { read_beside, (char *)(uintptr_t)path };
    uint8_t *text;
    size_t size;
    int line;

    *out = NULL;
    snprintf(bad, bad_size, "%s", path);
    fap_err err = file_read(path, MAX_RECIPE, &text, &size);
    if (err)
        return err;
    err = recipe_parse(out, (char *)text, &files, &line);
    free(text);
    if (line)
        snprintf(bad, bad_size, "%s:%d", path, line);
    return err;
}
