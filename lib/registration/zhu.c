/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method zhu: consistent parameterisation as Zhu 2006 has it, chapter 4. Landmarks bend space by Hardy's multiquadrics, met
 * exactly (4.3); the face is made finer by Loop's scheme (4.4; "a factor of eight" for two steps is a slip: 1,485 triangles
 * become 23,760, which is sixteen); then each vertex goes along a ray to the scan, about the head's axis or along its
 * normal, if that is not too far (4.5). What a scanner sees badly, ears, the top and the back of the head, is not projected
 * and can be left out (4.6). The affine part of the bending is ours: without it a head that is larger everywhere comes out
 * lumpy between the landmarks.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/laying.h"
#include "registration/loop.h"
#include "registration/warp.h"
#include "surface/normals.h"

/* Seen from the head's axis, the face is this far to either side of straight ahead; ears begin there. */
static const double face_degrees = 80;
/* And this share of the head's height above its middle: there the hair begins. */
static const double face_top = 0.62;

/* --- 4.3 --- */

/* Lips that are shut have two landmarks in one place, and no function takes two values there: they share the mean. */
static const double one_place_mm = 0.2;

typedef struct bending {
    double (*centre)[3], (*move)[3];
    uint32_t *merged, count;
} bending;

static uint32_t find_centre(const bending *b, const double at[3])
{
    for (uint32_t i = 0; i < b->count; i++)
        if (pow(at[0] - b->centre[i][0], 2) + pow(at[1] - b->centre[i][1], 2) +
                pow(at[2] - b->centre[i][2], 2) <
            one_place_mm * one_place_mm)
            return i;
    return b->count;
}

static void collect(const laying *l, bending *b)
{
    for (uint32_t i = 0; i < l->pin_count; i++) {
        double at[3];
        if (l->pin[i].weight <= 0)
            continue;
        laying_pin_place(&l->pin[i], l->generic->position, at);
        const uint32_t k = find_centre(b, at);
        if (k == b->count)
            memcpy(b->centre[b->count++], at, sizeof at);
        b->merged[k]++;
        for (int a = 0; a < 3; a++)
            b->move[k][a] += (l->pin[i].at[a] - at[a] - b->move[k][a]) / b->merged[k];
    }
}

static void bend_face(laying *l, const warp *w)
{
    for (uint32_t i = 0; i < l->generic->vertex_count; i++) {
        double at[3], moved[3];
        for (int a = 0; a < 3; a++)
            at[a] = (double)l->generic->position[i][a];
        warp_move(w, at, moved);
        for (int a = 0; a < 3; a++)
            l->at[i][a] = (float)(at[a] + moved[a]);
    }
}

static fap_err bend(laying *l)
{
    bending b = { .centre = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.centre),
                  .move = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.move),
                  .merged = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.merged) };
    fap_err err = b.centre && b.move && b.merged ? FAP_OK : FAP_E_NOMEM;
    warp w;

    if (err == FAP_OK) {
        collect(l, &b);
        err = warp_open(&w, WARP_HARDY, (const double(*)[3])b.centre, (const double(*)[3])b.move, NULL,
                        b.count, 0, l->alloc);
    }
    if (err == FAP_OK) {
        bend_face(l, &w);
        warp_close(&w, l->alloc);
    }
    fap_mem_free(l->alloc, b.centre);
    fap_mem_free(l->alloc, b.move);
    fap_mem_free(l->alloc, b.merged);
    return err;
}

/* --- 4.5, 4.6 --- */

typedef struct cylinder {
    double x, z;          /* the axis, upright */
    double middle_y, top; /* of the face */
} cylinder;

/* The middle of the generic head's box. */
static cylinder find_axis(const laying *l)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    for (uint32_t i = 0; i < l->generic->vertex_count; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], (double)l->generic->position[i][a]);
            high[a] = fmax(high[a], (double)l->generic->position[i][a]);
        }
    const double middle = (low[1] + high[1]) / 2;
    return (cylinder){ (low[0] + high[0]) / 2, (low[2] + high[2]) / 2, middle,
                       middle + face_top * (high[1] - middle) };
}

static int is_face(const laying *l, const cylinder *c, uint32_t i)
{
    const float *p = l->generic->position[i];
    const double degrees = fabs(atan2((double)p[0] - c->x, (double)p[2] - c->z)) * 57.29577951308232;

    return laying_is_skin(l, i) && degrees < face_degrees && (double)p[1] < c->top;
}

static void direction_of(const laying *l, const cylinder *c, uint32_t i, float out[3])
{
    const float *p = l->at[i];
    double v[3] = { (double)p[0] - c->x, 0, (double)p[2] - c->z };

    if (l->cfg->along_normals) {
        memcpy(out, l->normal[i], 3 * sizeof *out);
        return;
    }
    const double length = fmax(1e-9, sqrt(v[0] * v[0] + v[2] * v[2]));
    for (int a = 0; a < 3; a++)
        out[a] = (float)(v[a] / length);
}

/* The nearer of what is met outwards and inwards; 0: nothing within the limit. */
static int project(const laying *l, uint32_t i, const float direction[3], float out[3])
{
    const float back[3] = { -direction[0], -direction[1], -direction[2] }, limit = (float)l->cfg->limit_mm;
    surface_hit outwards, inwards;

    const int is_out = surface_index_ray(l->index, l->at[i], direction, limit, &outwards);
    const int is_in = surface_index_ray(l->index, l->at[i], back, limit, &inwards);
    if (!is_out && !is_in)
        return 0;
    memcpy(out, is_out && (!is_in || outwards.distance < inwards.distance) ? outwards.at : inwards.at,
           3 * sizeof *out);
    return 1;
}

static fap_err refine(laying *l)
{
    const fap_generic *g = l->generic;
    const cylinder c = find_axis(l);
    float(*to)[3] = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *to);

    if (!to)
        return FAP_E_NOMEM;
    surface_normals((const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, l->normal);
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        float direction[3];
        memcpy(to[i], l->at[i], sizeof to[i]);
        if (!is_face(l, &c, i))
            continue;
        direction_of(l, &c, i, direction);
        project(l, i, direction, to[i]);
    }
    memcpy(l->at, to, g->vertex_count * sizeof *to);
    fap_mem_free(l->alloc, to);
    return FAP_OK;
}

fap_err laying_zhu(laying *l)
{
    fap_err err = bend(l);

    if (err == FAP_E_DATA)
        return laying_fail(l, err, "the landmarks are too few, or all in one plane, to bend space by");
    for (int step = 0; step < l->cfg->subdivisions && err == FAP_OK; step++)
        err = laying_subdivide(l);
    if (err == FAP_OK)
        err = laying_progress(l, 0.5);
    if (err == FAP_OK)
        err = refine(l);
    if (err == FAP_OK)
        laying_bring_inside(l);
    return err;
}
