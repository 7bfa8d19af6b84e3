/* SPDX-License-Identifier: BSD-2-Clause */
/* See fap/studio/range.h. */
#include <math.h>
#include <string.h>

#include <fap/studio/range.h>

#include "base/mem.h"

/* tan(83 degrees): how much deeper than wide a step between neighbours may be. */
static const double steepest = 8;

typedef struct meshing {
    const fap_range_image *image;
    const fap_range_camera *camera;
    fap_surface *out;
} meshing;

static double depth_of(const meshing *m, uint32_t i)
{
    const double d = (double)m->image->depth[i] * m->camera->unit_mm;
    return d > 0 && d < 1e9 ? d : 0;
}

static void place(const meshing *m, uint32_t column, uint32_t row, double depth, float out[3])
{
    out[0] = (float)((column - m->camera->cx) / m->camera->fx * depth);
    out[1] = (float)(-(row - m->camera->cy) / m->camera->fy * depth);
    out[2] = (float)-depth;
}

static void dress(const meshing *m, uint32_t column, uint32_t row, uint32_t v)
{
    const fap_range_image *im = m->image;
    const double u = (column + 0.5) / im->columns, w = (row + 0.5) / im->rows;

    m->out->uv[v][0] = (float)u;
    m->out->uv[v][1] = (float)(1 - w);
    if (!m->out->colour)
        return;
    const uint32_t x = (uint32_t)(u * im->colour_columns), y = (uint32_t)(w * im->colour_rows);
    memcpy(m->out->colour[v], im->rgb[(size_t)y * im->colour_columns + x], 3);
    m->out->colour[v][3] = 255;
}

static void make_vertices(const meshing *m)
{
    uint32_t v = 0;

    for (uint32_t row = 0; row < m->image->rows; row++)
        for (uint32_t column = 0; column < m->image->columns; column++) {
            const uint32_t i = row * m->image->columns + column;
            const double d = depth_of(m, i);
            m->out->grid[i] = UINT32_MAX;
            if (!(d > 0))
                continue;
            place(m, column, row, d, m->out->position[v]);
            dress(m, column, row, v);
            m->out->grid[i] = v++;
        }
}

/* The step in depth is one that a surface may make. */
static int hangs_together(const meshing *m, uint32_t a, uint32_t b)
{
    const double d[2] = { depth_of(m, a), depth_of(m, b) };
    const double wide = fmin(d[0], d[1]) / fmin(m->camera->fx, m->camera->fy);

    return fabs(d[0] - d[1]) <= steepest * wide;
}

static void link_three(const meshing *m, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t *grid = m->out->grid;

    if (grid[a] == UINT32_MAX || grid[b] == UINT32_MAX || grid[c] == UINT32_MAX || !hangs_together(m, a, b) ||
        !hangs_together(m, b, c) || !hangs_together(m, c, a))
        return;
    uint32_t *t = m->out->triangle[m->out->triangle_count++];
    t[0] = grid[a], t[1] = grid[b], t[2] = grid[c];
}

/* Rows run down and the camera looks at the front: top left, bottom left, top right is counter-clockwise. */
static void make_triangles(const meshing *m)
{
    const uint32_t wide = m->image->columns;

    m->out->triangle_count = 0;
    for (uint32_t row = 0; row + 1 < m->image->rows; row++)
        for (uint32_t column = 0; column + 1 < wide; column++) {
            const uint32_t i = row * wide + column;
            const int first = m->out->grid[i] != UINT32_MAX && m->out->grid[i + wide + 1] != UINT32_MAX;
            link_three(m, i, i + wide, first ? i + wide + 1 : i + 1);
            link_three(m, first ? i : i + 1, first ? i + wide + 1 : i + wide, first ? i + 1 : i + wide + 1);
        }
}

static uint32_t count_seen(const meshing *m)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < m->image->columns * m->image->rows; i++)
        count += depth_of(m, i) > 0;
    return count;
}

static fap_err allocate(meshing *m, fap_surface **out, const fap_allocator *alloc)
{
    const fap_range_image *im = m->image;
    const uint32_t seen = count_seen(m), cells = (im->columns - 1) * (im->rows - 1);

    if (!seen)
        return FAP_E_NOT_FOUND;
    const fap_err err = fap_surface_create(out, seen, 2 * cells, alloc);
    if (err != FAP_OK)
        return err;
    fap_surface *s = m->out = *out;
    s->format = "range";
    s->columns = im->columns;
    s->rows = im->rows;
    s->grid = fap_mem_calloc(&s->alloc, (size_t)im->columns * im->rows, sizeof *s->grid);
    s->uv = fap_mem_calloc(&s->alloc, seen, sizeof *s->uv);
    s->colour = im->rgb ? fap_mem_calloc(&s->alloc, seen, sizeof *s->colour) : NULL;
    return s->grid && s->uv && (!im->rgb || s->colour) ? FAP_OK : FAP_E_NOMEM;
}

static int is_camera(const fap_range_camera *c)
{
    return c->fx > 0 && c->fy > 0 && c->unit_mm > 0 && isfinite(c->fx) && isfinite(c->fy) &&
           isfinite(c->cx) && isfinite(c->cy) && isfinite(c->unit_mm);
}

fap_err fap_range_surface(fap_surface **out, const fap_range_image *image, const fap_range_camera *camera,
                          const fap_allocator *alloc)
{
    meshing m = { .image = image, .camera = camera };

    *out = NULL;
    if (image->columns < 2 || image->rows < 2 || !is_camera(camera) ||
        (image->rgb && (!image->colour_columns || !image->colour_rows)))
        return FAP_E_ARG;
    if (image->columns > FAP_RANGE_MAX_SIDE || image->rows > FAP_RANGE_MAX_SIDE)
        return FAP_E_LIMIT;
    const fap_err err = allocate(&m, out, alloc);
    if (err != FAP_OK) {
        fap_surface_close(out);
        return err;
    }
    make_vertices(&m);
    make_triangles(&m);
    return FAP_OK;
}
