/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAP values to feature-point targets: value times FAPU, along the axis and in the sense of Table C-1.
 * Rotations (eyes, head), pupils and the tongue's curl are not translations of a point and are no targets.
 * Source: ISO/IEC 14496-2, Annex C, Table C-1.
 */
#include <string.h>

#include <fap/face.h>

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
