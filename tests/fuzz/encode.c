/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any settings and any frames through the FBA encoder. Its stream must decode, strictly, to what the encoder says is
 * shown; a bitrate must be kept in any 2 seconds; without memory it must not open, and give back what it took. The
 * input is read as settings and then as changes from frame to frame; behind its end all is 0.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAX_FRAMES = 96, MAX_NUMBERS = MAX_FRAMES * 4 + 16 };

typedef struct input {
    const uint8_t *data;
    size_t size, at;
} input;

typedef struct scarce {
    int left, taken; /* left -1: plenty */
} scarce;

/* What the decoder received. */
typedef struct stream {
    fap_encoder *encoder;
    fap_decoder *decoder;
    uint8_t *data;
    size_t room;
    int64_t bits[MAX_NUMBERS]; /* by frame number */
    int last;
} stream;

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

static unsigned byte(input *in)
{
    return in->at < in->size ? in->data[in->at++] : 0;
}

static int32_t word(input *in)
{
    const unsigned high = byte(in);
    return (int16_t)(high << 8 | byte(in));
}

static void *scarce_alloc(void *user, size_t size)
{
    scarce *s = user;

    if (!s->left)
        return NULL;
    s->left -= s->left > 0;
    s->taken++;
    return malloc(size);
}

static void scarce_free(void *user, void *ptr)
{
    ((scarce *)user)->taken--;
    free(ptr);
}

static fap_encoder_config read_settings(input *in)
{
    static const double rates[] = { 25, 1, 5, 29.97, 60, 0.5, 12.5, 100 };
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    const unsigned flags = byte(in);
    cfg.mode = (fap_encoder_mode)(flags % 3);
    cfg.derive = flags >> 2 & 1;
    cfg.skip = flags >> 3 & 1;
    cfg.plane_codes = flags >> 4 & 1;
    cfg.time_codes = flags >> 5 & 1;
    cfg.gender = flags >> 6 & 1;
    cfg.quant = (int)byte(in) % 32;
    cfg.bitrate_bps = 100 + (int)byte(in) * (int)byte(in);
    cfg.max_error_mm = 0.01 + byte(in) * 0.05;
    cfg.intra = 1 + (int)byte(in) % 80;
    cfg.look_ahead = (int)byte(in) % 80;
    cfg.rate_hz = rates[byte(in) % 8];
    return cfg;
}

/* --- frames --- */

static void change_value(input *in, fap_frame *f)
{
    const unsigned what = byte(in), fap = 1 + what % 68;

    if (what >= 204)
        f->state[fap] = (uint8_t)(f->state[fap] == FAP_CODED ? what & 2 : FAP_CODED);
    else if (what >= 136)
        f->value[fap] = (int32_t)((uint32_t)word(in) << (byte(in) % 17));
    else
        f->value[fap] = (int32_t)((uint32_t)f->value[fap] + (uint32_t)(word(in) % 2000));
}

static void change_mixes(input *in, fap_frame *f)
{
    f->viseme = (fap_viseme){ (uint8_t)(byte(in) % 15), (uint8_t)(byte(in) % 15), (uint8_t)(byte(in) % 64),
                              (uint8_t)(byte(in) % 2) };
    f->expression =
        (fap_expression){ (uint8_t)(byte(in) % 7),  (uint8_t)(byte(in) % 64), (uint8_t)(byte(in) % 7),
                          (uint8_t)(byte(in) % 64), (uint8_t)(byte(in) & 1),  (uint8_t)(byte(in) & 1) };
}

static void change_frame(input *in, fap_frame *f, double rate_hz)
{
    const unsigned what = byte(in);

    for (unsigned i = 0; i < what % 8; i++)
        change_value(in, f);
    if (what & 8)
        change_mixes(in, f);
    f->pts_us += (int64_t)(1e6 / rate_hz * (1 + (what >> 4) % 4));
}

static void first_frame(input *in, fap_frame *f)
{
    const unsigned every = byte(in) % 8;

    for (unsigned fap = 1; fap <= FAP_COUNT; fap++)
        f->state[fap] = every && fap % every == 0 ? FAP_CODED : FAP_ABSENT;
}

/* --- the stream --- */

static void same(const fap_frame *a, const fap_frame *b)
{
    check(a->pts_us == b->pts_us && !memcmp(a->state, b->state, sizeof a->state));
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        check(a->value[fap] == b->value[fap]);
    check(!memcmp(&a->viseme, &b->viseme, sizeof a->viseme));
    check(!memcmp(&a->expression, &b->expression, sizeof a->expression));
}

static void check_planes(stream *s, size_t size)
{
    fap_frame f;
    fap_err err;
    int count, i = 0;
    const fap_frame *said = fap_encoder_reconstruction(s->encoder, &count);

    check(fap_decoder_send(s->decoder, s->data, size) == FAP_OK);
    while ((err = fap_decoder_receive(s->decoder, &f)) == FAP_OK) {
        while (i < count && said[i].number != f.number)
            i++;
        check(i < count && f.number < MAX_NUMBERS);
        same(&f, &said[i++]);
        s->bits[f.number] += fap_decoder_plane(s->decoder)->bit_count;
        s->last = (int)f.number;
    }
    check(err == FAP_E_AGAIN || err == FAP_E_END);
    if (err == FAP_E_END)
        s->bits[s->last] += 32;
}

static fap_err check_packets(stream *s)
{
    size_t size;
    fap_err err;

    while ((err = fap_encoder_receive(s->encoder, s->data, s->room, &size)) == FAP_OK)
        if (size)
            check_planes(s, size);
    return err;
}

static void check_windows(const stream *s, const fap_encoder_config *cfg)
{
    int frames = (int)(2 * cfg->rate_hz);

    frames += frames < 2 * cfg->rate_hz;
    for (int first = 0; first <= s->last; first++) {
        int64_t sum = 0;
        for (int i = first; i < first + frames && i < MAX_NUMBERS; i++)
            sum += s->bits[i];
        check(sum <= 2 * (int64_t)cfg->bitrate_bps);
    }
}

static void run(input *in, const fap_encoder_config *cfg, stream *s)
{
    fap_frame f = { 0 };
    fap_err err;
    int64_t sent = 0;

    s->room = fap_encoder_bound(s->encoder);
    s->data = malloc(s->room);
    check(s->data != NULL);
    first_frame(in, &f);
    for (int i = 0; i < MAX_FRAMES && (i == 0 || in->at < in->size); i++) {
        change_frame(in, &f, cfg->rate_hz);
        while ((err = fap_encoder_send(s->encoder, &f)) == FAP_E_AGAIN)
            check(check_packets(s) == FAP_E_AGAIN);
        check(err == FAP_OK || err == FAP_E_LIMIT);
        sent += err == FAP_OK;
    }
    fap_encoder_flush(s->encoder);
    check(check_packets(s) == FAP_E_END);
    const fap_encoder_stats stats = fap_encoder_get_stats(s->encoder);
    check(stats.frames == sent);
    check(cfg->mode != FAP_ENCODE_ERROR || stats.clipped || stats.mean_error_mm <= stats.max_error_mm);
    if (cfg->mode == FAP_ENCODE_BITRATE)
        check_windows(s, cfg);
    free(s->data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input in = { data, size, 0 };
    fap_encoder_config cfg = read_settings(&in);
    scarce memory = { (int)byte(&in) % 40, 0 };
    fap_decoder_config strict;
    static stream s;

    s = (stream){ 0 };
    cfg.alloc = (fap_allocator){ scarce_alloc, scarce_free, &memory };
    const fap_err err = fap_encoder_open(&s.encoder, &cfg);
    check(err == FAP_OK || (err == FAP_E_NOMEM && !s.encoder && !memory.taken));
    fap_encoder_close(&s.encoder);
    check(!memory.taken);
    memory.left = -1;
    check(fap_encoder_open(&s.encoder, &cfg) == FAP_OK);
    fap_decoder_config_init(&strict);
    strict.strict = 1;
    check(fap_decoder_open(&s.decoder, &strict) == FAP_OK);
    run(&in, &cfg, &s);
    fap_encoder_close(&s.encoder);
    fap_decoder_close(&s.decoder);
    check(!memory.taken);
    return 0;
}
