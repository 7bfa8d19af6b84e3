/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Feature points out of markers: head motion removed, head axes, the mean where several markers stand for one
 * point. Also the rings whose markers have no documented order, and long gaps.
 */
#include <math.h>
#include <string.h>

#include "capture/performance.h"

static void to_head(const performance *p, const double v[3], float out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = (float)(p->axes[row][0] * v[0] + p->axes[row][1] * v[1] + p->axes[row][2] * v[2]);
}

int head_place(const performance *p, uint32_t point, float out[3])
{
    if (p->placed[point])
        to_head(p, p->place[point], out);
    return p->placed[point];
}

int marker_moved(const performance *p, uint32_t frame, uint32_t point, float out[3])
{
    double v[3];

    if (!p->placed[point] || !head_still(p, frame, point, v))
        return FAP_SAMPLE_MISSING;
    for (int axis = 0; axis < 3; axis++)
        v[axis] -= p->place[point][axis];
    to_head(p, v, out);
    return p->take->valid[(size_t)frame * p->take->point_count + point];
}

/* --- rings --- */

static void assign(performance *p, const char *name, int marker)
{
    fap_marker_source *s = &p->report->markers.point[fap_point_by_name(name)];

    if (s->count || marker < 0)
        return;
    *s = (fap_marker_source){ .count = 1, .near = 1, .index = { (int16_t)marker } };
}

/* The ring's marker with the largest x * a + y * b among those on the wanted side; side 0: all. -1: none. */
static int extreme(const performance *p, int role, float a, float b, int side, float middle)
{
    int best = -1;
    float most = -INFINITY;

    for (uint32_t i = 0; i < p->take->point_count; i++) {
        float h[3];
        if (!(p->report->markers.role[i] & role) || !p->placed[i])
            continue;
        to_head(p, p->place[i], h);
        if (side && (h[0] - middle) * (float)side <= 0)
            continue;
        if (h[0] * a + h[1] * b > most) {
            most = h[0] * a + h[1] * b;
            best = (int)i;
        }
    }
    return best;
}

static float ring_middle(const performance *p, int role, int axis)
{
    float low = INFINITY, high = -INFINITY;

    for (uint32_t i = 0; i < p->take->point_count; i++) {
        float h[3];
        if (!(p->report->markers.role[i] & role) || !p->placed[i])
            continue;
        to_head(p, p->place[i], h);
        low = fminf(low, h[axis]);
        high = fmaxf(high, h[axis]);
    }
    return 0.5f * (low + high);
}

/* Corners are the outermost markers, the midpoints the highest and lowest, the rest lies between on the
 * diagonals. */
static void assign_mouth(performance *p)
{
    const float x = ring_middle(p, FAP_MARKER_MOUTH, 0);

    if (!isfinite(x))
        return;
    assign(p, "8.3", extreme(p, FAP_MARKER_MOUTH, 1, 0, 0, 0));
    assign(p, "8.4", extreme(p, FAP_MARKER_MOUTH, -1, 0, 0, 0));
    assign(p, "8.1", extreme(p, FAP_MARKER_MOUTH, 0, 1, 0, 0));
    assign(p, "8.2", extreme(p, FAP_MARKER_MOUTH, 0, -1, 0, 0));
    assign(p, "8.5", extreme(p, FAP_MARKER_MOUTH, 0.7f, 1, 1, x));
    assign(p, "8.6", extreme(p, FAP_MARKER_MOUTH, -0.7f, 1, -1, x));
    assign(p, "8.7", extreme(p, FAP_MARKER_MOUTH, 0.7f, -1, 1, x));
    assign(p, "8.8", extreme(p, FAP_MARKER_MOUTH, -0.7f, -1, -1, x));
}

static void assign_brow(performance *p, int role, float outward, const char *inner, const char *middle,
                        const char *outer)
{
    assign(p, inner, extreme(p, role, -outward, 0, 0, 0));
    assign(p, outer, extreme(p, role, outward, 0, 0, 0));
    assign(p, middle, extreme(p, role, 0, 1, 0, 0));
}

void rings_assign(performance *p)
{
    assign_mouth(p);
    assign_brow(p, FAP_MARKER_BROW_LEFT, 1, "4.1", "4.3", "4.5");
    assign_brow(p, FAP_MARKER_BROW_RIGHT, -1, "4.2", "4.4", "4.6");
}

/* --- feature points --- */

/*
 * Each marker's own displacement from rest, so that a hidden one of several does not make the mean jump. Gives the
 * fap_sample that is the least sure of them.
 */
static int mean_displacement(const performance *p, uint32_t frame, const fap_marker_source *s, double out[3])
{
    int seen = 0, origin = FAP_SAMPLE_MISSING;

    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < s->count; k++) {
        double v[3];
        if (!p->placed[s->index[k]] || !head_still(p, frame, (uint32_t)s->index[k], v))
            continue;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += v[axis] - p->place[s->index[k]][axis];
        const int this = p->take->valid[(size_t)frame * p->take->point_count + (size_t)s->index[k]];
        origin = this > origin ? this : origin;
        seen++;
    }
    for (int axis = 0; axis < 3 && seen; axis++)
        out[axis] /= seen;
    return origin;
}

static void place_point(performance *p, int i)
{
    const fap_marker_source *s = &p->report->markers.point[i];
    double rest[3], moved[3];

    p->known[i] = neutral_point(p, i, rest) != 0;
    if (!p->known[i])
        return;
    to_head(p, rest, p->neutral[i]);
    for (uint32_t f = 0; f < p->frames; f++) {
        p->seen[f][i] = (uint8_t)mean_displacement(p, f, s, moved);
        if (p->seen[f][i])
            to_head(p, moved, p->point[f][i]);
    }
}

void points_place(performance *p)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++)
        place_point(p, i);
}

/* --- long gaps --- */

/* Slow at both ends, so that neither end shows. */
static void ease_gap(performance *p, int i, uint32_t before, uint32_t after)
{
    for (uint32_t f = before + 1; f < after; f++) {
        const float t = (float)(f - before) / (float)(after - before), part = t * t * (3 - 2 * t);
        for (int axis = 0; axis < 3; axis++)
            p->point[f][i][axis] =
                p->point[before][i][axis] + part * (p->point[after][i][axis] - p->point[before][i][axis]);
        p->seen[f][i] = FAP_SAMPLE_EASED;
    }
}

static void ease_point(performance *p, int i)
{
    uint32_t last = UINT32_MAX;

    for (uint32_t f = 0; f < p->frames; f++) {
        if (!p->seen[f][i])
            continue;
        if (last != UINT32_MAX && f > last + 1) {
            ease_gap(p, i, last, f);
            p->report->gaps_eased++;
        }
        last = f;
    }
}

void points_ease(performance *p)
{
    if (p->cfg->fill != FAP_FILL_ALL)
        return;
    for (int i = 0; i < FAP_POINT_COUNT; i++)
        if (p->known[i])
            ease_point(p, i);
}
