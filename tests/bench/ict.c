/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The bank holds ICT-FaceKit's shapes under ARKit's names and the library's own visemes, expressions and extras made
 * of them. It does not hold the shapes listed in left_out; brows and cheeks it holds only as both sides together.
 * Held-out faces mix shapes of either kind. Sources: ../shared/data/faces/SOURCES.md; feature points of
 * ../shared/spec/feature_points_ict.csv.
 */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/bank_build.h>

#include "ict.h"
#include "common/file.h"
#include "shape/bytes.h"
#include "shape/obj.h"
#include "shape/target.h"

static const char folder[] = "../shared/data/faces/ict";
static const char points_file[] = "../shared/spec/feature_points_ict.csv";
static const double face_height_mm = 190;

enum {
    FILE_MAX = 64 << 20,
    UV_RADIX = 1000,
    SKIN_END = 14062,
    GUMS_END = 17039,
    TEETH_END = 21451,
    EYE_END = 23021,
    EYES_END = 24591,
    FACE_END = ICT_FACE_VERTICES
};

/* Shapes that no ARKit face has, or that faces in a bank are seldom made for. */
static const char *const left_out[] = { "cheekRaiser_L", "cheekRaiser_R", "mouthDimple_L",
                                        "mouthDimple_R", "mouthPress_L",  "mouthPress_R",
                                        "noseSneer_L",   "noseSneer_R",   "mouthShrugUpper" };
/* Held by the bank as one unit of both sides. */
static const char *const joined[] = { "browInnerUp", "cheekPuff" };

/* What FAPs move as bodies or what moves no skin. */
static const char *const no_face[] = { "eyeLook", "PupilDilate", "mouthClose", NULL };

typedef struct loading {
    fap_obj obj;
    float (*position)[3];
    uint8_t *part, *head_weight;
    uint8_t (*colour)[4];
    float (*uv)[2];
    uint32_t (*triangle)[3];
    uint32_t triangle_count;
} loading;

static int read_text(const char *path, uint8_t **text, size_t *size)
{
    *text = NULL;
    return file_read(path, FILE_MAX, text, size) == FAP_OK;
}

static int listed(const char *name, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!strcmp(name, list[i]))
            return 1;
    return 0;
}

/* --- the neutral mesh --- */

static int read_mesh(loading *l)
{
    char path[256];
    uint8_t *text;
    size_t size;

    snprintf(path, sizeof path, "%s/generic_neutral_mesh.obj", folder);
    if (!read_text(path, &text, &size))
        return 0;
    const fap_err err = fap_obj_parse(&l->obj, (char *)text, size, NULL);
    free(text);
    return err == FAP_OK;
}

/* Rows of "point,vertex,part,x,y,z,description"; calls back for each that has a vertex. */
static int each_point(int (*use)(void *user, int point, uint32_t vertex), void *user)
{
    uint8_t *text;
    size_t size;
    int ok;

    if (!read_text(points_file, &text, &size))
        return 0;
    ok = 1;
    for (char *line = strtok((char *)text, "\n"); line && ok; line = strtok(NULL, "\n")) {
        char name[8];
        unsigned vertex;
        if (sscanf(line, "%7[0-9.],%u", name, &vertex) == 2 && fap_point_by_name(name) >= 0)
            ok = use(user, fap_point_by_name(name), vertex);
    }
    free(text);
    return ok;
}

typedef struct height {
    const loading *l;
    double top, bottom;
} height;

static int note_height(void *user, int point, uint32_t vertex)
{
    height *h = user;

    if (vertex >= h->l->obj.position_count)
        return 0;
    if (point == fap_point_by_name("11.1"))
        h->top = h->l->obj.position[vertex][1];
    if (point == fap_point_by_name("2.1"))
        h->bottom = h->l->obj.position[vertex][1];
    return 1;
}

/* Ranges of FaceXModel; gums count as tongue, what lies on the eyes as lashes. */
static uint8_t part_of(uint32_t v)
{
    static const struct range {
        uint32_t end;
        uint8_t part;
    } ranges[] = { { SKIN_END, FAP_PART_SKIN },
                   { GUMS_END, FAP_PART_TONGUE },
                   { TEETH_END, FAP_PART_TEETH_UPPER },
                   { EYE_END, FAP_PART_EYE_LEFT },
                   { EYES_END, FAP_PART_EYE_RIGHT } };

    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (v < ranges[i].end)
            return ranges[i].part;
    return FAP_PART_LASHES;
}

static int fill_mesh(ict *f, loading *l)
{
    const uint32_t n = l->obj.position_count;

    l->position = calloc(n, sizeof *l->position);
    l->part = calloc(n, 1);
    l->head_weight = calloc(n, 1);
    l->colour = calloc(n, sizeof *l->colour);
    l->uv = calloc(n, sizeof *l->uv);
    l->triangle = calloc(l->obj.corner_count, sizeof *l->triangle);
    if (!l->position || !l->part || !l->head_weight || !l->colour || !l->uv || !l->triangle)
        return 0;
    for (uint32_t v = 0; v < n; v++) {
        for (int axis = 0; axis < 3; axis++)
            l->position[v][axis] = (float)(f->mm_per_unit * l->obj.position[v][axis]);
        l->part[v] = part_of(v);
        l->head_weight[v] = 255;
        l->uv[v][0] = (float)(v % UV_RADIX); /* the bank reorders vertices: this is how to find them again */
        l->uv[v][1] = (float)(v / UV_RADIX);
    }
    return 1;
}

static void fill_triangles(loading *l)
{
    for (uint32_t i = 0; i < l->obj.face_count; i++) {
        const fap_obj_face *face = &l->obj.face[i];
        const uint32_t *corner = l->obj.vertex + face->first;
        for (uint32_t k = 2; k < face->count; k++) {
            uint32_t *t = l->triangle[l->triangle_count];
            t[0] = corner[0], t[1] = corner[k - 1], t[2] = corner[k];
            if (l->part[t[0]] == l->part[t[1]] && l->part[t[1]] == l->part[t[2]])
                l->triangle_count++;
        }
    }
}

static void free_loading(loading *l)
{
    fap_obj_free(&l->obj);
    free(l->position);
    free(l->part);
    free(l->head_weight);
    free(l->colour);
    free(l->uv);
    free(l->triangle);
}

/* --- shapes --- */

static int is_no_face(const char *name)
{
    for (const char *const *p = no_face; *p; p++)
        if (!strncmp(name, *p, strlen(*p)))
            return 1;
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(a, b);
}

static int list_shapes(ict *f)
{
    char path[256];

    snprintf(path, sizeof path, "%s/expressions", folder);
    DIR *dir = opendir(path);
    if (!dir)
        return 0;
    for (const struct dirent *e; (e = readdir(dir)) && f->unit_count < ICT_UNITS_MAX;) {
        const char *dot = strstr(e->d_name, ".target");
        if (dot && (size_t)(dot - e->d_name) < sizeof f->name[0])
            snprintf(f->name[f->unit_count++], sizeof f->name[0], "%.*s", (int)(dot - e->d_name), e->d_name);
    }
    closedir(dir);
    qsort(f->name, (size_t)f->unit_count, sizeof f->name[0], by_name);
    return f->unit_count > 0;
}

static int read_shape(ict *f, int unit)
{
    char path[256];
    uint8_t *text;
    size_t size;

    snprintf(path, sizeof path, "%s/expressions/%s.target", folder, f->name[unit]);
    f->delta[unit] = calloc(f->vertex_count, sizeof *f->delta[unit]);
    if (!f->delta[unit] || !read_text(path, &text, &size))
        return 0;
    const fap_err err =
        fap_target_add((char *)text, (float)f->mm_per_unit, f->delta[unit], f->vertex_count, NULL);
    free(text);
    return err == FAP_OK;
}

/* mouthSmile_L is ARKit's mouthSmileLeft. */
static void arkit_name(const char *name, char out[32])
{
    const size_t stem = strcspn(name, "_");

    snprintf(out, 32, "%.*s%s", (int)stem, name,
             !strcmp(name + stem, "_L")   ? "Left"
             : !strcmp(name + stem, "_R") ? "Right"
                                          : "");
}

static int add_unit(ict *f, fap_bank_builder *b, int unit)
{
    char name[32];

    if (listed(f->name[unit], left_out, sizeof left_out / sizeof *left_out) ||
        !strncmp(f->name[unit], "PupilDilate", 11))
        return 1;
    for (size_t i = 0; i < sizeof joined / sizeof *joined; i++)
        if (!strncmp(f->name[unit], joined[i], strlen(joined[i])))
            return 1;
    f->in_bank[unit] = 1;
    arkit_name(f->name[unit], name);
    return fap_bank_builder_key(b, FAP_KEY_UNIT, 0, name, (const float(*)[3])f->delta[unit]) == FAP_OK;
}

static int add_joined(ict *f, fap_bank_builder *b, const char *stem)
{
    float(*sum)[3] = calloc(f->vertex_count, sizeof *sum);
    int ok = sum != NULL;

    for (int u = 0; u < f->unit_count && ok; u++)
        for (uint32_t v = 0; v < f->vertex_count && !strncmp(f->name[u], stem, strlen(stem)); v++)
            for (int axis = 0; axis < 3; axis++)
                sum[v][axis] += f->delta[u][v][axis];
    ok = ok && fap_bank_builder_key(b, FAP_KEY_UNIT, 0, stem, (const float(*)[3])sum) == FAP_OK;
    free(sum);
    return ok;
}

/* --- the bank --- */

static int add_point(void *user, int point, uint32_t vertex)
{
    return fap_bank_builder_point(user, point, &vertex, 1) == FAP_OK;
}

/* Middle and half width of an eyeball's vertices. */
static void add_eye(const loading *l, fap_bank_builder *b, int right)
{
    float lo[3] = { INFINITY, INFINITY, INFINITY }, hi[3] = { -INFINITY, -INFINITY, -INFINITY }, centre[3];

    for (uint32_t v = 0; v < l->obj.position_count; v++)
        for (int axis = 0; axis < 3 && l->part[v] == (right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT);
             axis++) {
            lo[axis] = fminf(lo[axis], l->position[v][axis]);
            hi[axis] = fmaxf(hi[axis], l->position[v][axis]);
        }
    const float radius = (hi[1] - lo[1]) / 2;
    for (int axis = 0; axis < 2; axis++)
        centre[axis] = (lo[axis] + hi[axis]) / 2;
    centre[2] = lo[2] + radius;
    fap_bank_builder_eye(b, right, centre, radius);
}

static int take_bytes(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return ((fap_bytes *)user)->failed;
}

static int write_bank(ict *f, fap_bank_builder *b)
{
    fap_bytes file = { 0 };
    const fap_writer w = { take_bytes, &file };
    const int ok = fap_bank_builder_write(b, &w) == FAP_OK &&
                   fap_bank_load(&f->bank, file.data, file.size, NULL) == FAP_OK;

    free(file.data);
    return ok;
}

static int fill_builder(ict *f, const loading *l, fap_bank_builder *b)
{
    const float place[3] = { 0, 0, (float)(-2.8 * f->mm_per_unit) };
    int ok = each_point(add_point, b) && fap_bank_builder_place(b, fap_point_by_name("7.1"), place) == FAP_OK;

    for (int u = 0; u < f->unit_count && ok; u++)
        ok = add_unit(f, b, u);
    for (size_t i = 0; i < sizeof joined / sizeof *joined && ok; i++)
        ok = add_joined(f, b, joined[i]);
    for (int right = 0; right < 2; right++)
        add_eye(l, b, right);
    return ok && fap_bank_builder_models(b) == FAP_OK && write_bank(f, b);
}

static int build_bank(ict *f, const loading *l)
{
    const fap_build_mesh mesh = { .vertex_count = l->obj.position_count,
                                  .triangle_count = l->triangle_count,
                                  .position = (const float(*)[3])l->position,
                                  .uv = (const float(*)[2])l->uv,
                                  .part = l->part,
                                  .head_weight = l->head_weight,
                                  .colour = (const uint8_t(*)[4])l->colour,
                                  .triangle = (const uint32_t(*)[3])l->triangle };
    fap_bank_builder *b;

    if (fap_bank_builder_open(&b, "ICT-FaceKit", &mesh) != FAP_OK)
        return 0;
    const int ok = fill_builder(f, l, b);
    fap_bank_builder_close(&b);
    return ok;
}

/* --- the truth, in the bank's order --- */

static uint32_t original(const fap_mesh *mesh, uint32_t v)
{
    return (uint32_t)mesh->uv[2 * v] + UV_RADIX * (uint32_t)mesh->uv[2 * v + 1];
}

static int reorder(ict *f)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);
    float(*sorted)[3] = malloc(f->vertex_count * sizeof *sorted);

    for (int u = 0; u < f->unit_count && sorted; u++) {
        for (uint32_t v = 0; v < f->vertex_count; v++)
            memcpy(sorted[v], f->delta[u][original(mesh, v)], sizeof *sorted);
        memcpy(f->delta[u], sorted, f->vertex_count * sizeof *sorted);
    }
    free(sorted);
    return sorted != NULL;
}

static int moves(const ict *f, uint32_t v)
{
    for (int u = 0; u < f->unit_count; u++) {
        const float *d = f->delta[u][v];
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 0.01f)
            return 1;
    }
    return 0;
}

static int mark_face(ict *f)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);

    f->face = calloc(f->vertex_count, 1);
    for (uint32_t v = 0; v < f->vertex_count && f->face; v++)
        f->face[v] = original(mesh, v) < FACE_END && moves(f, v);
    return f->face != NULL;
}

static int load_all(ict *f, loading *l)
{
    height h = { .l = l };

    if (!read_mesh(l) || !each_point(note_height, &h) || !(h.top > h.bottom) || !list_shapes(f))
        return 0;
    f->mm_per_unit = face_height_mm / (h.top - h.bottom);
    f->vertex_count = l->obj.position_count;
    if (!fill_mesh(f, l))
        return 0;
    fill_triangles(l);
    for (int u = 0; u < f->unit_count; u++)
        if (!read_shape(f, u))
            return 0;
    return build_bank(f, l) && reorder(f) && mark_face(f);
}

uint32_t ict_original(const ict *face, uint32_t vertex)
{
    return original(fap_bank_mesh(face->bank), vertex);
}

int ict_open(ict *face)
{
    loading l = { 0 };

    memset(face, 0, sizeof *face);
    const int ok = load_all(face, &l);
    if (ok)
        face->stride = fap_bank_mesh(face->bank)->stride;
    free_loading(&l);
    return ok;
}

void ict_close(ict *face)
{
    fap_bank_close(&face->bank);
    for (int u = 0; u < face->unit_count; u++)
        free(face->delta[u]);
    free(face->face);
    memset(face, 0, sizeof *face);
}

/* --- held-out faces --- */

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static int taken(const ict_model *m, int unit)
{
    for (int i = 0; i < m->count; i++)
        if (m->unit[i] == unit)
            return 1;
    return 0;
}

/*
 * Six shapes, jaws and lids among them as chance has it. Every second face has one among them that the bank lacks;
 * the others are combinations that no key shows.
 */
void ict_model_get(const ict *face, int number, ict_model *model)
{
    uint32_t seed = 7919u * (uint32_t)(number + 1);

    memset(model, 0, sizeof *model);
    while (model->count < ICT_PARTS) {
        const int unit = (int)(next(&seed) % (uint32_t)face->unit_count);
        const int wants_held = model->count > 0 || number % 2 == 0;
        if (is_no_face(face->name[unit]) || taken(model, unit) || face->in_bank[unit] != wants_held)
            continue;
        model->unit[model->count] = unit;
        model->weight[model->count++] = 0.2f + 0.6f * (float)(next(&seed) % 1000) / 1000;
    }
}

void ict_truth(const ict *face, const ict_model *model, float (*motion)[3])
{
    memset(motion, 0, face->vertex_count * sizeof *motion);
    for (int i = 0; i < model->count; i++)
        for (uint32_t v = 0; v < face->vertex_count; v++)
            for (int axis = 0; axis < 3; axis++)
                motion[v][axis] += model->weight[i] * face->delta[model->unit[i]][v][axis];
}
