/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Head motion: the markers that follow the skull, and the pose they give in each frame. Named markers are
 * taken as they are, but for one that slips. Those of a marker set are a start: they lie on skin too (a forehead
 * marker rises with the brow), so others that carry no FAP and keep their place join in, and each is weighted by
 * how well it keeps it. Sources: Lorenzo et al. 4.2 (rigid markers), Zhu 2006 chapter 6 (the nose's tip).
 */
#include <math.h>

#include "capture/performance.h"

/* Lips, jaw and tongue may be near one another for a whole take and still are no head. */
static int is_of_mouth(int feature_point)
{
    const int group = fap_point_get(feature_point)->group, index = fap_point_get(feature_point)->index;
    return group == 2 || group == 6 || group == 8 || (group == 9 && index >= 8 && index <= 11);
}

static int is_not_of_mouth(const performance *p, uint32_t point)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_marker_source *s = &p->report->markers.point[i];
        for (int k = 0; k < s->count; k++)
            if (s->index[k] == (int16_t)point && is_of_mouth(i))
                return 0;
    }
    return !(p->report->markers.role[point] & (FAP_MARKER_INSIDE | FAP_MARKER_MOUTH));
}

/* May the point be rigid without disturbing a FAP: it moves with no feature point that FAPs move. */
static int is_free(const performance *p, uint32_t point)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_marker_source *s = &p->report->markers.point[i];
        for (int k = 0; k < s->count; k++)
            if (s->index[k] == (int16_t)point && fap_point_get(i)->moved)
                return 0;
    }
    return !(p->report->markers.role[point] & (FAP_MARKER_BROW_LEFT | FAP_MARKER_BROW_RIGHT)) &&
           is_not_of_mouth(p, point);
}

/* Of more points than there is room for, as many spread evenly. */
static uint32_t list_points(const performance *p, int (*wanted)(const performance *, uint32_t), uint16_t *out)
{
    uint32_t all = 0, met = 0, n = 0;

    for (uint32_t i = 0; i < p->take->point_count; i++)
        all += wanted(p, i) != 0;
    const uint32_t room = all < RIGID_MAX_POINTS ? all : RIGID_MAX_POINTS;
    for (uint32_t i = 0; i < p->take->point_count && n < room; i++)
        if (wanted(p, i) && (uint64_t)met++ * room >= (uint64_t)n * all)
            out[n++] = (uint16_t)i;
    return n;
}

static int is_rigid(const performance *p, uint32_t point)
{
    return (p->report->markers.role[point] & FAP_MARKER_RIGID) != 0;
}

static void note_left_out(performance *p, const rigid_body *whole)
{
    for (uint32_t i = 0; i < whole->count; i++) {
        uint32_t k = 0;
        while (k < p->body.count && p->body.point[k] != whole->point[i])
            k++;
        if (k == p->body.count)
            performance_note(p, "%s does not keep its place among the rigid markers: it is left out",
                             p->take->name[whole->point[i]]);
    }
}

/*
 * A cap that is knocked, a dot that comes off: its weight falls, but what is left of it still turns the head. When
 * most of the others keep their distances, they do without it.
 */
static void drop_slipped(performance *p)
{
    static const double slipped_mm = 2;
    const rigid_body whole = p->body;
    double worst = 0;

    for (uint32_t i = 0; i < whole.count; i++)
        worst = fmax(worst, rigid_body_stray(&whole, i));
    if (whole.count < 4 || worst < slipped_mm)
        return;
    if (rigid_body_find(&p->body, p->take, whole.point, whole.count) && 2 * p->body.count > whole.count) {
        rigid_body_extend(&p->body, p->take, whole.point, whole.count, slipped_mm);
        note_left_out(p, &whole);
    } else {
        p->body = whole;
    }
}

static int learn_named(performance *p)
{
    p->body.count = list_points(p, is_rigid, p->body.point);
    if (p->body.count < 3 || !rigid_body_learn(&p->body, p->take))
        return 0;
    drop_slipped(p);
    return 1;
}

/* First among points that carry no FAP, then among all but the mouth's. */
static int find_any(performance *p)
{
    uint16_t candidate[RIGID_MAX_POINTS];

    return rigid_body_find(&p->body, p->take, candidate, list_points(p, is_free, candidate)) ||
           rigid_body_find(&p->body, p->take, candidate, list_points(p, is_not_of_mouth, candidate));
}

/* Those join that keep their place as well as the others do: skin among bones only turns the head. */
static void extend(performance *p)
{
    const double limit_mm = fmin(1.5, fmax(0.4, 3 * p->body.rms_mm));
    uint16_t candidate[RIGID_MAX_POINTS];

    rigid_body_extend(&p->body, p->take, candidate, list_points(p, is_free, candidate), limit_mm);
}

/*
 * Forehead markers ride on the brows: in a brow take they turn the head by degrees and the chin by a
 * centimetre. When the set's markers do not keep their distances, a larger group that does is better. (A
 * smaller one is often just close together.)
 */
static int replace_loose(performance *p)
{
    static const double loose_mm = 0.7;
    uint16_t candidate[RIGID_MAX_POINTS];
    const rigid_body named = p->body;

    if (named.rms_mm < loose_mm)
        return 0;
    if (rigid_body_find(&p->body, p->take, candidate, list_points(p, is_free, candidate)) &&
        p->body.count > named.count && p->body.rms_mm < named.rms_mm) {
        performance_note(
            p,
            "the set's rigid markers stray by %.2f mm, others keep together within %.2f mm: those are used",
            named.rms_mm, p->body.rms_mm);
        return 1;
    }
    p->body = named;
    return 0;
}

static fap_err choose_body(performance *p)
{
    fap_capture_report *r = p->report;

    r->rigid_origin = p->cfg->rigid ? FAP_ORIGIN_GIVEN : FAP_ORIGIN_SET;
    p->has_body = learn_named(p);
    if (!p->has_body && p->cfg->rigid)
        return performance_fail(p, FAP_E_ARG,
                                "--rigid: needs three markers that are not in a line and seen together");
    if (p->has_body && !p->cfg->rigid) {
        extend(p);
        if (replace_loose(p))
            r->rigid_origin = FAP_ORIGIN_FOUND;
    }
    if (!p->has_body) {
        p->has_body = find_any(p);
        r->rigid_origin = p->has_body ? FAP_ORIGIN_FOUND : FAP_ORIGIN_NONE;
    }
    if (!p->has_body)
        performance_note(
            p, "no three markers keep their distances: head motion stays in, FAPs 48 to 50 are left out");
    return FAP_OK;
}

static void write_report(performance *p)
{
    fap_capture_report *r = p->report;

    for (uint32_t i = 0; p->has_body && i < p->body.count && r->rigid_count < FAP_CAPTURE_MAX_RIGID; i++)
        r->rigid[r->rigid_count++] = (int16_t)p->body.point[i];
    r->rigid_rms_mm = p->has_body ? p->body.rms_mm : 0;
}

/* --- carried by the nose --- */

int head_carrier(const performance *p)
{
    const int nose = fap_point_by_name("9.3");
    return p->cfg->head == FAP_HEAD_NOSE && p->report->markers.point[nose].count ? nose : -1;
}

static int nose_in_body(const performance *p, uint32_t frame, uint32_t nose, double seen[3], double model[3])
{
    const float *v = fap_take_sample(p->take, frame, nose);

    if (!v || !p->posed[frame])
        return 0;
    for (int axis = 0; axis < 3; axis++)
        seen[axis] = v[axis];
    rigid_undo(&p->pose[frame], seen, model);
    return 1;
}

/* Moves the pose until the nose is where it is in the mean. */
static void carry(rigid_pose *pose, const double mean[3], const double seen[3])
{
    double there[3];

    rigid_apply(pose, mean, there);
    for (int axis = 0; axis < 3; axis++)
        pose->t[axis] += seen[axis] - there[axis];
}

static void follow_nose(performance *p, uint32_t nose)
{
    double mean[3] = { 0 }, seen[3], model[3];
    uint32_t n = 0;

    for (uint32_t f = 0; f < p->frames; f++) {
        if (!nose_in_body(p, f, nose, seen, model))
            continue;
        for (int axis = 0; axis < 3; axis++)
            mean[axis] += model[axis];
        n++;
    }
    for (int axis = 0; axis < 3 && n; axis++)
        mean[axis] /= n;
    for (uint32_t f = 0; f < p->frames; f++)
        if (nose_in_body(p, f, nose, seen, model))
            carry(&p->pose[f], mean, seen);
    p->report->frames_without_nose = p->frames - n;
}

static fap_err move_with_nose(performance *p)
{
    const int nose = head_carrier(p);

    if (p->cfg->head != FAP_HEAD_NOSE)
        return FAP_OK;
    if (nose < 0)
        return performance_fail(p, FAP_E_ARG, "--head nose: no marker is on the tip of the nose (9.3)");
    follow_nose(p, (uint32_t)p->report->markers.point[nose].index[0]);
    return FAP_OK;
}

fap_err head_find(performance *p)
{
    static const rigid_pose identity = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { 0 } };
    const fap_err err = choose_body(p);

    if (err != FAP_OK)
        return err;
    for (uint32_t f = 0; f < p->frames; f++) {
        p->pose[f] = identity;
        p->posed[f] = !p->has_body || rigid_body_pose(&p->body, p->take, f, &p->pose[f]);
        p->report->frames_without_head += !p->posed[f];
    }
    p->rest = identity;
    write_report(p);
    if (p->report->frames_without_head == p->frames)
        return performance_fail(p, FAP_E_DATA, "the rigid markers are never seen three at a time");
    return move_with_nose(p);
}

int head_still(const performance *p, uint32_t frame, uint32_t point, double out[3])
{
    const float *v = fap_take_sample(p->take, frame, point);

    if (!v || !p->posed[frame])
        return 0;
    const double seen[3] = { v[0], v[1], v[2] };
    double model[3];
    rigid_undo(&p->pose[frame], seen, model);
    rigid_apply(&p->rest, model, out);
    return 1;
}
