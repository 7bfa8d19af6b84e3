/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The mask line and the value line of a .fap frame: where reading a file spends its time. See
 * docs/fap-ascii.md.
 */
#include <string.h>

#include "codec/ascii_reader.h"
#include "param/frame.h"

/* --- mask line --- */

/* One digit and what separates it from the next; NULL where there is none. */
static const char *mask_digit(fap_ascii_reader *r, const char *p, int *digit)
{
    *digit = *p - '0';
    if ((unsigned)*digit > 1 || !(ascii_is_blank(p[1]) || p[1] == '\n')) {
        fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected a mask digit, 0 or 1, for FAP 1 to %d", FAP_COUNT);
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

    const char *start = p;
    p = mask_digit(r, p, &digit);
    if (!p)
        return;
    if (*p != '\n')
        fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected the end of the mask behind 69 digits");
    r->has_dummy = (uint8_t)digit;
    fap_ascii_note(r, ASCII_MASK_69, start);
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
    r->number_count = 1 + r->has_viseme * ASCII_VISEME_NUMBERS +
                      r->has_expression * ASCII_EXPRESSION_NUMBERS + r->fap_count + r->has_dummy;
}

static void keep_mask_line(fap_ascii_reader *r)
{
    if (r->length <= sizeof r->mask_line) {
        memcpy(r->mask_line, r->line, r->length);
        r->mask_length = r->length;
    }
}

/* A mask that is written like the one before means the same: one comparison in place of 68 digits. */
fap_err fap_ascii_read_mask(fap_ascii_reader *r)
{
    if (r->length && r->length == r->mask_length && !memcmp(r->line, r->mask_line, r->length))
        return FAP_OK;
    parse_mask(r);
    if (r->err == FAP_OK) {
        fap_ascii_note_tabs(r);
        keep_mask_line(r);
    }
    return r->err;
}

/* --- value line --- */

static void refuse_number(fap_ascii_reader *r, const char *p, const char *end)
{
    if (*p == '-' && p + 1 == end)
        p = end; /* a lone sign: what is missing stands behind it */
    fap_ascii_fail(r, FAP_E_SYNTAX, p,
                   r->parsed ? "expected a value, a whole number of at most 32 bits"
                             : "expected a frame number, of at most 15 digits");
}

static void take_absent(fap_ascii_reader *r, const char *p)
{
    fap_ascii_note(r, ASCII_NOT_FINITE, p);
    if (!r->odd)
        memset(r->absent, 0, sizeof r->absent);
    r->odd = r->absent[r->parsed] = 1;
}

/* Frame numbers may have more bits than values. */
static int fits(const fap_ascii_reader *r, int64_t number)
{
    return !r->parsed || (number >= INT32_MIN && number <= INT32_MAX);
}

/* The number is none of the plain ones: decimals, inf, a sign, a word that does not belong here. */
static const char *parse_odd(fap_ascii_reader *r, const char *p)
{
    const char *end = ascii_skip_word(p);
    int64_t number;
    const ascii_kind kind = fap_ascii_odd_number(p, end, &number);

    if (kind == ASCII_BAD || !fits(r, number) || (kind == ASCII_ABSENT && !r->parsed)) {
        refuse_number(r, p, end);
        return NULL;
    }
    if (kind == ASCII_ROUNDED)
        fap_ascii_note(r, ASCII_DECIMALS, p);
    if (kind == ASCII_ABSENT)
        take_absent(r, p);
    if (r->parsed)
        r->number[r->parsed] = (int32_t)number;
    else
        r->frame_number = number;
    return end;
}

static const char *parse_frame_number(fap_ascii_reader *r, const char *p)
{
    int32_t number;
    const char *end = ascii_plain_number(p, &number);

    if (!end)
        return parse_odd(r, p);
    r->frame_number = number;
    return end;
}

static const char *next_word(const char *end)
{
    return *end == ' ' && end[1] > ' ' ? end + 1 : ascii_skip_blanks(end);
}

/* All numbers of the line. This is where reading a file spends its time. */
static void parse_numbers(fap_ascii_reader *r)
{
    r->parsed = r->odd = 0;
    const char *end = parse_frame_number(r, ascii_skip_blanks(r->line));

    for (r->parsed = 1; end; r->parsed++) {
        const char *p = next_word(end);
        if (*p == '\n')
            return;
        if (r->parsed == r->number_count) {
            fap_ascii_fail(r, FAP_E_SYNTAX, p, "expected the end of the line behind %d numbers",
                           r->number_count);
            return;
        }
        end = ascii_plain_number(p, &r->number[r->parsed]);
        if (!end)
            end = parse_odd(r, p);
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

/* A cut last line may look like one with single numbers: it is one only where such were met before. */
static int singles_are_likely(const fap_ascii_reader *r)
{
    const uint32_t met = 1u << ASCII_ONE_VISEME | 1u << ASCII_ONE_EXPRESSION | 1u << ASCII_PACKED_VISEME;

    return !r->lines.unended || !r->frames || r->noticed & met;
}

/* Producers that treat FAPs 1 and 2 like any other write one number for them: the line is short by 3, 5 or 8.
 */
static int find_layout(const fap_ascii_reader *r, layout *out)
{
    static const layout known[] = { { ASCII_VISEME_NUMBERS, ASCII_EXPRESSION_NUMBERS },
                                    { 1, ASCII_EXPRESSION_NUMBERS },
                                    { ASCII_VISEME_NUMBERS, 1 },
                                    { 1, 1 } };

    const size_t count = singles_are_likely(r) ? sizeof known / sizeof *known : 1;

    for (size_t i = 0; i < count; i++) {
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

/* Where a number of the line stands, counted from 0. */
static const char *find_number(const fap_ascii_reader *r, int index)
{
    const char *p = ascii_skip_blanks(r->line);

    while (index--)
        p = ascii_skip_blanks(ascii_skip_word(p));
    return p;
}

/* An unknown viseme or expression cannot be shown. */
static int is_select(fap_ascii_reader *r, int at, int32_t max)
{
    if (r->number[at] >= 0 && r->number[at] <= max)
        return 1;
    fap_ascii_note(r, ASCII_SELECT_RANGE, find_number(r, at));
    return 0;
}

/* MetaFace fades an expression out to intensity -1: worth a notice, not the expression. */
static uint8_t strength(fap_ascii_reader *r, int at, int32_t max)
{
    const int32_t v = r->number[at];

    if (v >= 0 && v <= max)
        return (uint8_t)v;
    fap_ascii_note(r, ASCII_AMPLITUDE, find_number(r, at));
    return (uint8_t)(v < 0 ? 0 : max);
}

/* Some Xface users: viseme1 * 10000 + viseme2 * 100 + blend + 101010. */
static int unpack_viseme(int32_t packed, fap_viseme *v)
{
    const int32_t rest = packed > 101010 ? packed - 101010 : 0;

    if (packed < 101010 || rest / 10000 > FAP_VISEME_COUNT || rest / 100 % 100 > FAP_VISEME_COUNT ||
        rest % 100 > FRAME_STRENGTH_MAX)
        return 0;
    *v = (fap_viseme){ (uint8_t)(rest / 10000), (uint8_t)(rest / 100 % 100), (uint8_t)(rest % 100), 0 };
    return 1;
}

static int take_one_viseme(fap_ascii_reader *r, int at)
{
    const int packed = all_present(r, at, 1) && unpack_viseme(r->number[at], &r->frame.viseme);

    fap_ascii_note(r, packed ? ASCII_PACKED_VISEME : ASCII_ONE_VISEME, find_number(r, at));
    return packed;
}

static int take_four(fap_ascii_reader *r, int at)
{
    if (!all_present(r, at, ASCII_VISEME_NUMBERS) || !is_select(r, at, FAP_VISEME_COUNT) ||
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
    if (!all_present(r, at, ASCII_EXPRESSION_NUMBERS) || !is_select(r, at, FAP_EXPRESSION_COUNT) ||
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
        fap_ascii_note(r, ASCII_ONE_EXPRESSION, find_number(r, at));
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
        fap_ascii_fail(r, FAP_E_SYNTAX, r->line + r->length, "expected %d numbers, found %d", r->number_count,
                       r->parsed);
        return;
    }
    if (l.viseme)
        take_viseme(r, 1, l.viseme);
    if (l.expression)
        take_expression(r, 1 + l.viseme, l.expression);
    take_values(r, 1 + l.viseme + l.expression);
}

fap_err fap_ascii_read_values(fap_ascii_reader *r)
{
    parse_numbers(r);
    if (r->err == FAP_OK)
        fap_ascii_note_tabs(r);
    if (r->err == FAP_OK)
        take_line(r);
    return r->err;
}
