/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The ASCII .fap reader: a header line, then per frame one line of mask digits and one of values. Reads what
 * real producers write, says once for each kind of deviation that it did, and keeps one line and one frame in
 * memory. Sources: docs/fap-ascii.md; ISO/IEC 14496-2 annexes on FAP files.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/tables.h>

#include "base/mem.h"
#include "codec/ascii_lines.h"
#include "codec/ascii_number.h"
#include "param/frame.h"

enum {
    VISEME_NUMBERS = 4,
    EXPRESSION_NUMBERS = 6,
    MAX_NUMBERS =
        1 + VISEME_NUMBERS + EXPRESSION_NUMBERS + FAP_COUNT - 2 + 1, /* frame number, FAPs, a 69th column */
    MASK_LINE_KEPT = 160, /* a mask line up to this length is recognised when it comes again */
    MS_STEP = 10,         /* without a header, steps this large are milliseconds, not frames */
};

static const double default_rate_hz = 25;
static const int64_t latest_pts_us = INT64_MAX / 4; /* room for one more step of any size */

/* Every deviation that is tolerated, in the words of the notice. */
#define DEVIATIONS(X)                                                                                        \
    X(BYTE_ORDER_MARK, "a byte order mark stands before the text")                                           \
    X(LONE_CR, "lines end in CR alone")                                                                      \
    X(TABS, "tabs between the numbers")                                                                      \
    X(EMPTY_LINE, "an empty line was skipped")                                                               \
    X(NO_HEADER, "there is no header line: 25 frames a second are assumed")                                  \
    X(LONE_NUMBER, "a lone number before the first mask was skipped: a time in milliseconds")                \
    X(VERSION, "the version is none of 2.0, 2.1 and 2.2: read like 2.1")                                     \
    X(NAME, "the sequence name is not one word")                                                             \
    X(RATE, "the frame rate makes no sense: 25 frames a second are assumed")                                 \
    X(COUNT, "the header states another number of frames than the file has")                                 \
    X(MASK_69, "the mask has 69 digits: the last one was ignored")                                           \
    X(NUMBERS, "frame numbers do not count up from 0 by 1")                                                  \
    X(MILLISECONDS, "frame numbers are times in milliseconds")                                               \
    X(ONE_VISEME, "FAP 1 has one value in place of four: viseme taken as absent")                            \
    X(ONE_EXPRESSION, "FAP 2 has one value in place of six: expression taken as absent")                     \
    X(PACKED_VISEME, "FAP 1 has one value with viseme and blend packed into it")                             \
    X(SELECT_RANGE, "viseme or expression number out of its range: taken as absent")                         \
    X(AMPLITUDE, "viseme or expression strength out of its range: brought to the nearest end")               \
    X(DECIMALS, "values with decimals were rounded")                                                         \
    X(NOT_FINITE, "values that are inf or nan: taken as absent")

typedef enum deviation {
#define X(name, text) DEV_##name,
    DEVIATIONS(X)
#undef X
} deviation;

struct fap_ascii_reader {
    fap_allocator alloc;
    fap_ascii_reader_config cfg;
    fap_ascii_header header;
    uint32_t noticed; /* a bit for every deviation already told */
    fap_err err;      /* what next() keeps returning once something went wrong */
    char text[FAP_ERROR_TEXT_SIZE];

    char *line; /* the line being parsed, ended by '\n' */
    size_t length;
    int unread; /* the line was looked at, and is still to be used */

    char mask_line[MASK_LINE_KEPT]; /* the mask as it was written: most frames repeat it */
    size_t mask_length;
    uint8_t has_viseme, has_expression, has_dummy;
    int fap_count, number_count;
    uint8_t fap[FAP_COUNT]; /* FAPs 3..68 whose digit is 1 */

    int32_t number[MAX_NUMBERS]; /* the value line */
    int parsed;
    int odd; /* some number of the line is absent */
    uint8_t absent[MAX_NUMBERS];

    int64_t frames, base_number, base_pts_us;
    double period_us;
    int in_ms;
    fap_frame frame;
    ascii_lines lines;
};

static fap_err fail(fap_ascii_reader *r, fap_err err, const char *at, const char *expected, ...)
    __attribute__((format(printf, 4, 5)));

/* Notes line, column and what was expected; @p at NULL: the line as a whole. The first error stays. */
static fap_err fail(fap_ascii_reader *r, fap_err err, const char *at, const char *expected, ...)
{
    va_list args;
    int used;

    if (r->err != FAP_OK)
        return r->err;
    r->err = err;
    if (at)
        used = snprintf(r->text, sizeof r->text, "line %lld, column %lld: ", (long long)r->lines.number,
                        (long long)(at - r->line) + 1);
    else
        used = snprintf(r->text, sizeof r->text, "line %lld: ", (long long)r->lines.number);
    va_start(args, expected);
    vsnprintf(r->text + used, sizeof r->text - (size_t)used, expected, args);
    va_end(args);
    return err;
}

/* A deviation: told once, or fatal when strict. */
static void note(fap_ascii_reader *r, deviation which)
{
    static const char *const texts[] = {
#define X(name, text) [DEV_##name] = text,
        DEVIATIONS(X)
#undef X
    };

    if (r->noticed & 1u << which)
        return;
    r->noticed |= 1u << which;
    if (r->cfg.strict)
        fail(r, FAP_E_SYNTAX, NULL, "%s", texts[which]);
    else if (r->cfg.notice)
        r->cfg.notice(r->cfg.notice_user, r->lines.number, texts[which]);
}

static fap_err line_error(fap_ascii_reader *r, fap_err err)
{
    if (err == FAP_E_LIMIT)
        return fail(r, FAP_E_SYNTAX, NULL, "expected a line of at most %d bytes", ASCII_LINE_MAX);
    if (err == FAP_E_IO)
        return fail(r, FAP_E_IO, NULL, "reading failed behind this line");
    return r->err = err;
}

/* The next line that is neither comment nor empty. FAP_E_END is not yet final: the caller knows what is
 * missing. */
static fap_err next_line(fap_ascii_reader *r)
{
    if (r->unread)
        return r->unread = 0, FAP_OK;
    for (;;) {
        const fap_err err = ascii_lines_next(&r->lines, &r->line, &r->length);
        if (err == FAP_E_END)
            return err;
        if (err != FAP_OK)
            return line_error(r, err);
        if (r->lines.byte_order_mark)
            note(r, DEV_BYTE_ORDER_MARK);
        if (r->lines.lone_cr)
            note(r, DEV_LONE_CR);
        const char first = *ascii_skip_blanks(r->line);
        if (first == '\n')
            note(r, DEV_EMPTY_LINE);
        else if (first != '#')
            return r->err;
    }
}

/* --- header
 * -------------------------------------------------------------------------------------------------------- */

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

/* No header has more than four words of 0 and 1: such a line is a mask, and if it is a wrong one, it is told
 * so. */
static int is_mask(const words *w)
{
    return w->all_digits && w->count > 4;
}

static int is_lone_number(const fap_ascii_reader *r, const words *w)
{
    const char *start = ascii_skip_blanks(r->line);
    int32_t ignored;
    return w->count == 1 && ascii_odd_number(start, w->first_end, &ignored) == ASCII_INTEGER;
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

    if (!ascii_decimal(p, end, &number) || *p < '0' || *p > '9') {
        fail(r, FAP_E_SYNTAX, p, "expected a version number such as 2.1, or 68 mask digits");
        return;
    }
    copy_text(r->header.version, sizeof r->header.version, p, end);
    if (strcmp(r->header.version, "2.0") && strcmp(r->header.version, "2.1") &&
        strcmp(r->header.version, "2.2"))
        note(r, DEV_VERSION);
}

static void take_name(fap_ascii_reader *r, const char *p, const char *end)
{
    p = ascii_skip_blanks(p);
    if (p >= end) {
        note(r, DEV_NAME);
        return;
    }
    while (ascii_is_blank(end[-1]))
        end--;
    for (const char *c = p; c < end; c++)
        if (ascii_is_blank(*c))
            note(r, DEV_NAME);
    copy_text(r->header.name, sizeof r->header.name, p, end);
}

static void take_rate(fap_ascii_reader *r, const char *p, const char *end)
{
    double rate;

    if (!ascii_decimal(p, end, &rate)) {
        fail(r, FAP_E_SYNTAX, p, "expected the frame rate, a number");
        return;
    }
    if (rate >= 0.001 && rate <= 100000)
        r->header.rate_hz = rate;
    else
        note(r, DEV_RATE);
}

static void take_count(fap_ascii_reader *r, const char *p, const char *end)
{
    int32_t count;

    if (ascii_odd_number(p, end, &count) != ASCII_INTEGER || count < 0)
        fail(r, FAP_E_SYNTAX, p, "expected the number of frames at the end of the header");
    else
        r->header.frame_count = count;
}

/* From the right, because names have blanks: version, name, rate, count. */
static fap_err parse_header(fap_ascii_reader *r, const words *w)
{
    const char *end = r->line + r->length, *version = ascii_skip_blanks(r->line);

    if (w->count < 3) {
        take_version(r, version, w->first_end);
        return fail(r, FAP_E_SYNTAX, w->first_end,
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
    return r->err;
}

/* What stands in front of the first mask: a header, nothing, or a lone time. */
static fap_err read_header(fap_ascii_reader *r)
{
    fap_err err = next_line(r);
    if (err == FAP_E_END)
        return fail(r, FAP_E_SYNTAX, NULL, "expected a header, but the file ends");
    if (err != FAP_OK)
        return err;

    words w = count_words(r->line);
    if (is_lone_number(r, &w)) {
        note(r, DEV_LONE_NUMBER);
        r->in_ms = 1;
        err = next_line(r);
        if (err != FAP_OK)
            return fail(r, FAP_E_SYNTAX, NULL, "expected 68 mask digits behind the lone number");
        w = count_words(r->line);
    }
    if (!is_mask(&w) && !r->in_ms)
        return parse_header(r, &w);
    note(r, DEV_NO_HEADER);
    r->unread = 1;
    return r->err;
}

/* --- mask line
 * ------------------------------------------------------------------------------------------------------- */

/* One digit and what separates it from the next; NULL where there is none. */
static const char *mask_digit(fap_ascii_reader *r, const char *p, int *digit)
{
    *digit = *p - '0';
    if ((unsigned)*digit > 1 || !(ascii_is_blank(p[1]) || p[1] == '\n')) {
        fail(r, FAP_E_SYNTAX, p, "expected a mask digit, 0 or 1, for FAP 1 to %d", FAP_COUNT);
        return NULL;
    }
    p++;
    if (*p == ' ' && p[1] > ' ')
        return p + 1;
    return ascii_skip_blanks(p);
}

static void take_mask_digit(fap_ascii_reader *r, int fap, int digit)
{
    if (r->frame.state[fap] == FAP_CODED)
        r->frame.state[fap] = FAP_HELD;
    if (fap == 1)
        r->has_viseme = (uint8_t)digit;
    else if (fap == 2)
        r->has_expression = (uint8_t)digit;
    else if (digit)
        r->fap[r->fap_count++] = (uint8_t)fap;
}

/* Producers that start their array at FAP 0 write a digit too many, at the end. */
static void take_extra_digit(fap_ascii_reader *r, const char *p)
{
    int digit;

    p = mask_digit(r, p, &digit);
    if (!p)
        return;
    if (*p != '\n')
        fail(r, FAP_E_SYNTAX, p, "expected the end of the mask behind 69 digits");
    r->has_dummy = (uint8_t)digit;
    note(r, DEV_MASK_69);
}

static void parse_mask(fap_ascii_reader *r)
{
    const char *p = ascii_skip_blanks(r->line);
    int digit;

    r->mask_length = 0;
    r->fap_count = r->has_dummy = 0;
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        p = mask_digit(r, p, &digit);
        if (!p)
            return;
        take_mask_digit(r, fap, digit);
    }
    if (*p != '\n')
        take_extra_digit(r, p);
    r->number_count = 1 + r->has_viseme * VISEME_NUMBERS + r->has_expression * EXPRESSION_NUMBERS +
                      r->fap_count + r->has_dummy;
}

static void keep_mask_line(fap_ascii_reader *r)
{
    if (r->length <= sizeof r->mask_line) {
        memcpy(r->mask_line, r->line, r->length);
        r->mask_length = r->length;
    }
}

/* A mask that is written like the one before means the same: one comparison in place of 68 digits. */
static fap_err read_mask(fap_ascii_reader *r)
{
    if (r->length && r->length == r->mask_length && !memcmp(r->line, r->mask_line, r->length))
        return FAP_OK;
    parse_mask(r);
    if (r->err == FAP_OK)
        keep_mask_line(r);
    return r->err;
}

/* --- value line
 * ------------------------------------------------------------------------------------------------------ */

/* The number is none of the plain ones: decimals, inf, a sign, a word that does not belong here. */
static const char *parse_odd(fap_ascii_reader *r, const char *p)
{
    const char *end = ascii_skip_word(p);
    const ascii_kind kind = ascii_odd_number(p, end, &r->number[r->parsed]);

    if (kind == ASCII_BAD || (kind == ASCII_ABSENT && r->parsed == 0)) {
        fail(r, FAP_E_SYNTAX, p,
             r->parsed ? "expected a value, a whole number of at most 32 bits" : "expected a frame number");
        return NULL;
    }
    if (kind == ASCII_ROUNDED)
        note(r, DEV_DECIMALS);
    if (kind != ASCII_ABSENT)
        return end;
    note(r, DEV_NOT_FINITE);
    if (!r->odd)
        memset(r->absent, 0, sizeof r->absent);
    r->odd = r->absent[r->parsed] = 1;
    return end;
}

/* All numbers of the line. This is where reading a file spends its time. */
static void parse_numbers(fap_ascii_reader *r)
{
    const char *p = ascii_skip_blanks(r->line);

    r->parsed = r->odd = 0;
    while (*p != '\n') {
        if (r->parsed == r->number_count) {
            fail(r, FAP_E_SYNTAX, p, "expected the end of the line behind %d numbers", r->number_count);
            return;
        }
        const char *end = ascii_plain_number(p, &r->number[r->parsed]);
        if (!end && !(end = parse_odd(r, p)))
            return;
        r->parsed++;
        if (*end == ' ' && end[1] > ' ')
            p = end + 1;
        else
            p = ascii_skip_blanks(end);
    }
}

/* FAPs 1 and 2 of the line: how many numbers each really has. */
typedef struct layout {
    int viseme, expression;
} layout;

static int plain_count(const fap_ascii_reader *r)
{
    return 1 + r->fap_count + r->has_dummy;
}

/* Producers that treat FAPs 1 and 2 like any other write one number for them: the line is short by 3, 5 or 8.
 */
static int find_layout(fap_ascii_reader *r, layout *out)
{
    static const layout known[] = {
        { VISEME_NUMBERS, EXPRESSION_NUMBERS }, { 1, EXPRESSION_NUMBERS }, { VISEME_NUMBERS, 1 }, { 1, 1 }
    };

    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        out->viseme = r->has_viseme ? known[i].viseme : 0;
        out->expression = r->has_expression ? known[i].expression : 0;
        if (r->parsed == plain_count(r) + out->viseme + out->expression)
            return 1;
    }
    return 0;
}

static int all_present(const fap_ascii_reader *r, int at, int count)
{
    for (int i = 0; r->odd && i < count; i++)
        if (r->absent[at + i])
            return 0;
    return 1;
}

/* An unknown viseme or expression cannot be shown. */
static int is_select(fap_ascii_reader *r, int at, int32_t max)
{
    if (r->number[at] >= 0 && r->number[at] <= max)
        return 1;
    note(r, DEV_SELECT_RANGE);
    return 0;
}

/* MetaFace fades an expression out to intensity -1: worth a notice, not the expression. */
static uint8_t strength(fap_ascii_reader *r, int at, int32_t max)
{
    const int32_t v = r->number[at];

    if (v >= 0 && v <= max)
        return (uint8_t)v;
    note(r, DEV_AMPLITUDE);
    return (uint8_t)(v < 0 ? 0 : max);
}

/* Some Xface users: viseme1 * 10000 + viseme2 * 100 + blend + 101010. */
static int unpack_viseme(int32_t packed, fap_viseme *v)
{
    const int32_t rest = packed - 101010;

    if (rest < 0 || rest / 10000 > FAP_VISEME_COUNT || rest / 100 % 100 > FAP_VISEME_COUNT ||
        rest % 100 > FRAME_STRENGTH_MAX)
        return 0;
    *v = (fap_viseme){ (uint8_t)(rest / 10000), (uint8_t)(rest / 100 % 100), (uint8_t)(rest % 100), 0 };
    return 1;
}

static int take_one_viseme(fap_ascii_reader *r, int at)
{
    const int packed = all_present(r, at, 1) && unpack_viseme(r->number[at], &r->frame.viseme);

    note(r, packed ? DEV_PACKED_VISEME : DEV_ONE_VISEME);
    return packed;
}

static int take_four(fap_ascii_reader *r, int at)
{
    if (!all_present(r, at, VISEME_NUMBERS) || !is_select(r, at, FAP_VISEME_COUNT) ||
        !is_select(r, at + 1, FAP_VISEME_COUNT))
        return 0;
    r->frame.viseme = (fap_viseme){ .select1 = (uint8_t)r->number[at],
                                    .select2 = (uint8_t)r->number[at + 1],
                                    .blend = strength(r, at + 2, FRAME_STRENGTH_MAX),
                                    .def = strength(r, at + 3, 1) };
    return 1;
}

static int take_six(fap_ascii_reader *r, int at)
{
    if (!all_present(r, at, EXPRESSION_NUMBERS) || !is_select(r, at, FAP_EXPRESSION_COUNT) ||
        !is_select(r, at + 2, FAP_EXPRESSION_COUNT))
        return 0;
    r->frame.expression = (fap_expression){ .select1 = (uint8_t)r->number[at],
                                            .intensity1 = strength(r, at + 1, FRAME_STRENGTH_MAX),
                                            .select2 = (uint8_t)r->number[at + 2],
                                            .intensity2 = strength(r, at + 3, FRAME_STRENGTH_MAX),
                                            .init_face = strength(r, at + 4, 1),
                                            .def = strength(r, at + 5, 1) };
    return 1;
}

static void take_viseme(fap_ascii_reader *r, int at, int count)
{
    const int present = count == 1 ? take_one_viseme(r, at) : take_four(r, at);

    r->frame.state[1] = present ? FAP_CODED : FAP_ABSENT;
    if (!present)
        r->frame.viseme = (fap_viseme){ 0 };
}

static void take_expression(fap_ascii_reader *r, int at, int count)
{
    if (count == 1)
        note(r, DEV_ONE_EXPRESSION);
    const int present = count != 1 && take_six(r, at);

    r->frame.state[2] = present ? FAP_CODED : FAP_ABSENT;
    if (!present)
        r->frame.expression = (fap_expression){ 0 };
}

static void take_values(fap_ascii_reader *r, int at)
{
    for (int i = 0; i < r->fap_count; i++) {
        const int fap = r->fap[i];
        r->frame.state[fap] = FAP_CODED;
        r->frame.value[fap] = r->number[at + i];
    }
    for (int i = 0; r->odd && i < r->fap_count; i++)
        if (r->absent[at + i]) {
            r->frame.state[r->fap[i]] = FAP_ABSENT;
            r->frame.value[r->fap[i]] = 0;
        }
}

static void take_line(fap_ascii_reader *r)
{
    layout l;

    if (!find_layout(r, &l)) {
        fail(r, FAP_E_SYNTAX, r->line + r->length, "expected %d numbers, found %d", r->number_count,
             r->parsed);
        return;
    }
    if (l.viseme)
        take_viseme(r, 1, l.viseme);
    if (l.expression)
        take_expression(r, 1 + l.viseme, l.expression);
    take_values(r, 1 + l.viseme + l.expression);
}

/* --- frames
 * ----------------------------------------------------------------------------------------------------------
 */

/* Only the second frame of a file without header tells frame numbers from times. */
static void recognise_ms(fap_ascii_reader *r, int64_t number)
{
    if (!r->header.present && r->frames == 1 && number - r->base_number >= MS_STEP)
        r->in_ms = 1;
    if (!r->in_ms)
        return;
    note(r, DEV_MILLISECONDS);
}

static int64_t span_us(const fap_ascii_reader *r, int64_t numbers)
{
    return r->in_ms ? numbers * 1000 : (int64_t)((double)numbers * r->period_us + 0.5);
}

/* Numbers that repeat or go back start a new count one frame later: media time never does. */
static void restart_count(fap_ascii_reader *r, int64_t number)
{
    const int64_t next = r->frame.pts_us + (int64_t)(r->period_us + 0.5);

    r->base_number = number;
    r->base_pts_us = next < latest_pts_us ? next : latest_pts_us;
}

static void take_number(fap_ascii_reader *r)
{
    const int64_t number = r->number[0];

    recognise_ms(r, number);
    if (!r->in_ms && number != (r->frames ? r->frame.number + 1 : 0))
        note(r, DEV_NUMBERS);
    if (!r->frames)
        r->base_number = number;
    else if (number <= r->frame.number)
        restart_count(r, number);
    r->frame.number = number;
    r->frame.pts_us = r->base_pts_us + span_us(r, number - r->base_number);
    r->frames++;
}

/* The whole frame is parsed before any of it is believed. */
static fap_err read_values(fap_ascii_reader *r)
{
    const fap_err err = next_line(r);
    if (err == FAP_E_END)
        return fail(r, FAP_E_SYNTAX, NULL, "expected a line of values behind the mask, but the file ends");
    if (err != FAP_OK)
        return err;
    parse_numbers(r);
    if (r->err != FAP_OK)
        return r->err;
    if (memchr(r->line, '\t', r->length))
        note(r, DEV_TABS);
    take_line(r);
    if (r->err == FAP_OK)
        take_number(r);
    return r->err;
}

static fap_err finish(fap_ascii_reader *r)
{
    if (r->header.frame_count >= 0 && r->header.frame_count != r->frames)
        note(r, DEV_COUNT);
    if (r->err == FAP_OK)
        r->err = FAP_E_END;
    return r->err;
}

fap_err fap_ascii_reader_next(fap_ascii_reader *r, fap_frame *out)
{
    if (!r || !out)
        return FAP_E_ARG;
    if (r->err != FAP_OK)
        return r->err;

    fap_err err = next_line(r);
    if (err == FAP_E_END)
        return finish(r);
    if (err == FAP_OK)
        err = read_mask(r);
    if (err == FAP_OK)
        err = read_values(r);
    if (err == FAP_OK)
        *out = r->frame;
    return err;
}

/* --- life
 * ------------------------------------------------------------------------------------------------------------
 */

void fap_ascii_reader_config_init(fap_ascii_reader_config *cfg)
{
    *cfg = (fap_ascii_reader_config){ .struct_size = sizeof *cfg };
}

/* A caller built against a newer header knows members that this library does not, and the other way round. */
static fap_err take_config(fap_ascii_reader_config *to, const fap_ascii_reader_config *cfg)
{
    fap_ascii_reader_config_init(to);
    if (!cfg)
        return FAP_OK;
    if (cfg->struct_size < offsetof(fap_ascii_reader_config, alloc))
        return FAP_E_ARG;
    memcpy(to, cfg, cfg->struct_size < sizeof *to ? cfg->struct_size : sizeof *to);
    return FAP_OK;
}

static void init_reader(fap_ascii_reader *r, const fap_reader *in)
{
    r->header = (fap_ascii_header){ .version = "2.1", .rate_hz = default_rate_hz, .frame_count = -1 };
    ascii_lines_init(&r->lines, in);
}

fap_err fap_ascii_reader_open(fap_ascii_reader **reader, const fap_reader *in,
                              const fap_ascii_reader_config *cfg, char *where)
{
    fap_ascii_reader_config config;

    if (where)
        *where = 0;
    if (!reader)
        return FAP_E_ARG;
    *reader = NULL;
    if (!in || !in->read || take_config(&config, cfg) != FAP_OK)
        return FAP_E_ARG;

    const fap_allocator alloc = fap_mem_allocator(&config.alloc);
    fap_ascii_reader *r = fap_mem_calloc(&alloc, 1, sizeof *r);
    if (!r)
        return FAP_E_NOMEM;
    r->alloc = alloc;
    r->cfg = config;
    init_reader(r, in);

    fap_err err = read_header(r);
    if (err != FAP_OK) {
        if (where)
            memcpy(where, r->text, sizeof r->text);
        fap_ascii_reader_close(&r);
        return err;
    }
    r->period_us = 1e6 / r->header.rate_hz;
    *reader = r;
    return FAP_OK;
}

const fap_ascii_header *fap_ascii_reader_header(const fap_ascii_reader *r)
{
    return &r->header;
}

const char *fap_ascii_reader_last_error(const fap_ascii_reader *r)
{
    return r ? r->text : "";
}

void fap_ascii_reader_close(fap_ascii_reader **reader)
{
    if (!reader || !*reader)
        return;
    fap_ascii_reader *r = *reader;
    const fap_allocator alloc = r->alloc;
    fap_mem_free(&alloc, r);
    *reader = NULL;
}
