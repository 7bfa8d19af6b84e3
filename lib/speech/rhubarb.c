/* SPDX-License-Identifier: BSD-2-Clause */
/* Rhubarb Lip Sync's JSON: "metadata" with a "duration", and "mouthCues" of "start", "end" and "value". */
#include <string.h>

#include "speech/source.h"
#include "take/json_text.h"

static int rhubarb_claims(const uint8_t *data, size_t size)
{
    json_text j = json_text_open(data, size);
    int first = 1;
    text key;

    if (!json_text_enter(&j, '{'))
        return 0;
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (text_is(key, "mouthCues"))
            return 1;
        json_text_skip(&j);
    }
    return 0;
}

static void read_metadata(json_text *j, fap_speech *s)
{
    int first = 1;
    text key;

    if (!json_text_enter(j, '{')) {
        json_text_skip(j);
        return;
    }
    while (json_text_next(j, '}', &first) && json_text_key(j, &key))
        if (text_is(key, "duration"))
            json_text_number(j, &s->length_s);
        else
            json_text_skip(j);
}

static fap_err read_cue(json_text *j, fap_speech *s)
{
    double start = -1, end = -1;
    text key, value = { "", 0 };
    int first = 1;

    if (!json_text_enter(j, '{')) {
        json_text_skip(j);
        return FAP_OK;
    }
    while (json_text_next(j, '}', &first) && json_text_key(j, &key))
        if (text_is(key, "start"))
            json_text_number(j, &start);
        else if (text_is(key, "end"))
            json_text_number(j, &end);
        else if (text_is(key, "value"))
            json_text_string(j, &value);
        else
            json_text_skip(j);
    return j->bad ? FAP_OK : speech_add(s, start, end, value);
}

static fap_err read_cues(json_text *j, fap_speech *s)
{
    fap_err err = FAP_OK;
    int first = 1;

    if (!json_text_enter(j, '[')) {
        json_text_skip(j);
        return FAP_OK;
    }
    while (err == FAP_OK && json_text_next(j, ']', &first) && !j->bad)
        err = read_cue(j, s);
    return err;
}

static fap_err rhubarb_read(speech_source *src, fap_speech *s)
{
    json_text j = json_text_open(src->data, src->size);
    fap_err err = FAP_OK;
    int first = 1;
    text key;

    json_text_enter(&j, '{');
    while (err == FAP_OK && json_text_next(&j, '}', &first) && json_text_key(&j, &key))
        if (text_is(key, "metadata"))
            read_metadata(&j, s);
        else if (text_is(key, "mouthCues"))
            err = read_cues(&j, s);
        else
            json_text_skip(&j);
    if (j.bad)
        speech_note(s, "the JSON breaks off or is damaged behind cue %u", (unsigned)s->count);
    s->alphabet = FAP_ALPHABET_RHUBARB;
    return err;
}

const speech_driver speech_driver_rhubarb = { "rhubarb", rhubarb_claims, rhubarb_read };
