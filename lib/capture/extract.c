/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAPs out of feature points: how far a point is from its place on the neutral face, along the FAP's axis, in
 * the FAP's unit. Only what is measured becomes a FAP. Nothing is clamped; what leaves the table's range is
 * counted. Source: ISO/IEC 14496-2, Annex C, Table C-1.
 */
#include <math.h>
#include <string.h>

#include "capture/performance.h"

enum {
    FAP_OPEN_JAW = 3,
    FAP_PUSH_B_LIP = 16,
    FAP_PUSH_T_LIP = 17,
    FAP_DEPRESS_CHIN = 18,
    FAP_HEAD_PITCH = 48
};

/* Of an adult's eyeball; where a pupil is on it gives the gaze. */
static const float eyeball_radius_mm = 12;

/* Points that may stand in for the one of the table. The jaw is one bone: its teeth and the chin's boss move
 * with it. */
static const struct stand_in {
    const char *point;
    int fap; /* 0: any */
    const char *other;
} stand_ins[] = {
    { "2.1", 0, "9.11" },
    { "2.1", 0, "9.9" },
    { "2.1", 0, "2.10" },
    { "2.3", FAP_PUSH_B_LIP, "8.2" },
    { "2.2", FAP_PUSH_T_LIP, "8.1" },
};

/* The known point that gives a FAP; -1: none. */
static int point_for(const performance *p, int fap, int *stands_in)
{
    const int wanted = fap_info_get(fap)->point;

    *stands_in = 0;
    if (wanted < 0 || p->known[wanted])
        return wanted;
    *stands_in = 1;
    for (size_t i = 0; i < sizeof stand_ins / sizeof *stand_ins; i++) {
        const int other = fap_point_by_name(stand_ins[i].other);
        if (wanted == fap_point_by_name(stand_ins[i].point) &&
            (!stand_ins[i].fap || stand_ins[i].fap == fap) && p->known[other])
            return other;
    }
    return -1;
}

/* The chin's skin can be told from the jaw only where each has a marker of its own. */
static int chin_is_separate(const performance *p)
{
    int stands_in;
    const int jaw = point_for(p, FAP_OPEN_JAW, &stands_in), chin = fap_info_get(FAP_DEPRESS_CHIN)->point;

    return jaw >= 0 && jaw != chin &&
           p->report->markers.point[jaw].index[0] != p->report->markers.point[chin].index[0];
}

static int is_measurable(const performance *p, int fap)
{
    switch (fap_info_get(fap)->motion) {
    case FAP_MOTION_X:
    case FAP_MOTION_Y: return fap != FAP_DEPRESS_CHIN || chin_is_separate(p);
    case FAP_MOTION_Z:
        return fap_info_get(fap)->group != 3; /* a pupil's depth is the eye's turning, not its thrust */
    case FAP_MOTION_YAW:
    case FAP_MOTION_PITCH: return fap < FAP_HEAD_PITCH;
    default: return 0;
    }
}

/* The FAP's value for a displacement in head axes. */
static double value_of(const performance *p, const fap_info *info, const float moved[3])
{
    const double step = fap_fapu_step(&p->report->fapu, (fap_unit)info->unit);
    double amount;

    switch (info->motion) {
    case FAP_MOTION_X: amount = moved[0]; break;
    case FAP_MOTION_Y: amount = moved[1]; break;
    case FAP_MOTION_Z: amount = moved[2]; break;
    case FAP_MOTION_YAW: amount = asin(fmax(-1, fmin(1, moved[0] / eyeball_radius_mm))); break;
    default: amount = asin(fmax(-1, fmin(1, -moved[1] / eyeball_radius_mm))); break;
    }
    return info->sign * amount / step;
}

static void put(performance *p, uint32_t frame, int fap, double value)
{
    static const double limit = 1e9;
    fap_frame *f = &p->out[frame];

    f->state[fap] = FAP_CODED;
    f->value[fap] = (int32_t)lrint(fmax(-limit, fmin(limit, value)));
}

/* Not seen in this frame: the last value is held, which in the file is a 0 in the mask. */
static void hold(performance *p, uint32_t frame, int fap)
{
    const fap_frame *before = frame ? &p->out[frame - 1] : NULL;

    if (!before || before->state[fap] == FAP_ABSENT)
        return;
    p->out[frame].state[fap] = FAP_HELD;
    p->out[frame].value[fap] = before->value[fap];
}

static void extract_fap(performance *p, int fap)
{
    const fap_info *info = fap_info_get(fap);
    int stands_in;
    const int point = point_for(p, fap, &stands_in);

    if (point < 0 || !p->known[point] || point == head_carrier(p) || !is_measurable(p, fap))
        return;
    p->report->fap[fap].point = (int8_t)point;
    p->report->fap[fap].origin = p->origin[point];
    if (stands_in)
        p->report->fap[fap].origin.how = FAP_HOW_COPIED;
    p->report->fap[fap].near =
        stands_in || p->origin[point].how != FAP_HOW_DIRECT || p->report->markers.point[point].near;
    for (uint32_t f = 0; f < p->frames; f++) {
        if (p->seen[f][point])
            put(p, f, fap, value_of(p, info, p->point[f][point]));
        else
            hold(p, f, fap);
    }
}

/* --- head --- */

/* The rotation from rest, in head axes: A R rest^T A^T. */
static void head_rotation(const performance *p, uint32_t frame, float out[3][3])
{
    const double(*r)[3] = p->pose[frame].r, (*rest)[3] = p->rest.r;
    double turn[3][3] = { { 0 } }, half[3][3] = { { 0 } };

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                turn[i][j] += r[i][k] * rest[j][k];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                half[i][j] += p->axes[i][k] * turn[k][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += half[i][k] * p->axes[j][k];
            out[i][j] = (float)sum;
        }
}

static void extract_head(performance *p)
{
    for (uint32_t f = 0; f < p->frames; f++) {
        float rotation[3][3];
        int32_t angle[3];
        if (p->posed[f]) {
            head_rotation(p, f, rotation);
            fap_head_angles((const float(*)[3])rotation, &angle[0], &angle[1], &angle[2]);
        }
        for (int i = 0; i < 3; i++) {
            if (p->posed[f])
                put(p, f, FAP_HEAD_PITCH + i, angle[i]);
            else
                hold(p, f, FAP_HEAD_PITCH + i);
        }
    }
}

/* --- the account --- */

/* The table's range counts quantiser steps. Where it prints no lower limit, decoders take the upper one with
 * a minus. */
static int is_beyond(const fap_info *info, int32_t value)
{
    const int32_t high = info->i_max * info->quant_step, low = info->i_min * info->quant_step;
    return value > high || value < (low ? low : -high);
}

static void count_fap(performance *p, int fap)
{
    fap_capture_fap *r = &p->report->fap[fap];

    for (uint32_t f = 0; f < p->frames; f++) {
        const int32_t v = p->out[f].value[fap];
        if (p->out[f].state[fap] != FAP_CODED)
            continue;
        r->min = r->coded ? (v < r->min ? v : r->min) : v;
        r->max = r->coded ? (v > r->max ? v : r->max) : v;
        r->coded++;
        r->beyond += is_beyond(fap_info_get(fap), v) != 0;
    }
}

void faps_extract(performance *p)
{
    for (uint32_t f = 0; f < p->frames; f++) {
        p->out[f].number = f;
        p->out[f].pts_us = (int64_t)llrint(f * 1e6 / p->report->rate_hz);
    }
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        p->report->fap[fap].point = -1;
    for (int fap = FAP_OPEN_JAW; fap <= FAP_COUNT; fap++)
        extract_fap(p, fap);
    if (p->has_body)
        extract_head(p);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        count_fap(p, fap);
        p->report->fap[fap].reason = p->report->fap[fap].coded ? NULL : reason_for(p, fap);
    }
}
