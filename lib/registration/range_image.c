/* SPDX-License-Identifier: BSD-2-Clause */
/* See range_image.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/range_image.h"

/* Unrolled: millimetres of a sample at the radius of a face, and how far to either side of straight ahead. */
static const double sample_mm = 0.6, radius_mm = 85, side_radians = 1.75;
/* Longer than from the axis to any nose. */
static const float outside_mm = 400;
/* Four neighbours farther apart than this are of two things, one in front of the other. */
static const double edge_mm = 6;
/* A blurred matte of this much has enough around it to be filled. */
static const float enough_matte = 0.4F;

enum { MOST_SIDE = 4096 };

/* --- out of a scan --- */

static fap_err allocate(range_image *im, const fap_allocator *alloc)
{
    const size_t n = (size_t)im->columns * im->rows;

    im->at = fap_mem_calloc(alloc, n, sizeof *im->at);
    im->matte = fap_mem_calloc(alloc, n, sizeof *im->matte);
    return im->at && im->matte ? FAP_OK : FAP_E_NOMEM;
}

static fap_err take_grid(range_image *im, const laying *l)
{
    const fap_surface *s = l->surface;

    im->columns = s->columns;
    im->rows = s->rows;
    im->sample_of = fap_mem_calloc(l->alloc, l->scan_vertices, sizeof *im->sample_of);
    const fap_err err = im->sample_of ? allocate(im, l->alloc) : FAP_E_NOMEM;
    if (err != FAP_OK)
        return err;
    for (uint32_t i = 0; i < l->scan_vertices; i++)
        im->sample_of[i] = UINT32_MAX;
    for (uint32_t i = 0; i < im->columns * im->rows; i++) {
        const uint32_t v = s->grid[i];
        if (v >= l->scan_vertices)
            continue;
        memcpy(im->at[i], l->scan[v], sizeof im->at[i]);
        im->matte[i] = 1;
        im->sample_of[v] = i;
    }
    return FAP_OK;
}

/* From outside towards the axis, as a turning laser scanner looks. */
static void cast(range_image *im, const laying *l, uint32_t column, uint32_t row)
{
    const double angle = im->left + column * im->pixel[0], y = im->top - row * im->pixel[1];
    const float way[3] = { (float)-sin(angle), 0, (float)-cos(angle) };
    const float from[3] = { (float)im->axis.x - outside_mm * way[0], (float)y,
                            (float)im->axis.z - outside_mm * way[2] };
    const size_t i = (size_t)row * im->columns + column;
    surface_hit h;

    if (!surface_index_ray(l->index, from, way, outside_mm, &h))
        return;
    memcpy(im->at[i], h.at, sizeof im->at[i]);
    im->matte[i] = 1;
}

static fap_err unroll(range_image *im, const laying *l)
{
    im->axis = cylinder_around(l->generic->position, l->generic->vertex_count);
    im->left = -side_radians;
    im->top = im->axis.high;
    im->pixel[0] = sample_mm / radius_mm;
    im->pixel[1] = sample_mm;
    im->columns = (uint32_t)fmin(MOST_SIDE, 2 * side_radians / im->pixel[0] + 1);
    im->rows = (uint32_t)fmax(2, fmin(MOST_SIDE, (im->axis.high - im->axis.low) / im->pixel[1] + 1));
    const fap_err err = allocate(im, l->alloc);
    for (uint32_t row = 0; err == FAP_OK && row < im->rows; row++)
        for (uint32_t column = 0; column < im->columns; column++)
            cast(im, l, column, row);
    return err;
}

fap_err range_image_open(range_image *im, const laying *l)
{
    *im = (range_image){ 0 };
    return l->surface->grid && l->surface->columns > 1 && l->surface->rows > 1 ? take_grid(im, l)
                                                                               : unroll(im, l);
}

void range_image_close(range_image *im, const fap_allocator *alloc)
{
    fap_mem_free(alloc, im->at);
    fap_mem_free(alloc, im->matte);
    fap_mem_free(alloc, im->sample_of);
    *im = (range_image){ 0 };
}

/* --- holes --- */

/* Mean of the nine around, of data times matte and of the matte alone. */
static float blur(const range_image *im, uint32_t column, uint32_t row, float at[3])
{
    float matte = 0;

    at[0] = at[1] = at[2] = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            const int64_t x = (int64_t)column + dx, y = (int64_t)row + dy;
            if (x < 0 || y < 0 || x >= im->columns || y >= im->rows)
                continue;
            const size_t i = (size_t)y * im->columns + (size_t)x;
            matte += im->matte[i] / 9;
            for (int a = 0; a < 3; a++)
                at[a] += im->matte[i] * im->at[i][a] / 9;
        }
    return matte;
}

fap_err range_image_fill(range_image *im, int rounds, const fap_allocator *alloc)
{
    const size_t n = (size_t)im->columns * im->rows;
    uint8_t *found = fap_mem_calloc(alloc, n, 1);

    for (int round = 0; found && round < rounds; round++) {
        memset(found, 0, n);
        for (uint32_t row = 0; row < im->rows; row++)
            for (uint32_t column = 0; column < im->columns; column++) {
                const size_t i = (size_t)row * im->columns + column;
                float at[3];
                const float matte = im->matte[i] > 0 ? 0 : blur(im, column, row, at);
                if (matte < enough_matte)
                    continue;
                for (int a = 0; a < 3; a++)
                    im->at[i][a] = at[a] / matte; /* nobody reads it before its matte is set */
                found[i] = 1;
            }
        for (size_t i = 0; i < n; i++) {
            im->filled += found[i];
            im->matte[i] = found[i] ? 1 : im->matte[i];
        }
    }
    fap_mem_free(alloc, found);
    return found ? FAP_OK : FAP_E_NOMEM;
}

/* --- in and out --- */

static int find_in_grid(const range_image *im, const laying *l, const double at[3], double pixel[2])
{
    const float there[3] = { (float)at[0], (float)at[1], (float)at[2] };
    surface_hit h;

    if (!surface_index_nearest(l->index, there, (float)l->cfg->reach_mm, NULL, NULL, &h))
        return 0;
    pixel[0] = pixel[1] = 0;
    for (int c = 0; c < 3; c++) {
        const uint32_t i = im->sample_of[l->scan_triangle[h.triangle][c]];
        if (i == UINT32_MAX)
            return 0;
        pixel[0] += (double)h.share[c] * (i % im->columns);
        pixel[1] += (double)h.share[c] * (i / im->columns);
    }
    return 1;
}

int range_image_find(const range_image *im, const laying *l, const double at[3], double pixel[2])
{
    const float there[3] = { (float)at[0], (float)at[1], (float)at[2] };
    double unrolled[3];

    if (im->sample_of)
        return find_in_grid(im, l, at, pixel);
    cylinder_unroll(&im->axis, there, unrolled);
    pixel[0] = (unrolled[0] - im->left) / im->pixel[0];
    pixel[1] = (im->top - unrolled[1]) / im->pixel[1];
    return 1;
}

int range_image_sample(const range_image *im, const double pixel[2], float at[3])
{
    const double x = floor(pixel[0]), y = floor(pixel[1]);
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    if (!(x >= 0 && y >= 0 && x + 1 < im->columns && y + 1 < im->rows))
        return 0;
    at[0] = at[1] = at[2] = 0;
    for (int k = 0; k < 4; k++) {
        const size_t i = ((size_t)y + (size_t)(k / 2)) * im->columns + (size_t)x + (size_t)(k % 2);
        const double share =
            (k % 2 ? pixel[0] - x : 1 - (pixel[0] - x)) * (k / 2 ? pixel[1] - y : 1 - (pixel[1] - y));
        if (!(im->matte[i] > 0))
            return 0;
        for (int a = 0; a < 3; a++) {
            at[a] += (float)(share * (double)im->at[i][a]);
            low[a] = fmin(low[a], (double)im->at[i][a]);
            high[a] = fmax(high[a], (double)im->at[i][a]);
        }
    }
    return high[0] - low[0] < edge_mm && high[1] - low[1] < edge_mm && high[2] - low[2] < edge_mm;
}
