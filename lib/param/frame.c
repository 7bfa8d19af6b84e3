/* SPDX-License-Identifier: BSD-2-Clause */
/* See frame.h. Source: ISO/IEC 14496-2, Annex C, ranges of FAPs 1 and 2. */
#include <fap/tables.h>

#include "param/frame.h"

int fap_viseme_is_sound(const fap_viseme *v)
{
    return v->select1 <= FAP_VISEME_COUNT && v->select2 <= FAP_VISEME_COUNT &&
           v->blend <= FRAME_STRENGTH_MAX && v->def <= 1;
}

int fap_expression_is_sound(const fap_expression *e)
{
    return e->select1 <= FAP_EXPRESSION_COUNT && e->select2 <= FAP_EXPRESSION_COUNT &&
           e->intensity1 <= FRAME_STRENGTH_MAX && e->intensity2 <= FRAME_STRENGTH_MAX && e->init_face <= 1 &&
           e->def <= 1;
}

int fap_frame_is_sound(const fap_frame *f)
{
    return (f->state[1] != FAP_CODED || fap_viseme_is_sound(&f->viseme)) &&
           (f->state[2] != FAP_CODED || fap_expression_is_sound(&f->expression));
}

void fap_frame_hold(fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (f->state[fap] != FAP_ABSENT)
            f->state[fap] = FAP_HELD;
}
