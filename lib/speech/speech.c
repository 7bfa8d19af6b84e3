/* SPDX-License-Identifier: BSD-2-Clause */
/* Speech in memory, and what all its readers share. See fap/studio/speech.h. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "speech/phonemes.h"
#include "speech/source.h"

static const double most_s = 1e6;

static const speech_driver *const drivers[] = { &speech_driver_textgrid, &speech_driver_rhubarb,
                                                &speech_driver_tsv };

void fap_speech_read_config_init(fap_speech_read_config *cfg)
{
    *cfg = (fap_speech_read_config){ .struct_size = sizeof *cfg };
}

fap_err speech_fail(speech_source *src, fap_err err, const char *fmt, ...)
{
    va_list args;

    va_start(args, fmt);
    vsnprintf(src->where, sizeof src->where, fmt, args);
    va_end(args);
    return err;
}

void speech_note(fap_speech *speech, const char *fmt, ...)
{
    va_list args;

    if (speech->note_count == FAP_TAKE_MAX_NOTES)
        return;
    va_start(args, fmt);
    vsnprintf(speech->note[speech->note_count++], FAP_TAKE_NOTE_SIZE, fmt, args);
    va_end(args);
}

/* --- phonemes one after the other --- */

/* Room doubles where the count is a power of two. */
static fap_err make_room(fap_speech *s)
{
    const uint32_t n = s->count;

    if (n & (n - 1))
        return FAP_OK;
    if (n >= FAP_SPEECH_MAX_PHONEMES)
        return FAP_E_LIMIT;
    fap_phoneme *more = fap_mem_calloc(&s->alloc, n ? 2 * (size_t)n : 1, sizeof *more);
    if (!more)
        return FAP_E_NOMEM;
    if (n)
        memcpy(more, s->phoneme, n * sizeof *more);
    fap_mem_free(&s->alloc, s->phoneme);
    s->phoneme = more;
    return FAP_OK;
}

static void set_name(char *out, text name)
{
    const text t = text_trim(name);
    size_t n = t.length < FAP_PHONEME_NAME_SIZE ? t.length : FAP_PHONEME_NAME_SIZE - 1;

    while (n < t.length && n && ((unsigned char)t.start[n] & 0xc0) == 0x80)
        n--;
    for (size_t i = 0; i < n; i++)
        out[i] = (unsigned char)t.start[i] < ' ' || t.start[i] == 0x7f ? '?' : t.start[i];
    out[n] = '\0';
}

fap_err speech_add(fap_speech *s, double start_s, double end_s, text name)
{
    const fap_err err = make_room(s);

    if (err != FAP_OK)
        return err;
    fap_phoneme *p = &s->phoneme[s->count++];
    *p = (fap_phoneme){ .start_s = start_s, .end_s = end_s };
    set_name(p->name, name);
    return FAP_OK;
}

/* --- order --- */

static int is_sound(const fap_phoneme *p)
{
    return isfinite(p->start_s) && isfinite(p->end_s) && p->start_s >= 0 && p->end_s > p->start_s &&
           p->end_s <= most_s;
}

static void drop_unsound(fap_speech *s)
{
    uint32_t kept = 0;

    for (uint32_t i = 0; i < s->count; i++)
        if (is_sound(&s->phoneme[i]))
            s->phoneme[kept++] = s->phoneme[i];
    if (kept < s->count)
        speech_note(s, "%u phonemes left out: their times are no stretch of time",
                    (unsigned)(s->count - kept));
    s->count = kept;
}

static int by_start(const void *a, const void *b)
{
    const fap_phoneme *p = a, *q = b;

    if (p->start_s != q->start_s)
        return p->start_s < q->start_s ? -1 : 1;
    return (p->end_s > q->end_s) - (p->end_s < q->end_s);
}

static int is_ordered(const fap_speech *s)
{
    for (uint32_t i = 1; i < s->count; i++)
        if (by_start(&s->phoneme[i - 1], &s->phoneme[i]) > 0)
            return 0;
    return 1;
}

/* Where two overlap the later one wins; of two that begin together, the longer one. */
static void part(fap_speech *s)
{
    uint32_t cut = 0, kept = 0;

    for (uint32_t i = 0; i < s->count; i++) {
        fap_phoneme p = s->phoneme[i];
        if (i + 1 < s->count && p.end_s > s->phoneme[i + 1].start_s) {
            /* Aligners round: a thousandth is no news. */
            cut += p.end_s > s->phoneme[i + 1].start_s + 1e-3;
            p.end_s = s->phoneme[i + 1].start_s;
        }
        if (p.end_s > p.start_s)
            s->phoneme[kept++] = p;
    }
    s->count = kept;
    if (cut)
        speech_note(s, "%u phonemes reach into the next one and are cut there", (unsigned)cut);
}

static void put_in_order(fap_speech *s)
{
    drop_unsound(s);
    if (!is_ordered(s)) {
        speech_note(s, "phonemes were not in order of time");
        qsort(s->phoneme, s->count, sizeof *s->phoneme, by_start);
    }
    part(s);
    if (!(s->length_s > 0 && s->length_s <= most_s))
        s->length_s = 0;
    if (s->count)
        s->length_s = fmax(s->length_s, s->phoneme[s->count - 1].end_s);
}

/* --- files --- */

static const speech_driver *driver_of(const uint8_t *data, size_t size)
{
    for (size_t i = 0; i < sizeof drivers / sizeof *drivers; i++)
        if (drivers[i]->claims(data, size))
            return drivers[i];
    return NULL;
}

static fap_err fill(fap_speech *s, const speech_driver *driver, speech_source *src)
{
    const fap_err err = driver->read(src, s);

    if (err == FAP_E_LIMIT && !*src->where)
        return speech_fail(src, err, "more than %d phonemes", FAP_SPEECH_MAX_PHONEMES);
    if (err != FAP_OK)
        return err;
    put_in_order(s);
    if (!s->count)
        return speech_fail(src, FAP_E_NOT_FOUND, "no phoneme with a time in this %s", driver->name);
    if (src->cfg->alphabet)
        s->alphabet = src->cfg->alphabet;
    if (s->alphabet <= FAP_ALPHABET_AUTO || s->alphabet >= FAP_ALPHABET_COUNT)
        s->alphabet = phonemes_alphabet(s->phoneme, s->count);
    return FAP_OK;
}

static fap_err read_source(fap_speech **speech, speech_source *src)
{
    const speech_driver *driver = driver_of(src->data, src->size);

    if (!driver)
        return speech_fail(src, FAP_E_UNKNOWN_FORMAT,
                           "no TextGrid, no Rhubarb JSON and no lines of start, end and phoneme");
    fap_speech *s = fap_mem_calloc(&src->alloc, 1, sizeof *s);
    if (!s)
        return speech_fail(src, FAP_E_NOMEM, "%s", fap_strerror(FAP_E_NOMEM));
    s->alloc = src->alloc;
    s->format = driver->name;
    const fap_err err = fill(s, driver, src);
    if (err != FAP_OK)
        fap_speech_close(&s);
    *speech = s;
    return err;
}

fap_err fap_speech_read(fap_speech **speech, const void *data, size_t size, const fap_speech_read_config *cfg,
                        char *where)
{
    fap_speech_read_config own;

    *speech = NULL;
    fap_speech_read_config_init(&own);
    speech_source src = { .data = data, .size = size, .cfg = cfg ? cfg : &own };
    src.alloc = fap_mem_allocator(&src.cfg->alloc);
    const fap_err err = read_source(speech, &src);
    if (where)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s",
                 err == FAP_OK || *src.where ? src.where : fap_strerror(err));
    return err;
}

void fap_speech_close(fap_speech **speech)
{
    fap_speech *s = speech ? *speech : NULL;

    if (!s)
        return;
    const fap_allocator alloc = s->alloc;
    fap_mem_free(&alloc, s->phoneme);
    fap_mem_free(&alloc, s);
    *speech = NULL;
}
