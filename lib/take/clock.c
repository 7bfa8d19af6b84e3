/* SPDX-License-Identifier: BSD-2-Clause */
/* See clock.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "take/clock.h"

int take_clock_open(take_source *src, take_clock *c, uint32_t rows)
{
    c->time = fap_mem_calloc(&src->alloc, rows, 2 * sizeof *c->time);
    c->step = c->time ? c->time + rows : NULL;
    for (uint32_t row = 0; c->time && row < rows; row++)
        c->time[row] = NAN;
    return c->time != NULL;
}

void take_clock_close(take_source *src, take_clock *c)
{
    fap_mem_free(&src->alloc, c->time);
    c->time = c->step = NULL;
}

/* The unit of times whose key does not say it, from their usual step: nobody films below 2 or above 500 frames a second. */
static double guess_unit_s(double step)
{
    return step >= 2000 ? 1e-6 : step >= 2 ? 1e-3 : 1;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Half of the steps are longer; 0: there are no times, or they run back. @p step: room for as many as there are rows. */
static double median_step(const double *time, double *step, uint32_t count)
{
    if (count < 2)
        return 0;
    for (uint32_t i = 0; i + 1 < count; i++) {
        step[i] = time[i + 1] - time[i];
        if (!(step[i] >= 0)) /* NAN too */
            return 0;
    }
    qsort(step, count - 1, sizeof *step, by_size);
    return step[(count - 2) / 2]; /* the lower one: gaps make steps longer, never shorter */
}

/* The same rows at their times: what a camera or a script left out becomes a gap. */
static fap_err spread_rows(fap_take **take, const double *time, double per_frame, uint32_t frames)
{
    fap_take *t = *take, *wide;
    const fap_err err = fap_take_create(&wide, t->point_count, frames, &t->alloc);

    if (err != FAP_OK)
        return err;
    memcpy(wide->name, t->name, t->point_count * sizeof *t->name);
    memcpy(wide->note, t->note, sizeof t->note);
    wide->note_count = t->note_count;
    wide->mm_per_unit = t->mm_per_unit;
    wide->first_frame = t->first_frame;
    for (uint32_t f = 0; f < t->frame_count; f++) {
        const double at = floor((time[f] - time[0]) / per_frame + 0.5);
        const uint32_t to = at < frames ? (uint32_t)at : frames - 1;
        for (uint32_t p = 0; p < t->point_count; p++) {
            const float *v = fap_take_sample(t, f, p);
            if (v)
                fap_take_set(wide, to, p, v);
        }
    }
    take_note(wide, "the times leave out %u frames; they are gaps", (unsigned)(frames - t->frame_count));
    fap_take_close(take);
    *take = wide;
    return FAP_OK;
}

/* What the times of all rows say, jittery as they may be. */
typedef struct clock_reading {
    double step;     /* between rows, in the unit of the times; 0: they say nothing */
    double rate_hz;  /* 0: unknown */
    uint32_t frames; /* with those that are left out */
} clock_reading;

static double rate_of_times(const take_clock *c, double step, uint32_t rows, double length, int dropped)
{
    const double unit_s = c->unit_s > 0 ? c->unit_s : guess_unit_s(step);

    if (!c->timed)
        return c->rate_hz / step; /* every second picture of a film has every second number */
    return take_usual_rate(dropped ? 1 / (step * unit_s) : (rows - 1) / (length * unit_s));
}

static clock_reading read_clock(const take_clock *c, uint32_t rows)
{
    static const double few = 0.02; /* where hardly anything is left out the mean is better than the median */
    clock_reading r = { .step = median_step(c->time, c->step, rows), .rate_hz = c->rate_hz, .frames = rows };
    const double length = r.step > 0 ? c->time[rows - 1] - c->time[0] : 0;

    if (!(r.step > 0) || !isfinite(length / r.step))
        return (clock_reading){ .rate_hz = c->rate_hz, .frames = rows };
    const double frames = floor(length / r.step + 0.5) + 1;
    const int dropped = c->timed ? frames > rows * (1 + few) : frames > rows;
    r.rate_hz = rate_of_times(c, r.step, rows, length, dropped);
    if (dropped && frames < 4. * rows + 100) /* beyond it the times mean something else */
        r.frames = (uint32_t)frames;
    return r;
}

fap_err take_clock_settle(const take_clock *c, fap_take **take)
{
    const clock_reading r = read_clock(c, (*take)->frame_count);

    if (r.frames > (*take)->frame_count) {
        const fap_err err = spread_rows(take, c->time, r.step, r.frames);
        if (err != FAP_OK)
            return err;
    }
    (*take)->rate_hz = r.rate_hz;
    if (c->timed && c->rate_hz > 0 && fabs(r.rate_hz - c->rate_hz) > 0.02 * c->rate_hz)
        take_note(*take, "the file says %g frames a second, its times say %.4g; the times are used",
                  c->rate_hz, r.rate_hz);
    return FAP_OK;
}
