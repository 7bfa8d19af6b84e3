/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The list of blend methods, and what they share. Source: DESIGN.md section 5; Zhu 2006 eq. 3.2 and 3.3.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "bank/ga.h"
#include "base/lanes.h"

const fap_blend_method *const fap_blend_methods[] = { &fap_blend_zhu,   &fap_blend_qp,
                                                      &fap_blend_ga,    &fap_blend_pca,
                                                      &fap_blend_rbf,   &fap_blend_fat,
                                                      &fap_blend_bones, NULL };

const float fap_blend_most_beside = 300;

static const fap_blend_method *method_at(int blend)
{
    for (int i = 0; blend >= 0 && fap_blend_methods[i]; i++)
        if (i == blend)
            return fap_blend_methods[i];
    return NULL;
}

const char *fap_blend_name(int blend)
{
    const fap_blend_method *m = method_at(blend);
    return m ? m->name : NULL;
}

const char *fap_blend_summary(int blend)
{
    const fap_blend_method *m = method_at(blend);
    return m ? m->summary : NULL;
}

/* --- shared --- */

/*
 * A mouth that does not quite close, or lids that leave a slit, are seen at once; a cheek half a millimetre
 * off is not.
 */
float fap_blend_importance(int row)
{
    const fap_point_info *info = fap_point_get(row / 3);

    switch (info->group) {
    case 2: return info->index == 1 ? 1 : info->index == 10 ? 0.5f : row % 3 == 1 ? 4 : 2;
    case 3: return 4;
    case 8: return 2;
    case 5:
    case 9: return 0.5f;
    case 10: return 0.25f;
    default: return 1;
    }
}

float fap_face_row_motion(const fap_face *face, int row, const float *weight)
{
    return fap_lanes_dot(face->motion + (size_t)row * (size_t)face->key_count, weight, face->key_count);
}

float fap_blend_row_motion(const fap_face *face, int row, const float *weight)
{
    float sum = face->field_share * face->field_motion[row];

    for (int r = 0; r < face->regions.count; r++) {
        const float share = face->regions.point[r][row / 3];
        if (share != 0)
            sum += share * fap_face_row_motion(face, row, weight + (size_t)r * (size_t)face->key_count);
    }
    return sum;
}

float fap_blend_row_target(const fap_face *face, int row)
{
    return face->target[row / 3][row % 3] - face->fixed_motion[row];
}

float fap_blend_shortfall(const fap_face *face, int row, const float *weight)
{
    return face->asked[row / 3][row % 3] - face->fixed_motion[row] - fap_blend_row_motion(face, row, weight);
}

float *fap_blend_region(const fap_face *face, float *weight, int region)
{
    return weight + (size_t)region * (size_t)face->key_count;
}

void fap_blend_copy_to_regions(const fap_face *face, float *weight)
{
    for (int r = 1; r < face->regions.count; r++)
        memcpy(fap_blend_region(face, weight, r), weight, sizeof *weight * (size_t)face->key_count);
}

float fap_blend_fitness(const fap_face *face, const float *weight)
{
    float target[3][FAP_GA_POINTS] = { 0 }, got[3][FAP_GA_POINTS] = { 0 };

    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        target[row % 3][row / 3] = fap_blend_row_target(face, row);
        got[row % 3][row / 3] = fap_blend_row_motion(face, row, weight);
    }
    return fap_ga_cosine(target[0], got[0], FAP_GA_POINTS);
}

float fap_blend_squared_error(const fap_face *face, const float *weight)
{
    float sum = 0;

    for (int r = 0; r < face->row_count; r++) {
        const float e = fap_blend_shortfall(face, face->row[r], weight);
        sum += e * e;
    }
    return sum;
}

static void add_squares(const fap_face *face, const float *a, float share, float *restrict sum)
{
    const int n = face->key_count;
    int i = 0;

    for (; i + FAP_LANES <= n; i += FAP_LANES)
        for (int k = 0; k < FAP_LANES; k++)
            sum[i + k] += share * (a[i + k] * a[i + k]);
    for (; i < n; i++)
        sum[i] += share * (a[i] * a[i]);
}

void fap_blend_beside(const fap_face *face, int region, const float *matrix, size_t stride, float *beside)
{
    float *asked = beside + face->key_count;

    memset(beside, 0, 2 * sizeof *beside * (size_t)face->key_count);
    for (int row = 0; row < FAP_ROWS; row++) {
        const uint8_t *w = face->wanted[row / 3];
        const float share = region < 0 ? 1 : face->regions.point[region][row / 3];
        if (w[row % 3])
            add_squares(face, matrix + (size_t)row * stride, share, asked);
        else if (!w[0] && !w[1] && !w[2])
            add_squares(face, matrix + (size_t)row * stride, share, beside);
    }
    for (int k = 0; k < face->key_count; k++)
        beside[k] = fminf(beside[k] / (asked[k] + 1e-3f), fap_blend_most_beside);
}

/* --- solving --- */

static void show_base(fap_face *face)
{
    for (int i = 0; i < face->base_count; i++)
        face->weight[face->base_key[i]] = face->base_weight[i];
    fap_blend_copy_to_regions(face, face->weight);
}

static void add_fixed(fap_face *face)
{
    for (int r = 0; r < face->regions.count; r++) {
        float *w = fap_blend_region(face, face->weight, r);
        for (int k = 0; k < face->key_count; k++)
            w[k] += face->fixed[k];
    }
}

void fap_face_solve(fap_face *face)
{
    memset(face->weight, 0, sizeof *face->weight * FAP_REGION_MAX * (size_t)face->key_count);
    face->field_share = 0;
    if (face->row_count)
        face->method->solve(face->state, face);
    else
        show_base(face);
    face->stats.fitness = fap_blend_fitness(face, face->weight);
    add_fixed(face);
}
