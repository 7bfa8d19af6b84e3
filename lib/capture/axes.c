/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The head's axes in the coordinates of the take: x to the face's left, y up, z forward. Left and right
 * points of the neutral face give x; y is the take's own axis that points from the chin to the brows, since a
 * studio's vertical is better than a face's; z follows. What should lie in front decides whether left and
 * right were meant the other way. Source: ISO/IEC 14496-2, Annex C, head coordinate system.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "capture/performance.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static int normalise(double v[3])
{
    const double length = sqrt(dot(v, v));

    if (!(length > 1e-6))
        return 0;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return 1;
}

static void remove_part(double v[3], const double unit[3])
{
    const double part = dot(v, unit);

    for (int i = 0; i < 3; i++)
        v[i] -= part * unit[i];
}

/* --- given --- */

/* "x-zy": one axis of the take, with its sign, for each axis of the head. */
static int parse_axes(const char *text, double axes[3][3])
{
    int used = 0;

    memset(axes, 0, 9 * sizeof(double));
    for (int row = 0; row < 3; row++) {
        const double sign = *text == '-' ? -1 : 1;
        text += *text == '-' || *text == '+';
        const int axis = (*text | 32) - 'x';
        if (axis < 0 || axis > 2 || used & 1 << axis)
            return 0;
        used |= 1 << axis;
        axes[row][axis] = sign;
        text++;
    }
    return !*text;
}

/* --- found --- */

/* Mean place of all markers with a role; 0 when there is none. */
static int role_centre(const performance *p, int role, double out[3])
{
    uint32_t n = 0;

    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = 0; i < p->take->point_count; i++) {
        if (!(p->report->markers.role[i] & role) || !p->placed[i])
            continue;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += p->place[i][axis];
        n++;
    }
    for (int axis = 0; axis < 3 && n; axis++)
        out[axis] /= n;
    return n > 0;
}

/* The table's own words: "left eyebrow, right end" is on the left. Points that it only places between others
 * do not say. */
static int is_left(int point)
{
    const char *text = fap_point_get(point)->description;
    const char *left = strstr(text, "left"), *right = strstr(text, "right");

    return left && (!right || left < right);
}

/* Sum of the vectors from right points to their left partners. */
static int leftward(const performance *p, double out[3])
{
    double left[3], right[3];
    int pairs = 0;

    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const int other = fap_point_get(i)->mirror;
        if (other == i || !is_left(i))
            continue;
        if (!neutral_point(p, i, left) || !neutral_point(p, other, right))
            continue;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += left[axis] - right[axis];
        pairs++;
    }
    if (role_centre(p, FAP_MARKER_BROW_LEFT, left) && role_centre(p, FAP_MARKER_BROW_RIGHT, right)) {
        for (int axis = 0; axis < 3; axis++)
            out[axis] += left[axis] - right[axis];
        pairs++;
    }
    return pairs > 0 && normalise(out);
}

/* How high a group of feature points sits, in rough steps. */
static int height_of(int group)
{
    static const int8_t height[12] = { [2] = -3, [3] = 2, [4] = 3, [5] = 0, [8] = -2, [9] = 0, [11] = 6 };
    return height[group];
}

/* Sum of places weighted by how much higher than the average they should be: the direction in which height
 * grows. */
static int heightward(const performance *p, double out[3])
{
    double place[FAP_POINT_COUNT][3], height[FAP_POINT_COUNT], mean = 0, spread = 0;
    int n = 0;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const int group = fap_point_get(i)->group;
        if (group == 6 || group == 7 || group == 10 || !neutral_point(p, i, place[n]))
            continue;
        height[n] = height_of(group);
        mean += height[n++];
    }
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < n; i++) {
        spread += fabs(height[i] - mean / n);
        for (int axis = 0; axis < 3; axis++)
            out[axis] += (height[i] - mean / n) * place[i][axis];
    }
    return n >= 3 && spread > 0.5 && normalise(out);
}

/* Solves the 3x3 system in place; 0 when it has no single answer. */
static int solve3(double a[3][4])
{
    for (int c = 0; c < 3; c++) {
        int pivot = c;
        for (int r = c + 1; r < 3; r++)
            if (fabs(a[r][c]) > fabs(a[pivot][c]))
                pivot = r;
        if (fabs(a[pivot][c]) < 1e-6)
            return 0;
        for (int k = 0; k < 4; k++) {
            const double t = a[c][k];
            a[c][k] = a[pivot][k];
            a[pivot][k] = t;
        }
        for (int r = 0; r < 3; r++) {
            const double f = r == c ? 0 : a[r][c] / a[c][c];
            for (int k = c; k < 4; k++)
                a[r][k] -= f * a[c][k];
        }
    }
    return 1;
}

/*
 * A face falls back towards its sides. The fit z = a + b y + c |x| over all points tells by the sign of c,
 * whichever way the head nods: 1 when what is called forward is backward.
 */
static int is_inside_out(const performance *p, const double x[3], const double y[3], const double z[3])
{
    static const double clear_slope = 0.15;
    double normal[3][4] = { { 0 } }, place[3], middle = 0;
    int n = 0;

    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < FAP_POINT_COUNT; i++) {
            const int group = fap_point_get(i)->group;
            if (group == 6 || group == 7 || !neutral_point(p, i, place))
                continue;
            if (pass == 0) {
                middle += dot(place, x);
                n++;
                continue;
            }
            const double term[4] = { 1, dot(place, y), fabs(dot(place, x) - middle / n), dot(place, z) };
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 4; c++)
                    normal[r][c] += term[r] * term[c];
        }
    return n >= 6 && solve3(normal) && normal[2][3] / normal[2][2] > clear_slope;
}

/* Rings have no feature points yet: brows are above mouths. */
static int upward(const performance *p, double out[3])
{
    double brow[3], mouth[3];

    if (heightward(p, out))
        return 1;
    if (!role_centre(p, FAP_MARKER_BROW_LEFT | FAP_MARKER_BROW_RIGHT, brow) ||
        !role_centre(p, FAP_MARKER_MOUTH, mouth))
        return 0;
    for (int axis = 0; axis < 3; axis++)
        out[axis] = brow[axis] - mouth[axis];
    return normalise(out);
}

/* The take's own axis nearest to @p up replaces it, unless the head is far from upright. */
static void prefer_own_axis(const double x[3], double up[3])
{
    static const double least_cosine = 0.85;
    int best = 0;
    double own[3] = { 0 };

    for (int axis = 1; axis < 3; axis++)
        if (fabs(up[axis]) > fabs(up[best]))
            best = axis;
    own[best] = up[best] > 0 ? 1 : -1;
    remove_part(own, x);
    if (normalise(own) && dot(own, up) > least_cosine)
        memcpy(up, own, sizeof own);
}

static void swap_sides(performance *p)
{
    fap_marker_source swapped[FAP_POINT_COUNT];

    for (int i = 0; i < FAP_POINT_COUNT; i++)
        swapped[i] = p->report->markers.point[fap_point_get(i)->mirror];
    memcpy(p->report->markers.point, swapped, sizeof swapped);
    p->report->sides_swapped = 1;
    performance_note(
        p, "left and right names lie on the other side than the face in this take says: they are swapped; "
           "--axes keeps them");
}

/*
 * Coils lie in the plane that parts left from right, and none of a pair: forward is from the tongue's body to the lips, up
 * from the lower lip to the upper.
 */
static int found_in_mouth(performance *p)
{
    double tongue[3], upper[3], lower[3], forward[3], up[3], left[3];

    if (!neutral_point(p, fap_point_by_name("6.2"), tongue) ||
        !neutral_point(p, fap_point_by_name("8.1"), upper) ||
        !neutral_point(p, fap_point_by_name("8.2"), lower))
        return 0;
    for (int axis = 0; axis < 3; axis++) {
        up[axis] = upper[axis] - lower[axis];
        forward[axis] = (upper[axis] + lower[axis]) / 2 - tongue[axis];
    }
    if (!normalise(up))
        return 0;
    prefer_own_axis((const double[3]){ 0 }, up);
    remove_part(forward, up);
    if (!normalise(forward))
        return 0;
    prefer_own_axis(up, forward);
    cross(up, forward, left);
    memcpy(p->axes[0], left, sizeof left);
    memcpy(p->axes[1], up, sizeof up);
    memcpy(p->axes[2], forward, sizeof forward);
    return 1;
}

static int found(performance *p)
{
    double x[3], up[3], z[3];

    if (!leftward(p, x) || !upward(p, up))
        return 0;
    remove_part(up, x);
    if (!normalise(up))
        return 0;
    prefer_own_axis(x, up);
    cross(x, up, z);
    if (is_inside_out(p, x, up, z)) {
        for (int axis = 0; axis < 3; axis++) {
            x[axis] = -x[axis];
            z[axis] = -z[axis];
        }
        swap_sides(p);
    }
    memcpy(p->axes[0], x, sizeof x);
    memcpy(p->axes[1], up, sizeof up);
    memcpy(p->axes[2], z, sizeof z);
    return 1;
}

/* --- report --- */

static void describe(performance *p)
{
    double worst = 1;
    char *text = p->report->axes;

    for (int row = 0; row < 3; row++) {
        int best = 0;
        for (int axis = 1; axis < 3; axis++)
            if (fabs(p->axes[row][axis]) > fabs(p->axes[row][best]))
                best = axis;
        *text++ = p->axes[row][best] < 0 ? '-' : '+';
        *text++ = (char)('x' + best);
        worst = fmin(worst, fabs(p->axes[row][best]));
    }
    *text = '\0';
    p->report->axes_turn_deg = acos(fmin(1, worst)) * 57.29577951308232;
}

fap_err axes_find(performance *p)
{
    static const double straight[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };

    if (p->cfg->axes) {
        if (!parse_axes(p->cfg->axes, p->axes))
            return performance_fail(
                p, FAP_E_ARG, "--axes %s: expected three of x, y, z with signs, like x-zy", p->cfg->axes);
    } else if (found(p) || found_in_mouth(p)) {
        p->report->axes_found = 1;
    } else {
        memcpy(p->axes, straight, sizeof straight);
        performance_note(
            p, "too few points to find the head's axes: x left, y up, z forward is assumed; see --axes");
    }
    describe(p);
    return FAP_OK;
}
