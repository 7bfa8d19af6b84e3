/* SPDX-License-Identifier: BSD-2-Clause */
/* See spoken.h. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "common/sound_file.h"
#include "encoder/speech/heard.h"
#include "encoder/speech/phonemize.h"
#include "encoder/speech/spoken.h"

enum { MOST_PHONEMES = 1 << 26 };

/* After the last sound without a sound file: time for the mouth to come to rest. */
static const double tail_s = 0.3;
static const double longest_s = 6 * 3600;

/* --- what is said --- */

static fap_err read_file(spoken *s, const options *opt, const char **path, char *where)
{
    uint8_t *data;
    size_t size;

    *path = opt->speech.phonemes;
    errno = 0;
    fap_err err = file_read(*path, MOST_PHONEMES, &data, &size);
    if (err != FAP_OK)
        return err;
    fap_speech_read_config cfg;
    fap_speech_read_config_init(&cfg);
    cfg.tier = opt->speech.tier;
    err = fap_speech_read(&s->speech, data, size, &cfg, where);
    free(data);
    return err;
}

static fap_err read_text(spoken *s, const options *opt, const char **path, int *missing, char *where)
{
    uint8_t *tsv;
    size_t size;

    *path = "--text";
    fap_err err = phonemize(opt->speech.text, opt->speech.language, &tsv, &size, where);
    *missing = err == FAP_E_UNSUPPORTED;
    if (err != FAP_OK)
        return err;
    err = fap_speech_read(&s->speech, tsv, size, NULL, where);
    free(tsv);
    return err;
}

/* --- the sound --- */

/* A synthesizer's times are stretched evenly over what was really said. */
static void stretch(spoken *s, double from_s, double to_s)
{
    fap_speech *p = s->speech;
    const double begin = p->phoneme[0].start_s, end = p->phoneme[p->count - 1].end_s;

    s->pace = (to_s - from_s) / (end - begin);
    for (uint32_t i = 0; i < p->count; i++) {
        p->phoneme[i].start_s = from_s + (p->phoneme[i].start_s - begin) * s->pace;
        p->phoneme[i].end_s = from_s + (p->phoneme[i].end_s - begin) * s->pace;
    }
    p->length_s = s->sound_s;
}

static fap_err lay_over_sound(spoken *s, const char *path, int *missing, char *where)
{
    sound heard;

    const fap_err err = sound_load(&heard, path, where);
    *missing = err == FAP_E_UNSUPPORTED;
    if (err != FAP_OK)
        return err;
    s->sound_s = (double)heard.frame_count / heard.rate_hz;
    const int found = heard_span(&heard, &s->heard_from_s, &s->heard_to_s);
    sound_free(&heard);
    if (!found) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "nobody is heard in it");
        return FAP_E_DATA;
    }
    stretch(s, s->heard_from_s, s->heard_to_s);
    return FAP_OK;
}

static fap_err measure_sound(spoken *s, const options *opt, const char **path, int *missing, char *where)
{
    if (!opt->speech.sound)
        return FAP_OK;
    *path = opt->speech.sound;
    if (opt->speech.text)
        return lay_over_sound(s, *path, missing, where);
    const fap_err err = sound_measure(*path, &s->sound_s, where);
    *missing = err == FAP_E_UNSUPPORTED;
    return err;
}

/* --- the mouth --- */

static fap_err speak(spoken *s, const fap_mouth *mouth)
{
    const double length_s = s->sound_s > 0 ? s->sound_s : s->speech->length_s + tail_s;

    if (!(length_s < longest_s))
        return FAP_E_LIMIT;
    s->frame_count = (size_t)ceil(length_s * s->rate_hz);
    s->frame = calloc(s->frame_count + 1, sizeof *s->frame);
    if (!s->frame)
        return FAP_E_NOMEM;
    for (size_t i = 0; i < s->frame_count; i++) {
        s->frame[i].number = (int64_t)i;
        s->frame[i].pts_us = llround((double)i * 1e6 / s->rate_hz);
        fap_mouth_at(mouth, (double)i / s->rate_hz, &s->frame[i]);
    }
    return FAP_OK;
}

static fap_err make_frames(spoken *s, const options *opt)
{
    fap_mouth_config cfg;
    fap_mouth *mouth;

    fap_mouth_config_init(&cfg);
    cfg.way = opt->speech.lips ? FAP_MOUTH_LIPS : FAP_MOUTH_VISEMES;
    fap_err err = fap_mouth_open(&mouth, s->speech, &cfg);
    if (err != FAP_OK)
        return err;
    s->mouth = *fap_mouth_report_get(mouth);
    err = speak(s, mouth);
    fap_mouth_close(&mouth);
    return err;
}

fap_err spoken_make(spoken *s, const options *opt, const char **path, int *missing, char *where)
{
    *s = (spoken){ .rate_hz = opt->capture.rate_hz, .pace = 1 };
    *where = '\0';
    *missing = 0;
    fap_err err =
        opt->speech.phonemes ? read_file(s, opt, path, where) : read_text(s, opt, path, missing, where);
    if (err == FAP_OK)
        err = measure_sound(s, opt, path, missing, where);
    return err == FAP_OK ? make_frames(s, opt) : err;
}

void spoken_close(spoken *s)
{
    fap_speech_close(&s->speech);
    free(s->frame);
    s->frame = NULL;
}
