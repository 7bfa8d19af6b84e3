/* SPDX-License-Identifier: BSD-2-Clause */
/* See streams.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static int64_t frame_us(double rate_hz)
{
    return (int64_t)(1e6 / rate_hz + 0.5);
}

static fap_err take_frame(stream_summary *s, const frame_sink *sink, const fap_frame *f, double rate_hz)
{
    s->frames++;
    s->end_us = f->pts_us + frame_us(rate_hz);
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

static fap_err read_text(memory bytes, const stream_options *options, stream_summary *s,
                         const frame_sink *sink, char *where)
{
    const fap_reader in = { read_memory, &bytes };
    fap_ascii_reader_config cfg;
    fap_ascii_reader *reader;
    fap_frame frame;

    s->format = "fap";
    fap_ascii_reader_config_init(&cfg);
    cfg.strict = options->strict;
    cfg.notice = take_notice;
    cfg.notice_user = s;
    fap_err err = fap_ascii_reader_open(&reader, &in, &cfg, where);
    if (err != FAP_OK)
        return err;
    s->header = *fap_ascii_reader_header(reader);
    while (err == FAP_OK && (err = fap_ascii_reader_next(reader, &frame)) == FAP_OK)
        err = take_frame(s, sink, &frame, s->header.rate_hz);
    if (err != FAP_E_END)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", fap_ascii_reader_last_error(reader));
    fap_ascii_reader_close(&reader);
    return err == FAP_E_END ? FAP_OK : err;
}

/* A stream being decoded. */
typedef struct bits_reading {
    fap_decoder *decoder;
    stream_summary *summary;
    const frame_sink *sink;
    double rate_hz; /* of the plane before */
    int strict;
    char *where;
} bits_reading;

static void take_plane(bits_reading *r, const fap_plane_info *plane, const fap_frame *frame)
{
    stream_summary *s = r->summary;

    if (plane->concealed) {
        s->concealed++;
        return;
    }
    if (!s->frames)
        s->header.rate_hz = plane->rate_hz;
    s->rate_changes += s->frames && plane->rate_hz != r->rate_hz;
    r->rate_hz = plane->rate_hz;
    s->intra_frames += plane->intra;
    s->skipped += plane->skipped;
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        s->fap[fap].bits += plane->fap_bits[fap];
    if (r->sink && r->sink->plane)
        r->sink->plane(r->sink->user, plane, frame);
}

static void take_broken(bits_reading *r)
{
    const char *const why = fap_decoder_last_error(r->decoder);

    if (!r->summary->broken_planes++)
        snprintf(r->where, FAP_ERROR_TEXT_SIZE, "%s", why);
    if (r->sink && r->sink->broken)
        r->sink->broken(r->sink->user, why);
}

/* A broken plane loses what stands before the next I plane, not the stream. */
static fap_err receive_all(bits_reading *r)
{
    fap_frame frame;

    for (;;) {
        const fap_err err = fap_decoder_receive(r->decoder, &frame);
        if (err == FAP_E_AGAIN || err == FAP_E_END)
            break;
        if (err != FAP_OK) {
            take_broken(r);
            if (r->strict)
                return err;
            continue;
        }
        take_plane(r, fap_decoder_plane(r->decoder), &frame);
        const fap_err taken = take_frame(r->summary, r->sink, &frame, r->rate_hz);
        if (taken != FAP_OK)
            return taken;
    }
    if (!r->summary->frames && !r->summary->broken_planes)
        snprintf(r->where, FAP_ERROR_TEXT_SIZE, "no face object plane in it");
    return r->summary->frames ? FAP_OK : FAP_E_BITSTREAM;
}

static fap_err read_bits(memory bytes, const stream_options *options, stream_summary *s,
                         const frame_sink *sink, char *where)
{
    bits_reading r = { .summary = s, .sink = sink, .strict = options->strict, .where = where };
    fap_decoder_config cfg;

    s->format = "fba";
    fap_decoder_config_init(&cfg);
    cfg.strict = options->strict;
    cfg.fit = options->fit;
    cfg.notice = take_notice;
    cfg.notice_user = s;
    cfg.symbol_memory = 65534;
    fap_err err = fap_decoder_open(&r.decoder, &cfg);
    if (err != FAP_OK)
        return err;
    err = fap_decoder_send(r.decoder, bytes.at, bytes.left);
    if (err == FAP_OK)
        err = receive_all(&r);
    fap_decoder_close(&r.decoder);
    return err;
}

int stream_is_bits(const uint8_t *data, size_t size)
{
    static const uint8_t start_code[3] = { 0, 0, 1 };

    return size > sizeof start_code && !memcmp(data, start_code, sizeof start_code);
}

fap_err stream_read(const uint8_t *data, size_t size, const stream_options *options, stream_summary *s,
                    const frame_sink *sink, char *where)
{
    static const stream_options plain = { 0 };
    const memory bytes = { data, size };

    *where = '\0';
    *s = (stream_summary){ .size = size, .header = { .rate_hz = 25 } };
    if (!options)
        options = &plain;
    return (stream_is_bits(data, size) ? read_bits : read_text)(bytes, options, s, sink, where);
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
