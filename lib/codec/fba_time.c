/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_time.h. */
#include "codec/fba_time.h"

enum { DEFAULT_RATE_16 = 30 * 16 }; /* before the stream says */

void fap_fba_time_init(fba_time *t)
{
    *t = (fba_time){ .rate_16 = DEFAULT_RATE_16 };
}

double fap_fba_rate_hz(uint32_t rate_16, int offset)
{
    return offset ? rate_16 * 1000 / 16016.0 : rate_16 / 16.0;
}

int64_t fap_fba_frames_us(uint32_t rate_16, int offset, int64_t frames)
{
    return (frames * (offset ? 16016000 : 16000000) + rate_16 / 2) / rate_16;
}

int64_t fap_fba_time_us(const fba_time *t)
{
    return t->base_us + fap_fba_frames_us(t->rate_16, t->offset, t->since_base);
}

static void rebase(fba_time *t, int64_t us)
{
    t->base_us = us;
    t->since_base = 0;
}

static unsigned take_rate(fba_time *t, const fba_time_fields *f)
{
    if (!f->is_frame_rate || (f->rate_16 == t->rate_16 && f->offset == t->offset))
        return 0;
    if (!f->rate_16)
        return FBA_TIME_RATE_0;
    rebase(t, fap_fba_time_us(t));
    t->rate_16 = f->rate_16;
    t->offset = f->offset;
    return 0;
}

/* A time code counts whole seconds: it moves the time only when it says another second than the frames do. */
static unsigned take_time_code(fba_time *t, const fba_time_fields *f)
{
    const int64_t code_us = (int64_t)f->time_code_s * 1000000, now = fap_fba_time_us(t);

    if (!f->is_time_code)
        return 0;
    if (!t->has_epoch) {
        t->has_epoch = 1;
        t->epoch_us = code_us - now;
    }
    const int64_t here = now + t->epoch_us;
    if (here >= code_us && here < code_us + 1000000)
        return 0;
    if (code_us < here)
        return FBA_TIME_BACK;
    rebase(t, code_us - t->epoch_us);
    return 0;
}

unsigned fap_fba_time_advance(fba_time *t, const fba_time_fields *f, int frames)
{
    const unsigned rate = take_rate(t, f);
    const int64_t step = (int64_t)f->skipped + (t->started ? frames : 0);

    t->number += step;
    t->since_base += step;
    t->started = 1;
    return rate | take_time_code(t, f);
}
