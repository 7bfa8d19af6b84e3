/* SPDX-License-Identifier: BSD-2-Clause */
/* See raster.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "raster.h"
#include "track/vector.h"

int raster_make(raster *r, const fap_camera *camera)
{
    const size_t count = (size_t)camera->width_px * (size_t)camera->height_px;

    *r = (raster){ .camera = *camera };
    r->depth = malloc(count * sizeof *r->depth);
    r->rgb = malloc(3 * count);
    r->owner = malloc(count);
    return r->depth && r->rgb && r->owner;
}

void raster_free(raster *r)
{
    free(r->depth);
    free(r->rgb);
    free(r->owner);
}

void raster_clear(raster *r, const uint8_t rgb[3])
{
    const size_t count = (size_t)r->camera.width_px * (size_t)r->camera.height_px;

    for (size_t i = 0; i < count; i++) {
        r->depth[i] = INFINITY;
        memcpy(&r->rgb[3 * i], rgb, 3);
    }
    memset(r->owner, 0, count);
    r->drawing = 0;
}

/* --- pixels --- */

typedef struct box {
    int x0, y0, x1, y1; /* the last ones are outside */
} box;

static int clamp(double v, int most)
{
    return v < 0 ? 0 : v > most ? most : (int)v;
}

static box box_of(const raster *r, double x0, double y0, double x1, double y1)
{
    const int w = r->camera.width_px, h = r->camera.height_px;

    return (box){ clamp(floor(x0), w), clamp(floor(y0), h), clamp(ceil(x1) + 1, w), clamp(ceil(y1) + 1, h) };
}

static void ray_of(const raster *r, int x, int y, double ray[3])
{
    ray[0] = (x + r->shift_px[0] - r->camera.cx_px) / r->camera.fx_px;
    ray[1] = (y + r->shift_px[1] - r->camera.cy_px) / r->camera.fy_px;
    ray[2] = 1;
}

/* Where it appears, counted so that samples are at whole numbers. */
static void pixel_of(const raster *r, const double place[3], double pixel[2])
{
    pixel[0] = r->camera.fx_px * place[0] / place[2] + r->camera.cx_px - r->shift_px[0];
    pixel[1] = r->camera.fy_px * place[1] / place[2] + r->camera.cy_px - r->shift_px[1];
}

static size_t index_of(const raster *r, int x, int y)
{
    return (size_t)y * (size_t)r->camera.width_px + (size_t)x;
}

/* 1: nothing is before it. */
static int put(raster *r, int x, int y, double depth, double nearer, const uint8_t rgb[3])
{
    const size_t i = index_of(r, x, y);

    if (r->owner[i] != r->drawing || depth - nearer > r->depth[i])
        return 0;
    r->depth[i] = (float)fmin(depth, r->depth[i]);
    memcpy(&r->rgb[3 * i], rgb, 3);
    return 1;
}

/* --- triangles --- */

typedef struct corner2 {
    double x, y, w; /* w: 1 / z */
} corner2;

static double edge(const corner2 *a, const corner2 *b, double x, double y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static void put_blend(raster *r, int x, int y, const corner2 c[3], const double share[3],
                      const float colour[3][3])
{
    const double w = share[0] * c[0].w + share[1] * c[1].w + share[2] * c[2].w;
    uint8_t rgb[3];

    for (int k = 0; k < 3; k++)
        rgb[k] = (uint8_t)(share[0] * (double)colour[0][k] + share[1] * (double)colour[1][k] +
                           share[2] * (double)colour[2][k]);
    put(r, x, y, 1 / w, 0, rgb);
}

static void fill(raster *r, const corner2 c[3], const float colour[3][3])
{
    const double area = edge(&c[0], &c[1], c[2].x, c[2].y);
    const box b = box_of(r, fmin(c[0].x, fmin(c[1].x, c[2].x)), fmin(c[0].y, fmin(c[1].y, c[2].y)),
                         fmax(c[0].x, fmax(c[1].x, c[2].x)), fmax(c[0].y, fmax(c[1].y, c[2].y)));

    if (fabs(area) < 1e-9)
        return;
    for (int y = b.y0; y < b.y1; y++)
        for (int x = b.x0; x < b.x1; x++) {
            const double share[3] = { edge(&c[1], &c[2], x, y) / area, edge(&c[2], &c[0], x, y) / area,
                                      edge(&c[0], &c[1], x, y) / area };
            if (share[0] >= 0 && share[1] >= 0 && share[2] >= 0)
                put_blend(r, x, y, c, share, colour);
        }
}

void raster_triangle(raster *r, const float corner[3][3], const float colour[3][3])
{
    corner2 c[3];

    for (int i = 0; i < 3; i++) {
        const double place[3] = { (double)corner[i][0], (double)corner[i][1], (double)corner[i][2] };
        double pixel[2];
        if (!(place[2] > 1))
            return;
        pixel_of(r, place, pixel);
        c[i] = (corner2){ pixel[0], pixel[1], 1 / place[2] };
    }
    fill(r, c, colour);
}

/* --- discs and balls: where a pixel's ray meets them --- */

static box box_around(const raster *r, const double centre[3], double radius_mm)
{
    double pixel[2];
    const double near = fmax(centre[2] - radius_mm, 1), rx = r->camera.fx_px * radius_mm / near,
                 ry = r->camera.fy_px * radius_mm / near;

    pixel_of(r, centre, pixel);
    return box_of(r, pixel[0] - rx - 1, pixel[1] - ry - 1, pixel[0] + rx + 1, pixel[1] + ry + 1);
}

/* The depth at which a ray meets a plane; 0: never, or edge on. */
static double meets(const double ray[3], const double at[3], const double normal[3])
{
    const double slope = dot3(normal, ray);

    return fabs(slope) < 1e-6 ? 0 : dot3(normal, at) / slope;
}

raster_cover raster_disc(raster *r, const double centre[3], const double normal[3], double radius_mm,
                         double sunk_mm, const uint8_t rgb[3])
{
    raster_cover cover = { 0, 0 };
    const box b = box_around(r, centre, radius_mm);

    if (dot3(normal, centre) > 0) /* seen from behind */
        return cover;
    for (int y = b.y0; y < b.y1; y++)
        for (int x = b.x0; x < b.x1; x++) {
            double ray[3], off[3];
            ray_of(r, x, y, ray);
            const double depth = meets(ray, centre, normal);
            for (int k = 0; k < 3; k++)
                off[k] = depth * ray[k] - centre[k];
            if (depth <= 0 || dot3(off, off) > radius_mm * radius_mm)
                continue;
            cover.pixels++;
            cover.seen += put(r, x, y, depth, sunk_mm, rgb);
        }
    return cover;
}

/* The depth of a ball's near side on a ray; 0: it misses. */
static double hits(const double ray[3], const double centre[3], double radius_mm)
{
    const double a = dot3(ray, ray), b = dot3(ray, centre), c = dot3(centre, centre) - radius_mm * radius_mm;
    const double root = b * b - a * c;

    return root < 0 ? 0 : (b - sqrt(root)) / a;
}

raster_cover raster_ball(raster *r, const double centre[3], double radius_mm, const uint8_t rgb[3])
{
    raster_cover cover = { 0, 0 };
    const box b = box_around(r, centre, radius_mm);

    for (int y = b.y0; y < b.y1; y++)
        for (int x = b.x0; x < b.x1; x++) {
            double ray[3];
            ray_of(r, x, y, ray);
            const double depth = hits(ray, centre, radius_mm);
            if (depth <= 0)
                continue;
            cover.pixels++;
            cover.seen += put(r, x, y, depth, 0, rgb);
        }
    return cover;
}

/* --- glass --- */

static int on_glass(const double off[3], const double half[2][3])
{
    return fabs(dot3(off, half[0])) <= dot3(half[0], half[0]) &&
           fabs(dot3(off, half[1])) <= dot3(half[1], half[1]);
}

void raster_mirror(raster *r, const double middle[3], const double half[2][3], int owner,
                   const uint8_t rgb[3])
{
    double normal[3];

    cross3(half[0], half[1], normal);
    for (int y = 0; y < r->camera.height_px; y++)
        for (int x = 0; x < r->camera.width_px; x++) {
            const size_t i = index_of(r, x, y);
            double ray[3], off[3];
            ray_of(r, x, y, ray);
            const double depth = meets(ray, middle, normal);
            for (int k = 0; k < 3; k++)
                off[k] = depth * ray[k] - middle[k];
            if (depth <= 0 || depth > (double)r->depth[i] || !on_glass(off, half))
                continue;
            r->owner[i] = (uint8_t)owner;
            r->depth[i] = INFINITY;
            memcpy(&r->rgb[3 * i], rgb, 3);
        }
}
