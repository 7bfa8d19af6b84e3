/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Carstens AG500 and AG501 positions: a text head that says how long it is, then seven floats a channel and sample: x, y, z in
 * millimetres, two angles, the fit's error, one more. Channels have no names in the file. Source: the layout of real files (V003).
 */
#include <stdio.h>
#include <string.h>

#include "take/take_driver.h"
#include "take/text.h"

enum { FLOATS = 7, MOST_CHANNELS = 256, HEAD_REACH = 1 << 16 };

typedef struct pos_head {
    size_t size; /* bytes, the samples begin behind it */
    double channels, rate_hz;
} pos_head;

static int pos_claims(const uint8_t *data, size_t size)
{
    return size > 8 && !memcmp(data, "AG50", 4) && memchr(data, '\n', size < 64 ? size : 64) ? 95 : 0;
}

/* "NumberOfChannels=16" */
static void read_pair(text line, const char *key, double *value)
{
    const size_t length = strlen(key);

    if (line.length > length && line.start[length] == '=' && text_starts(line, key))
        text_number(text_trim((text){ line.start + length + 1, line.length - length - 1 }), value);
}

static void read_head(take_source *src, pos_head *h)
{
    text_lines lines = text_open(src->data, src->size < HEAD_REACH ? src->size : HEAD_REACH);
    double size = 0;
    text line;

    text_next(&lines, &line); /* AG50xDATA_V003 */
    if (text_next(&lines, &line) && text_number(text_trim(line), &size) == TEXT_NUMBER && size > 0 &&
        size <= HEAD_REACH)
        h->size = (size_t)size;
    while ((size_t)(lines.at - (const char *)src->data) < h->size && text_next(&lines, &line)) {
        read_pair(line, "NumberOfChannels", &h->channels);
        read_pair(line, "SamplingFrequencyHz", &h->rate_hz);
    }
}

static float read_float(const uint8_t *at)
{
    const uint32_t bits =
        (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    float v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

static const uint8_t *sample_at(const take_source *src, const pos_head *h, size_t frame, size_t channel)
{
    return src->data + h->size + 4 * FLOATS * (frame * (size_t)h->channels + channel);
}

/* A channel without a sensor is 0 throughout. */
static int is_used(const take_source *src, const pos_head *h, size_t frames, size_t channel)
{
    static const uint8_t zero[12];

    for (size_t f = 0; f < frames; f++)
        if (memcmp(sample_at(src, h, f, channel), zero, sizeof zero))
            return 1;
    return 0;
}

/* x forward, y left, z up: to the axes of a head. */
static void read_channel(const take_source *src, const pos_head *h, size_t channel, fap_take *take,
                         uint32_t point)
{
    char name[32];

    take_set_name(take, point, name, (size_t)snprintf(name, sizeof name, "Sensor%zu", channel + 1));
    for (uint32_t f = 0; f < take->frame_count; f++) {
        const uint8_t *at = sample_at(src, h, f, channel);
        fap_take_set(take, f, point,
                     (const float[3]){ read_float(at + 4), read_float(at + 8), read_float(at) });
    }
}

static fap_err pos_read(take_source *src, fap_take **take)
{
    size_t used[MOST_CHANNELS], count = 0;
    pos_head h = { 0 };

    read_head(src, &h);
    if (!h.size || !(h.channels >= 1) || h.channels > MOST_CHANNELS)
        return take_fail(src, FAP_E_SYNTAX,
                         "ema: the head should give its length in line 2, and NumberOfChannels (to %d)",
                         MOST_CHANNELS);
    const size_t row = 4 * FLOATS * (size_t)h.channels, rest = src->size > h.size ? src->size - h.size : 0,
                 frames = rest / row;
    for (size_t c = 0; c < (size_t)h.channels; c++)
        if (is_used(src, &h, frames, c))
            used[count++] = c;
    if (!frames || !count)
        return take_fail(src, FAP_E_NOT_FOUND, "ema: no sample behind the head, or all channels are empty");
    if (frames > FAP_TAKE_MAX_SAMPLES)
        return FAP_E_LIMIT;
    const fap_err err = fap_take_create(take, (uint32_t)count, (uint32_t)frames, &src->alloc);
    if (err != FAP_OK)
        return err;
    (*take)->format = "ema";
    (*take)->rate_hz = h.rate_hz;
    for (size_t i = 0; i < count; i++)
        read_channel(src, &h, used[i], *take, (uint32_t)i);
    if (count < (size_t)h.channels)
        take_note(*take, "%u of %u channels have no sensor", (unsigned)((size_t)h.channels - count),
                  (unsigned)h.channels);
    if (rest % row)
        take_note(*take, "the last sample is cut");
    take_note(
        *take,
        "channels have no names in this format: say which is where with --markers, as in \"Sensor1,6.1\"");
    return FAP_OK;
}

const take_driver take_driver_ema_pos = { "ema", pos_claims, pos_read };
