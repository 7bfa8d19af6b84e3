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

/* --- given
 * ---------------------------------------------------------------------------------------------------------------
 */

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

/* --- found
 * ---------------------------------------------------------------------------------------------------------------
 */

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

/* How high a group of feature points sits, and how far in front, in rough steps. */
static int height_of(int group)
{
    static const int8_t height[12] = { [2] = -3, [3] = 2, [4] = 3, [5] = 0, [8] = -2, [9] = 0, [11] = 6 };
    return height[group];
}

static int frontness_of(const fap_point_info *info)
{
    const int on_midline = strcmp(info->name, fap_point_get(info->mirror)->name) == 0;

    if (info->group == 10)
        return -2;
    if (info->group == 2 || info->group == 8 || info->group == 9)
        return on_midline ? 1 : 0;
    return info->group == 3 || info->group == 4 || info->group == 5 ? -1 : 0;
}

/* Sum of places weighted by the deviation of a rough score from its mean: the direction in which the score
 * grows. */
static int direction(const performance *p, int by_height, double out[3])
{
    double place[FAP_POINT_COUNT][3], score[FAP_POINT_COUNT], mean = 0, spread = 0;
    int n = 0;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_point_info *info = fap_point_get(i);
        if (info->group == 6 || info->group == 7 || !neutral_point(p, i, place[n]))
            continue;
        score[n] = by_height ? height_of(info->group) : frontness_of(info);
        mean += score[n++];
    }
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < n; i++) {
        spread += fabs(score[i] - mean / n);
        for (int axis = 0; axis < 3; axis++)
            out[axis] += (score[i] - mean / n) * place[i][axis];
    }
    return n >= 3 && spread > 0.5 && normalise(out);
}

/* Rings have no feature points yet: brows are above mouths. */
static int upward(const performance *p, double out[3])
{
    double brow[3], mouth[3];

    if (direction(p, 1, out))
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

static int found(performance *p)
{
    double x[3], up[3], z[3], front[3];

    if (!leftward(p, x) || !upward(p, up))
        return 0;
    remove_part(up, x);
    if (!normalise(up))
        return 0;
    prefer_own_axis(x, up);
    cross(x, up, z);
    /* Middle points lie in front of side points by tens of millimetres; a mirrored face has them behind. */
    if (direction(p, 0, front) && dot(front, z) < -0.3) {
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

/* --- report
 * ------------------------------------------------------------------------------------------------------------
 */

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
    } else if (found(p)) {
        p->report->axes_found = 1;
    } else {
        memcpy(p->axes, straight, sizeof straight);
        performance_note(
            p, "too few points to find the head's axes: x left, y up, z forward is assumed; see --axes");
    }
    describe(p);
    return FAP_OK;
}
