/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The default face: MakeHuman's head with its units, made ready for a databank. One linear operator, cutting
 * and subdivision, serves the rest shape and every unit; only the eyeballs are our own.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "databank/build/import_makehuman.h"
#include "databank/build/makehuman.h"
#include "gen/makehuman_points.h"

#define POINT(group, index) #group "." #index

static const struct point_row {
    const char *name;
    uint16_t vertex;
} point_rows[] = {
#define X(point, vertex) { point, vertex },
    MAKEHUMAN_POINTS_ROWS(X)
#undef X
};
enum { POINT_ROWS = sizeof point_rows / sizeof *point_rows };

uint32_t mh_face_vertex(const mh_face *f, uint32_t vertex)
{
    if (vertex >= f->source->obj.position_count)
        return UINT32_MAX;
    for (int i = 0; i < MH_PATCHES; i++)
        if (f->patch[i].compact[vertex] != UINT32_MAX)
            return f->patch[i].first + f->patch[i].compact[vertex];
    return UINT32_MAX;
}

const float *mh_face_point(const mh_face *f, const char *name)
{
    if (!strcmp(name, "3.5") || !strcmp(name, "3.6"))
        return f->position[f->eye_first[name[2] == '6']];
    for (int i = 0; i < POINT_ROWS; i++)
        if (!strcmp(point_rows[i].name, name)) {
            const uint32_t v = mh_face_vertex(f, point_rows[i].vertex);
            return v == UINT32_MAX ? NULL : f->position[v];
        }
    return NULL;
}

static int allocate(mh_face *f)
{
    f->position = calloc(f->count, sizeof *f->position);
    f->uv = calloc(f->count, sizeof *f->uv);
    f->part = calloc(f->count, 1);
    f->weight = calloc(f->count, 1);
    f->colour = calloc(f->count, sizeof *f->colour);
    f->triangle = calloc(f->triangle_count, sizeof *f->triangle);
    for (int u = 0; u < MH_UNITS; u++) {
        f->unit[u] = calloc(f->count, sizeof *f->unit[u]);
        if (!f->unit[u])
            return 0;
    }
    return f->position && f->uv && f->part && f->weight && f->colour && f->triangle;
}

static void release(mh_face *f)
{
    free(f->position);
    free(f->uv);
    free(f->part);
    free(f->weight);
    free(f->colour);
    free(f->triangle);
    for (int u = 0; u < MH_UNITS; u++)
        free(f->unit[u]);
}

/* The shorter diagonal bends less; equal ones always split the same way. */
static void split_quad(const mh_face *f, const uint32_t q[4], uint32_t out[2][3])
{
    float d02 = 0, d13 = 0;

    for (int axis = 0; axis < 3; axis++) {
        const float a = f->position[q[0]][axis] - f->position[q[2]][axis];
        const float b = f->position[q[1]][axis] - f->position[q[3]][axis];
        d02 += a * a, d13 += b * b;
    }
    const int turn = d13 < d02 * 0.999f;
    for (int i = 0; i < 3; i++) {
        out[0][i] = q[(turn + i) % 4];
        out[1][i] = q[(turn + (i ? i + 1 : 0)) % 4];
    }
}

/* 1 from the jaw up, 0 where the neck was cut, by the place in the file, which identities do not change. */
static uint8_t head_weight(const float base_dm[3])
{
    const float t = fminf(1, fmaxf(0, (mh_height_over_cut(base_dm) - 0.01f) / 0.42f));
    return (uint8_t)lrintf(255 * t * t * (3 - 2 * t));
}

static fap_err place_weights(mh_face *f, const mh_patch *p, float (*scratch)[3])
{
    const fap_err err = mh_patch_apply(p, (const float(*)[3])f->source->base, scratch);

    for (uint32_t v = 0; !err && v < p->count; v++)
        f->weight[p->first + v] = p->part == FAP_PART_SKIN ? head_weight(scratch[v]) : 255;
    return err;
}

static fap_err place_patch(mh_face *f, const mh_patch *p, uint32_t first_triangle)
{
    float(*scratch)[3] = malloc((p->count + 1u) * sizeof *scratch);
    fap_err err = scratch ? place_weights(f, p, scratch) : FAP_E_NOMEM;

    free(scratch);
    if (!err)
        err = mh_patch_apply(p, (const float(*)[3])f->source->rest, f->position + p->first);
    for (int u = 0; !err && u < MH_UNITS; u++)
        if (f->source->unit[u])
            err = mh_patch_apply(p, (const float(*)[3])f->source->unit[u], f->unit[u] + p->first);
    memset(f->part + p->first, p->part, p->count);
    memcpy(f->uv + p->first, p->uv, p->count * sizeof *p->uv);
    for (uint32_t q = 0; q < p->quad_count; q++) {
        const uint32_t *from = p->quad[q];
        const uint32_t quad[4] = { p->first + from[0], p->first + from[1], p->first + from[2],
                                   p->first + from[3] };
        split_quad(f, quad, &f->triangle[first_triangle + 2 * q]);
    }
    return err;
}

/* Skin, then eyes, teeth and tongue; the writer sorts within parts only. */
static fap_err assemble(mh_face *f, mh_patch *patch)
{
    uint32_t triangle = 0;

    for (int i = 0; i < MH_PATCHES; i++) {
        patch[i].first = f->count;
        f->count += patch[i].count;
        f->triangle_count += 2 * patch[i].quad_count;
    }
    const uint32_t eyes = f->count;
    f->count += 2 * mh_eye_vertices();
    f->triangle_count += 2 * mh_eye_triangles();
    if (!allocate(f))
        return FAP_E_NOMEM;
    for (int i = 0; i < MH_PATCHES; i++) {
        const fap_err err = place_patch(f, &patch[i], triangle);
        if (err)
            return err;
        triangle += 2 * patch[i].quad_count;
    }
    for (int right = 0; right < 2; right++)
        mh_eye_build(f, right, eyes + (uint32_t)right * mh_eye_vertices(),
                     triangle + (uint32_t)right * mh_eye_triangles());
    return FAP_OK;
}

/* The two units nobody's set has: s runs from 0 at the tongue's root to 1 at its tip. */
static void add_tongue_units(mh_face *f)
{
    const mh_patch *p = &f->patch[MH_TONGUE];
    float back = 1e9f, front = -1e9f;

    for (uint32_t v = 0; v < p->count; v++) {
        back = fminf(back, f->position[p->first + v][2]);
        front = fmaxf(front, f->position[p->first + v][2]);
    }
    for (uint32_t v = p->first; v < p->first + p->count; v++) {
        const float s = (f->position[v][2] - back) / fmaxf(1, front - back);
        f->unit[MH_TONGUE_UP][v][1] = 10 * s * s * s * s;
        f->unit[MH_TONGUE_UP][v][2] = 3 * s * s;
        f->unit[MH_TONGUE_BACK][v][1] = 8 * sinf(3.14159265f * fminf(1, 1.2f * s)) - 5 * s * s * s;
        f->unit[MH_TONGUE_BACK][v][2] = -10 * s;
    }
}

static fap_err add_points(fap_bank_builder *b, const mh_face *f)
{
    static const float origin[3] = { 0, 0, 0 };
    fap_err err = fap_bank_builder_place(b, fap_point_by_name("7.1"), origin);

    for (int right = 0; !err && right < 2; right++) {
        fap_bank_builder_eye(b, right, f->eye_centre[right], f->eye_radius[right]);
        err = fap_bank_builder_point(b, fap_point_by_name(right ? "3.6" : "3.5"), &f->eye_first[right], 1);
    }
    for (int i = 0; !err && i < POINT_ROWS; i++) {
        const uint32_t v = mh_face_vertex(f, point_rows[i].vertex);
        err = v == UINT32_MAX ? FAP_E_DATA
                              : fap_bank_builder_point(b, fap_point_by_name(point_rows[i].name), &v, 1);
    }
    return err;
}

static fap_err add_keys(fap_bank_builder *b, const mh_face *f)
{
    fap_err err = FAP_OK;

    for (int u = 0; !err && u < MH_UNITS; u++)
        if (f->source->unit[u])
            err = fap_bank_builder_key(b, FAP_KEY_UNIT, 0, mh_unit_names[u], (const float(*)[3])f->unit[u]);
    return err ? err : fap_bank_builder_models(b);
}

static fap_err build(fap_bank_builder **out, const mh_face *f)
{
    const fap_build_mesh mesh = {
        f->count, f->triangle_count, (const float(*)[3])f->position, (const float(*)[2])f->uv,
        f->part,  f->weight,         (const uint8_t(*)[4])f->colour, (const uint32_t(*)[3])f->triangle
    };
    fap_err err = fap_bank_builder_open(out, "makehuman default", &mesh);
    if (!err)
        err = add_points(*out, f);
    if (!err)
        err = add_keys(*out, f);
    if (err)
        fap_bank_builder_close(out);
    return err;
}

static fap_err make_face(fap_bank_builder **out, const mh_source *s, mh_patch *patch)
{
    mh_face f = { .source = s, .patch = patch };
    fap_err err = assemble(&f, patch);

    if (!err) {
        add_tongue_units(&f);
        mh_paint(&f);
        mh_lengthen_teeth(&f);
        err = mh_close_lips(&f);
    }
    if (!err)
        err = build(out, &f);
    release(&f);
    return err;
}

static fap_err cut_and_make(fap_bank_builder **out, const mh_source *s, char *bad, size_t bad_size)
{
    mh_patch patch[MH_PATCHES] = { 0 };
    fap_err err = FAP_OK;

    for (int i = 0; !err && i < MH_PATCHES; i++)
        err = mh_cut(&patch[i], s, (enum mh_patch_id)i);
    if (!err)
        err = make_face(out, s, patch);
    if (err)
        snprintf(bad, bad_size, "base.obj");
    for (int i = 0; i < MH_PATCHES; i++)
        mh_patch_free(&patch[i]);
    return err;
}

fap_err import_makehuman(fap_bank_builder **out, const char *path, char *bad, size_t bad_size)
{
    package p;
    mh_source s;

    *out = NULL;
    snprintf(bad, bad_size, "%s", path);
    fap_err err = package_open(&p, path);
    if (err)
        return err;
    err = mh_read(&s, &p, bad, bad_size);
    package_close(&p);
    if (err)
        return err;
    err = cut_and_make(out, &s, bad, bad_size);
    mh_source_free(&s);
    return err;
}
