/* SPDX-License-Identifier: BSD-2-Clause */
/* See sound_file.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/sound_file.h"

void sound_free(sound *s)
{
    free(s->sample);
    *s = (sound){ 0 };
}

#ifdef HAVE_SNDFILE

#include <sndfile.h>

enum { CHUNK = 4096, MOST_CHANNELS = 16 };
static const int64_t most_bytes = INT64_C(1) << 30;

static fap_err open_sound(SNDFILE **file, SF_INFO *info, const char *path, char *where)
{
    *info = (SF_INFO){ 0 };
    *file = sf_open(path, SFM_READ, info);
    if (!*file) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", sf_strerror(NULL));
        return FAP_E_DATA;
    }
    if (info->frames > 0 && info->samplerate > 0 && info->channels > 0)
        return FAP_OK;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "the sound is empty");
    sf_close(*file);
    return FAP_E_DATA;
}

fap_err sound_measure(const char *path, double *duration_s, char *where)
{
    SNDFILE *file;
    SF_INFO info;
    const fap_err err = open_sound(&file, &info, path, where);

    if (err)
        return err;
    sf_close(file);
    *duration_s = (double)info.frames / info.samplerate;
    return FAP_OK;
}

static fap_err make_room(sound *s, const SF_INFO *info, char *where)
{
    s->rate_hz = info->samplerate;
    s->channels = info->channels == 2 ? 2 : 1;
    if (info->channels > MOST_CHANNELS || info->frames > most_bytes / 2 / s->channels) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "more than 1 GiB of samples or %d channels", MOST_CHANNELS);
        return FAP_E_LIMIT;
    }
    s->sample = malloc((size_t)info->frames * (size_t)s->channels * sizeof *s->sample);
    return s->sample ? FAP_OK : FAP_E_NOMEM;
}

/* Samples of 16 bits come back as they were; what is no number is silence. */
static int16_t to_16_bits(float v)
{
    return v == v ? (int16_t)lrintf(fmaxf(-32768, fminf(32767, v * 32768))) : 0;
}

static float mean(const float *v, int count)
{
    float sum = 0;

    for (int i = 0; i < count; i++)
        sum += v[i];
    return sum / (float)count;
}

static void append(sound *s, const float *from, int64_t frames, int channels)
{
    int16_t *to = s->sample + s->frame_count * s->channels;

    for (int64_t i = 0; i < frames; i++, from += channels)
        if (channels > 2)
            *to++ = to_16_bits(mean(from, channels));
        else
            for (int c = 0; c < channels; c++)
                *to++ = to_16_bits(from[c]);
    s->frame_count += frames;
}

/* Read as floats: libsndfile gives those of every kind of file the same range. A cut file ends where it ends. */
static void read_samples(sound *s, SNDFILE *file, const SF_INFO *info)
{
    float chunk[CHUNK];
    const sf_count_t room = CHUNK / info->channels;
    sf_count_t got = 1;

    while (got > 0 && s->frame_count < info->frames) {
        const sf_count_t left = info->frames - s->frame_count;
        got = sf_readf_float(file, chunk, left < room ? left : room);
        if (got > 0)
            append(s, chunk, got, info->channels);
    }
}

fap_err sound_load(sound *out, const char *path, char *where)
{
    SNDFILE *file;
    SF_INFO info;

    *out = (sound){ 0 };
    fap_err err = open_sound(&file, &info, path, where);
    if (err)
        return err;
    err = make_room(out, &info, where);
    if (!err)
        read_samples(out, file, &info);
    sf_close(file);
    if (err)
        sound_free(out);
    return err;
}

#else

static fap_err no_sndfile(char *where)
{
    snprintf(where, FAP_ERROR_TEXT_SIZE,
             "this build is without libsndfile; install libsndfile1-dev and build again");
    return FAP_E_UNSUPPORTED;
}

fap_err sound_measure(const char *path, double *duration_s, char *where)
{
    (void)path;
    *duration_s = 0;
    return no_sndfile(where);
}

fap_err sound_load(sound *out, const char *path, char *where)
{
    (void)path;
    *out = (sound){ 0 };
    return no_sndfile(where);
}

#endif
