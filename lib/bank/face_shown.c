/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From feature points back to FAPs: what a face shows where nobody commanded it, in the stream's own units. The other
 * way round is face_targets.c. Source: ISO/IEC 14496-2, Annex C, Table C-1.
 */
#include <math.h>

#include <fap/face.h>

static int32_t angle_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : frame->value[fap];
}

/* How far a point is from its place on the neutral face, before the head turned. */
static void motion_of(const fap_bank *bank, int point, const float at[3], const float head[3][3],
                      float out[3])
{
    const float *rest = fap_bank_point_get(bank, point)->position_mm;
    const float *spine = fap_bank_point_get(bank, fap_point_by_name("7.1"))->position_mm;

    for (int i = 0; i < 3; i++) {
        out[i] = spine[i] - rest[i];
        for (int k = 0; k < 3; k++)
            out[i] += head[k][i] * (at[k] - spine[k]); /* the inverse of a turn is its transpose */
    }
}

void fap_face_complete(const fap_bank *bank, const float points[FAP_POINT_COUNT][3], fap_frame *frame)
{
    const float most = 1e6f;
    float head[3][3];

    fap_head_rotation(angle_of(frame, 48), angle_of(frame, 49), angle_of(frame, 50), head);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const float step = fap_fapu_step(fap_bank_fapu(bank), info->unit);
        float mm[3];
        if (frame->state[fap] != FAP_ABSENT || info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z ||
            info->point < 0 || !fap_bank_point_get(bank, info->point)->present)
            continue;
        motion_of(bank, info->point, points[info->point], (const float(*)[3])head, mm);
        const float value = (float)info->sign * mm[info->motion - FAP_MOTION_X] / step;
        frame->state[fap] = FAP_DERIVED;
        frame->value[fap] = isnan(value) ? 0 : (int32_t)lroundf(fminf(most, fmaxf(-most, value)));
    }
}
