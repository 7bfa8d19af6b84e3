/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See import_ict.h. The model's vertices come in ranges, which its own read-me lists. Left out are the triangles of the film on
 * the eyes, of what shades them and of the lashes: they are made to be seen through. Both sides of a shape that ARKit has as one are added.
 */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "databank/build/import_ict.h"
#include "databank/build/marked.h"
#include "gen/ict_points.h"
#include "shape/target.h"

#define POINT(group, index) #group "." #index

enum {
    ICT_VERTICES = 26719,
    SKIN_END = 14062,
    GUMS_END = 17039,
    TEETH_UPPER_END = 19247,
    TEETH_END = 21451,
    EYE_LEFT_END = 23021,
    EYES_END = 24591,
    SHAPES_MAX = 128,
    NAME_SIZE = 64,
    PATH_SIZE = 4096
};
static const size_t most = (size_t)64 << 20;
static const float mm_per_unit = 10, neck_low_mm = -185, neck_high_mm = -95, spine_mm = -28;

static const struct point_row {
    const char *name;
    uint16_t vertex;
} point_rows[] = {
#define X(point, vertex) { point, vertex },
    ICT_POINTS_ROWS(X)
#undef X
};

typedef struct importing {
    const char *folder;
    char *bad;
    size_t bad_size;
    fap_surface *neutral;
    marked marks;
    char shape[SHAPES_MAX][NAME_SIZE]; /* file names, sorted */
    int shape_count;
    const char *kind; /* "" or "expressions/" */
    fap_bank_builder *builder;
} importing;

/* --- files --- */

static fap_err read_file(const importing *im, const char *name, uint8_t **data, size_t *size)
{
    char path[PATH_SIZE];

    snprintf(im->bad, im->bad_size, "%s/%s", im->folder, name);
    const int n = snprintf(path, sizeof path, "%s/%s", im->folder, name);
    return n < 0 || n >= PATH_SIZE ? FAP_E_ARG : file_read(path, most, data, size);
}

static fap_err read_surface(const importing *im, const char *name, fap_surface **out)
{
    uint8_t *data;
    size_t size;
    fap_err err = read_file(im, name, &data, &size);

    if (err == FAP_OK) {
        err = fap_surface_read(out, data, size, NULL, NULL);
        free(data);
    }
    if (err == FAP_OK && (*out)->vertex_count != ICT_VERTICES) {
        fap_surface_close(out);
        err = FAP_E_DATA;
    }
    for (uint32_t i = 0; err == FAP_OK && i < 3 * ICT_VERTICES; i++)
        (*out)->position[i / 3][i % 3] *= mm_per_unit;
    return err;
}

static int is_shape(const char *name, const char *ending)
{
    const char *dot = strrchr(name, '.');

    return dot && !strcmp(dot, ending) && strlen(name) < NAME_SIZE && strncmp(name, "identity", 8) &&
           strncmp(name, "generic", 7) && strncmp(name, "PupilDilate", 11);
}

static int by_name(const void *a, const void *b)
{
    return strcmp(a, b);
}

static void list_shapes(importing *im, const char *kind, const char *ending)
{
    char path[PATH_SIZE];

    im->kind = kind;
    if (snprintf(path, sizeof path, "%s/%s", im->folder, kind) >= PATH_SIZE)
        return;
    DIR *dir = opendir(path);
    for (const struct dirent *e; dir && (e = readdir(dir)) && im->shape_count < SHAPES_MAX;)
        if (is_shape(e->d_name, ending))
            strcpy(im->shape[im->shape_count++], e->d_name);
    if (dir)
        closedir(dir);
    qsort(im->shape, (size_t)im->shape_count, NAME_SIZE, by_name);
}

/* --- marks --- */

static uint8_t part_of(uint32_t v)
{
    static const struct range {
        uint32_t end;
        uint8_t part;
    } ranges[] = { { SKIN_END, FAP_PART_SKIN },
                   { GUMS_END, FAP_PART_TONGUE },
                   { TEETH_UPPER_END, FAP_PART_TEETH_UPPER },
                   { TEETH_END, FAP_PART_TEETH_LOWER },
                   { EYE_LEFT_END, FAP_PART_EYE_LEFT },
                   { EYES_END, FAP_PART_EYE_RIGHT } };

    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (v < ranges[i].end)
            return ranges[i].part;
    return FAP_PART_LASHES;
}

static void drop_film(fap_surface *s)
{
    uint32_t kept = 0;

    for (uint32_t t = 0; t < s->triangle_count; t++)
        if (s->triangle[t][0] < EYES_END)
            memmove(s->triangle[kept++], s->triangle[t], sizeof *s->triangle);
    s->triangle_count = kept;
}

static fap_err mark(importing *im)
{
    drop_film(im->neutral);
    if (!marked_open(&im->marks, im->neutral))
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < ICT_VERTICES; v++) {
        const float rise = (im->neutral->position[v][1] - neck_low_mm) / (neck_high_mm - neck_low_mm);
        im->marks.part[v] = part_of(v);
        im->marks.weight[v] = (uint8_t)(255 * (rise < 0 ? 0 : rise > 1 ? 1 : rise));
    }
    for (size_t i = 0; i < sizeof point_rows / sizeof *point_rows; i++)
        im->marks.point[fap_point_by_name(point_rows[i].name)] = point_rows[i].vertex;
    const int spine = fap_point_by_name("7.1");
    im->marks.place[spine][2] = spine_mm;
    im->marks.has_place[spine] = 1;
    marked_paint(&im->marks);
    return FAP_OK;
}

/* --- shapes --- */

static fap_err read_shape(const importing *im, const char *file, float (*delta)[3])
{
    char name[2 * NAME_SIZE];
    uint8_t *data;
    size_t size;
    fap_surface *posed;

    snprintf(name, sizeof name, "%s%s", im->kind, file);
    if (!*im->kind) {
        const fap_err err = read_surface(im, name, &posed);
        for (uint32_t i = 0; err == FAP_OK && i < 3 * ICT_VERTICES; i++)
            delta[i / 3][i % 3] += posed->position[i / 3][i % 3] - im->neutral->position[i / 3][i % 3];
        fap_surface_close(&posed);
        return err;
    }
    fap_err err = read_file(im, name, &data, &size);
    if (err == FAP_OK) {
        err = fap_target_add((char *)data, mm_per_unit, delta, ICT_VERTICES, NULL);
        free(data);
    }
    return err;
}

static int is_joined(const char *stem, size_t length)
{
    static const char *const joined[] = { "browInnerUp", "cheekPuff" };

    for (int i = 0; i < 2; i++)
        if (length == strlen(joined[i]) && !strncmp(stem, joined[i], length))
            return 1;
    return 0;
}

/* mouthSmile_L.obj is ARKit's mouthSmileLeft. @return 1: the other side is to be added to it. */
static int shape_name(const char *file, char out[NAME_SIZE])
{
    const size_t stem = strcspn(file, "_.");
    const int joined = file[stem] == '_' && is_joined(file, stem);

    snprintf(out, NAME_SIZE, "%.*s%s", (int)stem, file,
             joined || file[stem] != '_' ? ""
             : file[stem + 1] == 'L'     ? "Left"
                                         : "Right");
    return joined;
}

/* Sides that are one shape stand beside each other in the list. */
static fap_err add_shapes(importing *im)
{
    float(*delta)[3] = malloc(ICT_VERTICES * sizeof *delta);
    fap_err err = delta ? FAP_OK : FAP_E_NOMEM;

    for (int i = 0; i < im->shape_count && err == FAP_OK; i++) {
        char name[NAME_SIZE], other[NAME_SIZE];
        memset(delta, 0, ICT_VERTICES * sizeof *delta);
        err = read_shape(im, im->shape[i], delta);
        if (shape_name(im->shape[i], name) && i + 1 < im->shape_count &&
            shape_name(im->shape[i + 1], other) && !strcmp(name, other) && err == FAP_OK)
            err = read_shape(im, im->shape[++i], delta);
        if (err == FAP_OK)
            err = marked_add_shape(im->builder, name, (const float(*)[3])delta);
    }
    free(delta);
    return err;
}

static fap_err run(importing *im)
{
    fap_err err = read_surface(im, "generic_neutral_mesh.obj", &im->neutral);

    if (err != FAP_OK)
        return err;
    list_shapes(im, "", ".obj");
    if (!im->shape_count)
        list_shapes(im, "expressions/", ".target");
    snprintf(im->bad, im->bad_size, "%s: no shape beside generic_neutral_mesh.obj", im->folder);
    if (!im->shape_count)
        return FAP_E_NOT_FOUND;
    err = mark(im);
    if (err == FAP_OK)
        err = marked_begin(&im->builder, &im->marks, "ICT-FaceKit");
    if (err == FAP_OK)
        err = add_shapes(im);
    return err == FAP_OK ? fap_bank_builder_models(im->builder) : err;
}

fap_err import_ict(fap_bank_builder **out, const char *path, char *bad, size_t bad_size)
{
    importing *im = calloc(1, sizeof *im);

    *out = NULL;
    if (!im)
        return FAP_E_NOMEM;
    im->folder = path;
    im->bad = bad;
    im->bad_size = bad_size;
    const fap_err err = run(im);
    if (err != FAP_OK)
        fap_bank_builder_close(&im->builder);
    *out = im->builder;
    marked_close(&im->marks);
    fap_surface_close(&im->neutral);
    free(im);
    return err;
}
