/* SPDX-License-Identifier: BSD-2-Clause */
/* See streams.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>

#include "common/streams.h"

/* --- reading --- */

typedef struct memory {
    const uint8_t *at;
    size_t left;
} memory;

static size_t read_memory(void *user, void *buf, size_t size)
{
    memory *m = user;
    const size_t n = size < m->left ? size : m->left;

    if (n)
        memcpy(buf, m->at, n);
    m->at += n;
    m->left -= n;
    return n;
}

static void take_notice(void *user, int64_t place, const char *text)
{
    stream_summary *s = user;

    if (s->notice_count == STREAM_MAX_NOTICES)
        return;
    s->notice[s->notice_count].where = place;
    s->notice[s->notice_count++].text = text;
}

static fap_err take_frame(stream_summary *s, const frame_sink *sink, const fap_frame *f)
{
    s->frames++;
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        stream_fap *c = &s->fap[fap];
        const int32_t v = f->value[fap];
        if (f->state[fap] != FAP_CODED)
            continue;
        c->min = c->coded && c->min < v ? c->min : v;
        c->max = c->coded && c->max > v ? c->max : v;
        c->sum += v;
        c->coded++;
    }
    return sink ? sink->put(sink->user, f) : FAP_OK;
}

static fap_err read_text(memory bytes, stream_summary *s, const frame_sink *sink, char *where)
{
    const fap_reader in = { read_memory, &bytes };
    fap_ascii_reader_config cfg;
    fap_ascii_reader *reader;
    fap_frame frame;

    s->format = "fap";
    fap_ascii_reader_config_init(&cfg);
    cfg.notice = take_notice;
    cfg.notice_user = s;
    fap_err err = fap_ascii_reader_open(&reader, &in, &cfg, where);
    if (err != FAP_OK)
        return err;
    s->header = *fap_ascii_reader_header(reader);
    while (err == FAP_OK && (err = fap_ascii_reader_next(reader, &frame)) == FAP_OK)
        err = take_frame(s, sink, &frame);
    if (err != FAP_E_END)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", fap_ascii_reader_last_error(reader));
    fap_ascii_reader_close(&reader);
    return err == FAP_E_END ? FAP_OK : err;
}

static void take_plane(stream_summary *s, const fap_plane_info *plane)
{
    s->header.rate_hz = plane->rate_hz;
    s->intra_frames += plane->intra;
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        s->fap[fap].bits += plane->fap_bits[fap];
}

/* A broken plane loses what stands before the next I plane, not the stream. */
static fap_err receive_all(fap_decoder *d, stream_summary *s, const frame_sink *sink, char *where)
{
    fap_frame frame;

    for (;;) {
        const fap_err err = fap_decoder_receive(d, &frame);
        if (err == FAP_E_AGAIN || err == FAP_E_END)
            return s->frames ? FAP_OK : FAP_E_BITSTREAM;
        if (err != FAP_OK) {
            if (!s->broken_planes++)
                snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", fap_decoder_last_error(d));
            continue;
        }
        take_plane(s, fap_decoder_plane(d));
        const fap_err taken = take_frame(s, sink, &frame);
        if (taken != FAP_OK)
            return taken;
    }
}

static fap_err read_bits(memory bytes, stream_summary *s, const frame_sink *sink, char *where)
{
    fap_decoder_config cfg;
    fap_decoder *d;

    s->format = "fba";
    fap_decoder_config_init(&cfg);
    cfg.notice = take_notice;
    cfg.notice_user = s;
    cfg.symbol_memory = 65534;
    fap_err err = fap_decoder_open(&d, &cfg);
    if (err != FAP_OK)
        return err;
    err = fap_decoder_send(d, bytes.at, bytes.left);
    if (err == FAP_OK)
        err = receive_all(d, s, sink, where);
    fap_decoder_close(&d);
    return err;
}

fap_err stream_read(const uint8_t *data, size_t size, stream_summary *s, const frame_sink *sink, char *where)
{
    static const uint8_t start_code[3] = { 0, 0, 1 };
    const memory bytes = { data, size };

    *where = '\0';
    *s = (stream_summary){ .size = size, .header = { .rate_hz = 25 } };
    if (size > sizeof start_code && !memcmp(data, start_code, sizeof start_code))
        return read_bits(bytes, s, sink, where);
    return read_text(bytes, s, sink, where);
}

/* --- writing --- */

static fap_err open_bits(stream_writer *w, const fap_encoder_config *cfg)
{
    const fap_err err = fap_encoder_open(&w->bits, cfg);

    if (err != FAP_OK)
        return err;
    w->packet_room = fap_encoder_bound(w->bits);
    w->packet = malloc(w->packet_room);
    return w->packet ? FAP_OK : FAP_E_NOMEM;
}

fap_err stream_writer_open(stream_writer *w, const fap_writer *out, const fap_ascii_header *header,
                           const fap_encoder_config *bits)
{
    *w = (stream_writer){ .out = *out };
    return bits ? open_bits(w, bits) : fap_ascii_writer_open(&w->text, out, header, NULL);
}

/* Writes every packet that is ready. FAP_E_AGAIN or FAP_E_END when there is none left. */
static fap_err drain(stream_writer *w)
{
    size_t size;
    fap_err err;

    while ((err = fap_encoder_receive(w->bits, w->packet, w->packet_room, &size)) == FAP_OK)
        if (w->out.write(w->out.user, w->packet, size))
            return FAP_E_IO;
    return err;
}

fap_err stream_writer_put(stream_writer *w, const fap_frame *frame)
{
    if (w->text)
        return fap_ascii_writer_put(w->text, frame);
    fap_err err = fap_encoder_send(w->bits, frame);
    if (err != FAP_E_AGAIN)
        return err;
    err = drain(w);
    return err == FAP_E_AGAIN ? fap_encoder_send(w->bits, frame) : err;
}

fap_err stream_writer_close(stream_writer *w, fap_encoder_stats *stats)
{
    fap_err err = FAP_OK;

    *stats = (fap_encoder_stats){ 0 };
    if (w->text)
        err = fap_ascii_writer_close(&w->text);
    if (w->bits && w->packet) {
        fap_encoder_flush(w->bits);
        err = drain(w);
        err = err == FAP_E_END ? FAP_OK : err;
        *stats = fap_encoder_get_stats(w->bits);
    }
    fap_encoder_close(&w->bits);
    free(w->packet);
    w->packet = NULL;
    return err;
}
