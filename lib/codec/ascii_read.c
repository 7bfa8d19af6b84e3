/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The ASCII .fap reader: a header line, then per frame one line of mask digits and one of values. Reads what
 * real producers write, says once for each kind of deviation that it did, and keeps one line and one frame in
 * memory. Sources: docs/fap-ascii.md; ISO/IEC 14496-2 annexes on FAP files.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "codec/ascii_reader.h"

enum { MS_STEP = 10 }; /* without a header, steps this large are milliseconds, not frames */

static const double default_rate_hz = 25;
static const int64_t latest_pts_us = INT64_MAX / 4; /* such times stay as they are: there is room to add */

/* --- what is wrong, and where --- */

typedef struct place {
    int64_t line, column; /* from 1; columns are bytes */
} place;

static place place_in_line(const fap_ascii_reader *r, const char *at)
{
    return (place){ r->lines.number, (int64_t)(at - r->line) + 1 };
}

/* Behind the last byte: on a new line where the last one was ended. */
static place place_of_end(const fap_ascii_reader *r)
{
    if (r->lines.unended)
        return place_in_line(r, r->line + r->length);
    return (place){ r->lines.number + 1, 1 };
}

static fap_err fail_at(fap_ascii_reader *r, fap_err err, place p, const char *expected)
{
    if (r->err != FAP_OK)
        return r->err;
    snprintf(r->text, sizeof r->text, "line %lld, column %lld: %s", (long long)p.line, (long long)p.column,
             expected);
    return r->err = err;
}

static void note_at(fap_ascii_reader *r, ascii_deviation which, place p)
{
    static const char *const texts[] = {
#define X(name, text) [ASCII_##name] = text,
        ASCII_DEVIATIONS(X)
#undef X
    };

    if (r->noticed & 1u << which)
        return;
    r->noticed |= 1u << which;
    if (r->cfg.strict)
        fail_at(r, FAP_E_SYNTAX, p, texts[which]);
    else if (r->cfg.notice)
        r->cfg.notice(r->cfg.notice_user, p.line, texts[which]);
}

void fap_ascii_note(fap_ascii_reader *r, ascii_deviation which, const char *at)
{
    note_at(r, which, place_in_line(r, at));
}

void fap_ascii_note_tabs(fap_ascii_reader *r)
{
    const char *tab = memchr(r->line, '\t', r->length);
    if (tab)
        fap_ascii_note(r, ASCII_TABS, tab);
}

/* What is wrong is that the file has no more bytes. Where frames came before, those are what there is to keep. */
static int is_cut(const fap_ascii_reader *r, const char *at)
{
    return r->frames && !r->cfg.strict && (!at || (r->lines.unended && at == r->line + r->length));
}

fap_err fap_ascii_fail(fap_ascii_reader *r, fap_err err, const char *at, const char *expected, ...)
{
    const place p = at ? place_in_line(r, at) : place_of_end(r);
    char text[FAP_ERROR_TEXT_SIZE - 64]; /* line and column stand in front */
    va_list args;

    if (r->err == FAP_OK && err == FAP_E_SYNTAX && is_cut(r, at)) {
        note_at(r, ASCII_CUT, p);
        return r->err = FAP_E_END;
    }
    va_start(args, expected);
    vsnprintf(text, sizeof text, expected, args);
    va_end(args);
    return fail_at(r, err, p, text);
}

/* --- lines --- */

static fap_err line_error(fap_ascii_reader *r, fap_err err)
{
    if (err == FAP_E_LIMIT)
        return fap_ascii_fail(r, FAP_E_SYNTAX, r->line + r->length, "expected a line of at most %d bytes",
                              ASCII_LINE_MAX);
    if (err == FAP_E_IO)
        return fap_ascii_fail(r, FAP_E_IO, NULL, "expected more bytes, but reading failed");
    return r->err = err;
}

fap_err fap_ascii_next_line(fap_ascii_reader *r)
{
    if (r->unread)
        return r->unread = 0, FAP_OK;
    for (;;) {
        const fap_err err = fap_ascii_lines_next(&r->lines, &r->line, &r->length);
        if (err == FAP_E_END)
            return err;
        if (err != FAP_OK)
            return line_error(r, err);
        if (r->lines.byte_order_mark)
            fap_ascii_note(r, ASCII_BYTE_ORDER_MARK, r->line);
        if (r->lines.lone_cr)
            fap_ascii_note(r, ASCII_LONE_CR, r->line + r->length);
        const char first = *ascii_skip_blanks(r->line);
        if (first == '\n')
            fap_ascii_note(r, ASCII_EMPTY_LINE, r->line);
        else if (first != '#')
            return r->err;
    }
}

/* --- frames --- */

/* Only the second frame of a file without header tells frame numbers from times. */
static void recognise_ms(fap_ascii_reader *r, int64_t number)
{
    if (!r->header.present && r->frames == 1 && number - r->base_number >= MS_STEP)
        r->in_ms = 1;
    if (!r->in_ms)
        return;
    fap_ascii_note(r, ASCII_MILLISECONDS, r->line);
}

static int64_t span_us(const fap_ascii_reader *r, int64_t numbers)
{
    const double us = (double)numbers * r->period_us + 0.5;

    if (r->in_ms)
        return numbers * 1000; /* of at most 2 * ASCII_NUMBER_MAX */
    return us < (double)latest_pts_us ? (int64_t)us : latest_pts_us;
}

static int64_t no_later(int64_t pts_us)
{
    return pts_us < latest_pts_us ? pts_us : latest_pts_us;
}

/* Numbers that repeat or go back start a new count one frame later: media time never does. */
static void restart_count(fap_ascii_reader *r, int64_t number)
{
    r->base_number = number;
    r->base_pts_us = no_later(r->frame.pts_us + (int64_t)(r->period_us + 0.5));
}

static void take_number(fap_ascii_reader *r)
{
    const int64_t number = r->frame_number;

    recognise_ms(r, number);
    if (!r->in_ms && number != (r->frames ? r->frame.number + 1 : 0))
        fap_ascii_note(r, ASCII_NUMBERS, ascii_skip_blanks(r->line));
    if (!r->frames)
        r->base_number = number;
    else if (number <= r->frame.number)
        restart_count(r, number);
    r->frame.number = number;
    r->frame.pts_us = no_later(r->base_pts_us + span_us(r, number - r->base_number));
    r->frames++;
}

/* The whole frame is parsed before any of it is given out. */
static fap_err read_value_line(fap_ascii_reader *r)
{
    fap_err err = fap_ascii_next_line(r);
    if (err == FAP_E_END)
        return fap_ascii_fail(r, FAP_E_SYNTAX, NULL,
                              "expected a line of values behind the mask, but the file ends");
    if (err == FAP_OK)
        err = fap_ascii_read_values(r);
    if (err == FAP_OK)
        take_number(r);
    return r->err;
}

static fap_err finish(fap_ascii_reader *r)
{
    if (r->header.frame_count >= 0 && r->header.frame_count != r->frames)
        note_at(r, ASCII_COUNT, (place){ r->header_line, r->count_column });
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

    fap_err err = fap_ascii_next_line(r);
    if (err == FAP_OK)
        err = fap_ascii_read_mask(r);
    if (err == FAP_OK)
        err = read_value_line(r);
    if (err == FAP_OK)
        *out = r->frame;
    return err == FAP_E_END ? finish(r) : err;
}

/* --- life --- */

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
    fap_ascii_lines_init(&r->lines, in);
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

    fap_err err = fap_ascii_read_header(r);
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
