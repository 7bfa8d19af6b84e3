/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick_view.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "databank/pick/pick_view.h"
#include "surface/normals.h"

static const double margin = 1.06;
static const uint8_t plaster[3] = { 214, 204, 194 }, nothing[4] = { 46, 52, 60, 255 };

int pick_scene_open(pick_scene *s)
{
    s->normal = malloc(s->vertex_count * sizeof *s->normal);
    if (s->normal)
        surface_normals(s->position, s->vertex_count, s->triangle, s->triangle_count, s->normal);
    return s->normal != NULL;
}

void pick_scene_close(pick_scene *s)
{
    free(s->normal);
    s->normal = NULL;
}

int pick_view_open(pick_view *v, int width, int height)
{
    *v = (pick_view){ .width = width, .height = height, .rgba = calloc(4, (size_t)width * (size_t)height) };
    return v->rgba != NULL;
}

void pick_view_close(pick_view *v)
{
    free(v->rgba);
    v->rgba = NULL;
}

/* --- where it is looked from --- */

/* Rows of the turn are the screen's axes as the front sees them. */
static void look_from(pick_view *v, const double turn[3][3], pick_side side)
{
    for (int a = 0; a < 3; a++) {
        v->up[a] = turn[1][a];
        v->right[a] = side == PICK_FRONT ? turn[0][a] : side == PICK_RIGHT ? turn[2][a] : -turn[2][a];
        v->toward[a] = side == PICK_FRONT ? turn[2][a] : side == PICK_RIGHT ? -turn[0][a] : turn[0][a];
    }
}

static double along(const double axis[3], const float p[3])
{
    return axis[0] * (double)p[0] + axis[1] * (double)p[1] + axis[2] * (double)p[2];
}

/* All of the scene fits in, whichever side it is seen from. */
static void frame(pick_view *v, const pick_scene *s)
{
    const double *const axis[3] = { v->right, v->up, v->toward };
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    for (uint32_t i = 0; i < s->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            const double x = along(axis[k], s->position[i]);
            low[k] = fmin(low[k], x);
            high[k] = fmax(high[k], x);
        }
    for (int a = 0; a < 3; a++) {
        v->middle[a] = 0;
        for (int k = 0; k < 3; k++)
            v->middle[a] += axis[k][a] * (low[k] + high[k]) / 2;
    }
    const double wide = fmax(high[0] - low[0], high[2] - low[2]), tall = high[1] - low[1];
    v->pixel = fmax(1e-12, margin * fmax(wide / v->width, tall / v->height));
    v->depth = (high[2] - low[2]) * 0.51 + v->pixel;
}

/* --- rays --- */

static int cast(const pick_view *v, const pick_scene *s, double x, double y, surface_hit *h)
{
    float from[3], direction[3];

    for (int a = 0; a < 3; a++) {
        from[a] = (float)(v->middle[a] + v->right[a] * (x - v->width / 2.0) * v->pixel -
                          v->up[a] * (y - v->height / 2.0) * v->pixel + v->toward[a] * v->depth);
        direction[a] = (float)-v->toward[a];
    }
    return surface_index_ray(s->index, from, direction, (float)(2 * v->depth), h);
}

int pick_view_cast(const pick_view *v, const pick_scene *s, double x, double y, float at[3])
{
    surface_hit h;

    if (!cast(v, s, x, y, &h))
        return 0;
    memcpy(at, h.at, sizeof h.at);
    return 1;
}

void pick_view_project(const pick_view *v, const float at[3], double pixel[2])
{
    const float d[3] = { (float)((double)at[0] - v->middle[0]), (float)((double)at[1] - v->middle[1]),
                         (float)((double)at[2] - v->middle[2]) };

    pixel[0] = v->width / 2.0 + along(v->right, d) / v->pixel;
    pixel[1] = v->height / 2.0 - along(v->up, d) / v->pixel;
}

/* --- light --- */

/* From above, a little to the left of who looks. */
static double light(const pick_view *v, const pick_scene *s, const surface_hit *h)
{
    double dot = 0, length = 0;

    for (int a = 0; a < 3; a++) {
        double n = 0;
        for (int c = 0; c < 3; c++)
            n += (double)(h->share[c] * s->normal[s->triangle[h->triangle][c]][a]);
        dot += n * (0.75 * v->toward[a] + 0.5 * v->up[a] - 0.4 * v->right[a]);
        length += n * n;
    }
    return 0.22 + 0.78 * fmin(1, fmax(0, dot / fmax(1e-9, sqrt(length))));
}

static void shade(const pick_view *v, const pick_scene *s, const surface_hit *h, uint8_t rgba[4])
{
    const double bright = light(v, s, h);

    for (int a = 0; a < 3; a++) {
        double own = s->colour ? 0 : plaster[a];
        for (int c = 0; s->colour && c < 3; c++)
            own += (double)h->share[c] * s->colour[s->triangle[h->triangle][c]][a];
        rgba[a] = (uint8_t)fmin(255, bright * own);
    }
    rgba[3] = 255;
}

/* The depth stays that of the whole scene, seen from the new middle. */
static void go_near(pick_view *v, const float focus[3], double zoom)
{
    for (int a = 0; a < 3; a++)
        v->middle[a] = (double)focus[a];
    v->pixel /= zoom;
    v->depth *= 2;
}

void pick_view_draw(pick_view *v, const pick_scene *s, const double turn[3][3], pick_side side,
                    const float *focus, double zoom)
{
    look_from(v, turn, side);
    frame(v, s);
    if (focus)
        go_near(v, focus, zoom);
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            uint8_t *rgba = v->rgba + 4 * ((size_t)y * (size_t)v->width + (size_t)x);
            surface_hit h;
            if (cast(v, s, x + 0.5, y + 0.5, &h))
                shade(v, s, &h, rgba);
            else
                memcpy(rgba, nothing, sizeof nothing);
        }
}
