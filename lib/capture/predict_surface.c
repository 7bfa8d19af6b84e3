/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The local surface frame: the three nearest witnesses that make a triangle give two edges that stretch with the skin and
 * its normal; the hidden point keeps its coordinates in them. Source: Sanchez Lorenzo et al. 2003, section 5.2.
 */
#include <math.h>
#include <string.h>

#include "capture/predict.h"

/* Sine of the angle between two edges: less is no frame. */
static const double thin = 0.15;

typedef struct surface_state {
    uint16_t corner[3];
    double offset[3]; /* along two edges, as shares of them, and along the normal, in mm */
} surface_state;

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = a[axis] - b[axis];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Origin, two edges and the unit normal; 0: hidden, or nearly a line. */
static int frame_of(const surface_state *s, const gap *g, uint32_t f, double least_sine, double origin[3],
                    double axes[3][3])
{
    double b[3], c[3];

    if (!scene_still(g->scene, f, s->corner[0], origin) || !scene_still(g->scene, f, s->corner[1], b) ||
        !scene_still(g->scene, f, s->corner[2], c))
        return 0;
    subtract(b, origin, axes[0]);
    subtract(c, origin, axes[1]);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        axes[2][i] = axes[0][j] * axes[1][k] - axes[0][k] * axes[1][j];
    }
    const double length = sqrt(dot(axes[2], axes[2]));
    if (!(length > least_sine * sqrt(dot(axes[0], axes[0]) * dot(axes[1], axes[1]))) || !(length > 1e-3))
        return 0;
    for (int i = 0; i < 3; i++)
        axes[2][i] /= length;
    return 1;
}

/* In all frames that show them: a mouth that opens may lay three markers in a line. */
static int is_triangle(const surface_state *s, const gap *g)
{
    double v[3], origin[3], axes[3][3];
    int n = 0;

    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, 50)) {
        if (!scene_still(g->scene, f, s->corner[0], v) || !scene_still(g->scene, f, s->corner[1], v) ||
            !scene_still(g->scene, f, s->corner[2], v))
            continue;
        if (!frame_of(s, g, f, 2 * thin, origin, axes))
            return 0;
        n++;
    }
    return n > 0;
}

static int prepare(void *state, const gap *g)
{
    surface_state *s = state;

    for (uint32_t last = 2; last < g->count; last++)
        for (uint32_t middle = 1; middle < last; middle++)
            for (uint32_t first = 0; first < middle; first++) {
                s->corner[0] = g->witness[first];
                s->corner[1] = g->witness[middle];
                s->corner[2] = g->witness[last];
                if (is_triangle(s, g))
                    return 1;
            }
    return 0;
}

/* Coordinates of @p v in the frame: the part off the normal is solved for in the plane of the edges. */
static void coordinates(const double v[3], double axes[3][3], double out[3])
{
    const double uu = dot(axes[0], axes[0]), uv = dot(axes[0], axes[1]), vv = dot(axes[1], axes[1]);
    const double pu = dot(v, axes[0]), pv = dot(v, axes[1]), det = uu * vv - uv * uv;

    out[0] = (pu * vv - pv * uv) / det;
    out[1] = (pv * uu - pu * uv) / det;
    out[2] = dot(v, axes[2]);
}

static int learn(void *state, const gap *g)
{
    surface_state *s = state;
    double point[3], origin[3], axes[3][3], v[3], offset[3];
    uint32_t n = 0;

    memset(s->offset, 0, sizeof s->offset);
    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, 400)) {
        if (!gap_teaches(g, f, point) || !frame_of(s, g, f, thin, origin, axes))
            continue;
        subtract(point, origin, v);
        coordinates(v, axes, offset);
        for (int i = 0; i < 3; i++)
            s->offset[i] += offset[i];
        n++;
    }
    for (int i = 0; i < 3 && n; i++)
        s->offset[i] /= n;
    return n > 0;
}

static int at(const void *state, const gap *g, uint32_t frame, double out[3])
{
    const surface_state *s = state;
    double origin[3], axes[3][3];

    if (!frame_of(s, g, frame, thin, origin, axes))
        return 0;
    for (int axis = 0; axis < 3; axis++)
        out[axis] = origin[axis] + s->offset[0] * axes[0][axis] + s->offset[1] * axes[1][axis] +
                    s->offset[2] * axes[2][axis];
    return 1;
}

const predictor predictor_surface = { FAP_SAMPLE_SURFACE, sizeof(surface_state), prepare, learn, at };
