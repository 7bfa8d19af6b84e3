/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Two repairs of MakeHuman's mouth at rest. Its lips stand up to 3 mm apart, by identity: the gap is measured
 * on a depth picture of the mouth and both lips move into it. Its upper teeth end where the lower ones begin,
 * so that speech hardly shows them: they are made to reach a little lower, behind the lower lip.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "databank/build/makehuman.h"

enum { GRID_W = 256, GRID_H = 96, PASSES = 4 };

/* Depth of the skin seen from the front, middle of the mouth in the middle of the picture. */
typedef struct depth {
    float x0, y0, step_mm;
    float z[GRID_H][GRID_W];
} depth;

typedef struct gap {
    float half[GRID_W], middle[GRID_W]; /* half height, 0: closed; height of its middle */
} gap;

static float edge(const float a[3], const float b[3], float x, float y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void draw_pixel(depth *d, int x, int y, const float *a, const float *b, const float *c)
{
    const float px = d->x0 + d->step_mm * ((float)x + 0.5f), py = d->y0 + d->step_mm * ((float)y + 0.5f);
    const float area = edge(a, b, c[0], c[1]), u = edge(b, c, px, py) / area, v = edge(c, a, px, py) / area;
    const float z = u * a[2] + v * b[2] + (1 - u - v) * c[2];

    if (u >= 0 && v >= 0 && u + v <= 1 && z > d->z[y][x])
        d->z[y][x] = z;
}

static int clamp_cell(float value, int count)
{
    return value < 0 ? 0 : value > (float)(count - 1) ? count - 1 : (int)value;
}

/* Backs count too: the far wall of the mouth is no lip whichever way it looks. */
static void draw_triangle(depth *d, const float *a, const float *b, const float *c)
{
    const float left = fminf(a[0], fminf(b[0], c[0])), right = fmaxf(a[0], fmaxf(b[0], c[0]));
    const float low = fminf(a[1], fminf(b[1], c[1])), high = fmaxf(a[1], fmaxf(b[1], c[1]));

    if (fabsf(edge(a, b, c[0], c[1])) < 1e-6f || right < d->x0 || left > d->x0 + GRID_W * d->step_mm ||
        high < d->y0 || low > d->y0 + GRID_H * d->step_mm)
        return;
    const int x1 = clamp_cell((right - d->x0) / d->step_mm, GRID_W),
              y1 = clamp_cell((high - d->y0) / d->step_mm, GRID_H);
    for (int y = clamp_cell((low - d->y0) / d->step_mm, GRID_H); y <= y1; y++)
        for (int x = clamp_cell((left - d->x0) / d->step_mm, GRID_W); x <= x1; x++)
            draw_pixel(d, x, y, a, b, c);
}

static void draw_mouth(depth *d, const mh_face *f)
{
    for (int y = 0; y < GRID_H; y++)
        for (int x = 0; x < GRID_W; x++)
            d->z[y][x] = -1e9f;
    for (uint32_t t = 0; t < f->triangle_count; t++)
        if (f->part[f->triangle[t][0]] == FAP_PART_SKIN)
            draw_triangle(d, f->position[f->triangle[t][0]], f->position[f->triangle[t][1]],
                          f->position[f->triangle[t][2]]);
}

/* A cell is in the gap when lips stand before it both above and below, within 5 mm. */
static int in_gap(const depth *d, int x, int y)
{
    const int reach = (int)(5 / d->step_mm);
    const float behind_mm = 2.5f;
    int above = 0, below = 0;

    for (int i = 1; i <= reach; i++) {
        above |= y + i < GRID_H && d->z[y + i][x] > d->z[y][x] + behind_mm;
        below |= y - i >= 0 && d->z[y - i][x] > d->z[y][x] + behind_mm;
    }
    return above && below;
}

static float measure_gap(const depth *d, gap *g)
{
    float widest = 0;

    for (int x = 0; x < GRID_W; x++) {
        int low = GRID_H, high = -1;
        for (int y = 0; y < GRID_H; y++)
            if (in_gap(d, x, y)) {
                low = y < low ? y : low;
                high = y;
            }
        g->half[x] = high < 0 ? 0 : 0.5f * d->step_mm * (float)(high - low + 1);
        g->middle[x] = high < 0 ? 0 : d->y0 + d->step_mm * (0.5f * (float)(high + low) + 0.5f);
        widest = fmaxf(widest, g->half[x]);
    }
    return widest;
}

/* Half the gap at x, the widest within 1.5 mm: the sides of a narrow gap must move as one. */
static float half_gap(const gap *g, const depth *d, float x, float *middle)
{
    const int centre = (int)((x - d->x0) / d->step_mm), reach = (int)(1.5f / d->step_mm);
    float half = 0;

    for (int i = centre - reach; i <= centre + reach; i++)
        if (i >= 0 && i < GRID_W && g->half[i] > half) {
            half = g->half[i];
            *middle = g->middle[i];
        }
    return half;
}

/* -1: upper lip, 1: lower lip, from how far the vertex follows the jaw. */
static float lip_side(const float (*jaw)[3], uint32_t v, float full)
{
    return fminf(1, fmaxf(-1, 5 * (jaw[v][1] / full - 0.42f)));
}

static void pull_together(mh_face *f, const gap *g, const depth *d, const float (*jaw)[3], float full,
                          float front)
{
    for (uint32_t v = 0; v < f->count; v++) {
        float *p = f->position[v], middle = 0;
        if (f->part[v] != FAP_PART_SKIN || p[2] < front - 35)
            continue;
        const float half = half_gap(g, d, p[0], &middle), away = (p[1] - middle) / 7;
        if (half > 0)
            p[1] += lip_side(jaw, v, full) * (half + 0.12f) * expf(-away * away);
    }
}

fap_err mh_close_lips(mh_face *f)
{
    const float *upper = mh_face_point(f, "2.2"), *left = mh_face_point(f, "8.3");
    int jaw = -1;

    for (int u = 0; u < MH_FILE_UNITS; u++)
        if (!strcmp(mh_unit_names[u], "jawOpen") && f->source->unit[u])
            jaw = u;
    depth *d = jaw < 0 || !upper || !left ? NULL : malloc(sizeof *d);
    if (!d)
        return jaw < 0 || !upper || !left ? FAP_E_DATA : FAP_E_NOMEM;

    d->step_mm = 2.4f * left[0] / GRID_W;
    d->x0 = -0.5f * GRID_W * d->step_mm;
    d->y0 = upper[1] - 0.5f * GRID_H * d->step_mm;
    const float full = f->unit[jaw][mh_face_vertex(f, 493)][1],
                front = upper[2]; /* 493: middle of the lower lip, 2.3 */
    for (int pass = 0; pass < PASSES; pass++) {
        gap g;
        draw_mouth(d, f);
        if (measure_gap(d, &g) == 0)
            break;
        pull_together(f, &g, d, (const float(*)[3])f->unit[jaw], full, front);
    }
    free(d);
    return FAP_OK;
}

void mh_lengthen_teeth(mh_face *f)
{
    const mh_patch *p = &f->patch[MH_TEETH_UPPER];
    const float *tip = mh_face_point(f, "9.10"), *root = mh_face_point(f, "9.8");
    if (!tip || !root || !(root[1] > tip[1]))
        return;
    const float low = tip[1], high = root[1], more_mm = 5.4f, forward_mm = 2.4f;

    for (uint32_t v = p->first; v < p->first + p->count; v++) {
        const float t = fminf(1, fmaxf(0, (high - f->position[v][1]) / (high - low)));
        f->position[v][1] -= more_mm * t * t;
        f->position[v][2] += forward_mm;
    }
}
