/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The FBA encoder's promises, with the decoder as the judge: what is shown is what it says is shown, no value is off
 * by more than it may be, no 2 seconds hold more bits than they may.
 */
#include "tests/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/decoder.h>
#include <fap/encoder.h>

#include "codec/fba.h"

enum { FRAMES_MAX = 2000, NUMBERS_MAX = 8192 };

/* --- takes --- */

typedef struct take {
    int count;
    double rate_hz;
    fap_frame frame[FRAMES_MAX];
} take;

static take given; /* 760 KB: too large for a stack */

static uint32_t draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* Somebody who talks: values run after targets that change now and then, visemes follow each other. */
static void talk(take *t, int count, int faps, uint32_t seed)
{
    int32_t target[FAP_COUNT + 1] = { 0 };
    fap_frame f = { 0 };

    t->count = count;
    t->rate_hz = 25;
    f.state[1] = f.state[2] = FAP_CODED;
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        f.state[fap] = (int)(draw(&seed) % 66) < faps ? FAP_CODED : FAP_ABSENT;
    for (int i = 0; i < count; i++) {
        if (i % 4 == 0)
            f.viseme = (fap_viseme){ f.viseme.select2, draw(&seed) % 15, 63, 0 };
        f.viseme.blend = (uint8_t)(63 - i % 4 * 20);
        f.expression = (fap_expression){ 1, (uint8_t)(i / 8 % 64), 0, 0, 0, 0 };
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            if (draw(&seed) % 16 == 0)
                target[fap] = (int32_t)(draw(&seed) % 401 - 200) * fap_info_get(fap)->quant_step;
            f.value[fap] += (target[fap] - f.value[fap]) / 4;
        }
        f.number = i;
        f.pts_us = (int64_t)i * 40000;
        t->frame[i] = f;
    }
}

static size_t stdio_read(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

static void load(take *t, const char *name)
{
    char path[256];
    fap_ascii_reader *r;

    snprintf(path, sizeof path, "data/fap/%s", name);
    FILE *file = fopen(test_shared(path), "rb");
    assert_int_equal(fap_ascii_reader_open(&r, &(fap_reader){ stdio_read, file }, NULL, NULL), FAP_OK);
    t->rate_hz = fap_ascii_reader_header(r)->rate_hz;
    t->count = 0;
    while (t->count < FRAMES_MAX && fap_ascii_reader_next(r, &t->frame[t->count]) == FAP_OK)
        t->count++;
    fap_ascii_reader_close(&r);
    fclose(file);
}

/* --- through encoder and decoder --- */

/* What a decoder made of it, by frame number. */
typedef struct result {
    fap_encoder_stats stats;
    int packets, empty_packets, shown, planes, last;
    int64_t bits[NUMBERS_MAX];   /* of the planes, as the decoder counts them */
    fap_frame frame[FRAMES_MAX]; /* as the encoder says that they are shown */
} result;

static result got;

static void same_frame(const fap_frame *a, const fap_frame *b)
{
    assert_int_equal(a->number, b->number);
    assert_int_equal(a->pts_us, b->pts_us);
    assert_memory_equal(a->state, b->state, sizeof a->state);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (a->value[fap] != b->value[fap])
            fail_msg("frame %d FAP %d: %d, not %d", (int)a->number, fap, (int)a->value[fap],
                     (int)b->value[fap]);
    assert_memory_equal(&a->viseme, &b->viseme, sizeof a->viseme);
    assert_memory_equal(&a->expression, &b->expression, sizeof a->expression);
}

static void is_held(const fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        assert_true(f->state[fap] == FAP_HELD || f->state[fap] == FAP_ABSENT);
    got.frame[got.shown++] = *f;
}

/* Frames of the packet: those that were sent come out of the decoder, the others hold what was before. */
static fap_err check_frames(fap_decoder *d, const fap_frame *said, int count)
{
    fap_frame f;
    fap_err err;
    int i = 0;

    while ((err = fap_decoder_receive(d, &f)) == FAP_OK) {
        while (i < count && said[i].number != f.number)
            is_held(&said[i++]);
        assert_in_range(i, 0, count - 1);
        same_frame(&f, &said[i]);
        got.frame[got.shown++] = said[i++];
        got.bits[f.number] += fap_decoder_plane(d)->bit_count;
        got.last = (int)f.number;
        got.planes++;
    }
    while (i < count)
        is_held(&said[i++]);
    return err;
}

static fap_err check_packet(fap_encoder *e, fap_decoder *d, uint8_t *data, size_t room)
{
    size_t size;
    int count;

    const fap_err err = fap_encoder_receive(e, data, room, &size);
    if (err != FAP_OK)
        return err;
    const fap_frame *said = fap_encoder_reconstruction(e, &count);
    got.packets++;
    got.empty_packets += size == 0;
    if (!size) {
        for (int i = 0; i < count; i++)
            is_held(&said[i]);
        return FAP_OK;
    }
    assert_int_equal(fap_decoder_send(d, data, size), FAP_OK);
    const int is_end = size >= 4 && data[size - 1] == 0xB1 && data[size - 2] == 1 && !data[size - 3];
    if (is_end && count)
        got.shown--; /* the last frame, which was left out at first */
    const fap_err last = check_frames(d, said, count);
    if (last != (is_end ? FAP_E_END : FAP_E_AGAIN))
        fail_msg("%s", fap_decoder_last_error(d));
    if (is_end)
        got.bits[got.last] += 40; /* stuffing and end code */
    return FAP_OK;
}

static void encode(const take *t, fap_encoder_config *cfg)
{
    fap_encoder *e;
    fap_decoder *d;
    fap_err err;

    memset(&got, 0, sizeof got);
    cfg->rate_hz = t->rate_hz;
    assert_int_equal(fap_encoder_open(&e, cfg), FAP_OK);
    assert_int_equal(fap_decoder_open(&d, &(fap_decoder_config){ .struct_size = sizeof(fap_decoder_config),
                                                                 .strict = 1,
                                                                 .fit = cfg->fit }),
                     FAP_OK);
    const size_t room = fap_encoder_bound(e);
    uint8_t *data = malloc(room);
    assert_non_null(data);
    for (int i = 0; i < t->count; i++) {
        while ((err = fap_encoder_send(e, &t->frame[i])) == FAP_E_AGAIN)
            assert_int_equal(check_packet(e, d, data, room), FAP_OK);
        assert_int_equal(err, FAP_OK);
    }
    fap_encoder_flush(e);
    while ((err = check_packet(e, d, data, room)) == FAP_OK)
        continue;
    assert_int_equal(err, FAP_E_END);
    got.stats = fap_encoder_get_stats(e);
    assert_int_equal(got.shown, t->count);
    assert_int_equal(got.stats.frames, t->count);
    assert_int_equal(got.stats.skipped, t->count - got.planes);
    fap_encoder_close(&e);
    fap_decoder_close(&d);
    free(data);
}

static fap_encoder_config config(fap_encoder_mode mode)
{
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    cfg.mode = mode;
    return cfg;
}

/* --- FAP_ENCODE_QUANT --- */

static void within_half_a_step(const take *t, int quant)
{
    for (int i = 0; i < t->count; i++) {
        const fap_frame *want = &t->frame[i], *f = &got.frame[i];
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            if (want->state[fap] == FAP_CODED)
                assert_in_range(2 * labs((long)want->value[fap] - f->value[fap]), 0,
                                quant ? quant * fap_info_get(fap)->quant_step : 0);
        if (want->state[1] == FAP_CODED) {
            assert_int_equal(f->viseme.select1, want->viseme.select1);
            assert_int_equal(f->viseme.select2, want->viseme.select2);
            assert_in_range(2 * abs(f->viseme.blend - want->viseme.blend), 0, quant);
        }
    }
}

TEST(encoder, no_value_is_off_by_more_than_half_a_step)
{
    static const int quants[] = { 1, 2, 3, 7, 16, 31 }, look_aheads[] = { 0, 1, 33, 250 };

    for (size_t q = 0; q < sizeof quants / sizeof *quants; q++)
        for (size_t l = 0; l < sizeof look_aheads / sizeof *look_aheads; l++) {
            fap_encoder_config cfg = config(FAP_ENCODE_QUANT);
            cfg.quant = quants[q];
            cfg.look_ahead = look_aheads[l];
            cfg.intra = 100;
            talk(&given, 230, 30, (uint32_t)(q + 10 * l));
            encode(&given, &cfg);
            assert_int_equal(got.stats.clipped, 0);
            within_half_a_step(&given, cfg.quant);
        }
}

TEST(encoder, quant_0_loses_nothing_that_a_plane_can_carry)
{
    for (int look_ahead = 0; look_ahead <= 50; look_ahead += 25) {
        fap_encoder_config cfg = config(FAP_ENCODE_QUANT);
        cfg.quant = 0;
        cfg.look_ahead = look_ahead;
        talk(&given, 120, 40, 5);
        for (int i = 0; i < given.count; i++)
            for (int fap = 3; fap <= FAP_COUNT; fap++)
                given.frame[i].value[fap] /= fap_info_get(fap)->quant_step;
        encode(&given, &cfg);
        within_half_a_step(&given, 0);
        assert_float_equal(got.stats.max_error_mm, 0, 0);
    }
}

TEST(encoder, what_a_plane_cannot_carry_is_caught_up_with)
{
    fap_encoder_config cfg = config(FAP_ENCODE_QUANT);

    cfg.quant = 0;
    talk(&given, 40, 0, 1);
    for (int i = 0; i < given.count; i++) {
        given.frame[i].state[5] = FAP_CODED;
        given.frame[i].value[5] = i < 20 ? 10000 : INT32_MIN;
    }
    encode(&given, &cfg);
    assert_true(got.stats.clipped > 0);
    assert_int_equal(got.frame[0].value[5], 1860);
    assert_int_equal(got.frame[4].value[5], 5 * 1860);
    assert_int_equal(got.frame[5].value[5], 10000);
    assert_int_equal(got.frame[39].value[5], 10000 - 20 * 1860);
}

/* S = 2: half of all integers lie between two levels. */
TEST(encoder, a_value_between_two_levels_does_not_make_it_waver)
{
    fap_encoder_config cfg = config(FAP_ENCODE_QUANT);

    talk(&given, 50, 0, 1);
    for (int i = 0; i < given.count; i++) {
        given.frame[i].state[4] = FAP_CODED;
        given.frame[i].value[4] = 7;
    }
    encode(&given, &cfg);
    for (int i = 1; i < given.count; i++)
        assert_int_equal(got.frame[i].value[4], got.frame[0].value[4]);
}

/* --- look-ahead --- */

TEST(encoder, without_look_ahead_every_frame_is_a_packet)
{
    static const fap_encoder_mode modes[] = { FAP_ENCODE_QUANT, FAP_ENCODE_BITRATE, FAP_ENCODE_ERROR };

    talk(&given, 120, 20, 9);
    for (int m = 0; m < 3; m++)
        for (int plane_codes = 0; plane_codes < 2; plane_codes++) {
            fap_encoder_config cfg = config(modes[m]);
            cfg.look_ahead = 0;
            cfg.plane_codes = plane_codes;
            encode(&given, &cfg);
            assert_int_equal(got.packets, given.count + 1);
        }
}

TEST(encoder, packets_in_a_row_are_a_stream)
{
    fap_encoder *e;
    fap_encoder_config cfg = config(FAP_ENCODE_QUANT);
    static uint8_t data[1 << 17];
    size_t at = 0, size;
    fap_decoder *d;
    fap_frame f;

    talk(&given, 90, 20, 3);
    cfg.look_ahead = 0;
    cfg.plane_codes = 1;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    for (int i = 0; i <= given.count; i++) {
        if (i < given.count)
            assert_int_equal(fap_encoder_send(e, &given.frame[i]), FAP_OK);
        else
            fap_encoder_flush(e);
        assert_int_equal(fap_encoder_receive(e, data + at, sizeof data - at, &size), FAP_OK);
        at += size;
    }
    fap_encoder_close(&e);
    assert_int_equal(fap_decoder_open(&d, NULL), FAP_OK);
    assert_int_equal(fap_decoder_send(d, data, at), FAP_OK);
    for (int i = 0; i < given.count; i++) {
        assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
        assert_int_equal(f.number, i);
    }
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_END);
    fap_decoder_close(&d);
}

/* --- FAP_ENCODE_BITRATE --- */

/* Counted over the planes that came out of the decoder, for every frame that a window can begin with. */
static int64_t fullest_window(double rate_hz)
{
    int frames = (int)(2 * rate_hz);
    int64_t most = 0;

    frames += frames < 2 * rate_hz;
    for (int first = 0; first <= got.last; first++) {
        int64_t sum = 0;
        for (int i = first; i < first + frames && i < NUMBERS_MAX; i++)
            sum += got.bits[i];
        most = sum > most ? sum : most;
    }
    return most;
}

static void keeps_the_bitrate(int bitrate, int look_ahead, int plane_codes, int intra)
{
    fap_encoder_config cfg = config(FAP_ENCODE_BITRATE);

    cfg.bitrate_bps = bitrate;
    cfg.look_ahead = look_ahead;
    cfg.plane_codes = plane_codes;
    cfg.intra = intra;
    encode(&given, &cfg);
    assert_in_range(fullest_window(given.rate_hz), 0, 2 * bitrate);
    assert_in_range(got.stats.largest_window_bits, 0, 2 * bitrate);
}

TEST(encoder, no_2_seconds_hold_more_bits_than_they_may)
{
    static const int bitrates[] = { 100, 500, 1000, 2000, 8000 };

    for (size_t b = 0; b < sizeof bitrates / sizeof *bitrates; b++) {
        talk(&given, 160, (int)b * 15, (uint32_t)b);
        keeps_the_bitrate(bitrates[b], 250, b % 2, 100);
        keeps_the_bitrate(bitrates[b], 30, 0, 100);
        keeps_the_bitrate(bitrates[b], 0, 0, 60);
        keeps_the_bitrate(bitrates[b], 0, 1, 7);
    }
}

TEST(encoder, real_takes_keep_the_bitrate)
{
    static const int bitrates[] = { 500, 1000, 2000, 8000 };

    for (size_t b = 0; b < sizeof bitrates / sizeof *bitrates; b++) {
        load(&given, "vreng_jag.fap");
        keeps_the_bitrate(bitrates[b], 250, 0, 250);
        keeps_the_bitrate(bitrates[b], 0, 0, 250);
        load(&given, "metaface_th-example-plain.fap");
        given.count = 400;
        keeps_the_bitrate(bitrates[b], 250, 0, 250);
    }
}

/* 0.046 mm when this was written; fap_quant 4 throughout takes about as many bits and is off by 0.068 mm. */
TEST(encoder, a_talking_head_is_well_shown_at_2_kbit_a_second)
{
    fap_encoder_config cfg = config(FAP_ENCODE_BITRATE);

    load(&given, "metaface_th-example-plain.fap");
    encode(&given, &cfg);
    assert_true(got.stats.mean_error_mm < 0.08);
    assert_in_range(got.stats.largest_window_bits, 2000, 4000);
}

TEST(encoder, live_a_talking_head_is_still_shown)
{
    fap_encoder_config cfg = config(FAP_ENCODE_BITRATE);

    load(&given, "metaface_th-example-plain.fap");
    cfg.look_ahead = 0;
    for (cfg.bitrate_bps = 1000; cfg.bitrate_bps <= 4000; cfg.bitrate_bps *= 2) {
        encode(&given, &cfg);
        assert_in_range(fullest_window(given.rate_hz), 0, 2 * cfg.bitrate_bps);
        assert_true(got.planes > given.count / 4);
        assert_true(got.stats.mean_error_mm < 1.5);
    }
}

/* --- FAP_ENCODE_ERROR --- */

static void all_within(double mm)
{
    fap_sensitivity s;
    fap_frame_error error;

    fap_sensitivity_typical(&s);
    for (int i = 0; i < given.count; i++) {
        fap_sensitivity_compare(&s, &given.frame[i], &got.frame[i], &error);
        if (error.max_nm > mm * 1e6)
            fail_msg("frame %d FAP %d is off by %u nm", i, error.max_fap, (unsigned)error.max_nm);
    }
}

TEST(encoder, no_place_is_off_by_more_than_is_asked_for)
{
    static const double errors[] = { 0.5, 1, 2 };
    static const int look_aheads[] = { 0, 30, 250 };

    for (int i = 0; i < 9; i++) {
        fap_encoder_config cfg = config(FAP_ENCODE_ERROR);
        cfg.max_error_mm = errors[i / 3];
        cfg.look_ahead = look_aheads[i % 3];
        talk(&given, 150, 12 * (i % 5), (uint32_t)i);
        encode(&given, &cfg);
        assert_int_equal(got.stats.clipped, 0);
        all_within(cfg.max_error_mm);
    }
}

TEST(encoder, more_error_takes_fewer_bits)
{
    int64_t bytes = INT64_MAX;

    load(&given, "metaface_th-example-plain.fap");
    for (double mm = 0.25; mm < 3; mm *= 2) {
        fap_encoder_config cfg = config(FAP_ENCODE_ERROR);
        cfg.max_error_mm = mm;
        encode(&given, &cfg);
        assert_true(got.stats.max_error_mm <= mm);
        assert_true(got.stats.bytes < bytes);
        bytes = got.stats.bytes;
    }
}

/* --- what is left to the decoder --- */

/* Both sides alike, and both contours of the lips. */
static void make_symmetric(take *t)
{
    for (int i = 0; i < t->count; i++)
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            const int other =
                fap_lip_pair(fap) && fap_lip_pair(fap) < fap ? fap_lip_pair(fap) : fap_mirror(fap);
            if (other && other < fap)
                t->frame[i].value[fap] = t->frame[i].value[other];
        }
}

TEST(encoder, faps_that_follow_from_others_are_not_sent)
{
    for (int mode = FAP_ENCODE_QUANT; mode <= FAP_ENCODE_ERROR; mode++) {
        fap_encoder_config cfg = config((fap_encoder_mode)mode);
        talk(&given, 120, 66, 8);
        make_symmetric(&given);
        cfg.derive = 0;
        cfg.bitrate_bps = 16000;
        encode(&given, &cfg);
        const int64_t bytes = got.stats.bytes;
        assert_int_equal(got.stats.derived, 0);
        cfg.derive = 1;
        encode(&given, &cfg);
        assert_true(got.stats.derived > 20 * 100);
        assert_true(got.stats.bytes * 10 < bytes * 9);
        if (mode == FAP_ENCODE_QUANT)
            within_half_a_step(&given, cfg.quant);
        if (mode == FAP_ENCODE_ERROR)
            all_within(cfg.max_error_mm);
    }
}

TEST(encoder, no_fap_is_derived_that_the_source_does_not_have)
{
    for (uint32_t seed = 0; seed < 6; seed++) {
        fap_encoder_config cfg = config(FAP_ENCODE_QUANT);
        cfg.derive = 1;
        talk(&given, 60, 25 + 6 * (int)seed, seed);
        make_symmetric(&given);
        encode(&given, &cfg);
        within_half_a_step(&given, cfg.quant);
        for (int i = 0; i < given.count; i++)
            for (int fap = 1; fap <= FAP_COUNT; fap++)
                assert_int_equal(got.frame[i].state[fap] == FAP_ABSENT,
                                 given.frame[i].state[fap] == FAP_ABSENT);
    }
}

TEST(encoder, an_interpolation_table_is_used)
{
    static const char text[] = "fap-fit 1\nfrom f3\n    f18 = 0.5*f3\n";
    fap_fit *fit;
    fap_encoder_config cfg = config(FAP_ENCODE_ERROR);

    assert_int_equal(fap_fit_parse(&fit, text, sizeof text - 1, NULL, NULL), FAP_OK);
    talk(&given, 100, 0, 8);
    for (int i = 0; i < given.count; i++) {
        given.frame[i].state[3] = given.frame[i].state[18] = FAP_CODED;
        given.frame[i].value[3] = i % 40 * 20;
        given.frame[i].value[18] = i % 40 * 10;
    }
    cfg.fit = fit;
    encode(&given, &cfg);
    assert_int_equal(got.stats.derived, got.planes);
    all_within(cfg.max_error_mm);
    fap_fit_close(&fit);
}

/* --- skip, time codes, memory --- */

TEST(encoder, frames_that_change_nothing_can_be_left_out)
{
    for (int look_ahead = 0; look_ahead <= 250; look_ahead += 250) {
        fap_encoder_config cfg = config(FAP_ENCODE_ERROR);
        cfg.look_ahead = look_ahead;
        talk(&given, 100, 20, 1);
        for (int i = 20; i < given.count; i++) {
            given.frame[i] = given.frame[20];
            given.frame[i].number = i;
            given.frame[i].pts_us = (int64_t)i * 40000;
        }
        encode(&given, &cfg);
        assert_in_range(got.planes, 2, 25);
        assert_int_equal(got.last, given.count - 1);
        assert_int_equal(got.frame[60].state[1], FAP_HELD);
        cfg.skip = 0;
        encode(&given, &cfg);
        assert_int_equal(got.planes, given.count);
    }
}

TEST(encoder, i_planes_on_a_full_second_carry_a_time_code)
{
    fap_encoder *e;
    fap_encoder_config cfg = config(FAP_ENCODE_QUANT);
    uint8_t data[65536];
    size_t size;
    int seconds = 0;

    talk(&given, 121, 5, 2);
    cfg.intra = 20; /* every fifth I plane is on a full second... */
    cfg.time_codes = 1;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    for (int i = 0, packet = 0; i < given.count; i++)
        while (fap_encoder_send(e, &given.frame[i]) == FAP_E_AGAIN) {
            assert_int_equal(fap_encoder_receive(e, data, sizeof data, &size), FAP_OK);
            fap_bits b;
            fap_bits_init(&b, data, size);
            const int has_code = fap_bits_peek(&b, 32 + 1 + 2 + 1 + 13, 1) != 0;
            assert_int_equal(has_code, packet * 20 % 25 == 0);
            if (has_code)
                seconds = (int)fap_bits_peek(&b, 32 + 18 + 5 + 6 + 1, 6);
            packet++;
        }
    fap_encoder_close(&e);
    assert_int_equal(seconds, 4);
    cfg.intra = 50;
    encode(&given, &cfg);
}

typedef struct scarce {
    int left, taken;
} scarce;

static void *scarce_alloc(void *user, size_t size)
{
    scarce *s = user;

    if (!s->left)
        return NULL;
    s->left--;
    s->taken++;
    return malloc(size);
}

static void scarce_free(void *user, void *ptr)
{
    ((scarce *)user)->taken--;
    free(ptr);
}

TEST(encoder, too_little_memory_is_said_and_given_back)
{
    for (int mode = FAP_ENCODE_QUANT; mode <= FAP_ENCODE_ERROR; mode++) {
        fap_err err = FAP_E_NOMEM;
        for (int left = 0; err != FAP_OK; left++) {
            scarce s = { left, 0 };
            fap_encoder_config cfg = config((fap_encoder_mode)mode);
            fap_encoder *e;
            cfg.alloc = (fap_allocator){ scarce_alloc, scarce_free, &s };
            err = fap_encoder_open(&e, &cfg);
            assert_true(err == FAP_OK ? e != NULL : err == FAP_E_NOMEM && !e);
            fap_encoder_close(&e);
            assert_int_equal(s.taken, 0);
            assert_in_range(left, 0, 100);
        }
    }
}

TEST(encoder, options_out_of_range_are_refused)
{
    fap_encoder *e;
    fap_encoder_config cfg = config(FAP_ENCODE_BITRATE);

    cfg.bitrate_bps = 99;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_E_ARG);
    cfg = config(FAP_ENCODE_ERROR);
    cfg.max_error_mm = 0;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_E_ARG);
    cfg = config(FAP_ENCODE_QUANT);
    cfg.look_ahead = -1;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_E_ARG);
    cfg = config((fap_encoder_mode)7);
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_E_ARG);
    cfg = config(FAP_ENCODE_QUANT);
    cfg.intra = 10001;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_E_ARG);
    assert_null(e);
}
