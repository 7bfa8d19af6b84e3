/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Praat's TextGrid. Praat itself reads both its text forms as one: numbers, strings and <flags> that stand by themselves
 * count, all other words are for people; so does this. UTF-8, and UTF-16 as Praat writes it when a letter asks for it.
 * Source: Praat's manual, "TextGrid file formats".
 */
#include <string.h>

#include "base/mem.h"
#include "speech/phonemes.h"
#include "speech/source.h"

typedef enum token_kind { TOKEN_END, TOKEN_NUMBER, TOKEN_STRING, TOKEN_FLAG } token_kind;

typedef struct token {
    token_kind kind;
    text text; /* of a string: doubled quotes still double */
    double number;
} token;

typedef struct scanner {
    const char *at, *end;
} scanner;

/* --- letters --- */

static int mark_of(const uint8_t *data, size_t size)
{
    if (size < 2)
        return 0;
    return data[0] == 0xfe && data[1] == 0xff ? 'B' : data[0] == 0xff && data[1] == 0xfe ? 'L' : 0;
}

static uint32_t unit_at(const uint8_t *data, size_t i, int mark)
{
    return mark == 'B' ? (uint32_t)data[i] << 8 | data[i + 1] : (uint32_t)data[i + 1] << 8 | data[i];
}

/* Letters beyond U+FFFF are in no phonetic alphabet: each half of theirs becomes a mark that is none either. */
static size_t put_utf8(char *out, uint32_t c)
{
    if (c >= 0xd800 && c < 0xe000)
        c = 0xfffd;
    if (c < 0x80) {
        out[0] = (char)c;
        return 1;
    }
    if (c < 0x800) {
        out[0] = (char)(0xc0 | c >> 6);
        out[1] = (char)(0x80 | (c & 0x3f));
        return 2;
    }
    out[0] = (char)(0xe0 | c >> 12);
    out[1] = (char)(0x80 | (c >> 6 & 0x3f));
    out[2] = (char)(0x80 | (c & 0x3f));
    return 3;
}

/* Memory to free where the file is UTF-16, else NULL with @p *err FAP_OK. */
static char *to_utf8(const speech_source *src, size_t *size, fap_err *err)
{
    const int mark = mark_of(src->data, src->size);

    *err = FAP_OK;
    if (!mark)
        return NULL;
    char *out = fap_mem_calloc(&src->alloc, src->size / 2, 3);
    if (!out)
        *err = FAP_E_NOMEM;
    *size = 0;
    for (size_t i = 2; out && i + 1 < src->size; i += 2)
        *size += put_utf8(out + *size, unit_at(src->data, i, mark));
    return out;
}

/* --- words --- */

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0';
}

static void skip_to(scanner *s, int (*stop)(char c))
{
    while (s->at < s->end && !stop(*s->at))
        s->at++;
}

static int is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

static int is_word(char c)
{
    return !is_blank(c);
}

/* Up to the quote that is not doubled. A string that is cut off is none. */
static int take_string(scanner *s, text *out)
{
    const char *start = ++s->at;

    for (; s->at < s->end; s->at++) {
        if (*s->at != '"')
            continue;
        if (s->at + 1 < s->end && s->at[1] == '"') {
            s->at++;
            continue;
        }
        *out = (text){ start, (size_t)(s->at++ - start) };
        return 1;
    }
    return 0;
}

static token next(scanner *s)
{
    token t = { TOKEN_END, { "", 0 }, 0 };

    for (;;) {
        skip_to(s, is_word);
        if (s->at == s->end)
            return t;
        if (*s->at == '"') {
            t.kind = take_string(s, &t.text) ? TOKEN_STRING : TOKEN_END;
            return t;
        }
        if (*s->at == '!') {
            skip_to(s, is_line_end);
            continue;
        }
        const char *start = s->at;
        skip_to(s, is_blank);
        t.text = (text){ start, (size_t)(s->at - start) };
        t.kind = *start == '<' ? TOKEN_FLAG : TOKEN_NUMBER;
        if (t.kind == TOKEN_FLAG || text_number(t.text, &t.number) == TEXT_NUMBER)
            return t;
    }
}

static int next_number(scanner *s, double *value)
{
    const token t = next(s);

    *value = t.number;
    return t.kind == TOKEN_NUMBER;
}

static int next_string(scanner *s, text *value)
{
    const token t = next(s);

    *value = t.text;
    return t.kind == TOKEN_STRING;
}

/* --- tiers --- */

typedef struct tier {
    text name;
    int has_intervals;
    double count;
} tier;

static int read_tier_head(scanner *s, tier *t)
{
    text kind;
    double from, to;

    if (!next_string(s, &kind) || !next_string(s, &t->name) || !next_number(s, &from) || !next_number(s, &to))
        return 0;
    t->has_intervals = text_is(kind, "IntervalTier");
    return next_number(s, &t->count);
}

/* 0: the file breaks off. */
static int skip_point(scanner *s)
{
    double at;
    text mark;

    return next_number(s, &at) && next_string(s, &mark);
}

static int read_interval(scanner *s, fap_speech *speech, fap_err *err)
{
    double from, to;
    text name;

    if (!next_number(s, &from) || !next_number(s, &to) || !next_string(s, &name))
        return 0;
    *err = speech_add(speech, from, to, name);
    return 1;
}

/* 0: the file breaks off in it. */
static int read_tier(scanner *s, const tier *t, fap_speech *speech, fap_err *err)
{
    for (double i = 0; i < t->count && *err == FAP_OK; i++)
        if (!(t->has_intervals ? read_interval(s, speech, err) : skip_point(s)))
            return 0;
    return 1;
}

static int ends_like(text name, const char *word)
{
    const size_t n = strlen(word);

    return name.length >= n && text_is((text){ name.start + name.length - n, n }, word);
}

static int is_called_phonemes(text name)
{
    static const char *const names[] = { "phones", "phone",    "phonemes", "phoneme",  "phonetic",
                                         "MAU",    "segments", "segment",  "phonemic", "mouth" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (ends_like(text_trim(name), names[i]))
            return 1;
    return 0;
}

static int is_wanted(const speech_source *src, text name)
{
    return src->cfg->tier && strlen(src->cfg->tier) == name.length &&
           !memcmp(name.start, src->cfg->tier, name.length);
}

/* How much a tier looks like phonemes: its name counts most, then what it says. 0: it does not. */
static double likeness(const speech_source *src, text name, const fap_speech *s)
{
    if (src->cfg->tier)
        return is_wanted(src, name);
    if (!s->count)
        return 0;
    const uint32_t known = phonemes_known(phonemes_alphabet(s->phoneme, s->count), s->phoneme, s->count);
    uint32_t silent = 0;
    for (uint32_t i = 0; i < s->count; i++)
        silent += !s->phoneme[i].name[0];
    return is_called_phonemes(name) + (double)(known - silent) / s->count;
}

static void keep(fap_speech *best, fap_speech *other, text name)
{
    fap_phoneme *const worse = best->phoneme;
    const size_t n = name.length < sizeof best->tier ? name.length : sizeof best->tier - 1;

    best->phoneme = other->phoneme;
    best->count = other->count;
    other->phoneme = worse;
    memcpy(best->tier, name.start, n);
    best->tier[n] = '\0';
}

static fap_err read_tiers(speech_source *src, scanner *s, double tiers, fap_speech *best)
{
    double most = 0;
    fap_err err = FAP_OK;

    for (double i = 0; i < tiers && err == FAP_OK; i++) {
        fap_speech one = { .alloc = best->alloc };
        tier t = { .count = 0 };
        const int begun = read_tier_head(s, &t);
        const int whole = begun && read_tier(s, &t, &one, &err);
        const double like = begun ? likeness(src, t.name, &one) : 0;
        if (err == FAP_OK && like > most) {
            most = like;
            keep(best, &one, t.name);
        }
        fap_mem_free(&one.alloc, one.phoneme);
        if (!whole && err == FAP_OK) {
            speech_note(best, "the TextGrid breaks off in tier %.0f of %.0f", i + 1, tiers);
            break;
        }
    }
    return err;
}

/* --- the file --- */

static int reads(const uint8_t *data, size_t size, const char *word)
{
    const size_t reach = size < 256 ? size : 256, step = mark_of(data, size) ? 2 : 1, n = strlen(word);

    for (size_t i = 0; i + n * step <= reach; i++) {
        size_t k = 0;
        while (k < n && data[i + k * step] == (uint8_t)word[k])
            k++;
        if (k == n)
            return 1;
    }
    return 0;
}

static int textgrid_claims(const uint8_t *data, size_t size)
{
    return (reads(data, size, "ooTextFile") || reads(data, size, "ooBinaryFile") ||
            reads(data, size, "chronological TextGrid")) &&
           reads(data, size, "TextGrid");
}

static fap_err read_text(speech_source *src, fap_speech *s, const char *data, size_t size)
{
    scanner in = { data, data + size };
    double from, tiers;
    text kind, what;

    if (!next_string(&in, &kind) || !next_string(&in, &what) || !text_is(what, "TextGrid") ||
        !next_number(&in, &from) || !next_number(&in, &s->length_s))
        return speech_fail(src, FAP_E_SYNTAX, "the TextGrid has no beginning");
    if (!text_is(next(&in).text, "<exists>") || !next_number(&in, &tiers))
        return speech_fail(src, FAP_E_NOT_FOUND, "the TextGrid has no tiers");
    const fap_err err = read_tiers(src, &in, tiers, s);
    if (err == FAP_OK && !s->count)
        return speech_fail(src, FAP_E_NOT_FOUND,
                           src->cfg->tier ? "the TextGrid has no tier of intervals called %.80s"
                                          : "no tier of the TextGrid looks like phonemes; name one%.0s",
                           src->cfg->tier ? src->cfg->tier : "");
    return err;
}

static fap_err textgrid_read(speech_source *src, fap_speech *s)
{
    size_t size;
    fap_err err;

    if (!reads(src->data, src->size, "ooTextFile"))
        return speech_fail(src, FAP_E_UNSUPPORTED,
                           "a binary or chronological TextGrid; save it as a text file in Praat");
    char *utf8 = to_utf8(src, &size, &err);
    if (err != FAP_OK)
        return err;
    err = utf8 ? read_text(src, s, utf8, size) : read_text(src, s, (const char *)src->data, src->size);
    fap_mem_free(&src->alloc, utf8);
    return err;
}

const speech_driver speech_driver_textgrid = { "textgrid", textgrid_claims, textgrid_read };
