/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * ARKit's coefficients as JSON, two kinds. BEAT: "names", and "frames" of "weights" and "time". Audio2Face: "facsNames",
 * "exportFps" and "weightMat", a row a frame. UNVERIFIED: both from general knowledge of these exports, no file was at hand.
 */
#include <string.h>

#include "take/coef.h"
#include "take/json_text.h"

typedef struct layout {
    int is_beat;
    int16_t channel[512]; /* of each name; -1: none */
    size_t names;
    uint32_t channels;
    double rate_hz;
    uint64_t rows;
} layout;

static int begins(const uint8_t *data, size_t size, const char *word)
{
    const size_t reach = size < 4096 ? size : 4096, length = strlen(word);

    for (size_t i = 0; i + length <= reach; i++)
        if (!memcmp(data + i, word, length))
            return 1;
    return 0;
}

/* The names come first in both kinds, so a look at the beginning does. */
static int json_claims(const uint8_t *data, size_t size)
{
    json_text j = json_text_open(data, size);

    if (!json_text_enter(&j, '{'))
        return 0;
    return begins(data, size, "\"facsNames\"") || begins(data, size, "\"weightMat\"") ||
                   (begins(data, size, "\"names\"") && begins(data, size, "eyeBlink")) ||
                   (begins(data, size, "\"weights\"") && begins(data, size, "\"frames\""))
               ? 75
               : 0;
}

static int is_taken(const layout *l, int channel)
{
    for (size_t i = 0; i < l->names; i++)
        if (l->channel[i] == channel)
            return 1;
    return 0;
}

static void read_names(json_text *j, layout *l)
{
    int first = 1;
    text name;

    if (l->names || !json_text_enter(j, '[')) {
        json_text_skip(j);
        return;
    }
    while (json_text_next(j, ']', &first) && json_text_string(j, &name)) {
        const int channel = coef_channel_of(name);
        if (l->names == sizeof l->channel / sizeof *l->channel)
            continue;
        const int fresh = channel >= 0 && !is_taken(l, channel);
        l->channels += (uint32_t)fresh;
        l->channel[l->names++] = (int16_t)(fresh ? channel : -1);
    }
}

static uint64_t count_items(json_text *j)
{
    uint64_t n = 0;
    int first = 1;

    if (!json_text_enter(j, '[')) {
        json_text_skip(j);
        return 0;
    }
    for (; json_text_next(j, ']', &first) && !j->bad; n++)
        json_text_skip(j);
    return n;
}

static void survey(json_text j, layout *l)
{
    int first = 1;
    text key;

    if (!json_text_enter(&j, '{'))
        return;
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (text_is(key, "names") || text_is(key, "facsNames")) {
            read_names(&j, l);
        } else if (text_is(key, "exportFps")) {
            json_text_number(&j, &l->rate_hz);
        } else if (text_is(key, "frames") || text_is(key, "weightMat")) {
            l->is_beat = text_is(key, "frames");
            l->rows = count_items(&j);
        } else {
            json_text_skip(&j);
        }
    }
}

static void read_weights(json_text *j, const layout *l, coef_rows *rows, int64_t row)
{
    uint32_t column = 0;
    int first = 1;
    double v;

    if (!json_text_enter(j, '[')) {
        json_text_skip(j);
        return;
    }
    for (size_t i = 0; json_text_next(j, ']', &first); i++) {
        const int known = json_text_number(j, &v), wanted = i < l->names && l->channel[i] >= 0;
        if (known && wanted)
            coef_set(rows, row, column, v);
        column += (uint32_t)wanted;
    }
}

/* One of BEAT's frames: an object. */
static void read_frame(json_text *j, const layout *l, coef_rows *rows)
{
    const int64_t row = coef_rows_add(rows, rows->count, 0);
    int first = 1;
    text key;

    if (row < 0 || !json_text_enter(j, '{')) {
        json_text_skip(j);
        return;
    }
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (text_is(key, "weights"))
            read_weights(j, l, rows, row);
        else if (text_is(key, "time"))
            json_text_number(j, &rows->time[row]);
        else
            json_text_skip(j);
    }
}

static void read_rows(json_text *j, const layout *l, coef_rows *rows)
{
    int first = 1;

    if (!json_text_enter(j, '[')) {
        json_text_skip(j);
        return;
    }
    while (json_text_next(j, ']', &first) && !j->bad) {
        if (l->is_beat)
            read_frame(j, l, rows);
        else
            read_weights(j, l, rows, coef_rows_add(rows, rows->count, 0));
    }
}

static void read_all(json_text j, const layout *l, coef_rows *rows)
{
    int first = 1;
    text key;

    if (!json_text_enter(&j, '{'))
        return;
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (text_is(key, l->is_beat ? "frames" : "weightMat") && !rows->count)
            read_rows(&j, l, rows);
        else
            json_text_skip(&j);
    }
    if (j.bad)
        coef_note(rows->take, "the JSON breaks off or is damaged behind row %u", (unsigned)rows->count);
}

static fap_err json_read(take_source *src, coef_rows *rows)
{
    const json_text j = json_text_open(src->data, src->size);
    layout l = { 0 };
    uint32_t n = 0;

    survey(j, &l);
    if (!l.channels)
        return take_fail(src, FAP_E_NOT_FOUND,
                         "JSON without a list of ARKit's names (\"names\" or \"facsNames\")");
    const fap_err err = coef_rows_open(src, rows, l.channels, l.rows);
    if (err != FAP_OK)
        return err;
    for (size_t i = 0; i < l.names; i++)
        if (l.channel[i] >= 0)
            rows->take->channel[n++] = (uint8_t)l.channel[i];
    rows->take->format = l.is_beat ? "BEAT JSON" : "Audio2Face JSON";
    rows->clock = l.is_beat ? COEF_CLOCK_SECONDS : COEF_CLOCK_NONE;
    rows->known_hz = l.rate_hz;
    rows->snap = 0.002;
    read_all(j, &l, rows);
    return FAP_OK;
}

const coef_driver coef_driver_json = { "json", json_claims, json_read };
