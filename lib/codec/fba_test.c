/* SPDX-License-Identifier: BSD-2-Clause */
/* The FBA decoder on streams written field by field, on damage, and behind the encoder. */
#include "tests/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/decoder.h>
#include <fap/encoder.h>

#include "codec/fba.h"
#include "codec/models.h"

/* --- writing streams --- */

typedef struct stream {
    uint8_t data[4096];
    fap_bit_writer w;
} stream;

static void put(stream *s, int n, uint32_t value)
{
    fap_bits_put(&s->w, n, value);
}

static void begin(stream *s)
{
    fap_bit_writer_init(&s->w, s->data, sizeof s->data);
    put(s, 32, 0x000001BA); /* fba_object_start_code */
}

static void plane_code(stream *s)
{
    fap_bits_put_stuffing(&s->w);
    put(s, 32, 0x000001BB);
}

static void end(stream *s)
{
    fap_bits_put_stuffing(&s->w);
    put(s, 32, 0x000001B1);
}

/* I plane of a face, no rate, no time code, no skip, fap_quant 1. */
static void intra_header(stream *s)
{
    put(s, 1, 1); /* is_intra */
    put(s, 2, 1); /* fba_object_mask */
    put(s, 1, 0); /* is_frame_rate */
    put(s, 1, 0); /* is_time_code */
    put(s, 1, 0); /* skip_frames */
    put(s, 5, 1); /* fap_quant */
}

static void predicted_header(stream *s)
{
    put(s, 1, 0); /* is_intra */
    put(s, 2, 1); /* fba_object_mask */
    put(s, 1, 0); /* skip_frames */
}

/* Masks of all groups: @p type for @p group, 0 for the others. */
static void masks(stream *s, int group, uint32_t type, int bits, uint32_t mask)
{
    for (int g = 1; g <= 10; g++) {
        put(s, 1, 1); /* marker */
        put(s, 2, g == group ? type : 0);
        if (g == group)
            put(s, bits, mask);
    }
}

static void setup_end(stream *s)
{
    put(s, 1, 1); /* fba_suggested_gender */
    put(s, 1, 0); /* fba_object_coding_type */
    put(s, 4, 0); /* no new ranges */
}

/* One arithmetic run of symbols with flat counts. */
static void flat_run(stream *s, const int (*symbol_size)[2], int count)
{
    arith_encoder a;

    fap_arith_encoder_begin(&a, &s->w);
    for (int i = 0; i < count; i++) {
        const uint32_t low = (uint32_t)(symbol_size[i][1] - 1 - symbol_size[i][0]);
        fap_arith_encoder_put(&a, (arith_interval){ low, low + 1, (uint32_t)symbol_size[i][1] });
    }
    fap_arith_encoder_end(&a);
}

/* Head pitch: default range -1860..1860, and -600..600 in P planes; step 170. */
static void intra_pitch(stream *s, int level)
{
    intra_header(s);
    masks(s, 7, 1, 3, 4);
    setup_end(s);
    flat_run(s, (const int[][2]){ { level + 1860, 3721 } }, 1);
}

static void predicted_pitch(stream *s, int difference)
{
    predicted_header(s);
    flat_run(s, (const int[][2]){ { difference + 600, 1201 } }, 1);
}

/* --- reading --- */

static void count_notice(void *user, int64_t bit, const char *text)
{
    (void)bit, (void)text;
    ++*(int *)user;
}

static fap_decoder *open_decoder(void)
{
    fap_decoder *d;
    assert_int_equal(fap_decoder_open(&d, NULL), FAP_OK);
    return d;
}

static fap_decoder *decode(stream *s)
{
    fap_decoder *d = open_decoder();
    assert_int_equal(fap_decoder_send(d, s->data, (size_t)(s->w.at + 7) / 8), FAP_OK);
    return d;
}

static fap_frame next_ok(fap_decoder *d)
{
    fap_frame f = { 0 };
    if (fap_decoder_receive(d, &f) != FAP_OK)
        fail_msg("%s", fap_decoder_last_error(d));
    return f;
}

static void ends(fap_decoder *d)
{
    fap_frame f;
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_END);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_AGAIN);
    fap_decoder_close(&d);
    assert_null(d);
}

TEST(fba, decodes_i_and_p_planes_written_field_by_field)
{
    stream s;

    begin(&s);
    intra_pitch(&s, 100);
    predicted_pitch(&s, -30);
    plane_code(&s);
    predicted_pitch(&s, 600);
    end(&s);
    fap_decoder *d = decode(&s);
    fap_frame f = next_ok(d);
    assert_int_equal(f.state[48], FAP_CODED);
    assert_int_equal(f.value[48], 100 * 170);
    assert_int_equal(f.state[49], FAP_ABSENT);
    assert_int_equal(fap_decoder_plane(d)->intra, 1);
    assert_int_equal(fap_decoder_plane(d)->gender, 1);
    assert_int_equal(fap_decoder_plane(d)->mask_type[7], 1);
    assert_int_equal(fap_decoder_plane(d)->i_max[48], 1860);
    assert_int_equal(fap_decoder_plane(d)->bit_position, 32);
    f = next_ok(d);
    assert_int_equal(f.value[48], 70 * 170);
    assert_int_equal(f.number, 1);
    assert_int_equal(f.pts_us, 33333); /* 30 frames a second before a rate was sent */
    assert_int_equal(fap_decoder_plane(d)->start_code, 0);
    f = next_ok(d);
    assert_int_equal(f.value[48], 670 * 170);
    assert_int_equal(f.pts_us, 66667);
    assert_int_equal(fap_decoder_plane(d)->start_code, 1);
    ends(d);
}

TEST(fba, rate_time_code_and_skip_make_the_time)
{
    stream s;

    begin(&s);
    put(&s, 1, 1);  /* is_intra */
    put(&s, 2, 1);  /* fba_object_mask */
    put(&s, 1, 1);  /* is_frame_rate */
    put(&s, 8, 30); /* frame_rate */
    put(&s, 4, 0);  /* seconds */
    put(&s, 1, 1);  /* frequency_offset */
    put(&s, 1, 1);  /* is_time_code */
    put(&s, 5, 1);  /* hours */
    put(&s, 6, 2);  /* minutes */
    put(&s, 1, 1);  /* marker */
    put(&s, 6, 3);  /* seconds */
    put(&s, 1, 0);  /* skip_frames */
    put(&s, 5, 1);  /* fap_quant */
    masks(&s, 7, 1, 3, 4);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 1860, 3721 } }, 1);

    put(&s, 1, 0);  /* is_intra */
    put(&s, 2, 1);  /* fba_object_mask */
    put(&s, 1, 1);  /* skip_frames */
    put(&s, 4, 15); /* 15 + 3 */
    put(&s, 4, 3);
    flat_run(&s, (const int[][2]){ { 600, 1201 } }, 1);

    put(&s, 1, 1); /* is_intra */
    put(&s, 2, 1); /* fba_object_mask */
    put(&s, 1, 0); /* is_frame_rate */
    put(&s, 1, 1); /* is_time_code: ten seconds after the first */
    put(&s, 5, 1);
    put(&s, 6, 2);
    put(&s, 1, 1);
    put(&s, 6, 13);
    put(&s, 1, 0); /* skip_frames */
    put(&s, 5, 1); /* fap_quant */
    masks(&s, 7, 1, 3, 4);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 1860, 3721 } }, 1);
    end(&s);

    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).pts_us, 0);
    assert_float_equal(fap_decoder_plane(d)->rate_hz, 30000 / 1001.0, 1e-4);
    fap_frame f = next_ok(d);
    assert_int_equal(f.number, 19);
    assert_int_equal(f.pts_us, 633967); /* 19 * 1001 / 30000 s */
    assert_int_equal(fap_decoder_plane(d)->skipped, 18);
    f = next_ok(d);
    assert_int_equal(f.number, 20);
    assert_int_equal(f.pts_us, 10000000);
    ends(d);
}

TEST(fba, visemes_and_expressions_have_runs_of_their_own)
{
    stream s;

    begin(&s);
    intra_header(&s);
    masks(&s, 1, 3, 0, 0);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 14, 15 }, { 3, 15 }, { 63, 64 } }, 3);
    put(&s, 1, 1); /* viseme_def */
    flat_run(&s, (const int[][2]){ { 6, 7 }, { 10, 64 }, { 2, 7 }, { 20, 64 } }, 4);
    put(&s, 1, 1); /* init_face */
    put(&s, 1, 0); /* expression_def */
    flat_run(&s, NULL, 0);
    predicted_header(&s);
    flat_run(&s, (const int[][2]){ { -4 + 14, 29 }, { 0 + 14, 29 }, { -3 + 63, 127 } }, 3);
    put(&s, 1, 0);
    flat_run(&s, (const int[][2]){ { -6 + 6, 13 }, { 5 + 63, 127 }, { 1 + 6, 13 }, { 0 + 63, 127 } }, 4);
    put(&s, 1, 0);
    put(&s, 1, 1);
    flat_run(&s, NULL, 0);
    end(&s);

    fap_decoder *d = decode(&s);
    fap_frame f = next_ok(d);
    assert_memory_equal(&f.viseme, (&(fap_viseme){ 14, 3, 63, 1 }), sizeof f.viseme);
    assert_memory_equal(&f.expression, (&(fap_expression){ 6, 10, 2, 20, 1, 0 }), sizeof f.expression);
    f = next_ok(d);
    assert_memory_equal(&f.viseme, (&(fap_viseme){ 10, 3, 60, 0 }), sizeof f.viseme);
    assert_memory_equal(&f.expression, (&(fap_expression){ 0, 15, 3, 20, 0, 1 }), sizeof f.expression);
    ends(d);
}

TEST(fba, a_viseme_beyond_the_table_is_refused)
{
    stream s;
    fap_frame f;

    begin(&s);
    intra_header(&s);
    masks(&s, 1, 1, 2, 2);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 14, 15 }, { 3, 15 }, { 63, 64 } }, 3);
    put(&s, 1, 0);
    flat_run(&s, NULL, 0);
    predicted_header(&s);
    flat_run(&s, (const int[][2]){ { 1 + 14, 29 }, { 14, 29 }, { 63, 127 } }, 3);
    put(&s, 1, 0);
    flat_run(&s, NULL, 0);
    end(&s);
    fap_decoder *d = decode(&s);
    next_ok(d);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_BITSTREAM);
    assert_non_null(strstr(fap_decoder_last_error(d), "viseme_select"));
    ends(d);
}

/* FAPs 31 to 38; of 31 and 32, a left and a right one, only the left is sent. */
static fap_frame after_mask_change(uint32_t type)
{
    stream s;

    begin(&s);
    intra_header(&s);
    masks(&s, 4, 1, 8, 0x40); /* FAP 32 */
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 7 + 900, 1801 } }, 1);
    intra_header(&s);
    masks(&s, 4, type, 8, 0x80); /* FAP 31 */
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 5 + 900, 1801 } }, 1);
    end(&s);
    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).state[32], FAP_CODED);
    const fap_frame f = next_ok(d);
    ends(d);
    return f;
}

TEST(fba, mask_type_1_holds_and_type_2_interpolates)
{
    fap_frame f = after_mask_change(1);
    const int held = f.value[32];

    assert_int_equal(f.state[32], FAP_HELD);
    assert_int_equal(held, 7 * fap_info_get(32)->quant_step);
    f = after_mask_change(2);
    assert_int_equal(f.state[31], FAP_CODED);
    assert_int_equal(f.state[32], FAP_DERIVED);
    assert_int_equal(f.value[32], f.value[31]);
    assert_int_equal(f.state[33], FAP_ABSENT);
}

/* An I plane of FAP 48 with tables of its own: I -60..120, P 0..60, in levels of fap_quant 2. */
TEST(fba, ranges_that_are_sent_replace_the_defaults_and_stay)
{
    static const uint32_t bound[4] = { 2, 1, 1, 0 }; /* I max, I min, P max, P min */
    stream s;

    begin(&s);
    put(&s, 6, 0x28); /* I plane, face, no rate, no time code, no skip: 1 01 0 0 0 */
    put(&s, 5, 2);    /* fap_quant */
    masks(&s, 7, 1, 3, 4);
    put(&s, 1, 0);  /* fba_suggested_gender */
    put(&s, 1, 0);  /* fba_object_coding_type */
    put(&s, 4, 15); /* four new tables */
    for (int table = 0; table < 4; table++)
        for (int g = 2; g <= 10; g++)
            for (int i = 0; i < fap_group_count(g); i++) {
                if (i % 4 == 0)
                    put(&s, 1, 1); /* marker */
                if (g == 7 && i == 0)
                    put(&s, 5, bound[table]);
            }
    flat_run(&s, (const int[][2]){ { 60 + 30, 91 } }, 1); /* 60 of -30..60 */
    predicted_header(&s);
    flat_run(&s, (const int[][2]){ { 30, 31 } }, 1);
    put(&s, 6, 0x28);
    put(&s, 5, 2);
    masks(&s, 7, 1, 3, 4);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { -30 + 30, 91 } }, 1);
    end(&s);

    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).value[48], 60 * 170 * 2);
    assert_int_equal(next_ok(d).value[48], 90 * 170 * 2);
    assert_int_equal(fap_decoder_plane(d)->p_min[48], 0);
    assert_int_equal(fap_decoder_plane(d)->p_max[48], 30);
    assert_int_equal(next_ok(d).value[48], -30 * 170 * 2);
    ends(d);
}

TEST(fba, another_default_range_can_be_asked_for)
{
    stream s;
    fap_decoder_config cfg;
    fap_decoder *d;

    begin(&s);
    intra_header(&s);
    masks(&s, 7, 1, 3, 4);
    setup_end(&s);
    flat_run(&s, (const int[][2]){ { 50 + 1020, 2041 } }, 1);
    end(&s);
    fap_decoder_config_init(&cfg);
    cfg.default_bound = 1020;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, s.data, (size_t)s.w.at / 8), FAP_OK);
    assert_int_equal(next_ok(d).value[48], 50 * 170);
    ends(d);
}

/* --- what is passed over --- */

static void segment_plane(stream *s)
{
    intra_header(s);
    masks(s, 7, 1, 3, 4);
    put(s, 1, 0);           /* fba_suggested_gender */
    put(s, 1, 1);           /* fba_object_coding_type: DCT */
    put(s, 32, 0x12345678); /* whatever */
    put(s, 13, 0x1FFF);
}

TEST(fba, dct_segments_are_named_and_left_out)
{
    stream s;
    fap_frame f;

    begin(&s);
    intra_pitch(&s, 1);
    plane_code(&s);
    segment_plane(&s);
    plane_code(&s);
    predicted_pitch(&s, 1); /* of the segment: nobody can read it */
    plane_code(&s);
    intra_pitch(&s, 2);
    predicted_pitch(&s, 1);
    end(&s);
    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).value[48], 170);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_UNSUPPORTED);
    assert_non_null(strstr(fap_decoder_last_error(d), "fba_object_coding_type"));
    assert_int_equal(next_ok(d).state[48], FAP_CONCEALED);
    f = next_ok(d);
    assert_int_equal(f.value[48], 2 * 170);
    assert_int_equal(f.number, 1 + 16 + 16);
    assert_int_equal(next_ok(d).value[48], 3 * 170);
    ends(d);
}

static void body_masks(stream *s, int last)
{
    put(s, 5, 3); /* bap_quant: scale 3 */
    for (int g = 1; g <= 24; g++) {
        put(s, 1, 1); /* marker */
        put(s, 2, g == 1 ? 3 : g == 24 ? 1 : 0);
        if (g == 24) /* 22 BAPs */
            put(s, 22, (uint32_t)last);
    }
    put(s, 1, 0); /* gender */
    put(s, 1, 0); /* coding type */
    put(s, 4, 8); /* a table of I maxima only */
}

/* The table of 296 BAPs: markers before every 4th of a group, a number for the four coded ones. */
static void body_table(stream *s)
{
    static const int size[24] = { 3,  4, 4,  6,  6,  5,  5, 7,  7,  12, 15, 18,
                                  18, 9, 16, 16, 13, 13, 6, 22, 22, 22, 22, 22 };
    for (int g = 0; g < 24; g++)
        for (int i = 0; i < size[g]; i++) {
            if (i % 4 == 0)
                put(s, 1, 1);
            if (g == 0 || (g == 23 && i == 21))
                put(s, 5, 10); /* 600 / 3 = 200 levels */
        }
}

TEST(fba, body_data_is_parsed_past)
{
    enum { I_SIZE = 200 + 1859 + 1, P_SIZE = 2 * 1859 + 1 };
    stream s;

    begin(&s);
    intra_pitch(&s, 4);
    s.data[4] |= 0x40; /* fba_object_mask 3 */
    body_masks(&s, 1);
    body_table(&s);
    flat_run(&s, (const int[][2]){ { 0, I_SIZE }, { 5, I_SIZE }, { I_SIZE - 1, I_SIZE }, { 9, I_SIZE } }, 4);
    put(&s, 4, 2 | 4); /* P plane, both, no skip: 0 11 0 */
    flat_run(&s, (const int[][2]){ { 7 + 600, 1201 } }, 1);
    flat_run(&s, (const int[][2]){ { 0, P_SIZE }, { 5, P_SIZE }, { P_SIZE - 1, P_SIZE }, { 9, P_SIZE } }, 4);
    put(&s, 4, 4); /* P plane, body only: 0 10 0 */
    flat_run(&s, (const int[][2]){ { 1, P_SIZE }, { 6, P_SIZE }, { 0, P_SIZE }, { 10, P_SIZE } }, 4);
    fap_bits_put_stuffing(&s.w);
    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).value[48], 4 * 170);
    assert_int_equal(fap_decoder_plane(d)->has_body, 1);
    assert_int_equal(next_ok(d).value[48], 11 * 170);
    fap_decoder_close(&d);
}

TEST(fba, headers_of_a_visual_sequence_are_passed_over)
{
    stream s;

    fap_bit_writer_init(&s.w, s.data, sizeof s.data);
    put(&s, 32, 0x000001B0);
    put(&s, 8, 0x61);
    put(&s, 32, 0x000001B5);
    put(&s, 8, 0x23);
    put(&s, 32, 0x000001BA);
    intra_pitch(&s, 4);
    end(&s);
    fap_decoder *d = decode(&s);
    assert_int_equal(next_ok(d).value[48], 4 * 170);
    ends(d);
}

/* --- units, damage, resources --- */

TEST(fba, units_are_taken_one_at_a_time)
{
    stream a, b;
    fap_frame f;

    begin(&a);
    intra_pitch(&a, 1);
    fap_bits_put_stuffing(&a.w);
    fap_bit_writer_init(&b.w, b.data, sizeof b.data);
    predicted_pitch(&b, 1);
    fap_bits_put_stuffing(&b.w);
    fap_decoder *d = decode(&a);
    assert_int_equal(fap_decoder_send(d, b.data, 1), FAP_E_AGAIN);
    next_ok(d);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_AGAIN);
    assert_int_equal(fap_decoder_send(d, b.data, (size_t)b.w.at / 8), FAP_OK);
    assert_int_equal(next_ok(d).value[48], 2 * 170);
    fap_decoder_flush(d);
    assert_int_equal(fap_decoder_send(d, b.data, (size_t)b.w.at / 8), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_AGAIN); /* a P plane without its I plane */
    fap_decoder_close(&d);
}

TEST(fba, a_damaged_plane_costs_no_more_than_its_group)
{
    stream s;
    fap_frame f;

    begin(&s);
    intra_pitch(&s, 1);
    plane_code(&s);
    intra_header(&s);
    put(&s, 3, 3); /* marker 0 */
    plane_code(&s);
    predicted_pitch(&s, 1);
    plane_code(&s);
    intra_pitch(&s, 3);
    end(&s);
    fap_decoder *d = decode(&s);
    next_ok(d);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_BITSTREAM);
    assert_non_null(strstr(fap_decoder_last_error(d), "marker"));
    assert_int_equal(next_ok(d).state[48], FAP_CONCEALED);
    assert_int_equal(fap_decoder_plane(d)->concealed, 1);
    f = next_ok(d);
    assert_int_equal(f.value[48], 3 * 170);
    assert_int_equal(f.number, 3);
    ends(d);
}

TEST(fba, tolerated_deviations_are_told_or_fatal)
{
    stream s;
    fap_decoder_config cfg;
    fap_decoder *d;
    fap_frame f;
    int notices = 0;

    begin(&s);
    intra_pitch(&s, 1);
    fap_bits_put_stuffing(&s.w);
    fap_decoder_config_init(&cfg);
    cfg.notice = count_notice;
    cfg.notice_user = &notices;
    for (cfg.strict = 0; cfg.strict < 2; cfg.strict++) {
        assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
        assert_int_equal(fap_decoder_send(d, s.data + 4, (size_t)s.w.at / 8 - 4),
                         FAP_OK); /* no object start code */
        assert_int_equal(fap_decoder_receive(d, &f), cfg.strict ? FAP_E_BITSTREAM : FAP_OK);
        fap_decoder_close(&d);
    }
    assert_int_equal(notices, 1);
}

static size_t taken;

static void *count_alloc(void *user, size_t size)
{
    (void)user;
    taken += size;
    return malloc(size);
}

static void count_free(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

static void *no_memory(void *user, size_t size)
{
    (void)user, (void)size;
    return NULL;
}

TEST(fba, a_decoder_takes_at_most_64_kib)
{
    fap_decoder_config cfg;
    fap_decoder *d;

    fap_decoder_config_init(&cfg);
    cfg.alloc = (fap_allocator){ count_alloc, count_free, NULL };
    taken = 0;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_in_range(taken, 1, 65536);
    fap_decoder_close(&d);
    cfg.alloc.alloc = no_memory;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_E_NOMEM);
    assert_null(d);
    cfg.symbol_memory = 65535;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_E_ARG);
}

TEST(fba, symbols_beyond_the_memory_are_an_error_not_a_guess)
{
    stream s;
    fap_decoder_config cfg;
    fap_decoder *d;
    fap_frame f;

    begin(&s);
    intra_pitch(&s, 1);
    predicted_pitch(&s, 1);
    end(&s);
    fap_decoder_config_init(&cfg);
    cfg.symbol_memory = 1;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, s.data, (size_t)s.w.at / 8), FAP_OK);
    next_ok(d);
    next_ok(d);
    ends(d);
    /* 2 P planes with different symbols */
    s.w.at = 32;
    intra_pitch(&s, 1);
    predicted_pitch(&s, 1);
    arith_encoder a;
    predicted_header(&s);
    fap_arith_encoder_begin(&a, &s.w);
    fap_arith_encoder_put(&a, (arith_interval){ 0, 1, 1202 });
    fap_arith_encoder_end(&a);
    end(&s);
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, s.data, (size_t)s.w.at / 8), FAP_OK);
    next_ok(d);
    next_ok(d);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_LIMIT);
    ends(d);
}

/* --- encoder and decoder --- */

static uint32_t draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

typedef struct take {
    int count, masks;  /* frames; mask changes */
    int32_t amplitude; /* largest value of I planes */
    int32_t step;      /* largest change from frame to frame */
    uint32_t seed;
} take;

static void next_frame(take *t, fap_frame *f, int i)
{
    if (i % ((t->count + t->masks) / (t->masks + 1)) == 0)
        for (int fap = 1; fap <= FAP_COUNT; fap++)
            f->state[fap] = draw(&t->seed) % 3 ? FAP_CODED : FAP_ABSENT;
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        f->value[fap] += (int32_t)(draw(&t->seed) % (uint32_t)(2 * t->step + 1)) - t->step;
        if (f->value[fap] > t->amplitude || f->value[fap] < -t->amplitude)
            f->value[fap] = 0;
    }
    f->viseme =
        (fap_viseme){ draw(&t->seed) % 15, draw(&t->seed) % 15, draw(&t->seed) % 64, draw(&t->seed) % 2 };
    f->expression = (fap_expression){ draw(&t->seed) % 7,  draw(&t->seed) % 64, draw(&t->seed) % 7,
                                      draw(&t->seed) % 64, draw(&t->seed) % 2,  draw(&t->seed) % 2 };
    if (!f->expression.select2) /* an intensity of nothing need not be sent */
        f->expression.intensity2 = 0;
    f->number = i < t->count / 2 ? i : i + 20; /* a gap */
    f->pts_us = f->number * 40000;
}

static void compare(const fap_frame *got, const fap_frame *want)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        if (want->state[fap] != FAP_CODED)
            continue;
        assert_int_equal(got->state[fap], FAP_CODED);
        if (fap > 2 && got->value[fap] != want->value[fap])
            fail_msg("frame %d FAP %d: %d, not %d", (int)got->number, fap, (int)got->value[fap],
                     (int)want->value[fap]);
    }
    if (want->state[1] == FAP_CODED)
        assert_memory_equal(&got->viseme, &want->viseme, sizeof got->viseme);
    if (want->state[2] == FAP_CODED)
        assert_memory_equal(&got->expression, &want->expression, sizeof got->expression);
    assert_int_equal(got->number, want->number);
    assert_int_equal(got->pts_us, want->pts_us);
}

/* A packet through the decoder, against what the encoder says it holds. */
static int check_packet(fap_encoder *e, fap_decoder *d, uint8_t *data, size_t room)
{
    size_t size;
    int count;
    fap_frame f;
    fap_err err = fap_encoder_receive(e, data, room, &size);

    if (err != FAP_OK)
        return err;
    const fap_frame *want = fap_encoder_reconstruction(e, &count);
    assert_int_equal(fap_decoder_send(d, data, size), FAP_OK);
    for (int i = 0; i < count; i++) {
        f = next_ok(d);
        compare(&f, &want[i]);
    }
    err = fap_decoder_receive(d, &f);
    assert_int_equal(err, count ? FAP_E_AGAIN : FAP_E_END);
    return FAP_OK;
}

static fap_encoder_stats round_trip(take t, int quant, int intra, int plane_codes)
{
    fap_encoder_config cfg;
    fap_encoder *e;
    fap_decoder *d = open_decoder();
    fap_frame f = { 0 };
    fap_err err;

    fap_encoder_config_init(&cfg);
    cfg.quant = quant;
    cfg.intra = intra;
    cfg.plane_codes = plane_codes;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    const size_t room = fap_encoder_bound(e);
    uint8_t *data = malloc(room);
    for (int i = 0; i < t.count; i++) {
        next_frame(&t, &f, i);
        while ((err = fap_encoder_send(e, &f)) == FAP_E_AGAIN)
            assert_int_equal(check_packet(e, d, data, room), FAP_OK);
        assert_int_equal(err, FAP_OK);
    }
    fap_encoder_flush(e);
    while ((err = check_packet(e, d, data, room)) == FAP_OK)
        continue;
    assert_int_equal(err, FAP_E_END);
    const fap_encoder_stats stats = fap_encoder_get_stats(e);
    assert_int_equal(stats.frames, t.count);
    fap_encoder_close(&e);
    fap_decoder_close(&d);
    free(data);
    return stats;
}

TEST(fba, decoded_values_are_the_encoders_reconstruction)
{
    static const int quants[] = { 0, 1, 2, 3, 7, 30, 31 };

    for (size_t q = 0; q < sizeof quants / sizeof *quants; q++)
        for (int k = 0; k < 4; k++) {
            const take t = { .count = 60 + 40 * k,
                             .masks = k,
                             .amplitude = k == 3 ? 60000 : 900,
                             .step = k == 3 ? 20000 : 60,
                             .seed = (uint32_t)(q * 4 + (size_t)k) };
            round_trip(t, quants[q], k == 0 ? 1 : k == 1 ? 17 : 250, k == 2);
        }
}

TEST(fba, quant_0_loses_nothing_within_the_range_of_a_plane)
{
    fap_encoder *e;
    fap_encoder_config cfg;
    uint8_t data[65536];
    size_t size;
    int count;
    fap_frame f = { 0 };
    take t = { .count = 40, .masks = 0, .amplitude = 1860, .step = 900, .seed = 4 };

    fap_encoder_config_init(&cfg);
    cfg.quant = 0;
    cfg.intra = 60;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    static fap_frame sent[40];
    for (int i = 0; i < t.count; i++) {
        next_frame(&t, &f, i);
        sent[i] = f;
        assert_int_equal(fap_encoder_send(e, &f), FAP_OK);
    }
    fap_encoder_flush(e);
    assert_int_equal(fap_encoder_receive(e, data, sizeof data, &size), FAP_OK);
    const fap_frame *shown = fap_encoder_reconstruction(e, &count);
    assert_int_equal(count, t.count);
    for (int i = 0; i < count; i++)
        compare(&shown[i], &sent[i]);
    assert_int_equal(fap_encoder_get_stats(e).clipped, 0);
    fap_encoder_close(&e);
}

/* More different symbols than a decoder has memory for: the group is cut where it would not fit. */
TEST(fba, the_encoder_respects_the_memory_of_a_decoder)
{
    const take t = { .count = 400, .masks = 0, .amplitude = 1800, .step = 900, .seed = 11 };
    assert_true(round_trip(t, 1, 400, 0).intra_frames > 1);
}

TEST(fba, an_empty_stream_is_a_stream)
{
    fap_encoder *e;
    uint8_t data[512 * 251 + 1024];
    size_t size;
    fap_frame f;

    assert_int_equal(fap_encoder_open(&e, NULL), FAP_OK);
    assert_int_equal(fap_encoder_receive(e, data, sizeof data, &size), FAP_E_AGAIN);
    fap_encoder_flush(e);
    assert_int_equal(fap_encoder_receive(e, data, sizeof data, &size), FAP_OK);
    assert_int_equal(size, 9);
    assert_int_equal(fap_encoder_receive(e, data, sizeof data, &size), FAP_E_END);
    assert_int_equal(fap_encoder_send(e, &(fap_frame){ 0 }), FAP_E_ARG);
    fap_encoder_close(&e);
    fap_decoder *d = open_decoder();
    assert_int_equal(fap_decoder_send(d, data, 9), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_END);
    fap_decoder_close(&d);
}

static void drain(const uint8_t *data, size_t size)
{
    fap_decoder *d = open_decoder();
    fap_frame f;
    fap_err err = fap_decoder_send(d, data, size);

    for (int i = 0; err == FAP_OK || (err != FAP_E_AGAIN && err != FAP_E_END); i++) {
        assert_true(i < 10000);
        err = fap_decoder_receive(d, &f);
    }
    fap_decoder_close(&d);
}

TEST(fba, no_damage_does_harm)
{
    stream s;

    begin(&s);
    intra_pitch(&s, 100);
    predicted_pitch(&s, -30);
    plane_code(&s);
    segment_plane(&s);
    plane_code(&s);
    intra_pitch(&s, 3);
    end(&s);
    const size_t size = (size_t)s.w.at / 8;
    for (size_t cut = 1; cut <= size; cut++) {
        uint8_t *copy = malloc(cut); /* exactly as large, for the sanitizer */
        memcpy(copy, s.data, cut);
        drain(copy, cut);
        free(copy);
    }
    for (size_t bit = 0; bit < size * 8; bit++) {
        s.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        drain(s.data, size);
        s.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
}

/* --- real files --- */

static size_t stdio_read(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

/* A real file through encoder and decoder; bytes of the stream. */
static int64_t real_round_trip(const char *name, int quant)
{
    char path[256];
    fap_ascii_reader *r;
    fap_encoder *e;
    fap_encoder_config cfg;
    fap_decoder *d = open_decoder();
    fap_frame f;

    snprintf(path, sizeof path, "data/fap/%s", name);
    FILE *file = fopen(test_shared(path), "rb");
    assert_int_equal(fap_ascii_reader_open(&r, &(fap_reader){ stdio_read, file }, NULL, NULL), FAP_OK);
    fap_encoder_config_init(&cfg);
    cfg.quant = quant;
    cfg.rate_hz = fap_ascii_reader_header(r)->rate_hz;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    const size_t room = fap_encoder_bound(e);
    uint8_t *data = malloc(room);
    while (fap_ascii_reader_next(r, &f) == FAP_OK) {
        fap_err err;
        while ((err = fap_encoder_send(e, &f)) == FAP_E_AGAIN)
            assert_int_equal(check_packet(e, d, data, room), FAP_OK);
        assert_int_equal(err, FAP_OK);
    }
    fap_encoder_flush(e);
    while (check_packet(e, d, data, room) == FAP_OK)
        continue;
    const int64_t bytes = fap_encoder_get_stats(e).bytes;
    free(data);
    fap_encoder_close(&e);
    fap_decoder_close(&d);
    fap_ascii_reader_close(&r);
    fclose(file);
    return bytes;
}

TEST(fba, real_files_decode_to_the_encoders_reconstruction)
{
    static const char *const names[] = {
        "metaface_th-example-plain.fap", "xface_joy.fap",        "vreng_jag.fap", "vreng_eyes.fap",
        "semaine_example2_bfba.fap",     "greta_1-Welcome_1.fap"
    };

    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (int quant = 0; quant < 32; quant += 5)
            real_round_trip(names[i], quant);
}

/* 48 s: 9,977 bytes; with the table's ranges they were 16,336. Literature gives 0.3 to 3 kbit/s. */
TEST(fba, a_talking_head_takes_a_few_kilobits_a_second)
{
    assert_in_range(real_round_trip("metaface_th-example-plain.fap", 1), 1000, 10500);
}

/* --- streams of another encoder --- */

/* A frame as tests/conformance/fba/reference.py words it: number, V and E with their parameters, FAP:value.
 */
static void word_frame(char *text, size_t size, const fap_frame *f)
{
    const fap_viseme *v = &f->viseme;
    const fap_expression *e = &f->expression;
    int at = snprintf(text, size, "%d", (int)f->number);

    if (f->state[1] == FAP_CODED)
        at += snprintf(text + at, size - (size_t)at, " V %d %d %d %d", v->select1, v->select2, v->blend,
                       v->def);
    if (f->state[2] == FAP_CODED)
        at += snprintf(text + at, size - (size_t)at, " E %d %d %d %d %d %d", e->select1, e->intensity1,
                       e->select2, e->intensity2, e->init_face, e->def);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->state[fap] == FAP_CODED)
            at += snprintf(text + at, size - (size_t)at, " %d:%d", fap, (int)f->value[fap]);
    snprintf(text + at, size - (size_t)at, "\n");
}

static FILE *open_vector(int seed, const char *ending)
{
    char path[128];

    snprintf(path, sizeof path, "tests/conformance/fba/random%d.%s", seed, ending);
    FILE *f = fopen(path, "rb");
    if (!f)
        fail_msg("%s is not there", path);
    return f;
}

static void check_vector(int seed)
{
    static uint8_t data[65536];
    char want[2048], got[2048];
    fap_decoder_config cfg;
    fap_decoder *d;
    FILE *stream_file = open_vector(seed, "fba"), *expected = open_vector(seed, "txt");
    const size_t size = fread(data, 1, sizeof data, stream_file);

    fap_decoder_config_init(&cfg);
    cfg.strict = 1;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, data, size), FAP_OK);
    while (fgets(want, sizeof want, expected)) {
        const fap_frame f = next_ok(d);
        word_frame(got, sizeof got, &f);
        assert_string_equal(got, want);
    }
    ends(d);
    fclose(expected);
    fclose(stream_file);
}

/* Mask types 0 to 3, ranges sent and not, seven classes of fap_quant, start codes at random, skips. */
TEST(fba, streams_of_another_encoder_decode_to_its_values)
{
    for (int seed = 0; seed < 8; seed++)
        check_vector(seed);
}
