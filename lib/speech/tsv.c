/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Lines of start, end and phoneme, tabs or blanks between them: what fap-phonemes writes, and Audacity's labels. Lines of
 * start and phoneme too, where each ends with the next: Rhubarb's plain output. "# alphabet: espeak" and "# length: 2.5"
 * say so; other lines behind # are remarks.
 */
#include <string.h>

#include "speech/source.h"

enum { MOST_CELLS = 3, LOOK_AT_LINES = 50 };

typedef struct cells {
    text cell[MOST_CELLS]; /* the last one is the rest of the line */
    int count;
} cells;

static int is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static text cut_word(text *rest)
{
    size_t n = 0;

    *rest = text_trim(*rest);
    while (n < rest->length && !is_blank(rest->start[n]))
        n++;
    const text word = { rest->start, n };
    *rest = text_trim((text){ rest->start + n, rest->length - n });
    return word;
}

static int is_number(text t, double *value)
{
    return text_number(t, value) == TEXT_NUMBER;
}

/* A phoneme may be called 3, so two columns are known by the first line's second one. */
static cells split(text line, int columns)
{
    cells c = { .count = 0 };

    while (line.length && c.count < columns - 1)
        c.cell[c.count++] = cut_word(&line);
    if (c.count == columns - 1)
        c.cell[c.count++] = text_trim(line);
    return c;
}

/* 3 or 2: what the lines have; 0: something else. */
static int columns_of(text line)
{
    double v;
    const cells c = split(line, 3);

    if (c.count < 2 || !is_number(c.cell[0], &v))
        return 0;
    return c.count == 3 && is_number(c.cell[1], &v) ? 3 : 2;
}

/* Of the first line that is no remark and no heading. */
static int find_columns(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;

    for (int i = 0; i < LOOK_AT_LINES && text_next(&lines, &line); i++) {
        line = text_trim(line);
        const int columns = line.length && line.start[0] != '#' ? columns_of(line) : 0;
        if (columns)
            return columns;
    }
    return 0;
}

static int tsv_claims(const uint8_t *data, size_t size)
{
    return !memchr(data ? data : (const uint8_t *)"", 0, data ? (size < 4096 ? size : 4096) : 0) &&
           find_columns(data, size);
}

/* --- remarks --- */

static void read_remark(fap_speech *s, text line)
{
    text rest = { line.start + 1, line.length - 1 };
    const text key = cut_word(&rest);
    double length;

    if (text_is(key, "length:") && is_number(rest, &length))
        s->length_s = length;
    for (int a = FAP_ALPHABET_AUTO + 1; text_is(key, "alphabet:") && a < FAP_ALPHABET_COUNT; a++)
        if (text_is(rest, fap_alphabet_name(a)))
            s->alphabet = (fap_alphabet)a;
}

/* --- lines --- */

static void end_last(fap_speech *s, double at_s)
{
    if (s->count)
        s->phoneme[s->count - 1].end_s = at_s;
}

/* 1: taken; 0: not such a line. */
static int read_line(fap_speech *s, text line, int columns, fap_err *err)
{
    const cells c = split(line, columns);
    double start, end;

    if (c.count < 1 || !is_number(c.cell[0], &start))
        return 0;
    if (columns == 2) {
        end_last(s, start);
        *err = speech_add(s, start, start, c.count > 1 ? c.cell[1] : (text){ "", 0 });
        return 1;
    }
    if (c.count < 2 || !is_number(c.cell[1], &end))
        return 0;
    *err = speech_add(s, start, end, c.count > 2 ? c.cell[2] : (text){ "", 0 });
    return 1;
}

static fap_err read_lines(speech_source *src, fap_speech *s, int columns)
{
    text_lines lines = text_open(src->data, src->size);
    unsigned strange = 0, first_strange = 0;
    fap_err err = FAP_OK;
    text line;

    while (err == FAP_OK && text_next(&lines, &line)) {
        line = text_trim(line);
        if (line.length && line.start[0] == '#')
            read_remark(s, line);
        else if (line.length && !read_line(s, line, columns, &err) && s->count && !strange++)
            first_strange = lines.number;
    }
    if (strange)
        speech_note(s, "%u lines passed over, line %u is the first: not start, end and phoneme", strange,
                    first_strange);
    return err;
}

/* 1: every name is a mouth shape of Rhubarb. */
static int are_mouth_shapes(const fap_speech *s)
{
    for (uint32_t i = 0; i < s->count; i++)
        if (s->phoneme[i].name[0] && (!strchr("ABCDEFGHX", s->phoneme[i].name[0]) || s->phoneme[i].name[1]))
            return 0;
    return 1;
}

static fap_err tsv_read(speech_source *src, fap_speech *s)
{
    const int columns = find_columns(src->data, src->size);
    const fap_err err = read_lines(src, s, columns);

    if (err != FAP_OK || columns == 3)
        return err;
    if (s->count) /* nobody says when the last one ends */
        end_last(s, s->length_s > s->phoneme[s->count - 1].start_s ? s->length_s
                                                                   : s->phoneme[s->count - 1].start_s + 0.1);
    if (!s->alphabet && are_mouth_shapes(s))
        s->alphabet = FAP_ALPHABET_RHUBARB;
    return FAP_OK;
}

const speech_driver speech_driver_tsv = { "tsv", tsv_claims, tsv_read };
