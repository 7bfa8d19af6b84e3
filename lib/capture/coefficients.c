/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A take of coefficients to FAPs: crop, spikes out, rest off, gaps closed, another rate, and only then the limits 0 and 1:
 * what is cut off earlier is missed by the filters. See <fap/studio/coefficients.h>.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include <fap/studio/coefficients.h>
#include <fap/tables.h>

struct fap_performance {
    fap_allocator alloc;
    fap_frame *frames;
    fap_arkit *arkit;
    fap_coefficients_report report;
};

/* A take on its way. */
typedef struct work {
    const fap_coefficients_config *cfg;
    fap_coefficients *take; /* a copy, changed step by step */
    fap_performance *out;
    char *where;
    uint8_t present[FAP_CHANNEL_COUNT]; /* by channel: it says something */
    uint8_t moved[FAP_COUNT + 1];       /* by FAP: some channel moves it */
    int has_head, has_eyes;
} work;

void fap_coefficients_config_init(fap_coefficients_config *cfg)
{
    *cfg = (fap_coefficients_config){
        .struct_size = sizeof *cfg, .rate_hz = 25, .neutral_last = -1, .fill = FAP_FILL_ALL
    };
}

static fap_err work_fail(work *w, fap_err err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));
static fap_err work_fail(work *w, fap_err err, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    vsnprintf(w->where, FAP_ERROR_TEXT_SIZE, fmt, args);
    va_end(args);
    return err;
}

static void work_note(work *w, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
static void work_note(work *w, const char *fmt, ...)
{
    fap_coefficients_report *r = &w->out->report;

    if (r->note_count == FAP_TAKE_MAX_NOTES)
        return;
    va_list args;
    va_start(args, fmt);
    vsnprintf(r->note[r->note_count++], FAP_TAKE_NOTE_SIZE, fmt, args);
    va_end(args);
}

/* --- a part of the take --- */

static fap_err crop(work *w, const fap_coefficients *take)
{
    const double start = ceil(w->cfg->start_s * take->rate_hz - 1e-6);
    const double end =
        w->cfg->end_s > 0 ? floor(w->cfg->end_s * take->rate_hz + 1e-6) + 1 : take->frame_count;
    const double first = fmax(start, 0), count = fmin(end, take->frame_count) - first;

    if (!(count >= 1))
        return work_fail(w, FAP_E_ARG, "--start and --end leave nothing of a take of %.2f s",
                         take->frame_count / take->rate_hz);
    const fap_err err = fap_coefficients_create(&w->take, take->channel_count, (uint32_t)count, &take->alloc);
    if (err != FAP_OK)
        return err;
    const size_t skip = (size_t)first * take->channel_count, samples = (size_t)count * take->channel_count;
    memcpy(w->take->channel, take->channel, sizeof take->channel);
    memcpy(w->take->value, take->value + skip, samples * sizeof *take->value);
    memcpy(w->take->valid, take->valid + skip, samples);
    w->take->rate_hz = take->rate_hz;
    w->take->format = take->format;
    return FAP_OK;
}

/* --- what is there --- */

static void survey_column(const fap_coefficients *t, uint32_t column, fap_channel_report *r)
{
    for (uint32_t f = 0; f < t->frame_count; f++) {
        const size_t i = (size_t)f * t->channel_count + column;
        if (!t->valid[i])
            continue;
        r->min = r->present ? fminf(r->min, t->value[i]) : t->value[i];
        r->max = r->present ? fmaxf(r->max, t->value[i]) : t->value[i];
        r->present = 1;
        r->moved |= t->value[i] != 0;
    }
}

static int is_moved(const work *w, int angle)
{
    return w->out->report.channel[FAP_CHANNEL_ANGLE + angle].moved;
}

/* Angles of a head, or of eyes, that are 0 from end to end were switched off. */
static void survey_angles(work *w)
{
    const fap_channel_report *r = w->out->report.channel + FAP_CHANNEL_ANGLE;

    w->has_head = is_moved(w, FAP_ARKIT_HEAD_YAW) || is_moved(w, FAP_ARKIT_HEAD_PITCH) ||
                  is_moved(w, FAP_ARKIT_HEAD_ROLL);
    w->has_eyes = is_moved(w, FAP_ARKIT_LEFT_EYE_YAW) || is_moved(w, FAP_ARKIT_LEFT_EYE_PITCH) ||
                  is_moved(w, FAP_ARKIT_RIGHT_EYE_YAW) || is_moved(w, FAP_ARKIT_RIGHT_EYE_PITCH);
    if (r[FAP_ARKIT_HEAD_YAW].present && !w->has_head)
        work_note(w, "the head's angles are 0 throughout: it was not recorded");
}

static int shape_is_known(const work *w, int shape)
{
    if (w->present[shape])
        return 1;
    for (int unit = 0; unit <= FAP_FACS_MAX_NUMBER; unit++)
        if (w->present[FAP_CHANNEL_AU + unit] && fap_facs_share(unit, shape) > 0)
            return 1;
    return 0;
}

static int is_gaze(int shape)
{
    return !strncmp(fap_arkit_name(shape), "EyeLook", 7);
}

static void survey_faps(work *w)
{
    int gaze = w->has_eyes;

    for (int s = 0; s < FAP_ARKIT_COUNT; s++) {
        if (!shape_is_known(w, s))
            continue;
        gaze |= is_gaze(s);
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            w->moved[fap] |= fap_arkit_value(s, fap) != 0;
    }
    for (int fap = 23; fap <= 26; fap++)
        w->moved[fap] = (uint8_t)gaze;
    for (int fap = 48; fap <= 50; fap++)
        w->moved[fap] = (uint8_t)w->has_head;
}

static fap_err survey(work *w)
{
    int any = 0;

    for (uint32_t c = 0; c < w->take->channel_count; c++) {
        const int channel = w->take->channel[c];
        fap_channel_report *r = &w->out->report.channel[channel];
        survey_column(w->take, c, r);
        w->present[channel] = r->present;
        any |= r->present;
    }
    survey_angles(w);
    survey_faps(w);
    return any ? FAP_OK : work_fail(w, FAP_E_NOT_FOUND, "not one coefficient in the frames asked for");
}

/* --- spikes --- */

/* Lids may do it: a blink at 25 frames a second is one frame. */
static int may_jump(int channel)
{
    return channel == FAP_CHANNEL_AU + 45 || channel == FAP_CHANNEL_AU + 43 ||
           (channel < FAP_ARKIT_COUNT && !strncmp(fap_arkit_name(channel), "EyeBlink", 8));
}

/* One frame far from two neighbours that agree. */
static int is_spike(float before, float at, float after)
{
    static const float least = 0.3f, agree = 0.2f;
    const float jump = fminf(fabsf(at - before), fabsf(at - after));

    return jump > least && fabsf(after - before) < agree * jump;
}

static void drop_spikes(work *w)
{
    fap_coefficients *t = w->take;
    const size_t width = t->channel_count;

    for (uint32_t c = 0; c < t->channel_count; c++) {
        if (may_jump(t->channel[c]))
            continue;
        for (uint32_t f = 1; f + 1 < t->frame_count; f++) {
            const size_t i = f * width + c;
            if (!t->valid[i - width] || !t->valid[i] || !t->valid[i + width] ||
                !is_spike(t->value[i - width], t->value[i], t->value[i + width]))
                continue;
            t->value[i] = (t->value[i - width] + t->value[i + width]) / 2;
            w->out->report.spikes++;
        }
    }
}

/* --- the face at rest --- */

/* What one channel does in frames @p first to @p last: how much there is of it, and how much it moves. */
static double unrest_of(const fap_coefficients *t, uint32_t column, uint32_t first, uint32_t last)
{
    static const double share_of_place = 0.1;
    double sum = 0, moved = 0;
    uint32_t n = 0;

    for (uint32_t f = first; f <= last; f++) {
        const size_t i = (size_t)f * t->channel_count + column;
        if (!t->valid[i])
            return 10;
        sum += fabs((double)t->value[i]);
        moved += f > first ? fabs((double)t->value[i] - (double)t->value[i - t->channel_count]) : 0;
        n++;
    }
    return share_of_place * sum / n + moved;
}

static double unrest(const work *w, uint32_t first, uint32_t last)
{
    const fap_coefficients *t = w->take;
    double sum = 0;

    for (uint32_t c = 0; c < t->channel_count; c++)
        if (w->present[t->channel[c]])
            sum += unrest_of(t, c, first, last);
    return sum;
}

static uint32_t stillest(const work *w, uint32_t length)
{
    const uint32_t hop = length > 4 ? length / 4 : 1;
    double least = INFINITY;
    uint32_t best = 0;

    for (uint32_t f = 0; f + length <= w->take->frame_count; f += hop) {
        const double u = unrest(w, f, f + length - 1);
        if (u < least) {
            least = u;
            best = f;
        }
    }
    return best;
}

static float mean_of(const fap_coefficients *t, uint32_t column, uint32_t first, uint32_t last)
{
    double sum = 0;
    uint32_t n = 0;

    for (uint32_t f = first; f <= last && f < t->frame_count; f++) {
        const size_t i = (size_t)f * t->channel_count + column;
        sum += t->valid[i] ? (double)t->value[i] : 0;
        n += t->valid[i];
    }
    return n ? (float)(sum / n) : 0;
}

/* The two ways along one axis: what is not down is up. */
static int opposite_of(int shape)
{
    static const char *const pairs[][2] = {
        { "EyeLookDownLeft", "EyeLookUpLeft" },
        { "EyeLookInLeft", "EyeLookOutLeft" },
        { "EyeLookDownRight", "EyeLookUpRight" },
        { "EyeLookInRight", "EyeLookOutRight" },
        { "JawLeft", "JawRight" },
        { "MouthLeft", "MouthRight" },
    };

    for (size_t i = 0; shape < FAP_ARKIT_COUNT && i < sizeof pairs / sizeof *pairs; i++)
        for (int k = 0; k < 2; k++)
            if (!strcmp(fap_arkit_name(shape), pairs[i][k]))
                return fap_arkit_by_name(pairs[i][!k]);
    return -1;
}

/* Both ends of an axis: the difference is what counts. */
static void rest_axis(fap_coefficients *t, uint32_t a, uint32_t b, float rest)
{
    for (uint32_t f = 0; f < t->frame_count; f++) {
        float *v = t->value + (size_t)f * t->channel_count;
        const float along = v[a] - v[b] - rest;
        v[a] = fmaxf(0, along);
        v[b] = fmaxf(0, -along);
    }
}

/* 0 at rest, and 1 stays 1. */
static void rest_share(fap_coefficients *t, uint32_t column, float rest)
{
    const float r = fminf(0.8f, fmaxf(0, rest));

    for (uint32_t f = 0; f < t->frame_count; f++) {
        float *v = t->value + (size_t)f * t->channel_count + column;
        *v = (*v - r) / (1 - r);
    }
}

static void rest_angle(fap_coefficients *t, uint32_t column, float rest)
{
    for (uint32_t f = 0; f < t->frame_count; f++)
        t->value[(size_t)f * t->channel_count + column] -= rest;
}

static void take_rest_off(work *w, const float *rest)
{
    fap_coefficients *t = w->take;

    for (uint32_t c = 0; c < t->channel_count; c++) {
        const int channel = t->channel[c], other = opposite_of(channel);
        const int column = other < 0 ? -1 : fap_coefficients_find(t, other);
        if (channel >= FAP_CHANNEL_ANGLE && channel < FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT)
            rest_angle(t, c, rest[c]);
        else if (column < 0)
            rest_share(t, c, rest[c]);
        else if (other > channel)
            rest_axis(t, c, (uint32_t)column, rest[c] - rest[column]);
    }
}

/* Frames of @c take whose mean is the face at rest. */
typedef struct rest_stretch {
    const fap_coefficients *take;
    uint32_t first, length;
} rest_stretch;

/* A tenth of a second around a frame, as one alone is noisy; or the stretch as it is. */
static fap_err named_stretch(work *w, const fap_coefficients *whole, rest_stretch *s)
{
    const int64_t from = w->cfg->neutral_frame, to = w->cfg->neutral_last < 0 ? from : w->cfg->neutral_last;

    if (from < 0 || to < from || to >= whole->frame_count)
        return work_fail(w, FAP_E_ARG, "--neutral %lld: the take has frames 0 to %u",
                         (long long)(from < 0 || from >= whole->frame_count ? from : to),
                         (unsigned)(whole->frame_count - 1));
    const uint32_t around = (uint32_t)fmin(whole->frame_count, fmax(1, 0.1 * whole->rate_hz));
    const uint32_t middle = (uint32_t)from, margin = around / 2;
    *s = to > from ? (rest_stretch){ whole, middle, (uint32_t)(to - from + 1) }
                   : (rest_stretch){ whole, middle > margin ? middle - margin : 0, around };
    return FAP_OK;
}

static fap_err still_stretch(const work *w, rest_stretch *s)
{
    const uint32_t length = (uint32_t)fmin(w->take->frame_count, fmax(1, 0.5 * w->take->rate_hz));

    *s = (rest_stretch){ w->take, stillest(w, length), length };
    return FAP_OK;
}

static fap_err settle_rest(work *w, const fap_coefficients *whole)
{
    const fap_coefficients_config *cfg = w->cfg;
    fap_coefficients *t = w->take;
    float rest[FAP_CHANNEL_COUNT];
    rest_stretch s = { t, 0, 1 };

    w->out->report.neutral_s = -1;
    if (cfg->rest == FAP_REST_ZERO)
        return FAP_OK;
    const int named = cfg->rest == FAP_REST_FRAME;
    const fap_err err = named ? named_stretch(w, whole, &s) : still_stretch(w, &s);
    if (err != FAP_OK)
        return err;
    for (uint32_t c = 0; c < t->channel_count; c++) {
        rest[c] = mean_of(s.take, c, s.first, s.first + s.length - 1);
        w->out->report.channel[t->channel[c]].rest = rest[c];
    }
    const double skipped = named ? 0 : fmax(0, ceil(cfg->start_s * whole->rate_hz - 1e-6));
    w->out->report.neutral_s = (skipped + s.first + s.length / 2.0) / t->rate_hz;
    take_rest_off(w, rest);
    return FAP_OK;
}

/* --- gaps --- */

static const double short_gap_s = 0.2;

static void bridge(fap_coefficients *t, uint32_t column, int64_t before, int64_t after)
{
    const size_t width = t->channel_count;
    const int64_t first = before < 0 ? 0 : before + 1, last = after < 0 ? t->frame_count - 1 : after - 1;

    for (int64_t f = first; f <= last; f++) {
        const float u = before < 0 ? 1 : after < 0 ? 0 : (float)(f - before) / (float)(after - before);
        const float ease = u * u * (3 - 2 * u);
        const float a = before < 0 ? 0 : t->value[(size_t)before * width + column];
        const float b = after < 0 ? 0 : t->value[(size_t)after * width + column];
        t->value[(size_t)f * width + column] = a + ease * (b - a);
        t->valid[(size_t)f * width + column] = 1;
    }
}

static void fill_column(work *w, uint32_t column)
{
    fap_coefficients *t = w->take;
    const double most = w->cfg->fill == FAP_FILL_ALL ? INFINITY : short_gap_s * t->rate_hz;
    int64_t before = -1;

    for (int64_t f = 0; f <= t->frame_count; f++) {
        const int at_end = f == t->frame_count;
        if (!at_end && !t->valid[(size_t)f * t->channel_count + column])
            continue;
        const int64_t gap = f - before - 1;
        if (gap > 0 && (double)gap <= most)
            bridge(t, column, before, at_end ? -1 : f);
        before = f;
    }
}

static uint32_t frames_missing(const work *w)
{
    const fap_coefficients *t = w->take;
    uint32_t n = 0;

    for (uint32_t f = 0; f < t->frame_count; f++) {
        int whole = 1;
        for (uint32_t c = 0; c < t->channel_count; c++)
            whole &= !w->present[t->channel[c]] || t->valid[(size_t)f * t->channel_count + c];
        n += !whole;
    }
    return n;
}

static void fill_gaps(work *w)
{
    fap_coefficients_report *r = &w->out->report;

    r->frames_missing = frames_missing(w);
    if (w->cfg->fill == FAP_FILL_NONE || !r->frames_missing)
        return;
    for (uint32_t c = 0; c < w->take->channel_count; c++)
        if (w->present[w->take->channel[c]])
            fill_column(w, c);
    r->frames_filled = r->frames_missing - frames_missing(w);
}

/* --- another rate --- */

/*
 * By the filter that markers go through: a column is a point that moves along one axis. Three columns to a point would be
 * quicker, but would share their gaps.
 */
static fap_err resample(work *w, fap_take **out)
{
    const fap_coefficients *t = w->take;
    const size_t samples = (size_t)t->frame_count * t->channel_count;
    fap_take *points;

    fap_err err = fap_take_create(&points, t->channel_count, t->frame_count, &t->alloc);
    if (err != FAP_OK)
        return err;
    points->rate_hz = t->rate_hz;
    for (size_t i = 0; i < samples; i++) {
        points->xyz[i][0] = t->value[i];
        points->valid[i] = t->valid[i];
    }
    err = fap_take_resample(points, w->cfg->rate_hz, w->cfg->smooth_hz, out);
    fap_take_close(&points);
    return err;
}

/* --- to FAPs --- */

/* A share within its limits; the filter's own small overshoot is no news. */
static float limited(work *w, float value)
{
    static const float slack = 0.01f;

    w->out->report.clamped += value < -slack || value > 1 + slack;
    return fminf(1, fmaxf(0, value));
}

static int gather(work *w, const fap_take *points, uint32_t frame, fap_arkit *out)
{
    fap_facs facs = { { 0 } };

    memset(out, 0, sizeof *out);
    for (int pass = 0; pass < 2; pass++) { /* units, then what has shapes of its own */
        for (uint32_t c = 0; c < w->take->channel_count; c++) {
            const int channel = w->take->channel[c];
            const float *v = fap_take_sample(points, frame, c);
            if (!w->present[channel] || (channel >= FAP_CHANNEL_AU) == pass)
                continue;
            if (!v)
                return 0;
            if (channel >= FAP_CHANNEL_AU)
                facs.unit[channel - FAP_CHANNEL_AU] = limited(w, v[0]);
            else if (channel >= FAP_CHANNEL_ANGLE)
                out->angle[channel - FAP_CHANNEL_ANGLE] = v[0];
            else
                out->shape[channel] = limited(w, v[0]);
        }
        if (!pass)
            fap_facs_to_arkit(&facs, out);
    }
    out->has_head = (uint8_t)w->has_head;
    out->has_eyes = (uint8_t)w->has_eyes;
    return 1;
}

/* As the point capture counts it: Table C-1's range in steps, minus the upper limit where it prints no lower one. */
static int is_beyond(const fap_info *info, int32_t value)
{
    const int32_t high = info->i_max * info->quant_step, low = info->i_min * info->quant_step;
    return value > high || value < (low ? low : -high);
}

static void count_fap(const fap_frame *frame, int fap, fap_capture_fap *r)
{
    const int32_t v = frame->value[fap];

    r->min = r->coded && r->min < v ? r->min : v;
    r->max = r->coded && r->max > v ? r->max : v;
    r->coded++;
    r->beyond += (uint32_t)is_beyond(fap_info_get(fap), v);
}

static void put_frame(work *w, const fap_take *points, uint32_t n)
{
    fap_frame *frame = &w->out->frames[n];
    fap_arkit *arkit = &w->out->arkit[n];

    *frame = (fap_frame){ .number = n, .pts_us = llround(n * 1e6 / w->cfg->rate_hz) };
    if (!gather(w, points, n, arkit))
        return;
    fap_arkit_to_faps(arkit, frame);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        if (!w->moved[fap]) {
            frame->state[fap] = FAP_ABSENT;
            frame->value[fap] = 0;
        } else if (frame->state[fap] != FAP_ABSENT) {
            count_fap(frame, fap, &w->out->report.fap[fap]);
        }
    }
}

static fap_err to_faps(work *w)
{
    fap_performance *out = w->out;
    fap_take *points;
    const fap_err err = resample(w, &points);

    if (err != FAP_OK)
        return work_fail(w, err, "%g frames a second cannot be made of this take", w->cfg->rate_hz);
    out->frames = fap_mem_calloc(&out->alloc, points->frame_count, sizeof *out->frames);
    out->arkit = fap_mem_calloc(&out->alloc, points->frame_count, sizeof *out->arkit);
    for (uint32_t f = 0; out->frames && out->arkit && f < points->frame_count; f++)
        put_frame(w, points, f);
    out->report.frames = points->frame_count;
    fap_take_close(&points);
    return out->frames && out->arkit ? FAP_OK : FAP_E_NOMEM;
}

/* --- all --- */

static fap_err encode(work *w, const fap_coefficients *take)
{
    fap_coefficients_report *r = &w->out->report;

    if (!(take->rate_hz > 0))
        return work_fail(w, FAP_E_ARG, "the take does not say its frame rate; give it with --take-rate");
    r->format = take->format;
    r->take_rate_hz = take->rate_hz;
    r->take_frames = take->frame_count;
    r->take_length_s = take->frame_count / take->rate_hz;
    r->rate_hz = w->cfg->rate_hz;
    fap_err err = crop(w, take);
    if (err == FAP_OK)
        err = survey(w);
    if (err != FAP_OK)
        return err;
    drop_spikes(w);
    err = settle_rest(w, take);
    if (err != FAP_OK)
        return err;
    fill_gaps(w);
    return to_faps(w);
}

fap_err fap_coefficients_encode(fap_performance **out, const fap_coefficients *take,
                                const fap_coefficients_config *cfg, char *where)
{
    char text[FAP_ERROR_TEXT_SIZE] = "";
    fap_coefficients_config defaults;

    *out = NULL;
    fap_coefficients_config_init(&defaults);
    fap_performance *p = fap_mem_calloc(&take->alloc, 1, sizeof *p);
    if (!p)
        return FAP_E_NOMEM;
    p->alloc = take->alloc;
    work w = { .cfg = cfg ? cfg : &defaults, .out = p, .where = text };
    const fap_err err = encode(&w, take);
    fap_coefficients_close(&w.take);
    if (err == FAP_OK)
        *out = p;
    else
        fap_performance_close(&p);
    if (err != FAP_OK && where)
        memcpy(where, text, sizeof text);
    return err;
}

const fap_frame *fap_performance_frames(const fap_performance *p)
{
    return p->frames;
}

const fap_arkit *fap_performance_arkit(const fap_performance *p)
{
    return p->arkit;
}

const fap_coefficients_report *fap_performance_report(const fap_performance *p)
{
    return &p->report;
}

void fap_performance_close(fap_performance **p)
{
    if (!*p)
        return;
    const fap_allocator a = (*p)->alloc;
    fap_mem_free(&a, (*p)->frames);
    fap_mem_free(&a, (*p)->arkit);
    fap_mem_free(&a, *p);
    *p = NULL;
}
