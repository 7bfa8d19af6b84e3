/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Encodes frames made in integers, in every mode, decodes them again, and prints a checksum of the bytes and one of the frames
 * for each way. tests/cross/run compares the lines of several machines. Needs libfap alone.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>

enum { FRAMES = 120 };

static const char fit_text[] = "fap-fit 1\n"
                               "from f3\n"
                               "f4 = -0.35*f3 + 1.5e-5*f3^2\n"
                               "f5 = -0.4*f3\n"
                               "from f48 viseme_select1\n"
                               "f49 = (7*f48^2 + 3 + 2*[viseme_select1 = 3])/(f48^2 + 10)\n";

typedef struct way {
    const char *name;
    fap_encoder_mode mode;
    int quant, bitrate_bps;
    double max_error_mm, rate_hz;
    int intra, look_ahead, derive, skip, plane_codes, time_codes, fit;
} way;

static const way ways[] = {
    { "quant 0", FAP_ENCODE_QUANT, 0, 0, 0, 25, 30, 30, -1, -1, 0, 0, 0 },
    { "quant 1", FAP_ENCODE_QUANT, 1, 0, 0, 25, 250, 250, -1, -1, 1, 1, 0 },
    { "quant 7 live", FAP_ENCODE_QUANT, 7, 0, 0, 30000 / 1001.0, 25, 0, -1, -1, 0, 0, 0 },
    { "quant 4 derived", FAP_ENCODE_QUANT, 4, 0, 0, 25, 50, 50, 1, 1, 0, 1, 1 },
    { "quant 31", FAP_ENCODE_QUANT, 31, 0, 0, 12.5, 40, 20, 1, 0, 0, 0, 0 },
    { "2 kbit/s", FAP_ENCODE_BITRATE, 0, 2000, 0, 25, 50, 50, -1, -1, 0, 0, 0 },
    { "6 kbit/s live", FAP_ENCODE_BITRATE, 0, 6000, 0, 25, 50, 0, -1, -1, 0, 0, 0 },
    { "0.8 kbit/s", FAP_ENCODE_BITRATE, 0, 800, 0, 25, 60, 60, 1, 1, 0, 0, 1 },
    { "0.5 mm", FAP_ENCODE_ERROR, 0, 0, 0.5, 25, 50, 50, -1, -1, 0, 0, 1 },
    { "2 mm live", FAP_ENCODE_ERROR, 0, 0, 2, 25, 50, 0, -1, -1, 0, 0, 0 },
};

static uint32_t draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* A triangle wave: a period of FAP's own, amplitude 1..512. */
static int32_t wave(int i, int fap)
{
    const int period = 20 + fap % 17, at = (i + fap) % period, half = period / 2;

    return ((at < half ? at : period - at) * 1024 / half - 512) * (1 + fap % 8) / 8;
}

/* Talking for a while, then still, then with another mask. */
static void make_frame(fap_frame *f, int i, uint32_t *seed)
{
    f->number = i;
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        f->state[fap] = (fap * 7 + i / 80) % 3 ? FAP_CODED : FAP_ABSENT;
        if (fap > 2 && !(i >= 60 && i < 75))
            f->value[fap] = wave(i, fap) + (int32_t)(draw(seed) % 5) - 2;
    }
    f->viseme = (fap_viseme){ (uint8_t)(i / 5 % 15), (uint8_t)(i / 5 % 14 + 1), (uint8_t)(i * 12 % 64), 0 };
    f->expression = (fap_expression){ (uint8_t)(i / 40 % 7), (uint8_t)(i % 64), 2, 20, 0, 0 };
}

typedef struct result {
    uint32_t bytes, frames;
    long size, count;
} result;

static void add(uint32_t *checksum, const void *data, size_t size)
{
    const unsigned char *p = data;

    while (size--)
        *checksum = (*checksum ^ *p++) * 16777619u;
}

static void add_number(uint32_t *checksum, int64_t v)
{
    for (int k = 0; k < 8; k++)
        *checksum = (*checksum ^ (uint32_t)((uint64_t)v >> 8 * k & 255)) * 16777619u;
}

static void add_frame(result *r, const fap_frame *f)
{
    r->count++;
    add_number(&r->frames, f->number);
    add_number(&r->frames, f->pts_us);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        add_number(&r->frames, f->state[fap]);
        add_number(&r->frames, f->value[fap]);
    }
    add(&r->frames, &f->viseme, sizeof f->viseme);
    add(&r->frames, &f->expression, sizeof f->expression);
}

typedef struct chain {
    fap_encoder *e;
    fap_decoder *d;
    uint8_t *data;
    size_t room;
    result r;
} chain;

static fap_err take_packet(chain *c)
{
    size_t size;
    fap_frame f;
    fap_err err = fap_encoder_receive(c->e, c->data, c->room, &size);

    if (err != FAP_OK)
        return err;
    add(&c->r.bytes, c->data, size);
    c->r.size += (long)size;
    if (!size)
        return FAP_OK;
    err = fap_decoder_send(c->d, c->data, size);
    while (err == FAP_OK && (err = fap_decoder_receive(c->d, &f)) == FAP_OK)
        add_frame(&c->r, &f);
    return err == FAP_E_AGAIN || err == FAP_E_END ? FAP_OK : err;
}

static fap_err take_packets(chain *c)
{
    fap_err err;

    do
        err = take_packet(c);
    while (err == FAP_OK);
    return err;
}

static fap_err encode_all(chain *c, const way *w)
{
    uint32_t seed = 1;
    fap_frame f;
    fap_err err = FAP_OK;

    memset(&f, 0, sizeof f);
    for (int i = 0; i < FRAMES && err == FAP_OK; i++) {
        make_frame(&f, i, &seed);
        f.pts_us = (int64_t)(i * 1000000.0 / w->rate_hz + 0.5);
        while ((err = fap_encoder_send(c->e, &f)) == FAP_E_AGAIN)
            if ((err = take_packets(c)) != FAP_E_AGAIN)
                return err;
    }
    if (err != FAP_OK)
        return err;
    fap_encoder_flush(c->e);
    return take_packets(c);
}

static fap_err open_chain(chain *c, const way *w, const fap_fit *fit)
{
    fap_encoder_config cfg;
    fap_decoder_config dec;

    fap_encoder_config_init(&cfg);
    fap_decoder_config_init(&dec);
    cfg.mode = w->mode;
    cfg.quant = w->mode == FAP_ENCODE_QUANT ? w->quant : cfg.quant;
    cfg.bitrate_bps = w->bitrate_bps ? w->bitrate_bps : cfg.bitrate_bps;
    cfg.max_error_mm = w->max_error_mm > 0 ? w->max_error_mm : cfg.max_error_mm;
    cfg.rate_hz = w->rate_hz;
    cfg.intra = w->intra;
    cfg.look_ahead = w->look_ahead;
    cfg.derive = w->derive;
    cfg.skip = w->skip;
    cfg.plane_codes = w->plane_codes;
    cfg.time_codes = w->time_codes;
    cfg.fit = dec.fit = w->fit ? fit : NULL;
    const fap_err err = fap_encoder_open(&c->e, &cfg);
    return err == FAP_OK ? fap_decoder_open(&c->d, &dec) : err;
}

static int run(const way *w, const fap_fit *fit)
{
    chain c = { .r = { 2166136261u, 2166136261u, 0, 0 } };
    fap_err err = open_chain(&c, w, fit);

    if (err == FAP_OK) {
        c.room = fap_encoder_bound(c.e);
        c.data = malloc(c.room);
        err = c.data ? encode_all(&c, w) : FAP_E_NOMEM;
    }
    printf("%-16s %6ld bytes %08lx %4ld frames %08lx\n", w->name, c.r.size, (unsigned long)c.r.bytes,
           c.r.count, (unsigned long)c.r.frames);
    if (err != FAP_E_END)
        printf("%s: %s %s\n", w->name, fap_strerror(err), fap_decoder_last_error(c.d));
    free(c.data);
    fap_encoder_close(&c.e);
    fap_decoder_close(&c.d);
    return err == FAP_E_END;
}

int main(void)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_fit *fit;
    int ok = fap_fit_parse(&fit, fit_text, sizeof fit_text - 1, NULL, where) == FAP_OK;

    if (!ok)
        printf("%s\n", where);
    for (size_t i = 0; ok && i < sizeof ways / sizeof *ways; i++)
        ok = run(&ways[i], fit);
    fap_fit_close(&fit);
    return !ok;
}
