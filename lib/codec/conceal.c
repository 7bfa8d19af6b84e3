/* SPDX-License-Identifier: BSD-2-Clause */
/* See conceal.h. Times were chosen on the streams of ../shared/data/fap: make bench, loss_error_mm_*. */
#include "codec/conceal.h"

/* Counts are for one second of frames. */
enum {
    FRACTION = 256, /* of a unit, in velocities */
    VALUE_MAX = 1 << 30,
    SPEED_MAX = 1 << 22,     /* units a frame: keeps products in 64 bits */
    COASTS = 8,              /* velocity loses 1 / (1 + rate / COASTS) of itself a frame */
    RESTS = 2,               /* after a loss of 1 / RESTS seconds the face eases to rest ... */
    REST_S = 1,              /* ... by 1 / (REST_S * rate) of the way a frame ... */
    HEAD_SLOWNESS = 4,       /* ... but a head that turns away by itself is seen at once */
    FADE = 126,              /* steps of 63: a viseme is gone in half a second */
    EXPRESSION_SLOWNESS = 3, /* an expression in one and a half */
    HEAD_FIRST = 48,
    HEAD_LAST = 50,
};

static int32_t clamp(int64_t v, int32_t most)
{
    return (int32_t)(v > most ? most : v < -most ? -most : v);
}

static int32_t size_of(int32_t v)
{
    return v < 0 ? -v : v;
}

static int at_least(int v, int least)
{
    return v > least ? v : least;
}

/* --- frames that came --- */

/* The last step is believed as it is: on real streams smoothing it made predictions worse. */
static void learn(fba_conceal *c, int fap, int32_t value, int frames)
{
    const int32_t step = clamp(((int64_t)value - c->shown[fap]) / frames, SPEED_MAX);

    c->velocity[fap] = step * FRACTION;
    if (size_of(step) > c->most[fap])
        c->most[fap] = size_of(step);
}

void fap_conceal_see(fba_conceal *c, const fap_frame *f)
{
    const int64_t passed = f->number - c->number;
    const int learns = c->started && !c->lost && passed > 0 && passed <= 1 << 20;

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        if (learns)
            learn(c, fap, f->value[fap], (int)passed);
        else
            c->velocity[fap] = 0; /* the way to an I plane behind a loss is no motion of the face */
        c->shown[fap] = f->value[fap];
    }
    c->viseme = f->viseme;
    c->expression = f->expression;
    c->number = f->number;
    c->started = 1;
    c->lost = 0;
}

/* --- frames that did not --- */

/* How far to go towards rest in this frame: nothing at first, then a steady part of the way. */
static int64_t rest_step(const fba_conceal *c, int fap, int rate_hz)
{
    const int late = c->lost - at_least(rate_hz / RESTS, 1);
    const int slowness = fap >= HEAD_FIRST && fap <= HEAD_LAST ? HEAD_SLOWNESS : 1;
    const int64_t frames = (int64_t)at_least(rate_hz * REST_S, 1) * slowness;

    if (late <= 0)
        return 0;
    const int64_t part =
        late < rate_hz / 4 ? late * 4 / at_least(rate_hz / 4, 1) : 4; /* eases in, in quarters */
    const int64_t step = -(int64_t)c->shown[fap] * part / (4 * frames);
    return step ? step : c->shown[fap] > 0 ? -1 : c->shown[fap] < 0;
}

static void move(fba_conceal *c, int fap, int rate_hz)
{
    int32_t *v = &c->velocity[fap];

    *v -= *v / (1 + rate_hz / COASTS);
    const int64_t step = clamp(*v / FRACTION + rest_step(c, fap, rate_hz), c->most[fap]);
    c->shown[fap] = clamp(c->shown[fap] + step, VALUE_MAX);
}

static uint8_t fade(uint8_t v, int step)
{
    return (uint8_t)(v > step ? v - step : 0);
}

static uint8_t grow(uint8_t v, int step)
{
    return (uint8_t)(v + step < 63 ? v + step : 63);
}

/* The weaker of two visemes goes first, then the other: the blend always belongs to two of them, one may be none. */
static void fade_viseme(fap_viseme *v, int step)
{
    if (!v->select1)
        v->blend = grow(v->blend, step);
    else if (!v->select2 || v->blend < 32)
        v->blend = fade(v->blend, step);
    else
        v->blend = grow(v->blend, step);
    if (v->blend == 63)
        v->select2 = 0;
    if (v->blend == 0)
        v->select1 = 0;
    v->def = 0;
}

static void fade_expression(fap_expression *e, int step)
{
    e->intensity1 = fade(e->intensity1, step);
    e->intensity2 = fade(e->intensity2, step);
    e->def = e->init_face = 0;
}

void fap_conceal_show(fba_conceal *c, fap_frame *f, int rate_hz)
{
    const int step = at_least(FADE / at_least(rate_hz, 1), 1);

    c->lost++;
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        if (f->state[fap] == FAP_ABSENT)
            continue;
        f->state[fap] = FAP_CONCEALED;
        if (fap >= 3)
            move(c, fap, rate_hz);
        f->value[fap] = fap >= 3 ? c->shown[fap] : 0;
    }
    fade_viseme(&c->viseme, step);
    if (c->lost > rate_hz / RESTS)
        fade_expression(&c->expression, at_least(step / EXPRESSION_SLOWNESS, 1));
    f->viseme = c->viseme;
    f->expression = c->expression;
}
