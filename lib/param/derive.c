/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAPs that follow from others. Lips first: a copied inner contour may still need its mirror side afterwards.
 * Source: ISO/IEC 14496-2, FAP interpolation; fap_tables/pairs.csv.
 */
#include <fap/derive.h>
#include <fap/tables.h>

static void fill_from(fap_frame *frame, int (*partner)(int fap))
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const int other = partner(fap);
        if (!other || frame->state[fap] != FAP_ABSENT || frame->state[other] == FAP_ABSENT)
            continue;
        frame->value[fap] = frame->value[other];
        frame->state[fap] = FAP_DERIVED;
    }
}

void fap_derive(fap_frame *frame)
{
    fap_derive_with(NULL, frame);
}

void fap_derive_with(const fap_fit *fit, fap_frame *frame)
{
    fap_fit_apply(fit, frame);
    fill_from(frame, fap_lip_pair);
    fill_from(frame, fap_mirror);
}
