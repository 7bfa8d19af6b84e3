/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAP values to feature-point targets: value times FAPU, along the axis and in the sense of Table C-1.
 * Rotations (eyes, head), pupils and the tongue's curl are not translations of a point and are no targets.
 * Source: ISO/IEC 14496-2, Annex C, Table C-1.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"

static const float farthest_mm = 150; /* beyond it a target is noise; keeps sums of squares finite */

static int is_translation(const fap_info *info)
{
    return info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z && info->point >= 0;
}

void fap_face_targets(const fap_fapu *fapu, const fap_frame *frame, float target_mm[FAP_POINT_COUNT][3],
                      uint8_t wanted[FAP_POINT_COUNT][3])
{
    memset(target_mm, 0, FAP_POINT_COUNT * sizeof *target_mm);
    memset(wanted, 0, FAP_POINT_COUNT * sizeof *wanted);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (frame->state[fap] == FAP_ABSENT || !is_translation(info))
            continue;
        const int axis = info->motion - FAP_MOTION_X;
        const float step = fap_fapu_step(fapu, info->unit);
        target_mm[info->point][axis] = (float)info->sign * (float)frame->value[fap] * step;
        wanted[info->point][axis] = 1;
    }
}

/*
 * An upper lid stops on the lower one. Asked for more (markers sit above the lid and travel further), the
 * solver would shut the eye too tight to get there. What was asked is still what the error is measured
 * against.
 */
static void stop_lid(fap_face *face, int upper, int lower)
{
    const float gap = face->neutral[upper][1] - face->neutral[lower][1];
    const float lower_lid = face->wanted[lower][1] ? face->target[lower][1] : 0;

    if (face->wanted[upper][1] && gap > 0)
        face->target[upper][1] = fmaxf(face->target[upper][1], fminf(lower_lid - gap, 0));
}

/* Emphasis is that of Zhu 2006 section 3.4.1. What is no number is not wanted. */
static void take_axis(fap_face *face, int p, int axis, float mm, int wanted)
{
    const float t = mm * face->cfg.emphasis;

    face->wanted[p][axis] = wanted && face->solvable[p] && !isnan(t);
    face->target[p][axis] = isnan(t) ? 0 : fminf(farthest_mm, fmaxf(-farthest_mm, t));
    if (face->wanted[p][axis])
        face->row[face->row_count++] = (uint16_t)(3 * p + axis);
}

void fap_face_take_targets(fap_face *face, const float target_mm[FAP_POINT_COUNT][3],
                           const uint8_t wanted[FAP_POINT_COUNT][3])
{
    face->row_count = 0;
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int axis = 0; axis < 3; axis++)
            take_axis(face, p, axis, target_mm[p][axis], wanted[p][axis]);
    memcpy(face->asked, face->target, sizeof face->asked);
    for (int i = FAP_LIP_SLITS; i < FAP_SLITS; i++)
        stop_lid(face, face->slit[i][0], face->slit[i][1]);
}

void fap_face_read_targets(fap_face *face, const fap_frame *frame)
{
    float target_mm[FAP_POINT_COUNT][3];
    uint8_t wanted[FAP_POINT_COUNT][3];

    fap_face_targets(fap_bank_fapu(face->bank), frame, target_mm, wanted);
    fap_face_take_targets(face, (const float(*)[3])target_mm, (const uint8_t(*)[3])wanted);
}
