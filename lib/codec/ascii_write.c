/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The ASCII .fap writer: version 2.1, LF, no trailing blanks, four numbers for FAP 1 and six for FAP 2, so
 * that every reader of the format agrees on what it reads. A frame at a time, one write call each. Sources:
 * docs/fap-ascii.md; ISO/IEC 14496-2 annexes on FAP files.
 */
#include <stdint.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/tables.h>

#include "base/mem.h"
#include "param/frame.h"

enum {
    MAX_NUMBER = 21, /* characters of a 64-bit number and a blank */
    FRAME_MAX = 2 * FAP_COUNT + MAX_NUMBER * (1 + 4 + 6 + FAP_COUNT), /* mask line and value line */
};

struct fap_ascii_writer {
    fap_allocator alloc;
    fap_writer out;
    double rate_hz;
    int64_t promised, written;
    int64_t number, first_pts_us;
    fap_frame shown; /* what readers of the text show: all that was written, held */
    fap_err err;
};

static char *put_digits(char *p, uint64_t v)
{
    char digit[20];
    int n = 0;

    do
        digit[n++] = (char)('0' + v % 10);
    while (v /= 10);
    while (n)
        *p++ = digit[--n];
    return p;
}

static char *put_number(char *p, int64_t v)
{
    if (v < 0)
        *p++ = '-';
    return put_digits(p, v < 0 ? 0 - (uint64_t)v : (uint64_t)v);
}

static char *put_next(char *p, int64_t v)
{
    *p++ = ' ';
    return put_number(p, v);
}

/* The format says whole frames a second; other rates get up to six decimals, as some readers take them. */
static char *put_rate(char *p, double rate_hz)
{
    const uint64_t millionths = (uint64_t)(rate_hz * 1e6 + 0.5);
    uint64_t rest = millionths % 1000000;

    p = put_digits(p, millionths / 1000000);
    if (rest)
        *p++ = '.';
    for (; rest; rest = rest * 10 % 1000000)
        *p++ = (char)('0' + rest / 100000);
    return p;
}

/* One word: readers split the header at blanks. */
static char *put_name(char *p, const fap_ascii_header *h)
{
    const char *end = memchr(h->name, 0, sizeof h->name);
    const size_t length = end ? (size_t)(end - h->name) : sizeof h->name;

    if (!length)
        *p++ = '_';
    for (size_t i = 0; i < length; i++)
        *p++ = (unsigned char)h->name[i] <= ' ' || h->name[i] == 127 ? '_' : h->name[i];
    return p;
}

static fap_err put_text(fap_ascii_writer *w, const char *text, const char *end)
{
    if (w->out.write(w->out.user, text, (size_t)(end - text)))
        w->err = FAP_E_IO;
    return w->err;
}

static fap_err put_header(fap_ascii_writer *w, const fap_ascii_header *h)
{
    char text[sizeof h->name + 64], *p = text;

    memcpy(p, "2.1 ", 4);
    p = put_name(p + 4, h);
    *p++ = ' ';
    p = put_rate(p, h->rate_hz);
    p = put_next(p, h->frame_count);
    *p++ = '\n';
    return put_text(w, text, p);
}

static int header_is_sound(const fap_ascii_header *h)
{
    return h->rate_hz >= 0.001 && h->rate_hz <= 100000 && h->frame_count >= 0 && h->frame_count <= INT32_MAX;
}

fap_err fap_ascii_writer_open(fap_ascii_writer **writer, const fap_writer *out,
                              const fap_ascii_header *header, const fap_allocator *alloc)
{
    if (!writer)
        return FAP_E_ARG;
    *writer = NULL;
    if (!out || !out->write || !header || !header_is_sound(header))
        return FAP_E_ARG;

    const fap_allocator a = fap_mem_allocator(alloc);
    fap_ascii_writer *w = fap_mem_calloc(&a, 1, sizeof *w);
    if (!w)
        return FAP_E_NOMEM;
    *w = (fap_ascii_writer){
        .alloc = a, .out = *out, .rate_hz = header->rate_hz, .promised = header->frame_count
    };
    if (put_header(w, header) != FAP_OK) {
        fap_mem_free(&a, w);
        return FAP_E_IO;
    }
    *writer = w;
    return FAP_OK;
}

/* --- what of a frame is written --- */

static int is_shown(const fap_ascii_writer *w, const fap_frame *f, int fap)
{
    if (w->shown.state[fap] == FAP_ABSENT)
        return 0;
    if (fap == 1)
        return !memcmp(&w->shown.viseme, &f->viseme, sizeof f->viseme);
    if (fap == 2)
        return !memcmp(&w->shown.expression, &f->expression, sizeof f->expression);
    return w->shown.value[fap] == f->value[fap];
}

/*
 * Derived and concealed values too: text has no decoder behind it that would find them again. Readers hold what
 * is masked out, so that a held value needs no number unless they hold another, or none.
 */
static void choose(const fap_ascii_writer *w, const fap_frame *f, uint8_t *written)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        written[fap] = f->state[fap] != FAP_ABSENT && (f->state[fap] != FAP_HELD || !is_shown(w, f, fap));
}

static int is_sound(const fap_frame *f, const uint8_t *written)
{
    return (!written[1] || fap_viseme_is_sound(&f->viseme)) &&
           (!written[2] || fap_expression_is_sound(&f->expression));
}

static void keep_shown(fap_ascii_writer *w, const fap_frame *f, const uint8_t *written)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (written[fap]) {
            w->shown.state[fap] = FAP_HELD;
            w->shown.value[fap] = f->value[fap];
        }
    if (written[1])
        w->shown.viseme = f->viseme;
    if (written[2])
        w->shown.expression = f->expression;
}

/* --- lines --- */

static char *put_mask(char *p, const uint8_t *written)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        *p++ = (char)('0' + written[fap]);
        *p++ = fap < FAP_COUNT ? ' ' : '\n';
    }
    return p;
}

static char *put_viseme(char *p, const fap_viseme *v)
{
    p = put_next(p, v->select1);
    p = put_next(p, v->select2);
    p = put_next(p, v->blend);
    return put_next(p, v->def);
}

static char *put_expression(char *p, const fap_expression *e)
{
    p = put_next(p, e->select1);
    p = put_next(p, e->intensity1);
    p = put_next(p, e->select2);
    p = put_next(p, e->intensity2);
    p = put_next(p, e->init_face);
    return put_next(p, e->def);
}

static char *put_values(char *p, const fap_frame *f, const uint8_t *written, int64_t number)
{
    p = put_number(p, number);
    if (written[1])
        p = put_viseme(p, &f->viseme);
    if (written[2])
        p = put_expression(p, &f->expression);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (written[fap])
            p = put_next(p, f->value[fap]);
    *p++ = '\n';
    return p;
}

/* The frame number nearest to the frame's time, so that gaps stay gaps; always above the one before. */
static int64_t next_number(const fap_ascii_writer *w, const fap_frame *f)
{
    if (!w->written)
        return 0;
    const double at = ((double)f->pts_us - (double)w->first_pts_us) * 1e-6 * w->rate_hz + 0.5;
    if (!(at < INT32_MAX))
        return w->number + 1;
    return at >= (double)(w->number + 1) ? (int64_t)at : w->number + 1;
}

fap_err fap_ascii_writer_put(fap_ascii_writer *w, const fap_frame *frame)
{
    uint8_t written[FAP_COUNT + 1];
    char text[FRAME_MAX];

    if (!w || !frame)
        return FAP_E_ARG;
    choose(w, frame, written);
    if (!is_sound(frame, written))
        return FAP_E_ARG;
    if (w->err == FAP_OK && w->written == w->promised)
        w->err = FAP_E_DATA;
    if (w->err != FAP_OK)
        return w->err;

    w->number = next_number(w, frame);
    if (!w->written)
        w->first_pts_us = frame->pts_us;
    w->written++;
    keep_shown(w, frame, written);
    return put_text(w, text, put_values(put_mask(text, written), frame, written, w->number));
}

fap_err fap_ascii_writer_close(fap_ascii_writer **writer)
{
    if (!writer || !*writer)
        return FAP_OK;
    fap_ascii_writer *w = *writer;
    const fap_allocator alloc = w->alloc;
    const fap_err err = w->err != FAP_OK ? w->err : w->written == w->promised ? FAP_OK : FAP_E_DATA;
    fap_mem_free(&alloc, w);
    *writer = NULL;
    return err;
}
