/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From what the rows' clock shows to frames at one rate. The usual step between rows is a frame; a row after a longer step
 * leaves a gap. The rate is the number of steps in the whole time, which is finer than any single one: a camera said
 * to run at 60 runs at 59.90. Times that do not rise are no times, and no rate is made of them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "take/coef.h"

static const double day_s = 86400;
/* Rows faster than this were never filmed: numbers of pictures, written as if they were times. */
static const double fastest_hz = 600;

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* --- time codes --- */

/* Where one second ends and the next begins: its base is the usual step plus what the frames fell by. */
static double base_at_wrap(const double *second, const double *part, uint32_t i, double step)
{
    const double seconds = second[i + 1] - second[i];
    return seconds == 1 ? step + part[i] - part[i + 1] : 0;
}

/* The middle of what @p of gives for each pair of rows, of those above 0. */
static double median_step(const double *second, const double *part, uint32_t count, double step, double *list)
{
    uint32_t n = 0;

    for (uint32_t i = 0; i + 1 < count; i++) {
        const double v = step > 0                     ? base_at_wrap(second, part, i, step)
                         : second[i] == second[i + 1] ? part[i + 1] - part[i]
                                                      : 0;
        if (v > 0)
            list[n++] = v;
    }
    if (!n)
        return 0;
    qsort(list, n, sizeof *list, by_size);
    return list[(n - 1) / 2];
}

static double nearest_base(double base)
{
    static const double usual[] = { 24, 25, 30, 48, 50, 60, 100, 120 };
    double best = 0;

    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (fabs(usual[i] - base) < fabs(best - base))
            best = usual[i];
    return fabs(best - base) < 0.5 ? best : 0;
}

static double next_base(double largest)
{
    static const double usual[] = { 24, 25, 30, 60, 120 };

    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (largest < usual[i])
            return usual[i];
    return 0;
}

static double timecode_base(const coef_rows *r, int *sure, double *list)
{
    double largest = 0;

    for (uint32_t i = 0; i < r->count; i++)
        largest = fmax(largest, r->part[i]);
    const double step = median_step(r->time, r->part, r->count, 0, list);
    const double base = step > 0 ? nearest_base(median_step(r->time, r->part, r->count, step, list)) : 0;
    *sure = base > largest;
    return *sure ? base : next_base(largest);
}

/* After midnight the seconds begin anew. */
static void unwrap(coef_rows *r)
{
    double days = 0;

    for (uint32_t i = 1; i < r->count; i++) {
        r->time[i] += days;
        if (r->time[i] < r->time[i - 1] - day_s / 2) {
            days += day_s;
            r->time[i] += day_s;
        }
    }
}

/* Seconds from seconds and frames. */
static void apply_timecode(coef_rows *r, double *list)
{
    int sure;

    unwrap(r);
    const double base = timecode_base(r, &sure, list);
    if (!(base > 0)) {
        coef_note(r->take, "the time code's frames make no sense; rows are frames");
        r->clock = COEF_CLOCK_NONE;
        return;
    }
    if (!sure)
        coef_note(r->take,
                  "no second ends in this take: %g frames a second is a guess of the time code's base; "
                  "--take-rate decides",
                  base);
    r->take->start_s = fmod(r->time[0], day_s) + r->part[0] / base;
    for (uint32_t i = 0; i < r->count; i++)
        r->time[i] += r->part[i] / base;
}

/* --- rows to frames --- */

/* The middle of the steps that go forward; 0 where too many do not. */
static double usual_step(const coef_rows *r, double *list)
{
    uint32_t n = 0;

    for (uint32_t i = 0; i + 1 < r->count; i++)
        if (r->time[i + 1] > r->time[i])
            list[n++] = r->time[i + 1] - r->time[i];
    if (!n || n < (r->count - 1) - (r->count - 1) / 4)
        return 0;
    qsort(list, n, sizeof *list, by_size);
    return list[(n - 1) / 2];
}

/* Numbers the rows by whole steps, -1 for those that do not go on. Returns the frames; 0: too many. */
static uint64_t number_rows(const coef_rows *r, double step, double *number)
{
    double at = 0, last = r->time[0];

    number[0] = 0;
    for (uint32_t i = 1; i < r->count; i++) {
        if (!(r->time[i] > last)) {
            number[i] = -1;
            continue;
        }
        at += fmax(1, nearbyint((r->time[i] - last) / step));
        if (!(at < FAP_COEFFICIENTS_MAX_FRAMES))
            return 0;
        number[i] = at;
        last = r->time[i];
    }
    return (uint64_t)at + 1;
}

static double snapped(double hz, double share)
{
    static const double usual[] = { 23.976, 24, 25, 29.97, 30, 50, 59.94, 60, 100, 120 };
    double best = hz, nearest = share;

    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (fabs(hz / usual[i] - 1) < nearest) {
            nearest = fabs(hz / usual[i] - 1);
            best = usual[i];
        }
    return best;
}

static double rate_of(const coef_rows *r, const double *number, uint64_t frames)
{
    double first = r->time[0], last = first;

    if (r->clock == COEF_CLOCK_FRAMES || frames < 2)
        return 0;
    for (uint32_t i = 0; i < r->count; i++)
        if (number[i] >= 0)
            last = r->time[i];
    const double hz = (double)(frames - 1) / (last - first);
    return r->snap > 0 ? snapped(hz, r->snap) : hz;
}

/* Rows go where their numbers say. */
static fap_err place(take_source *src, coef_rows *r, const double *number, uint64_t frames)
{
    fap_coefficients *old = r->take, *t;
    const size_t width = old->channel_count;
    const fap_err err = fap_coefficients_create(&t, old->channel_count, (uint32_t)frames, &src->alloc);

    if (err != FAP_OK)
        return err;
    for (uint32_t i = 0; i < r->count; i++) {
        if (number[i] < 0)
            continue;
        const size_t to = (size_t)number[i] * width, from = i * width;
        memcpy(t->value + to, old->value + from, width * sizeof *t->value);
        memcpy(t->valid + to, old->valid + from, width);
    }
    t->format = old->format;
    t->start_s = old->start_s;
    memcpy(t->channel, old->channel, sizeof t->channel);
    memcpy(t->note, old->note, sizeof t->note);
    t->note_count = old->note_count;
    fap_coefficients_close(&r->take);
    r->take = t;
    return FAP_OK;
}

static void note_dropped(const coef_rows *r, const double *number, uint64_t frames)
{
    uint32_t back = 0;

    for (uint32_t i = 0; i < r->count; i++)
        back += number[i] < 0;
    const uint64_t absent = frames - (r->count - back);
    if (back)
        coef_note(r->take, "%u rows are not later than the one before; they are left out", (unsigned)back);
    if (absent)
        coef_note(r->take, "%llu of %llu frames are absent", (unsigned long long)absent,
                  (unsigned long long)frames);
}

static fap_err place_by_time(take_source *src, coef_rows *r, double step, double *number)
{
    const uint64_t frames = number_rows(r, step, number);

    if (!frames)
        return take_fail(src, FAP_E_LIMIT, "the times of the rows span over %d frames",
                         FAP_COEFFICIENTS_MAX_FRAMES);
    double hz = rate_of(r, number, frames);
    if (hz > fastest_hz) {
        coef_note(r->take, "the times say %.4g frames a second: pictures without times?", hz);
        hz = 0;
    }
    const fap_err err = place(src, r, number, frames);
    if (err != FAP_OK)
        return err;
    r->take->rate_hz = hz;
    note_dropped(r, number, frames);
    return FAP_OK;
}

static fap_err place_in_order(take_source *src, coef_rows *r, double *number)
{
    for (uint32_t i = 0; i < r->count; i++)
        number[i] = i;
    return place(src, r, number, r->count);
}

static fap_err settle(take_source *src, coef_rows *r, double *list)
{
    if (r->clock == COEF_CLOCK_TIMECODE)
        apply_timecode(r, list);
    const double step = r->clock == COEF_CLOCK_NONE ? 0 : usual_step(r, list);
    if (r->clock != COEF_CLOCK_NONE && !(step > 0) && r->count > 1)
        coef_note(r->take, "the times do not rise from row to row; rows are frames");
    return step > 0 ? place_by_time(src, r, step, list) : place_in_order(src, r, list);
}

static void settle_rate(coef_rows *r, double user_hz)
{
    static const double slowest_hz = 0.5;
    fap_coefficients *t = r->take;

    if (r->known_hz > 0)
        t->rate_hz = r->known_hz;
    if (t->rate_hz != 0 && !(t->rate_hz >= slowest_hz && t->rate_hz <= fastest_hz)) {
        coef_note(t, "a rate of %g frames a second is not believed", t->rate_hz);
        t->rate_hz = 0;
    }
    if (user_hz > 0)
        t->rate_hz = user_hz;
}

fap_err coef_rows_settle(take_source *src, coef_rows *rows, double user_hz)
{
    double *list = fap_mem_calloc(&src->alloc, rows->count, sizeof *list);

    if (!list)
        return FAP_E_NOMEM;
    const fap_err err = settle(src, rows, list);
    fap_mem_free(&src->alloc, list);
    if (err == FAP_OK)
        settle_rate(rows, user_hz);
    return err;
}
