/* SPDX-License-Identifier: BSD-2-Clause */
/* See text.h. */
#include <math.h>
#include <string.h>

#include "take/text.h"

text_lines text_open(const uint8_t *data, size_t size)
{
    static const uint8_t mark[3] = { 0xef, 0xbb, 0xbf };
    const size_t skip = size >= sizeof mark && !memcmp(data, mark, sizeof mark) ? sizeof mark : 0;

    return (text_lines){ (const char *)data + skip, (const char *)data + size, 0 };
}

int text_next(text_lines *lines, text *line)
{
    if (lines->at == lines->end)
        return 0;
    const size_t left = (size_t)(lines->end - lines->at);
    const char *end = memchr(lines->at, '\n', left);
    *line = (text){ lines->at, end ? (size_t)(end - lines->at) : left };
    lines->at = end ? end + 1 : lines->end;
    if (line->length && line->start[line->length - 1] == '\r')
        line->length--;
    lines->number++;
    return 1;
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\0';
}

text text_trim(text t)
{
    while (t.length && is_blank(t.start[0]))
        t.start++, t.length--;
    while (t.length && is_blank(t.start[t.length - 1]))
        t.length--;
    return t;
}

/* A quoted cell may hold separators; doubled quotes inside it do not occur in takes and stay doubled. */
static text take_cell(const char **at, const char *end, char separator)
{
    const char *start = *at, *p = start;
    int quoted = 0;

    for (; p < end && (quoted || *p != separator); p++)
        quoted ^= *p == '"';
    *at = p;
    text t = text_trim((text){ start, (size_t)(p - start) });
    if (t.length >= 2 && t.start[0] == '"' && t.start[t.length - 1] == '"')
        t = text_trim((text){ t.start + 1, t.length - 2 });
    return t;
}

void text_split(text line, char separator, text_row *row)
{
    const char *at = line.start, *end = at + line.length;

    row->count = 0;
    while (row->count < TEXT_MAX_CELLS) {
        row->cell[row->count++] = take_cell(&at, end, separator);
        if (at == end)
            return;
        at++;
    }
}

text text_cell(const text_row *row, size_t n)
{
    return n < row->count ? row->cell[n] : (text){ "", 0 };
}

int text_row_is_blank(const text_row *row)
{
    for (size_t i = 0; i < row->count; i++)
        if (row->cell[i].length)
            return 0;
    return 1;
}

static size_t count_of(text line, char c)
{
    size_t n = 0;

    for (size_t i = 0; i < line.length; i++)
        n += line.start[i] == c;
    return n;
}

char text_separator(text line)
{
    const size_t semicolons = count_of(line, ';'), tabs = count_of(line, '\t'), commas = count_of(line, ',');

    if (semicolons && semicolons >= tabs)
        return ';';
    return tabs > commas ? '\t' : ',';
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

int text_starts(text t, const char *word)
{
    const size_t length = strlen(word);

    if (t.length < length)
        return 0;
    for (size_t i = 0; i < length; i++)
        if (lower(t.start[i]) != lower(word[i]))
            return 0;
    return 1;
}

int text_is(text t, const char *word)
{
    return t.length == strlen(word) && text_starts(t, word);
}

static int is_missing(text t)
{
    static const char *const words[] = { "", "-", "nan", "-nan", "na", "n/a", "null" };

    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (text_is(t, words[i]))
            return 1;
    return 0;
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Digits with at most one mark. Digits that a double cannot hold only count for the size. */
static size_t read_mantissa(text t, double *mantissa, int *exponent)
{
    size_t i = 0, digits = 0;
    int marks = 0;

    for (*mantissa = 0; i < t.length; i++) {
        const char c = t.start[i];
        if ((c == '.' || c == ',') && !marks) {
            marks = 1;
        } else if (is_digit(c)) {
            const int fits = *mantissa < 1e17;
            if (fits)
                *mantissa = *mantissa * 10 + (c - '0');
            *exponent += !fits - marks;
            digits++;
        } else {
            break;
        }
    }
    return digits ? i : 0;
}

static size_t read_exponent(text t, int *exponent)
{
    size_t i = 1;
    int e = 0, negative = 0;

    if (t.length < 2 || lower(t.start[0]) != 'e')
        return 0;
    if (t.start[i] == '-' || t.start[i] == '+')
        negative = t.start[i++] == '-';
    if (i == t.length)
        return 0;
    for (; i < t.length && is_digit(t.start[i]); i++)
        e = e < 10000 ? e * 10 + (t.start[i] - '0') : e;
    *exponent += negative ? -e : e;
    return i;
}

text_value text_number(text t, double *value)
{
    double mantissa;
    int exponent = 0;

    if (is_missing(t))
        return TEXT_MISSING;
    const int negative = t.start[0] == '-', has_sign = negative || t.start[0] == '+';
    t = (text){ t.start + has_sign, t.length - (size_t)has_sign };
    const size_t used = read_mantissa(t, &mantissa, &exponent);
    if (!used)
        return TEXT_OTHER;
    t = (text){ t.start + used, t.length - used };
    if (t.length && read_exponent(t, &exponent) != t.length)
        return TEXT_OTHER;
    /* Dividing keeps short decimals exact where multiplying by a rounded 0.1 would not. */
    const double size = exponent < 0 ? mantissa / pow(10, -exponent) : mantissa * pow(10, exponent);
    *value = negative ? -size : size;
    return TEXT_NUMBER;
}
