/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The table that Live Link Face writes: time code, 61, the 52 coefficients, nine angles. Frames of the time code count
 * sixtieths of a second, as in the app's own files.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/coefficients.h>

#include "take/text_out.h"

enum { SHOWN = FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT };

static void put_head(text_out *o)
{
    text_put(o, "Timecode,BlendShapeCount");
    for (int c = 0; c < SHOWN; c++) {
        text_put(o, ",");
        text_put(o, fap_channel_name(c));
    }
    text_put(o, "\n");
}

static void put_time_code(text_out *o, double time_s)
{
    const long long thousandths = llround(time_s * 60000), s = thousandths / 60000;
    char text[40];

    snprintf(text, sizeof text, "%02lld:%02lld:%02lld:%02lld.%03lld,%d", s / 3600 % 24, s / 60 % 60, s % 60,
             thousandths / 1000 % 60, thousandths % 1000, SHOWN);
    text_put(o, text);
}

static int is_seen(const fap_coefficients *take, uint32_t frame)
{
    const uint8_t *valid = take->valid + (size_t)frame * take->channel_count;

    return memchr(valid, 1, take->channel_count) != NULL;
}

static void put_frame(text_out *o, const fap_coefficients *take, uint32_t frame, const int *column)
{
    const float *value = take->value + (size_t)frame * take->channel_count;

    put_time_code(o, take->start_s + frame / take->rate_hz);
    for (int c = 0; c < SHOWN; c++) {
        text_put(o, ",");
        text_put_number(o, column[c] >= 0 ? (double)value[column[c]] : 0, 6);
    }
    text_put(o, "\n");
}

fap_err fap_coefficients_write_livelink(const fap_coefficients *take, const fap_writer *out)
{
    text_out o = { .to = out };
    int column[SHOWN];

    if (!(take->rate_hz > 0))
        return FAP_E_ARG;
    for (int c = 0; c < SHOWN; c++)
        column[c] = fap_coefficients_find(take, c);
    put_head(&o);
    for (uint32_t f = 0; f < take->frame_count && !o.failed; f++)
        if (is_seen(take, f))
            put_frame(&o, take, f, column);
    return o.failed ? FAP_E_IO : FAP_OK;
}
