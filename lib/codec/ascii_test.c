/* SPDX-License-Identifier: BSD-2-Clause */
/* The .fap reader and writer: the regular format, each dialect, damage, round trips, and the real files. */
#include "tests/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/tables.h>

/* --- memory as source and sink, and texts made of masks --- */

typedef struct memory {
    char *data;
    size_t size, at, step; /* step: bytes a read gives at most, 0: all */
} memory;

static size_t memory_read(void *user, void *buf, size_t size)
{
    memory *m = user;
    size_t n = m->size - m->at < size ? m->size - m->at : size;

    if (m->step && n > m->step)
        n = m->step;
    memcpy(buf, m->data + m->at, n);
    m->at += n;
    return n;
}

static int memory_write(void *user, const void *data, size_t size)
{
    memory *m = user;

    m->data = realloc(m->data, m->size + size);
    memcpy(m->data + m->size, data, size);
    m->size += size;
    return 0;
}

static size_t broken_read(void *user, void *buf, size_t size)
{
    (void)user, (void)buf, (void)size;
    return (size_t)-1;
}

static int broken_write(void *user, const void *data, size_t size)
{
    (void)user, (void)data, (void)size;
    return 1;
}

/* "0 0 1 ..." with the FAPs of @p list (ending in 0) set; @p digits 68 or 69. In a static buffer. */
static const char *mask(const int *list, int digits)
{
    static char text[256];

    for (int fap = 1; fap <= digits; fap++) {
        int on = 0;
        for (const int *p = list; *p; p++)
            on |= *p == fap;
        text[2 * fap - 2] = on ? '1' : '0';
        text[2 * fap - 1] = ' ';
    }
    text[2 * digits - 1] = 0;
    return text;
}

#define MASK(...) mask((const int[]){ __VA_ARGS__, 0 }, 68)

typedef struct told {
    int count;
    int64_t line[32];
    const char *text[32];
} told;

static void listen(void *user, int64_t line, const char *text)
{
    told *t = user;
    assert_true(t->count < 32);
    t->line[t->count] = line;
    t->text[t->count++] = text;
}

static int was_told(const told *t, const char *part)
{
    for (int i = 0; i < t->count; i++)
        if (strstr(t->text[i], part))
            return 1;
    return 0;
}

typedef struct opened {
    memory m;
    told told;
    fap_ascii_reader *reader;
    char where[FAP_ERROR_TEXT_SIZE];
} opened;

static fap_err open_bytes(opened *o, const char *data, size_t size, size_t step, int strict)
{
    fap_ascii_reader_config cfg;

    memset(o, 0, sizeof *o);
    o->m = (memory){ (char *)(uintptr_t)data, size, 0, step };
    fap_ascii_reader_config_init(&cfg);
    cfg.strict = strict;
    cfg.notice = listen;
    cfg.notice_user = &o->told;
    return fap_ascii_reader_open(&o->reader, &(fap_reader){ memory_read, &o->m }, &cfg, o->where);
}

static fap_err open_text(opened *o, const char *text)
{
    return open_bytes(o, text, strlen(text), 0, 0);
}

static void open_ok(opened *o, const char *text)
{
    if (open_text(o, text) != FAP_OK)
        fail_msg("%s", o->where);
}

static fap_frame next_ok(opened *o)
{
    fap_frame f = { 0 };
    if (fap_ascii_reader_next(o->reader, &f) != FAP_OK)
        fail_msg("%s", fap_ascii_reader_last_error(o->reader));
    return f;
}

/* Reads to the end or an error; how many frames came. */
static int drain(opened *o, fap_err *last)
{
    fap_frame f;
    int count = 0;

    while ((*last = fap_ascii_reader_next(o->reader, &f)) == FAP_OK)
        count++;
    fap_ascii_reader_close(&o->reader);
    return count;
}

/* A file of one frame. */
static const char *one_frame(const char *mask_line, const char *values)
{
    static char text[1024];
    snprintf(text, sizeof text, "2.1 t 25 1\n%s\n%s\n", mask_line, values);
    return text;
}

static fap_frame read_one(const char *mask_line, const char *values, told *t)
{
    opened o;
    open_ok(&o, one_frame(mask_line, values));
    const fap_frame f = next_ok(&o);
    fap_ascii_reader_close(&o.reader);
    if (t)
        *t = o.told;
    return f;
}

static fap_err error_of_one(const char *mask_line, const char *values, const char *expected)
{
    opened o;
    fap_frame f;

    open_ok(&o, one_frame(mask_line, values));
    const fap_err err = fap_ascii_reader_next(o.reader, &f);
    if (!strstr(fap_ascii_reader_last_error(o.reader), expected))
        fail_msg("\"%s\" is not in \"%s\"", expected, fap_ascii_reader_last_error(o.reader));
    assert_int_equal(fap_ascii_reader_next(o.reader, &f), err);
    fap_ascii_reader_close(&o.reader);
    assert_null(o.reader);
    return err;
}

/* --- the regular format --- */

TEST(ascii, reads_header_and_values)
{
    opened o;
    char text[1024];

    snprintf(text, sizeof text, "# made by hand\n2.1 take 30 2\n%s\n0 5 -7\n# between\n%s\n1 6 -8\n",
             MASK(3, 68), MASK(3, 68));
    open_ok(&o, text);
    const fap_ascii_header *h = fap_ascii_reader_header(o.reader);
    assert_string_equal(h->version, "2.1");
    assert_string_equal(h->name, "take");
    assert_true(h->rate_hz == 30);
    assert_int_equal(h->frame_count, 2);
    assert_int_equal(h->present, 1);

    fap_frame f = next_ok(&o);
    assert_int_equal(f.number, 0);
    assert_int_equal(f.pts_us, 0);
    assert_int_equal(f.state[3], FAP_CODED);
    assert_int_equal(f.state[4], FAP_ABSENT);
    assert_int_equal(f.value[3], 5);
    assert_int_equal(f.value[68], -7);
    f = next_ok(&o);
    assert_int_equal(f.number, 1);
    assert_int_equal(f.pts_us, 33333);
    assert_int_equal(f.value[68], -8);

    assert_int_equal(fap_ascii_reader_next(o.reader, &f), FAP_E_END);
    assert_int_equal(fap_ascii_reader_next(o.reader, &f), FAP_E_END);
    assert_int_equal(o.told.count, 0);
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, viseme_has_four_numbers_and_expression_six)
{
    const fap_frame f = read_one(MASK(1, 2, 3), "0 14 3 63 1 6 10 5 20 1 0 -9", NULL);

    assert_int_equal(f.state[1], FAP_CODED);
    assert_memory_equal(&f.viseme, (&(fap_viseme){ 14, 3, 63, 1 }), sizeof f.viseme);
    assert_int_equal(f.state[2], FAP_CODED);
    assert_memory_equal(&f.expression, (&(fap_expression){ 6, 10, 5, 20, 1, 0 }), sizeof f.expression);
    assert_int_equal(f.value[3], -9);
}

TEST(ascii, a_masked_fap_is_held_once_it_was_sent)
{
    opened o;
    char text[1024];
    int at = snprintf(text, sizeof text, "2.1 t 25 3\n%s\n0 11\n", MASK(5));

    at += snprintf(text + at, sizeof text - (size_t)at, "%s\n1 22\n", MASK(6));
    snprintf(text + at, sizeof text - (size_t)at, "%s\n2 12\n", MASK(5));
    open_ok(&o, text);
    next_ok(&o);
    fap_frame f = next_ok(&o);
    assert_int_equal(f.state[5], FAP_HELD);
    assert_int_equal(f.value[5], 11);
    assert_int_equal(f.state[6], FAP_CODED);
    assert_int_equal(f.state[7], FAP_ABSENT);
    f = next_ok(&o);
    assert_int_equal(f.state[5], FAP_CODED);
    assert_int_equal(f.value[5], 12);
    assert_int_equal(f.state[6], FAP_HELD);
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, values_reach_the_ends_of_32_bits)
{
    const fap_frame f = read_one(MASK(3, 4), "0 2147483647 -2147483648", NULL);

    assert_int_equal(f.value[3], INT32_MAX);
    assert_int_equal(f.value[4], INT32_MIN);
    assert_int_equal(error_of_one(MASK(3), "0 2147483648", "line 3, column 3: expected a value"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "0 -2147483649", "column 3"), FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "0 99999999999999999999", "column 3"), FAP_E_SYNTAX);
}

/* --- dialects --- */

TEST(ascii, line_ends_tabs_and_blanks_do_not_matter)
{
    static const char *const ends[] = { "\n", "\r\n", "\r" };

    for (int e = 0; e < 3; e++)
        for (size_t step = 1; step < 4; step++) {
            opened o;
            char text[1024];
            snprintf(text, sizeof text, "2.1  t\t25 2 %s %s %s0\t1 %s%s%s1 2", ends[e], MASK(3), ends[e],
                     ends[e], MASK(3), ends[e]);
            assert_int_equal(open_bytes(&o, text, strlen(text), step, 0), FAP_OK);
            assert_int_equal(next_ok(&o).value[3], 1);
            assert_int_equal(next_ok(&o).value[3], 2);
            assert_int_equal(was_told(&o.told, "tabs"), 1);
            assert_int_equal(was_told(&o.told, "CR alone"), e == 2);
            assert_int_equal(o.told.count, 1 + (e == 2));
            fap_ascii_reader_close(&o.reader);
        }
}

TEST(ascii, a_byte_order_mark_is_skipped)
{
    opened o;
    char text[512];

    snprintf(text, sizeof text,
             "\xEF\xBB\xBF"
             "2.1 t 25 1\n%s\n0 4\n",
             MASK(3));
    open_ok(&o, text);
    assert_int_equal(next_ok(&o).value[3], 4);
    assert_true(was_told(&o.told, "byte order mark"));
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, names_may_have_blanks_or_be_missing)
{
    opened o;

    open_ok(&o, "2.1 AU Interpolation_2.fap 25 0\n");
    assert_string_equal(fap_ascii_reader_header(o.reader)->name, "AU Interpolation_2.fap");
    assert_true(was_told(&o.told, "name"));
    fap_ascii_reader_close(&o.reader);
    open_ok(&o, "2.1 25 0\n");
    assert_string_equal(fap_ascii_reader_header(o.reader)->name, "");
    fap_ascii_reader_close(&o.reader);
    open_ok(&o, "2.0 C:\\a\\b 12.5 0");
    assert_string_equal(fap_ascii_reader_header(o.reader)->name, "C:\\a\\b");
    assert_true(fap_ascii_reader_header(o.reader)->rate_hz == 12.5);
    assert_int_equal(o.told.count, 0);
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, a_mask_of_69_digits_loses_its_last)
{
    told t;
    fap_frame f = read_one(mask((const int[]){ 19, 68, 0 }, 69), "0 313 5", &t);

    assert_int_equal(f.value[19], 313);
    assert_int_equal(f.value[68], 5);
    assert_int_equal(t.count, 1);
    assert_int_equal(t.line[0], 2);
    f = read_one(mask((const int[]){ 68, 69, 0 }, 69), "0 5 99", &t);
    assert_int_equal(f.value[68], 5);
    assert_int_equal(error_of_one(mask((const int[]){ 3, 0 }, 70), "0 1", "line 2, column 139"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one(mask((const int[]){ 3, 0 }, 67), "0 1", "mask digit"), FAP_E_SYNTAX);
}

TEST(ascii, one_value_for_viseme_or_expression_means_absent)
{
    told t;
    fap_frame f = read_one(MASK(1, 3), "0 7 5", &t);

    assert_int_equal(f.state[1], FAP_ABSENT);
    assert_int_equal(f.value[3], 5);
    assert_true(was_told(&t, "FAP 1"));
    f = read_one(MASK(1, 2, 3), "0 1 2 3 0 9 5", &t);
    assert_int_equal(f.state[1], FAP_CODED);
    assert_int_equal(f.state[2], FAP_ABSENT);
    assert_int_equal(f.value[3], 5);
    f = read_one(MASK(1, 2, 3), "0 9 1 2 3 4 0 1 5", &t);
    assert_int_equal(f.state[1], FAP_ABSENT);
    assert_int_equal(f.expression.intensity2, 4);
    assert_int_equal(f.value[3], 5);
    f = read_one(MASK(1, 2, 3), "0 9 9 5", &t);
    assert_int_equal(f.state[1], FAP_ABSENT);
    assert_int_equal(f.state[2], FAP_ABSENT);
    assert_int_equal(f.value[3], 5);
}

TEST(ascii, a_packed_viseme_is_unpacked)
{
    told t;
    fap_frame f =
        read_one(MASK(1), "0 215173", &t); /* 101010 + 11 * 10000 + 41 * 100 + 63 has no viseme 41 */

    assert_int_equal(f.state[1], FAP_ABSENT);
    f = read_one(MASK(1), "0 212473", &t); /* 101010 + 11 * 10000 + 14 * 100 + 63 */
    assert_int_equal(f.state[1], FAP_CODED);
    assert_memory_equal(&f.viseme, (&(fap_viseme){ 11, 14, 63, 0 }), sizeof f.viseme);
    assert_true(was_told(&t, "packed"));
}

TEST(ascii, decimals_are_rounded_and_what_is_not_finite_is_absent)
{
    told t;
    const fap_frame f =
        read_one(MASK(3, 4, 5, 6, 7, 8, 9, 10, 11), "0 1.5 -1.5 2.49 +7 1.2e2 inf -inf NaN -.4", &t);

    assert_int_equal(f.value[3], 2);
    assert_int_equal(f.value[4], -2);
    assert_int_equal(f.value[5], 2);
    assert_int_equal(f.value[6], 7);
    assert_int_equal(f.value[7], 120);
    for (int fap = 8; fap <= 10; fap++) {
        assert_int_equal(f.state[fap], FAP_ABSENT);
        assert_int_equal(f.value[fap], 0);
    }
    assert_int_equal(f.state[11], FAP_CODED);
    assert_int_equal(f.value[11], 0);
    assert_int_equal(t.count, 2);
}

TEST(ascii, visemes_and_expressions_out_of_range_are_absent)
{
    told t;
    assert_int_equal(read_one(MASK(1), "0 15 0 0 0", &t).state[1], FAP_ABSENT);
    assert_true(was_told(&t, "taken as absent"));
    assert_int_equal(read_one(MASK(2), "0 7 0 0 0 0 0", NULL).state[2], FAP_ABSENT);
    assert_int_equal(read_one(MASK(2), "0 6 63 6 63 1 1", NULL).state[2], FAP_CODED);
}

TEST(ascii, strengths_out_of_range_are_clamped)
{
    told t;
    assert_int_equal(read_one(MASK(1), "0 1 2 64 0", &t).viseme.blend, 63);
    assert_true(was_told(&t, "nearest end"));
    const fap_frame f = read_one(MASK(2), "0 6 -1 6 1000 1 1", NULL);
    assert_memory_equal(&f.expression, (&(fap_expression){ 6, 0, 6, 63, 1, 1 }), sizeof f.expression);
}

TEST(ascii, without_a_header_the_lines_decide)
{
    opened o;
    char text[1024];
    fap_err last;

    snprintf(text, sizeof text, "960\r\n%s\r\n1720 1\r\n%s\r\n1760 2\r\n", MASK(3), MASK(3));
    open_ok(&o, text);
    assert_int_equal(fap_ascii_reader_header(o.reader)->present, 0);
    assert_int_equal(fap_ascii_reader_header(o.reader)->frame_count, -1);
    assert_int_equal(next_ok(&o).pts_us, 0);
    fap_frame f = next_ok(&o);
    assert_int_equal(f.number, 1760);
    assert_int_equal(f.pts_us, 40000);
    assert_int_equal(drain(&o, &last), 0);
    assert_int_equal(last, FAP_E_END);
    assert_true(was_told(&o.told, "milliseconds"));

    snprintf(text, sizeof text, "%s\n0 1\n%s\n1 2\n", MASK(3), MASK(3));
    open_ok(&o, text);
    assert_int_equal(next_ok(&o).pts_us, 0);
    assert_int_equal(next_ok(&o).pts_us, 40000); /* frames at the default of 25 a second */
    fap_ascii_reader_close(&o.reader);

    snprintf(text, sizeof text, "%s\n120 1\n%s\n160 2\n", MASK(3), MASK(3));
    open_ok(&o, text);
    next_ok(&o);
    assert_int_equal(next_ok(&o).pts_us, 40000); /* the step tells milliseconds */
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, frame_numbers_give_the_time_and_it_never_runs_back)
{
    static const int64_t number[] = { 1, 2, 5, 5, 3, 4 }, frames[] = { 0, 1, 4, 5, 6, 7 };
    opened o;
    char text[2048];
    int at = snprintf(text, sizeof text, "2.1 t 10 6\n");

    for (int i = 0; i < 6; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%s\n%d 0\n", MASK(3), (int)number[i]);
    open_ok(&o, text);
    for (int i = 0; i < 6; i++) {
        const fap_frame f = next_ok(&o);
        assert_int_equal(f.number, number[i]);
        assert_int_equal(f.pts_us, frames[i] * 100000);
    }
    assert_int_equal(o.told.count, 1);
    assert_int_equal(o.told.line[0], 3);
    fap_ascii_reader_close(&o.reader);
}

TEST(ascii, the_lines_are_believed_not_the_count)
{
    opened o;
    char text[512];
    fap_err last;

    snprintf(text, sizeof text, "2.1 t 0 7\n%s\n0 1\n", MASK(3));
    open_ok(&o, text);
    assert_true(fap_ascii_reader_header(o.reader)->rate_hz == 25);
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(last, FAP_E_END);
    assert_true(was_told(&o.told, "number of frames"));
    assert_true(was_told(&o.told, "rate makes no sense"));
}

TEST(ascii, each_deviation_is_told_once_and_is_fatal_when_strict)
{
    opened o;
    char text[1024];
    fap_err last;

    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 1.5\n\n%s\n1 2.5\n", MASK(3), MASK(3));
    open_ok(&o, text);
    assert_int_equal(drain(&o, &last), 2);
    assert_int_equal(o.told.count, 2); /* decimals, empty line */
    assert_int_equal(open_bytes(&o, text, strlen(text), 0, 1), FAP_OK);
    assert_int_equal(drain(&o, &last), 0);
    assert_int_equal(last, FAP_E_SYNTAX);
}

TEST(ascii, a_senseless_count_is_not_used)
{
    static const char *const counts[] = { "-1", "1e9999", "99999999999999999999", "1.5" };

    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        opened o;
        char text[512];
        fap_err last;
        snprintf(text, sizeof text, "2.1 t 25 %s\n%s\n0 1\n", counts[i], MASK(3));
        open_ok(&o, text);
        assert_int_equal(fap_ascii_reader_header(o.reader)->frame_count, -1);
        assert_int_equal(drain(&o, &last), 1);
        assert_int_equal(last, FAP_E_END);
        assert_int_equal(o.told.count, 1);
        assert_true(was_told(&o.told, "makes no sense"));
    }
}

TEST(ascii, a_time_of_day_in_ms_is_a_frame_number)
{
    opened o;
    char text[1024];

    snprintf(text, sizeof text, "1700000000000\n%s\n1700000000040 1\n%s\n1700000000120 2\n", MASK(3),
             MASK(3));
    open_ok(&o, text);
    assert_true(next_ok(&o).number == 1700000000040);
    assert_int_equal(next_ok(&o).pts_us, 80000);
    fap_ascii_reader_close(&o.reader);
    assert_int_equal(error_of_one(MASK(3), "1000000000000001 1", "line 3, column 1: expected a frame number"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "1e400 1", "line 3, column 1"), FAP_E_SYNTAX);
}

TEST(ascii, media_time_never_runs_back_however_large_the_numbers)
{
    static const char *const numbers[] = { "-1e15", "1e15", "0", "1e15", "-1e15", "999999999999999" };
    opened o;
    char text[2048];
    int at = snprintf(text, sizeof text, "2.1 t 0.001 6\n");
    int64_t last_us = 0;

    for (int i = 0; i < 6; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%s\n%s 0\n", MASK(3), numbers[i]);
    open_ok(&o, text);
    for (int i = 0; i < 6; i++) {
        const fap_frame f = next_ok(&o);
        assert_true(f.pts_us >= last_us);
        last_us = f.pts_us;
    }
    fap_ascii_reader_close(&o.reader);
}

/* What stands where tabs were met first: 1 header, 2 mask, 3 values; the line numbers are the same. */
TEST(ascii, tabs_are_told_wherever_they_stand)
{
    for (int line = 1; line <= 3; line++) {
        opened o;
        char text[512];
        fap_err last;
        snprintf(text, sizeof text, "2.1%ct 25 1\n0%c%s\n0%c4\n", line == 1 ? '\t' : ' ',
                 line == 2 ? '\t' : ' ', MASK(3) + 2, line == 3 ? '\t' : ' ');
        open_ok(&o, text);
        assert_int_equal(drain(&o, &last), 1);
        assert_int_equal(o.told.count, 1);
        assert_int_equal(o.told.line[0], line);
        assert_true(was_told(&o.told, "tabs"));
    }
}

TEST(ascii, the_count_is_told_where_it_stands)
{
    opened o;
    char text[512];
    fap_err last;

    snprintf(text, sizeof text, "# one\n2.1 t 25 7\n%s\n0 1\n", MASK(3));
    open_ok(&o, text);
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(o.told.count, 1);
    assert_int_equal(o.told.line[0], 2);
}

TEST(ascii, a_huge_packed_viseme_is_absent)
{
    assert_int_equal(read_one(MASK(1), "0 -2147483648", NULL).state[1], FAP_ABSENT);
    assert_int_equal(read_one(MASK(1), "0 2147483647", NULL).state[1], FAP_ABSENT);
    assert_int_equal(read_one(MASK(1), "0 101009", NULL).state[1], FAP_ABSENT);
    assert_int_equal(read_one(MASK(1), "0 101010", NULL).state[1], FAP_CODED);
}

/* --- damage --- */

TEST(ascii, says_line_column_and_what_was_expected)
{
    assert_int_equal(error_of_one(MASK(3, 4), "0 1", "line 3, column 4: expected 3 numbers, found 2"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "0 1 2", "line 3, column 5: expected the end of the line"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "0 x1", "line 3, column 3: expected a value"), FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "0 1-", "line 3, column 3"), FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "inf 1", "line 3, column 1: expected a frame number"),
                     FAP_E_SYNTAX);
    assert_int_equal(error_of_one("0 2 0", "0", "line 2, column 3: expected a mask digit"), FAP_E_SYNTAX);
    assert_int_equal(error_of_one(MASK(3), "", "the file ends"), FAP_E_SYNTAX);
}

TEST(ascii, refuses_what_is_not_a_fap_file)
{
    static const char *const texts[] = { "",
                                         "# only a comment\n",
                                         "hello",
                                         "v2.1 name 25 10",
                                         "2.1 name 25 x",
                                         "2.1 name x 10",
                                         "{ \"a\": 1 }\n",
                                         "2.1",
                                         "17\n",
                                         "17\n2.1 t 25 0\n",
                                         "0 0 1 1 0 1 1" };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        opened o;
        const fap_err opened_err = open_text(&o, texts[i]);
        fap_err err = opened_err;
        if (opened_err == FAP_OK)
            assert_int_equal(drain(&o, &err), 0);
        else
            assert_true(o.where[0] != 0);
        assert_null(o.reader);
        assert_int_equal(err, FAP_E_SYNTAX);
    }
}

TEST(ascii, a_line_has_a_limit)
{
    enum { LIMIT = 16384 };
    static char text[LIMIT + 64];
    opened o;

    memset(text, 'x', sizeof text);
    text[0] = '#';
    memcpy(text + LIMIT, "\n2.1 t 25 0\n", 13);
    assert_int_equal(open_text(&o, text), FAP_OK);
    fap_ascii_reader_close(&o.reader);
    memcpy(text + LIMIT, "x\n2.1 t 25 0\n", 14);
    assert_int_equal(open_text(&o, text), FAP_E_SYNTAX);
    assert_non_null(strstr(o.where, "16384"));
    assert_int_equal(open_bytes(&o, text, strlen(text), 1, 0), FAP_E_SYNTAX);
}

/* The place of "the file ends": behind the last byte. */
TEST(ascii, an_end_too_early_has_a_place)
{
    static const struct {
        const char *text, *where;
    } cases[] = {
        { "", "line 1, column 1: expected a header, but the file ends" },
        { "# only a comment\n", "line 2, column 1: expected a header" },
        { "# only a comment", "line 1, column 17: expected a header" },
        { "17\n", "line 2, column 1: expected 68 mask digits" },
        { "2.1 t\n", "line 1, column 4: expected a header" },
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        opened o;
        assert_int_equal(open_text(&o, cases[i].text), FAP_E_SYNTAX);
        if (!strstr(o.where, cases[i].where))
            fail_msg("\"%s\" is not in \"%s\"", cases[i].where, o.where);
    }
    assert_int_equal(error_of_one(MASK(3), "", "line 4, column 1: expected a line of values"), FAP_E_SYNTAX);
}

TEST(ascii, what_strict_refuses_has_a_place)
{
    static const struct {
        const char *mask, *values, *where;
    } cases[] = { { "", "0 1.5", "line 4, column 3: values with decimals" },
                  { NULL, "0 1.5", "line 3, column 3: values with decimals" },
                  { NULL, "1 1", "line 3, column 1: frame numbers" },
                  { NULL, "0\t1", "line 3, column 2: tabs" } };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        opened o;
        fap_err last;
        fap_frame f;
        char text[512];
        snprintf(text, sizeof text, "2.1 t 25 1\n%s%s\n%s\n", cases[i].mask ? "#\n" : "", MASK(3),
                 cases[i].values);
        assert_int_equal(open_bytes(&o, text, strlen(text), 0, 1), FAP_OK);
        assert_int_equal(fap_ascii_reader_next(o.reader, &f), FAP_E_SYNTAX);
        if (!strstr(fap_ascii_reader_last_error(o.reader), cases[i].where))
            fail_msg("%s", fap_ascii_reader_last_error(o.reader));
        assert_int_equal(drain(&o, &last), 0);
    }
}

/* A recording whose power was cut: the frames before are kept, the last is dropped, with a notice. */
TEST(ascii, a_file_cut_anywhere_ends_in_whole_frames)
{
    char text[1024];
    fap_err last;

    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 1 123 456\n%s\n1 1 -124 -457\n", MASK(3, 4, 68),
             MASK(3, 4, 68));
    const size_t size = strlen(text), first = (size_t)(strstr(text, " 456\n") - text) + 2;
    const size_t second = (size_t)(strstr(text, "-457\n") - text) + 2;
    for (size_t cut = 0; cut < size; cut++) {
        opened o;
        char *copy = malloc(cut + 1); /* exactly as large, for the sanitizer */
        memcpy(copy, text, cut);
        if (open_bytes(&o, copy, cut, 0, 0) == FAP_OK) {
            assert_int_equal(drain(&o, &last), (cut >= first) + (cut >= second));
            assert_int_equal(last, cut >= first ? FAP_E_END : cut > 12 ? FAP_E_SYNTAX : last);
            assert_int_equal(was_told(&o.told, "inside a frame"), cut > first + 3 && cut < second);
        }
        assert_null(o.reader);
        free(copy);
    }
}

TEST(ascii, only_the_end_of_the_file_cuts_a_frame)
{
    opened o;
    char text[1024];
    fap_err last;

    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 1 2\n%s\n1 1\n", MASK(3, 4), MASK(3, 4));
    open_ok(&o, text); /* the short line is ended: it was written like that */
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(last, FAP_E_SYNTAX);
    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 1 2\n%s\n1 1 x", MASK(3, 4), MASK(3, 4));
    open_ok(&o, text); /* not cut, wrong */
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(last, FAP_E_SYNTAX);
    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 1 2\n%s\n1 1", MASK(3, 4), MASK(3, 4));
    assert_int_equal(open_bytes(&o, text, strlen(text), 0, 1), FAP_OK); /* strict */
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(last, FAP_E_SYNTAX);
}

/* "1 9 8 7", cut out of "1 9 8 7 0 5 5": three short, but no producer of single visemes was at work. */
TEST(ascii, a_cut_line_is_not_taken_for_single_visemes)
{
    opened o;
    char text[1024];
    fap_err last;

    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 9 8 7 0 5 5\n%s\n1 9 8 7", MASK(1, 3, 4), MASK(1, 3, 4));
    open_ok(&o, text);
    assert_int_equal(drain(&o, &last), 1);
    assert_int_equal(last, FAP_E_END);
    assert_true(was_told(&o.told, "inside a frame"));
    snprintf(text, sizeof text, "2.1 t 25 2\n%s\n0 9 5 5\n%s\n1 9 5 5", MASK(1, 3, 4), MASK(1, 3, 4));
    open_ok(&o, text);
    assert_int_equal(drain(&o, &last), 2);
    assert_int_equal(o.told.count, 1);
}

static void *no_memory(void *user, size_t size)
{
    (void)user, (void)size;
    return NULL;
}

static void never_free(void *user, void *ptr)
{
    (void)user, (void)ptr;
    fail();
}

TEST(ascii, failing_sources_sinks_and_allocators_are_told)
{
    fap_ascii_reader *reader;
    fap_ascii_writer *writer;
    fap_ascii_reader_config cfg;
    const fap_ascii_header header = { .name = "t", .rate_hz = 25, .frame_count = 0 };
    memory m = { 0 };

    assert_int_equal(fap_ascii_reader_open(&reader, &(fap_reader){ broken_read, NULL }, NULL, NULL),
                     FAP_E_IO);
    fap_ascii_reader_config_init(&cfg);
    cfg.alloc = (fap_allocator){ no_memory, never_free, NULL };
    assert_int_equal(fap_ascii_reader_open(&reader, &(fap_reader){ memory_read, &m }, &cfg, NULL),
                     FAP_E_NOMEM);
    assert_null(reader);
    assert_int_equal(fap_ascii_writer_open(&writer, &(fap_writer){ broken_write, NULL }, &header, NULL),
                     FAP_E_IO);
    assert_int_equal(fap_ascii_writer_open(&writer, &(fap_writer){ memory_write, &m }, &header, &cfg.alloc),
                     FAP_E_NOMEM);
    assert_null(writer);
}

/* --- the writer --- */

static fap_ascii_writer *write_to(memory *m, const char *name, double rate_hz, int64_t count)
{
    fap_ascii_header h = { .rate_hz = rate_hz, .frame_count = count };
    fap_ascii_writer *w;

    snprintf(h.name, sizeof h.name, "%s", name);
    assert_int_equal(fap_ascii_writer_open(&w, &(fap_writer){ memory_write, m }, &h, NULL), FAP_OK);
    return w;
}

TEST(ascii, writes_the_regular_format)
{
    memory m = { 0 };
    fap_frame f = { .viseme = { 1, 2, 3, 0 } };
    char expected[512];

    fap_ascii_writer *w = write_to(&m, "my take", 29.97, 1);
    f.state[1] = f.state[3] = FAP_CODED;
    f.value[3] = -2147483647 - 1;
    assert_int_equal(fap_ascii_writer_put(w, &f), FAP_OK);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);
    assert_null(w);
    snprintf(expected, sizeof expected, "2.1 my_take 29.97 1\n%s\n0 1 2 3 0 -2147483648\n", MASK(1, 3));
    assert_int_equal(m.size, strlen(expected));
    assert_memory_equal(m.data, expected, m.size);
    free(m.data);
}

/* Whoever shows the text shows what the frames say, however they came by it. */
TEST(ascii, all_that_a_frame_shows_can_be_read)
{
    static const uint8_t states[] = { FAP_HELD, FAP_CODED,     FAP_HELD, FAP_DERIVED, FAP_HELD,
                                      FAP_HELD, FAP_CONCEALED, FAP_HELD, FAP_HELD,    FAP_HELD };
    static const int32_t values[] = { 4, 5, 5, 6, 6, 5, 7, 5, 5, 5 };
    static const int written[] = { 1, 1, 0, 1, 0, 1, 1, 1, 0, 0 };
    enum { FRAMES = sizeof states };
    memory m = { 0 };
    opened o;

    fap_ascii_writer *w = write_to(&m, "t", 25, FRAMES);
    for (int i = 0; i < FRAMES; i++) {
        fap_frame f = { .pts_us = 40000 * i };
        f.state[1] = f.state[2] = f.state[50] = states[i];
        f.viseme.blend = f.expression.intensity2 = (uint8_t)values[i];
        f.value[50] = values[i];
        assert_int_equal(fap_ascii_writer_put(w, &f), FAP_OK);
    }
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);
    assert_int_equal(open_bytes(&o, m.data, m.size, 0, 1), FAP_OK);
    for (int i = 0; i < FRAMES; i++) {
        const fap_frame f = next_ok(&o);
        assert_int_equal(f.value[50], values[i]);
        assert_int_equal(f.viseme.blend, values[i]);
        assert_int_equal(f.expression.intensity2, values[i]);
        assert_int_equal(f.state[50], written[i] ? FAP_CODED : FAP_HELD);
        assert_int_equal(f.state[49], FAP_ABSENT);
    }
    fap_ascii_reader_close(&o.reader);
    free(m.data);
}

TEST(ascii, a_viseme_out_of_range_is_refused_where_it_would_be_written)
{
    memory m = { 0 };
    fap_frame f = { .viseme = { .select1 = 15 } };

    fap_ascii_writer *w = write_to(&m, "t", 25, 1);
    for (int state = FAP_CODED; state <= FAP_CONCEALED; state++) {
        f.state[1] = (uint8_t)state;
        assert_int_equal(fap_ascii_writer_put(w, &f), FAP_E_ARG);
    }
    f.state[1] = FAP_ABSENT;
    assert_int_equal(fap_ascii_writer_put(w, &f), FAP_OK);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);
    free(m.data);
}

TEST(ascii, the_writer_keeps_the_promise_of_the_header)
{
    memory m = { 0 };
    fap_frame f = { 0 };

    fap_ascii_writer *w = write_to(&m, "t", 25, 1);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_E_DATA);
    w = write_to(&m, "t", 25, 1);
    assert_int_equal(fap_ascii_writer_put(w, &f), FAP_OK);
    assert_int_equal(fap_ascii_writer_put(w, &f), FAP_E_DATA);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_E_DATA);
    w = write_to(&m, "t", 25, 1);
    f.state[1] = FAP_CODED, f.viseme.select1 = 15;
    assert_int_equal(fap_ascii_writer_put(w, &f), FAP_E_ARG);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_E_DATA);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);
    free(m.data);
}

static uint32_t draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static fap_frame random_frame(uint32_t *seed, const fap_frame *before, int64_t number, int rate)
{
    fap_frame f = *before;

    f.number = number;
    f.pts_us = (number * 1000000 * 2 + rate) / (2 * rate);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        f.state[fap] = draw(seed) % 4 ? FAP_CODED : before->state[fap] == FAP_ABSENT ? FAP_ABSENT : FAP_HELD;
        if (fap > 2 && f.state[fap] == FAP_CODED)
            f.value[fap] = (int32_t)(draw(seed) % 100001) - 50000;
    }
    if (f.state[1] == FAP_CODED)
        f.viseme = (fap_viseme){ draw(seed) % 15, draw(seed) % 15, draw(seed) % 64, draw(seed) % 2 };
    if (f.state[2] == FAP_CODED)
        f.expression = (fap_expression){ draw(seed) % 7,  draw(seed) % 64, draw(seed) % 7,
                                         draw(seed) % 64, draw(seed) % 2,  draw(seed) % 2 };
    return f;
}

TEST(ascii, what_was_written_reads_back_exactly)
{
    enum { FRAMES = 200, RATE = 30 };
    static fap_frame frames[FRAMES];
    fap_frame before = { 0 };
    uint32_t seed = 1;
    memory m = { 0 };
    opened o;

    fap_ascii_writer *w = write_to(&m, "t", RATE, FRAMES);
    for (int i = 0; i < FRAMES; i++) {
        before = frames[i] = random_frame(&seed, &before, i < 100 ? i : i + 7, RATE);
        assert_int_equal(fap_ascii_writer_put(w, &frames[i]), FAP_OK);
    }
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);

    assert_int_equal(open_bytes(&o, m.data, m.size, 1000, 0), FAP_OK);
    for (int i = 0; i < FRAMES; i++) {
        const fap_frame f = next_ok(&o);
        assert_int_equal(f.number, frames[i].number);
        assert_int_equal(f.pts_us, frames[i].pts_us);
        assert_memory_equal(f.state, frames[i].state, sizeof f.state);
        assert_memory_equal(f.value, frames[i].value, sizeof f.value);
        assert_memory_equal(&f.viseme, &frames[i].viseme, sizeof f.viseme);
        assert_memory_equal(&f.expression, &frames[i].expression, sizeof f.expression);
    }
    assert_int_equal(o.told.count, 1); /* the gap */
    fap_ascii_reader_close(&o.reader);
    free(m.data);
}

/* --- real files --- */

static size_t stdio_read(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

typedef struct real_file {
    const char *name;
    int frames;
    double rate_hz;
    const char *notice; /* part of what must be told; NULL: nothing may be told */
    int fap;            /* of the last frame */
    int32_t value;
} real_file;

static const real_file real_files[] = {
    /* Frame counts from SOURCES.md; the last value that is not 0 of the last frame read by other means. */
    { "xface_anger.fap", 108, 25, NULL, 58, 10 },
    { "xface_disgust.fap", 107, 25, NULL, 58, 10 },
    { "xface_joy.fap", 108, 25, NULL, 58, 10 },
    { "xface2_test.fap", 43, 25, NULL, 58, -103 },
    { "vreng_eyes.fap", 52, 2, "count up from 0", 26, -100 },
    { "vreng_jag.fap", 169, 5, "tabs", 60, -533 },
    { "vreng_surp.fap", 15, 10, NULL, 60, -399 },
    { "vreng_S100_joy.fap", 16, 10, NULL, 60, 207 },
    { "vreng_S102_dis.fap", 15, 10, NULL, 60, 22 },
    { "vreng_S136_surp.fap", 19, 10, NULL, 60, -395 },
    { "metaface_th-example-plain.fap", 1192, 25, "strength", 49, -110 },
    { "semaine_empty.fap", 1, 25, NULL, 3, 0 },
    { "semaine_example2.fap", 50, 25, "no header", 3, 0 },
    { "semaine_example3.fap", 3, 25, "milliseconds", 50, 4 },
    { "semaine_example2_bfba.fap", 20, 25, "milliseconds", 50, 329 },
    { "greta_1-Welcome_1.fap", 1, 25, "FAP 1 has one value", 3, 0 },
    { "greta_AU_Interpolation_2.fap", 1, 25, "69 digits", 62, 2 },
    { "greta_AU_Interpolation_5.fap", 1, 25, "69 digits", 58, -7 },
    { "greta_AU_Interpolation_1130.fap", 1, 25, "69 digits", 22, 66 },
    { "greta_AU_Interpolation_1186.fap", 1, 25, "69 digits", 22, 200 },
    { "greta_AU_Interpolation_1146.fap", 1, 25, "69 digits", 3, 0 },
};

static void check_real_file(const real_file *real)
{
    char path[256];
    told t = { 0 };
    fap_ascii_reader_config cfg;
    fap_ascii_reader *reader;
    fap_frame f = { 0 };
    fap_err err;
    int count = 0;

    snprintf(path, sizeof path, "data/fap/%s", real->name);
    FILE *file = fopen(test_shared(path), "rb");
    fap_ascii_reader_config_init(&cfg);
    cfg.notice = listen;
    cfg.notice_user = &t;
    assert_int_equal(fap_ascii_reader_open(&reader, &(fap_reader){ stdio_read, file }, &cfg, NULL), FAP_OK);
    while ((err = fap_ascii_reader_next(reader, &f)) == FAP_OK)
        count++;
    if (err != FAP_E_END || count != real->frames)
        fail_msg("%s: %d frames, %s", real->name, count, fap_ascii_reader_last_error(reader));
    assert_true(fap_ascii_reader_header(reader)->rate_hz == real->rate_hz);
    if (real->notice ? !was_told(&t, real->notice) : t.count)
        fail_msg("%s: not told as expected, but: %s", real->name, t.count ? t.text[0] : "nothing");
    if (f.value[real->fap] != real->value)
        fail_msg("%s: FAP %d of the last frame is %d", real->name, real->fap, (int)f.value[real->fap]);
    fap_ascii_reader_close(&reader);
    fclose(file);
}

TEST(ascii, real_files_read_right)
{
    for (size_t i = 0; i < sizeof real_files / sizeof *real_files; i++)
        check_real_file(&real_files[i]);
}

/* --- there and back --- */

enum { MAX_REAL = 1500 };

/* Frames of a file in memory; its header in @p h. */
static int read_all(const memory *bytes, fap_ascii_header *h, fap_frame *frame)
{
    opened o;
    int count = 0;

    assert_int_equal(open_bytes(&o, bytes->data, bytes->size, 0, 0), FAP_OK);
    while (count < MAX_REAL && fap_ascii_reader_next(o.reader, &frame[count]) == FAP_OK)
        count++;
    *h = *fap_ascii_reader_header(o.reader);
    fap_ascii_reader_close(&o.reader);
    return count;
}

static memory write_all(const fap_ascii_header *header, const fap_frame *frame, int count)
{
    fap_ascii_header h = *header;
    fap_ascii_writer *w;
    memory m = { 0 };

    h.frame_count = count;
    assert_int_equal(fap_ascii_writer_open(&w, &(fap_writer){ memory_write, &m }, &h, NULL), FAP_OK);
    for (int i = 0; i < count; i++)
        assert_int_equal(fap_ascii_writer_put(w, &frame[i]), FAP_OK);
    assert_int_equal(fap_ascii_writer_close(&w), FAP_OK);
    return m;
}

static void assert_same_frame(const fap_frame *a, const fap_frame *b)
{
    assert_int_equal(a->pts_us, b->pts_us);
    assert_memory_equal(a->state, b->state, sizeof a->state);
    assert_memory_equal(a->value, b->value, sizeof a->value);
    assert_memory_equal(&a->viseme, &b->viseme, sizeof a->viseme);
    assert_memory_equal(&a->expression, &b->expression, sizeof a->expression);
}

static void check_round_trip(const char *name)
{
    static fap_frame first[MAX_REAL], second[MAX_REAL];
    char path[256];
    fap_ascii_header h;
    memory in = { 0 };
    char chunk[4096];

    snprintf(path, sizeof path, "data/fap/%s", name);
    FILE *file = fopen(test_shared(path), "rb");
    for (size_t n; (n = fread(chunk, 1, sizeof chunk, file)) > 0;)
        memory_write(&in, chunk, n);
    fclose(file);

    const int count = read_all(&in, &h, first);
    memory text = write_all(&h, first, count);
    assert_int_equal(read_all(&text, &h, second), count);
    for (int i = 0; i < count; i++)
        assert_same_frame(&first[i], &second[i]);
    memory again = write_all(&h, second, count);
    assert_int_equal(again.size, text.size);
    assert_memory_equal(again.data, text.data, text.size);
    free(in.data);
    free(text.data);
    free(again.data);
}

TEST(ascii, real_files_survive_being_written)
{
    for (size_t i = 0; i < sizeof real_files / sizeof *real_files; i++)
        check_round_trip(real_files[i].name);
}

/* --- any length --- */

/* A file that is made while it is read, a frame at a time. */
typedef struct endless {
    char text[512];
    size_t size, at;
    int64_t frame, frames;
} endless;

static size_t endless_read(void *user, void *buf, size_t size)
{
    endless *e = user;

    if (e->at == e->size && e->frame < e->frames) {
        e->size = (size_t)snprintf(e->text, sizeof e->text, "%s\n%lld 7\n", MASK(3), (long long)e->frame++);
        e->at = 0;
    }
    const size_t n = e->size - e->at < size ? e->size - e->at : size;
    memcpy(buf, e->text + e->at, n);
    e->at += n;
    return n;
}

static void *count_bytes(void *user, size_t size)
{
    *(size_t *)user += size;
    return malloc(size);
}

static void just_free(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

TEST(ascii, memory_does_not_grow_with_the_file)
{
    enum { FRAMES = 100000, MOST = 48 << 10 };
    endless e = { .text = "2.1 t 25 100000\n", .size = 16, .frames = FRAMES };
    size_t allocated = 0;
    fap_ascii_reader_config cfg;
    fap_ascii_reader *r;
    fap_frame f;

    fap_ascii_reader_config_init(&cfg);
    cfg.strict = 1;
    cfg.alloc = (fap_allocator){ count_bytes, just_free, &allocated };
    assert_int_equal(fap_ascii_reader_open(&r, &(fap_reader){ endless_read, &e }, &cfg, NULL), FAP_OK);
    assert_true(allocated < MOST);
    for (int i = 0; i < FRAMES; i++) {
        assert_int_equal(fap_ascii_reader_next(r, &f), FAP_OK);
        assert_int_equal(f.number, i);
    }
    assert_int_equal(fap_ascii_reader_next(r, &f), FAP_E_END);
    fap_ascii_reader_close(&r);
    assert_true(allocated < MOST);
}
