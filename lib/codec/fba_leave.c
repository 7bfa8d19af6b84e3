/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAPs that are left to the decoder, fap_mask_type 2: the interpolation table, the other lip contour, the other side.
 * What the decoder would show is found by its own code; a FAP is left out if that is good enough, and if no FAP shows
 * up that the source does not have. Source: ISO/IEC 14496-2, FAP interpolation.
 */
#include <string.h>

#include "codec/fba_search.h"

/* A setup on trial. */
typedef struct leave {
    fap_encoder *e;
    int count, by_price;
    fba_face face;
    uint8_t left[FAP_COUNT + 1]; /* FAPs left to the decoder */
    fap_frame base;              /* what it shows before the I plane, held */
} leave;

static void set_types(leave *l)
{
    fap_fba_set_masks(&l->face.setup);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (l->left[fap])
            l->face.setup.mask_type[fap_info_get(fap)->group] = FBA_MASK_INTERPOLATE;
    fap_fba_list_coded(&l->face.list, &l->face.setup);
}

static void set_left(leave *l, int fap, int left)
{
    l->left[fap] = (uint8_t)left;
    l->face.setup.coded[fap] = !left;
    set_types(l);
}

static fap_frame shown(leave *l, int i)
{
    fap_frame f = l->base;

    for (int k = 0; k < l->face.list.count; k++) {
        const fba_coded *c = &l->face.list.of[k];
        l->face.motion.value[c->param] = l->e->path[i][c->param] * c->step;
    }
    fap_fba_face_show(&l->face, l->e->cfg.fit, &f);
    return f;
}

/* A FAP that the source does not have must not appear. */
static int invents(const leave *l, const fap_frame *f)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->state[fap] == FAP_DERIVED && !l->left[fap])
            return 1;
    return 0;
}

static uint64_t off_by(const leave *l, int fap, int i, int32_t value)
{
    const fap_encoder *e = l->e;
    const int param = FBA_FIRST_FAP + fap - 3;
    const int32_t want = e->search ? e->search->want[(size_t)param * (size_t)e->capacity + (size_t)i]
                                   : e->queue[i].frame.value[fap];
    const int64_t away = (int64_t)want - value, units = away < 0 ? -away : away;

    if (l->by_price)
        return fap_fba_square(e, fap, units);
    const int64_t half = fap_fba_step(param, e->plan.quant) / 2;
    const int64_t permitted =
        e->cfg.mode == FAP_ENCODE_ERROR && e->permitted[fap] > half ? e->permitted[fap] : half;
    return units > permitted;
}

/* Errors of all FAPs left out, as far as @p most; more than that: not good enough. */
static uint64_t error_of(leave *l, uint64_t most)
{
    uint64_t sum = 0;

    for (int i = 0; i < l->count && sum <= most; i++) {
        const fap_frame f = shown(l, i);
        if (invents(l, &f))
            return UINT64_MAX;
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            if (l->left[fap] && f.state[fap] != FAP_DERIVED)
                return UINT64_MAX;
            sum += l->left[fap] ? off_by(l, fap, i, f.value[fap]) : 0;
        }
    }
    return sum;
}

static int has_source(const leave *l, int fap)
{
    const int lip = fap_lip_pair(fap), mirror = fap_mirror(fap);

    return (l->e->cfg.fit && fap_fit_gives(l->e->cfg.fit, fap)) || (lip && l->base.state[lip]) ||
           (mirror && l->base.state[mirror]) || (lip && l->face.setup.coded[lip]) ||
           (mirror && l->face.setup.coded[mirror]);
}

/* What may be lost by leaving the FAP out: with a bitrate, what its bits are worth. */
static uint64_t price_of(const leave *l, int fap)
{
    return l->by_price ? fap_fba_worth(l->e, fap, l->count) : 0;
}

static void hold(fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (f->state[fap] != FAP_ABSENT)
            f->state[fap] = FAP_HELD;
}

/* Right sides and outer lips first: that is how most sources were made. */
int fap_fba_leave_out(fap_encoder *e, int count, int exactly)
{
    leave l = { .e = e,
                .count = count,
                .by_price = e->cfg.mode == FAP_ENCODE_BITRATE && !exactly,
                .base = e->shown_now };
    int any = 0;

    hold(&l.base);
    l.face.setup = e->plan;
    memcpy(l.left, e->plan_left, sizeof l.left);
    set_types(&l);
    uint64_t error = error_of(&l, UINT64_MAX - 1);
    for (int fap = FAP_COUNT; fap >= 3; fap--) {
        if (!e->plan.coded[fap] || !has_source(&l, fap))
            continue;
        const uint64_t most = error + price_of(&l, fap);
        set_left(&l, fap, 1);
        const uint64_t now = error_of(&l, most);
        if (now > most) {
            set_left(&l, fap, 0);
            continue;
        }
        error = now;
        any = 1;
    }
    e->plan = l.face.setup;
    memcpy(e->plan_left, l.left, sizeof e->plan_left);
    return any;
}
