/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Fields are Wendland's C2 function of the distance along the surface, compact so that a frame touches few
 * vertices. The radii are ours, by region: what must move apart (lids, lips) is kept apart. Source: DESIGN.md
 * section 5; Wendland 1995 (compactly supported radial functions).
 */
#include <math.h>
#include <string.h>

#include "bank/gauss.h"
#include "bank/mask.h"
#include "bank/residual.h"
#include "base/mem.h"

static const float typical_es_mm = 62; /* radii are for a face with its eyes this far apart */
static const float least_radius_mm = 5;
static const float detour_near = 1.15f, detour_far = 1.6f; /* way along the surface : straight line */
static const float least_blink_mm = 2, most_of_lid = 1.3f;
static const double least_pivot = 1e-3; /* below it two points are one */
static const float strongest_mm = 40;   /* no field folds the face further than this */

/* Points that face one another across a slit: their fields must end before they meet. */
static const char *const across[][2] = { { "2.2", "2.3" }, { "2.6", "2.8" }, { "2.7", "2.9" },
                                         { "3.1", "3.3" }, { "3.2", "3.4" }, { "8.1", "8.2" },
                                         { "8.5", "8.7" }, { "8.6", "8.8" } };

static float group_radius(const fap_point_info *info)
{
    switch (info->group) {
    case 2: return info->index == 1 ? 51 : info->index == 10 ? 39 : 16; /* chin, chin boss, inner lips */
    case 3: return 15;
    case 4: return 48;
    case 5: return 60;
    case 6: return 25;
    case 8: return 28;
    case 9: return 24;
    case 10: return 30;
    case 11: return 45;
    default: return 0;
    }
}

static int opposite_of(int p)
{
    const char *name = fap_point_get(p)->name;

    for (size_t i = 0; i < sizeof across / sizeof *across; i++)
        for (int side = 0; side < 2; side++)
            if (!strcmp(across[i][side], name))
                return fap_point_by_name(across[i][!side]);
    return -1;
}

static float nearest_of(const fap_graph *g, const fap_bank_point *point)
{
    float least = INFINITY;

    for (uint32_t i = 0; i < point->vertex_count; i++)
        least = fminf(least, g->distance[g->weld[point->vertex[i]]]);
    return least;
}

static float radius_of(const fap_graph *g, const fap_bank *bank, int p, float scale)
{
    const int opposite = opposite_of(p);
    float radius = scale * group_radius(fap_point_get(p));

    if (opposite >= 0)
        radius = fminf(radius, 0.95f * nearest_of(g, fap_bank_point_get(bank, opposite)));
    return fmaxf(radius, scale * least_radius_mm);
}

static float wendland(float t)
{
    const float u = 1 - t;
    return t >= 1 ? 0 : u * u * u * u * (4 * t + 1);
}

static float straight(const fap_graph *g, uint32_t v, const fap_bank_point *point)
{
    float least = INFINITY;

    for (uint32_t i = 0; i < point->vertex_count; i++) {
        float sum = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const float d =
                g->position[axis * g->stride + v] - g->position[axis * g->stride + point->vertex[i]];
            sum += d * d;
        }
        least = fminf(least, sum);
    }
    return sqrtf(least);
}

/*
 * Where the way along the surface is about the straight line, the straight line: it is smooth where
 * Dijkstra's way follows the grid. Where the way is a detour round a slit, the way.
 */
static float smooth_distance(const fap_graph *g, uint32_t v, const fap_bank_point *point)
{
    const float way = g->distance[v], line = straight(g, v, point);
    const float detour = (way - detour_near * line) / ((detour_far - detour_near) * line + 1e-6f);
    const float t = fminf(1, fmaxf(0, detour));

    return line + (way - line) * t * t * (3 - 2 * t);
}

/* @p mask, @p beyond: vertices beyond a slit, where the bank says so. */
static void fill_values(const fap_graph *g, const fap_bank_point *point, float radius,
                        const uint32_t *follows, const uint8_t *mask, uint8_t beyond, float *value)
{
    for (uint32_t v = 0; v < g->vertex_count; v++) {
        const uint32_t w = g->weld[follows[v]];
        const int cut = mask && (mask[follows[v]] & beyond);
        value[v] = isinf(g->distance[w]) || cut ? 0 : wendland(smooth_distance(g, w, point) / radius);
    }
}

/* The unit that lowers the lid of point @p p; -1: not an upper lid, or the bank has no such unit. */
static int lid_unit(const fap_bank *bank, int p)
{
    const char *name = fap_point_get(p)->name;

    return !strcmp(name, "3.1")   ? fap_bank_key_find(bank, FAP_KEY_UNIT, "eyeBlinkLeft")
           : !strcmp(name, "3.2") ? fap_bank_key_find(bank, FAP_KEY_UNIT, "eyeBlinkRight")
                                  : -1;
}

/*
 * An upper lid has one point in its middle, and its edge must follow it all along: a round field made a tent with the eye
 * in sight on both sides. So its field is the shape of the blink.
 */
static void fill_lid(const fap_bank *bank, int unit, int p, const uint32_t *follows, const uint8_t *mask,
                     uint8_t beyond, float *blink, float *value)
{
    const fap_key *key = fap_bank_key_get(bank, unit);
    const float full = key->point_mm[p][1] / key->scale_mm;

    memset(blink, 0, fap_bank_mesh(bank)->stride * sizeof *blink);
    for (uint32_t b = 0; b < key->block_count; b++)
        for (int i = 0; i < FAP_BLOCK; i++)
            blink[key->block[b] * FAP_BLOCK + i] = key->delta[(b * 3 + 1) * FAP_BLOCK + (uint32_t)i] / full;
    for (uint32_t v = 0; v < fap_bank_mesh(bank)->vertex_count; v++)
        value[v] = mask && (mask[follows[v]] & beyond) ? 0 : fminf(most_of_lid, fmaxf(0, blink[follows[v]]));
}

static int block_moves(const float *value)
{
    float sum = 0;

    for (int i = 0; i < FAP_BLOCK; i++)
        sum += value[i];
    return sum > 0;
}

static int pack(fap_field *field, const float *value, uint32_t stride, const fap_allocator *alloc)
{
    uint32_t count = 0;

    for (uint32_t v = 0; v < stride; v += FAP_BLOCK)
        count += (uint32_t)block_moves(value + v);
    field->block = fap_mem_calloc(alloc, count, sizeof *field->block);
    field->value = fap_mem_calloc(alloc, count, FAP_BLOCK * sizeof *field->value);
    if (!field->block || !field->value)
        return 1;
    for (uint32_t v = 0; v < stride; v += FAP_BLOCK) {
        if (!block_moves(value + v))
            continue;
        field->block[field->block_count] = (uint16_t)(v / FAP_BLOCK);
        memcpy(field->value + (size_t)FAP_BLOCK * field->block_count++, value + v, FAP_BLOCK * sizeof *value);
    }
    return 0;
}

static void note_pull(fap_residual *r, const fap_bank *bank, int q, const float *value)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(bank, p);
        double sum = 0;
        for (uint32_t i = 0; i < point->vertex_count; i++)
            sum += value[point->vertex[i]];
        r->pull[p][q] = point->vertex_count ? (float)(sum / point->vertex_count) : 0;
    }
}

/* @p value has room for a second row, for work. */
static int open_field(fap_residual *r, fap_graph *g, const fap_bank *bank, int p, const uint32_t *follows,
                      float *value, const fap_allocator *alloc)
{
    const fap_bank_point *point = fap_bank_point_get(bank, p);
    const float scale = fap_bank_fapu(bank)->es_mm / typical_es_mm,
                widest = scale * group_radius(fap_point_get(p));

    if (!point->present || !point->vertex_count || !(widest > 0))
        return 0;
    const uint8_t *mask = fap_bank_masks(bank), beyond = fap_mask_across(fap_mask_of_point(p));
    const int unit = lid_unit(bank, p);
    if (unit >= 0 && fap_bank_key_get(bank, unit)->point_mm[p][1] < -least_blink_mm) {
        fill_lid(bank, unit, p, follows, mask, beyond, value + g->stride, value);
    } else {
        fap_graph_flood(g, point->vertex, point->vertex_count, detour_far * widest);
        fill_values(g, point, radius_of(g, bank, p, scale), follows, mask, beyond, value);
    }
    note_pull(r, bank, p, value);
    return pack(&r->field[p], value, g->stride, alloc);
}

int fap_residual_open(fap_residual *r, const fap_bank *bank, fap_graph *graph, const uint32_t *follows,
                      const fap_allocator *alloc)
{
    float *value = fap_mem_calloc(alloc, 2 * (size_t)fap_bank_mesh(bank)->stride, sizeof *value);
    int failed = !value;

    memset(r, 0, sizeof *r);
    for (int p = 0; p < FAP_POINT_COUNT && !failed; p++)
        failed = open_field(r, graph, bank, p, follows, value, alloc);
    fap_mem_free(alloc, value);
    return failed;
}

void fap_residual_close(fap_residual *r, const fap_allocator *alloc)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        fap_mem_free(alloc, r->field[p].block);
        fap_mem_free(alloc, r->field[p].value);
    }
    memset(r, 0, sizeof *r);
}

static int list_points(fap_residual *r, const uint8_t *on, const float *error, int *list)
{
    int n = 0;

    for (int p = 0; p < FAP_POINT_COUNT; p++)
        if (on[p] && r->field[p].block_count)
            list[n++] = p;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            r->matrix[i][j] = r->pull[list[i]][list[j]];
        r->matrix[i][n] = error[list[i]];
    }
    return n;
}

void fap_residual_solve(fap_residual *r, const uint8_t on[FAP_POINT_COUNT],
                        const float error[FAP_POINT_COUNT], float strength[FAP_POINT_COUNT])
{
    int list[FAP_POINT_COUNT];
    double x[FAP_POINT_COUNT];
    const int n = list_points(r, on, error, list);

    memset(strength, 0, FAP_POINT_COUNT * sizeof *strength);
    fap_gauss_solve(r->matrix[0], FAP_POINT_COUNT + 1, n, least_pivot, x);
    for (int c = 0; c < n; c++)
        strength[list[c]] = fminf(strongest_mm, fmaxf(-strongest_mm, (float)x[c]));
}

float fap_residual_pull(const fap_residual *r, int p, const float strength[FAP_POINT_COUNT])
{
    float sum = 0;

    for (int q = 0; q < FAP_POINT_COUNT; q++)
        sum += r->pull[p][q] * strength[q];
    return sum;
}

void fap_residual_apply(const fap_residual *r, const fap_dsp *dsp, const float strength[3][FAP_POINT_COUNT],
                        float *xyz, size_t stride)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_field *f = &r->field[p];
        const float c[3] = { strength[0][p], strength[1][p], strength[2][p] };
        if (f->block_count && (c[0] != 0 || c[1] != 0 || c[2] != 0))
            dsp->add_field(xyz, stride, f->block, f->value, f->block_count, c);
    }
}
