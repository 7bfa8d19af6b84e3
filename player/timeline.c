/* SPDX-License-Identifier: BSD-2-Clause */
/* See timeline.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/derive.h>

#include "player/timeline.h"

static const int64_t longest_us = INT64_C(24) * 3600 * 1000000;
/* Times of stream and output are rounded to microseconds on their own: this close together they are the same
 * time. */
static const int64_t same_us = 2;

static fap_err grow(timeline *t)
{
    if (t->count < t->capacity)
        return FAP_OK;
    const size_t capacity = t->capacity ? 2 * t->capacity : 256;
    fap_frame *frame = realloc(t->frame, capacity * sizeof *frame);
    if (!frame)
        return FAP_E_NOMEM;
    t->frame = frame;
    uint32_t *bits = realloc(t->bits, capacity * sizeof *bits);
    if (!bits)
        return FAP_E_NOMEM;
    t->bits = bits;
    t->capacity = capacity;
    return FAP_OK;
}

/* What stream_read() hands frames to. */
typedef struct append_target {
    timeline *line;
    const fap_fit *fit;
    char *where;
    uint32_t skipped; /* in front of the frame that comes next */
    uint32_t bits;    /* of the plane that makes it */
    double rate_hz;
} append_target;

static fap_err append(append_target *target, const fap_frame *frame)
{
    timeline *t = target->line;

    if (t->count == TIMELINE_MAX_FRAMES || frame->pts_us > longest_us) {
        snprintf(target->where, FAP_ERROR_TEXT_SIZE, "more than %d frames or 24 hours; cut the stream",
                 TIMELINE_MAX_FRAMES);
        return FAP_E_LIMIT;
    }
    const fap_err err = grow(t);
    if (err)
        return err;
    t->frame[t->count] = *frame;
    t->bits[t->count] = target->bits;
    target->bits = 0;
    fap_derive_with(target->fit, &t->frame[t->count++]);
    return FAP_OK;
}

static void take_plane(void *user, const fap_plane_info *plane, const fap_frame *frame)
{
    append_target *target = user;

    (void)frame;
    target->skipped = plane->skipped;
    target->bits = plane->bit_count;
    target->rate_hz = plane->rate_hz;
}

/* During skipped frames the face stays as it is: it starts to move one frame before the next that was sent. */
static fap_err take_frame(void *user, const fap_frame *frame)
{
    append_target *target = user;
    const timeline *t = target->line;

    if (target->skipped && t->count) {
        fap_frame held = t->frame[t->count - 1];
        const int64_t last_us = frame->pts_us - timeline_time_us(1, target->rate_hz);
        held.pts_us = last_us > held.pts_us ? last_us : held.pts_us;
        const uint32_t bits = target->bits;
        target->bits = 0;
        const fap_err err = append(target, &held);
        target->bits = bits;
        if (err)
            return err;
    }
    target->skipped = 0;
    return append(target, frame);
}

fap_err timeline_load(timeline *t, const uint8_t *data, size_t size, const stream_options *options,
                      stream_summary *summary, char *where)
{
    char limit[FAP_ERROR_TEXT_SIZE] = "";
    append_target target = { .line = t, .fit = options ? options->fit : NULL, .where = limit };
    const frame_sink sink = { .put = take_frame, .user = &target, .plane = take_plane };

    *t = (timeline){ 0 };
    fap_err err = stream_read(data, size, options, summary, &sink, where);
    if (!err && !t->count) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "the stream has no frames");
        err = FAP_E_DATA;
    }
    if (limit[0])
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", limit);
    if (err) {
        timeline_free(t);
        return err;
    }
    t->rate_hz = summary->header.rate_hz;
    t->end_us = t->frame[t->count - 1].pts_us + timeline_time_us(1, t->rate_hz);
    return FAP_OK;
}

void timeline_free(timeline *t)
{
    free(t->frame);
    free(t->bits);
    *t = (timeline){ 0 };
}

int64_t timeline_time_us(int64_t k, double rate_hz)
{
    return (int64_t)((double)k * 1e6 / rate_hz + 0.5);
}

int64_t timeline_count_frames(int64_t length_us, double rate_hz)
{
    const int64_t count = (int64_t)ceil((double)(length_us - same_us) * rate_hz * 1e-6);
    return count > 1 ? count : 1;
}

int64_t timeline_frame_count(const timeline *t, double rate_hz)
{
    return timeline_count_frames(t->end_us, rate_hz);
}

/* The last stream frame that has begun at @time_us; the first one before that. */
static size_t frame_at(const timeline *t, int64_t time_us)
{
    size_t low = 0, high = t->count;

    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (t->frame[middle].pts_us <= time_us + same_us)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double timeline_kbit_s(const timeline *t, int64_t time_us)
{
    const int64_t second_us = 1000000, last_us = timeline_time_us(1, t->rate_hz);
    const int64_t span_us = time_us + last_us < second_us ? time_us + last_us : second_us;
    uint64_t bits = 0;

    for (size_t i = frame_at(t, time_us) + 1; i-- > 0 && t->frame[i].pts_us > time_us - second_us;)
        bits += t->bits[i];
    return span_us > 0 ? (double)bits * 1e3 / (double)span_us : 0;
}

/* A FAP without a value in either frame has nothing to be interpolated to. */
static void interpolate(fap_frame *out, const fap_frame *next, double share)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const double a = out->value[fap], b = next->value[fap];
        if (out->state[fap] != FAP_ABSENT && next->state[fap] != FAP_ABSENT)
            out->value[fap] = (int32_t)lround(a + (b - a) * share);
    }
}

void timeline_sample(const timeline *t, int64_t time_us, fap_frame *out)
{
    const size_t i = frame_at(t, time_us);
    const fap_frame *frame = &t->frame[i];
    const int64_t since_us = time_us - frame->pts_us;

    *out = *frame;
    out->pts_us = time_us;
    if (since_us <= same_us || i + 1 == t->count)
        return;
    interpolate(out, frame + 1, (double)since_us / (double)(frame[1].pts_us - frame->pts_us));
}
