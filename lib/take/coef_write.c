/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The table that Live Link Face writes: time code, 61, the 52 coefficients, nine angles. Frames of the time code count
 * sixtieths of a second, as in the app's own files.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/coefficients.h>

enum { SHOWN = FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT, LINE_SIZE = 32 + 16 * SHOWN };

typedef struct line {
    char text[LINE_SIZE];
    size_t used;
} line;

static void put(line *l, const char *text)
{
    const size_t n = strlen(text);

    if (l->used + n < sizeof l->text) {
        memcpy(l->text + l->used, text, n);
        l->used += n;
    }
}

static int write_line(const fap_writer *out, line *l)
{
    put(l, "\n");
    return out->write(out->user, l->text, l->used);
}

static int write_head(const fap_writer *out)
{
    line l = { .used = 0 };

    put(&l, "Timecode,BlendShapeCount");
    for (int c = 0; c < SHOWN; c++) {
        put(&l, ",");
        put(&l, fap_channel_name(c));
    }
    return write_line(out, &l);
}

static void put_time_code(line *l, double time_s)
{
    const long long thousandths = llround(time_s * 60000), s = thousandths / 60000;
    char text[40];

    snprintf(text, sizeof text, "%02lld:%02lld:%02lld:%02lld.%03lld,%d", s / 3600 % 24, s / 60 % 60, s % 60,
             thousandths / 1000 % 60, thousandths % 1000, SHOWN);
    put(l, text);
}

/* Without the locale, which may have another decimal mark; -0 is 0 for everybody but text. */
static void put_number(line *l, double value)
{
    const long long millionths = llround(value * 1e6), size = millionths < 0 ? -millionths : millionths;
    char text[32];

    snprintf(text, sizeof text, ",%s%lld.%06lld", millionths < 0 ? "-" : "", size / 1000000, size % 1000000);
    put(l, text);
}

static int is_seen(const fap_coefficients *take, uint32_t frame)
{
    const uint8_t *valid = take->valid + (size_t)frame * take->channel_count;

    return memchr(valid, 1, take->channel_count) != NULL;
}

static int write_frame(const fap_coefficients *take, uint32_t frame, const int *column, const fap_writer *out)
{
    const float *value = take->value + (size_t)frame * take->channel_count;
    line l = { .used = 0 };

    put_time_code(&l, take->start_s + frame / take->rate_hz);
    for (int c = 0; c < SHOWN; c++)
        put_number(&l, column[c] >= 0 ? (double)value[column[c]] : 0);
    return write_line(out, &l);
}

fap_err fap_coefficients_write_livelink(const fap_coefficients *take, const fap_writer *out)
{
    int column[SHOWN];

    if (!(take->rate_hz > 0))
        return FAP_E_ARG;
    for (int c = 0; c < SHOWN; c++)
        column[c] = fap_coefficients_find(take, c);
    if (write_head(out))
        return FAP_E_IO;
    for (uint32_t f = 0; f < take->frame_count; f++)
        if (is_seen(take, f) && write_frame(take, f, column, out))
            return FAP_E_IO;
    return FAP_OK;
}
