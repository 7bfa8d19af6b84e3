/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Encoders that are known to deviate are recognised, named, and refused in strict mode; sound streams are not taken for
 * theirs. And what is wrong with a body does not cost the face.
 */
#include "tests/test.h"

#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>

#include "codec/arith.h"

enum { PITCH_STEP = 170, QUANT = 1 };

typedef struct stream {
    uint8_t data[8192];
    fap_bit_writer w;
    uint16_t count[4096]; /* of P symbols */
} stream;

static void put_code(stream *s, uint32_t code)
{
    fap_bits_put(&s->w, 32, 0x00000100 | code);
}

static stream *begin(void)
{
    stream *s = calloc(1, sizeof *s);

    assert_non_null(s);
    fap_bit_writer_init(&s->w, s->data, sizeof s->data);
    put_code(s, 0xBA);
    return s;
}

static void put_run(stream *s, int size, int symbol, int adapts)
{
    uint32_t above = 0;
    arith_encoder a;

    for (int i = symbol + 1; i < size; i++)
        above += adapts ? s->count[i] : 1;
    uint32_t total = above + (adapts ? s->count[symbol] : 1);
    const arith_interval where = { above, total, 0 };
    for (int i = 0; i < symbol; i++)
        total += adapts ? s->count[i] : 1;
    fap_arith_encoder_begin(&a, &s->w);
    fap_arith_encoder_put(&a, (arith_interval){ where.low, where.high, total });
    fap_arith_encoder_end(&a);
    s->count[symbol] += adapts;
}

/* An I plane of head pitch alone, without range tables; @p body: fba_object_mask 3. */
static void put_intra(stream *s, int level, int bound, int body)
{
    fap_bits_put(&s->w, 1, 1);
    fap_bits_put(&s->w, 2, body ? 3 : 1);
    fap_bits_put(&s->w, 3, 0); /* no frame rate, time code, skip */
    fap_bits_put(&s->w, 5, QUANT);
    for (int group = 1; group <= 10; group++) {
        fap_bits_put(&s->w, 3, group == 7 ? 5 : 4); /* marker, fap_mask_type */
        if (group == 7)
            fap_bits_put(&s->w, 3, 4);
    }
    fap_bits_put(&s->w, 6, 0); /* gender, coding type, flags */
    put_run(s, 2 * bound + 1, level + bound, 0);
    for (int i = 0; i <= 2 * bound; i++)
        s->count[i] = 1;
}

static void put_predicted(stream *s, int difference, int bound)
{
    fap_bits_put(&s->w, 4, 2); /* P, face, no skip */
    put_run(s, 2 * bound + 1, difference + bound, 1);
}

static size_t end(stream *s)
{
    fap_bits_put_stuffing(&s->w);
    put_code(s, 0xB1);
    return (size_t)s->w.at / 8;
}

typedef struct notices {
    int count;
    char text[8][160];
} notices;

static void take_notice(void *user, int64_t bit, const char *text)
{
    notices *n = user;

    (void)bit;
    assert_true(n->count < 8);
    strcpy(n->text[n->count++], text);
}

static fap_decoder *decode(const stream *s, size_t size, int strict, notices *n)
{
    fap_decoder_config cfg;
    fap_decoder *d;

    memset(n, 0, sizeof *n);
    fap_decoder_config_init(&cfg);
    cfg.strict = strict;
    cfg.notice = take_notice;
    cfg.notice_user = n;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, s->data, size), FAP_OK);
    return d;
}

static int32_t next_pitch(fap_decoder *d)
{
    fap_frame f;

    assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
    return f.value[48] / PITCH_STEP;
}

static void check_end(fap_decoder *d)
{
    fap_frame f;

    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_END);
    fap_decoder_close(&d);
}

/* FAP 48 has +-1860 for I planes and +-600 for P planes in the table. */
static stream *silent_stream(int planes)
{
    stream *s = begin();

    put_intra(s, 50, 1020, 0);
    for (int i = 1; i < planes; i++)
        put_predicted(s, i % 7 - 3, 1020);
    return s;
}

TEST(fba_deviation, unsaid_ranges_are_recognised)
{
    for (int planes = 1; planes < 40; planes += 6) {
        stream *s = silent_stream(planes);
        notices n;
        fap_decoder *d = decode(s, end(s), 0, &n);
        int32_t level = 50;

        assert_int_equal(next_pitch(d), level);
        for (int i = 1; i < planes; i++)
            assert_int_equal(next_pitch(d), level += i % 7 - 3);
        check_end(d);
        assert_int_equal(n.count, 1);
        assert_non_null(strstr(n.text[0], "+-1020"));
        free(s);
    }
}

TEST(fba_deviation, unsaid_ranges_are_refused_in_strict_mode)
{
    stream *s = silent_stream(9);
    notices n;
    fap_decoder *d = decode(s, end(s), 1, &n);
    fap_frame f;

    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_BITSTREAM);
    assert_non_null(strstr(fap_decoder_last_error(d), "+-1020"));
    fap_decoder_close(&d);
    free(s);
}

TEST(fba_deviation, the_standards_ranges_are_not_mistaken)
{
    for (int level = -1800; level <= 1800; level += 37) {
        stream *s = begin();
        notices n;

        put_intra(s, level, 1860, 0);
        for (int i = 0; i <= 1200; i++)
            s->count[i] = 1;
        put_predicted(s, 3, 600);
        put_predicted(s, level / 4, 600);
        fap_decoder *d = decode(s, end(s), 1, &n);
        assert_int_equal(next_pitch(d), level);
        assert_int_equal(next_pitch(d), level + 3);
        assert_int_equal(next_pitch(d), level + 3 + level / 4);
        check_end(d);
        free(s);
    }
}

/* --- expressions; streams that swap them are in tests/conformance --- */

static size_t encode_expressions(uint8_t *data, size_t room, const fap_expression *e, int count)
{
    fap_encoder_config cfg;
    fap_encoder *enc;
    size_t size = 0, n;

    fap_encoder_config_init(&cfg);
    assert_int_equal(fap_encoder_open(&enc, &cfg), FAP_OK);
    for (int i = 0; i < count; i++) {
        fap_frame f = { .number = i, .pts_us = (int64_t)i * 40000, .expression = e[i] };
        f.state[2] = FAP_CODED;
        assert_int_equal(fap_encoder_send(enc, &f), FAP_OK);
    }
    fap_encoder_flush(enc);
    uint8_t *packet = malloc(fap_encoder_bound(enc));
    while (fap_encoder_receive(enc, packet, fap_encoder_bound(enc), &n) == FAP_OK) {
        assert_true(size + n <= room);
        memcpy(data + size, packet, n);
        size += n;
    }
    free(packet);
    fap_encoder_close(&enc);
    return size;
}

/* Expressions that come and go, two at a time, some of them selected before they are felt. */
TEST(fba_deviation, sound_expressions_are_left_alone)
{
    fap_expression coded[60];
    stream s;
    notices n;
    fap_frame f;

    for (int i = 0; i < 60; i++)
        coded[i] =
            (fap_expression){ 1, (uint8_t)(i < 3 ? 0 : i), 3, (uint8_t)(i < 30 ? 0 : 2 * i - 60), 0, 0 };
    const size_t size = encode_expressions(s.data, sizeof s.data, coded, 60);
    fap_decoder *d = decode(&s, size, 1, &n);
    for (int i = 0; i < 60; i++) {
        assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
        assert_memory_equal(&f.expression, &coded[i], sizeof coded[i]);
    }
    check_end(d);
}

/* --- stuffing, bodies --- */

TEST(fba_deviation, wrong_stuffing_is_told)
{
    stream *s = begin();
    notices n;
    fap_frame f;

    put_intra(s, 10, 1860, 0);
    assert_true(s->w.at % 8 != 0);
    while (s->w.at % 8)
        fap_bits_put(&s->w, 1, 1);
    put_code(s, 0xB1);
    fap_decoder *d = decode(s, (size_t)s->w.at / 8, 0, &n);
    assert_int_equal(next_pitch(d), 10);
    check_end(d);
    assert_int_equal(n.count, 1);
    assert_non_null(strstr(n.text[0], "stuffing"));
    d = decode(s, (size_t)s->w.at / 8, 1, &n);
    assert_int_equal(next_pitch(d), 10);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_BITSTREAM);
    fap_decoder_close(&d);
    free(s);
}

TEST(fba_deviation, a_broken_body_does_not_cost_the_face)
{
    stream *s = begin();
    notices n;
    fap_frame f;

    put_intra(s, 9, 1860, 1);
    fap_bits_put(&s->w, 5, 1);  /* bap_quant */
    fap_bits_put(&s->w, 32, 0); /* markers that are 0 */
    fap_bits_put_stuffing(&s->w);
    put_code(s, 0xBB);
    put_intra(s, 12, 1860, 0);
    fap_decoder *d = decode(s, end(s), 0, &n);
    assert_int_equal(next_pitch(d), 9);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_BITSTREAM);
    assert_non_null(strstr(fap_decoder_last_error(d), "body"));
    assert_int_equal(next_pitch(d), 12);
    check_end(d);
    free(s);
}
