/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The header line of a .fap file, or what people write in its place. See docs/fap-ascii.md.
 */
#include <string.h>

#include "codec/ascii_reader.h"

/* Words of a line, as far as the header and the mask test need them. */
typedef struct words {
    int count, all_digits; /* all_digits: each word is "0" or "1" */
    const char *first_end;
} words;

static words count_words(const char *line)
{
    words w = { 0, 1, NULL };

    for (const char *p = ascii_skip_blanks(line); *p != '\n'; p = ascii_skip_blanks(p), w.count++) {
        const char *end = ascii_skip_word(p);
        if (end - p != 1 || (*p != '0' && *p != '1'))
            w.all_digits = 0;
        if (!w.count)
            w.first_end = end;
        p = end;
    }
    return w;
}

/* No header has more than four words of 0 and 1: such a line is a mask, and is told what is wrong with it. */
static int is_mask(const words *w)
{
    return w->all_digits && w->count > 4;
}

static int is_lone_number(const fap_ascii_reader *r, const words *w)
{
    const char *start = ascii_skip_blanks(r->line);
    int64_t ignored;
    return w->count == 1 && fap_ascii_odd_number(start, w->first_end, &ignored) == ASCII_INTEGER;
}

/* The word that ends at or before @p end; both move to it. */
static const char *last_word(const char *line, const char **end)
{
    while (*end > line && ascii_is_blank((*end)[-1]))
        --*end;
    const char *start = *end;
    while (start > line && !ascii_is_blank(start[-1]))
        start--;
    return start;
}

static void copy_text(char *to, size_t size, const char *from, const char *end)
{
    const size_t n = (size_t)(end - from) < size - 1 ? (size_t)(end - from) : size - 1;

    memcpy(to, from, n);
    to[n] = 0;
}

static void take_version(fap_ascii_reader *r, const char *p, const char *end)
{
    double number;

    if (!fap_ascii_decimal(p, end, &number) || *p < '0' || *p > '9') {
        fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected a version number such as 2.1, or 68 mask digits");
        return;
    }
    copy_text(r->header.version, sizeof r->header.version, p, end);
    if (strcmp(r->header.version, "2.0") && strcmp(r->header.version, "2.1") &&
        strcmp(r->header.version, "2.2"))
        fap_ascii_note(r, ASCII_VERSION, p);
}

static void take_name(fap_ascii_reader *r, const char *p, const char *end)
{
    p = ascii_skip_blanks(p);
    if (p >= end) {
        fap_ascii_note(r, ASCII_NAME, end);
        return;
    }
    while (ascii_is_blank(end[-1]))
        end--;
    for (const char *c = p; c < end; c++)
        if (ascii_is_blank(*c))
            fap_ascii_note(r, ASCII_NAME, c);
    copy_text(r->header.name, sizeof r->header.name, p, end);
}

static void take_rate(fap_ascii_reader *r, const char *p, const char *end)
{
    double rate;

    if (!fap_ascii_decimal(p, end, &rate)) {
        fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected the frame rate, a number");
        return;
    }
    if (rate >= 0.001 && rate <= 100000)
        r->header.rate_hz = rate;
    else
        fap_ascii_note(r, ASCII_RATE, p);
}

static void take_count(fap_ascii_reader *r, const char *p, const char *end)
{
    int64_t count;
    double number;

    if (!fap_ascii_decimal(p, end, &number))
        fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected the number of frames at the end of the header");
    else if (fap_ascii_odd_number(p, end, &count) != ASCII_INTEGER || count < 0)
        fap_ascii_note(r, ASCII_NO_COUNT, p);
    else
        r->header.frame_count = count;
    r->header_line = r->lines.number;
    r->count_column = p - r->line + 1;
}

/* From the right, because names have blanks: version, name, rate, count. */
static fap_err parse_header(fap_ascii_reader *r, const words *w)
{
    const char *end = r->line + r->length, *version = ascii_skip_blanks(r->line);

    if (w->count < 3) {
        take_version(r, version, w->first_end);
        return fap_ascii_fail(r, FAP_E_SYNTAX, w->first_end,
                              "expected a header: version, name, frame rate, number of frames");
    }
    r->header.present = 1;
    take_version(r, version, w->first_end);
    const char *start = last_word(r->line, &end);
    take_count(r, start, end);
    end = start;
    start = last_word(r->line, &end);
    take_rate(r, start, end);
    take_name(r, w->first_end, start);
    fap_ascii_note_tabs(r);
    return r->err;
}

fap_err fap_ascii_read_header(fap_ascii_reader *r)
{
    fap_err err = fap_ascii_next_line(r);
    if (err == FAP_E_END)
        return fap_ascii_fail(r, FAP_E_SYNTAX, NULL, "expected a header, but the file ends");
    if (err != FAP_OK)
        return err;

    words w = count_words(r->line);
    if (is_lone_number(r, &w)) {
        fap_ascii_note(r, ASCII_LONE_NUMBER, r->line);
        r->in_ms = 1;
        err = fap_ascii_next_line(r);
        if (err != FAP_OK)
            return fap_ascii_fail(r, FAP_E_SYNTAX, NULL, "expected 68 mask digits behind the lone number");
        w = count_words(r->line);
    }
    if (!is_mask(&w) && !r->in_ms)
        return parse_header(r, &w);
    fap_ascii_note(r, ASCII_NO_HEADER, r->line);
    r->unread = 1;
    return r->err;
}
