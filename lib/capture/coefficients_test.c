/* SPDX-License-Identifier: BSD-2-Clause */
/* Coefficients to FAPs: what they become, what is not sent, and what happens to gaps, spikes, rests and rates. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/coefficients.h>

enum { FRAMES = 50, RATE = 25 };

typedef struct setup {
    fap_coefficients *take;
    fap_coefficients_config cfg;
    fap_performance *out;
} setup;

static int shape(const char *name)
{
    const int s = fap_arkit_by_name(name);
    assert_true(s >= 0);
    return s;
}

/* Two seconds of these channels, all 0. */
static setup start(uint32_t channels, const int *channel)
{
    setup s = { 0 };

    assert_int_equal(fap_coefficients_create(&s.take, channels, FRAMES, NULL), FAP_OK);
    for (uint32_t c = 0; c < channels; c++)
        s.take->channel[c] = (uint8_t)channel[c];
    memset(s.take->valid, 1, (size_t)channels * FRAMES);
    s.take->rate_hz = RATE;
    fap_coefficients_config_init(&s.cfg);
    return s;
}

static float *at(const setup *s, uint32_t frame, uint32_t column)
{
    return s->take->value + (size_t)frame * s->take->channel_count + column;
}

static void fill(const setup *s, uint32_t column, float value)
{
    for (uint32_t f = 0; f < FRAMES; f++)
        *at(s, f, column) = value;
}

static void lose(const setup *s, uint32_t first, uint32_t last)
{
    memset(s->take->valid + (size_t)first * s->take->channel_count, 0,
           (size_t)(last - first + 1) * s->take->channel_count);
}

static const fap_coefficients_report *encode(setup *s)
{
    char where[FAP_ERROR_TEXT_SIZE];

    fap_performance_close(&s->out);
    if (fap_coefficients_encode(&s->out, s->take, &s->cfg, where) != FAP_OK)
        fail_msg("%s", where);
    return fap_performance_report(s->out);
}

static int32_t value(const setup *s, uint32_t frame, int fap)
{
    assert_int_equal(fap_performance_frames(s->out)[frame].state[fap], FAP_CODED);
    return fap_performance_frames(s->out)[frame].value[fap];
}

static void end(setup *s)
{
    fap_performance_close(&s->out);
    fap_coefficients_close(&s->take);
}

TEST(coefficients, become_what_the_table_says)
{
    const int channel[] = { shape("JawOpen"), shape("EyeBlinkLeft") };
    setup s = start(2, channel);

    fill(&s, 0, 1);
    fill(&s, 1, 0.5f);
    const fap_coefficients_report *r = encode(&s);
    assert_int_equal(r->frames, FRAMES);
    assert_int_equal(value(&s, 7, 3), fap_arkit_value(channel[0], 3));
    assert_int_equal(value(&s, 7, 19), fap_arkit_value(channel[1], 19) / 2);
    end(&s);
}

TEST(coefficients, faps_that_no_column_moves_are_not_sent)
{
    const int channel[] = { shape("BrowInnerUp") };
    setup s = start(1, channel);
    const fap_coefficients_report *r = encode(&s);

    assert_int_equal(r->fap[31].coded, FRAMES);
    for (int fap = 3; fap <= 18; fap++)
        assert_int_equal(r->fap[fap].coded, 0);
    assert_int_equal(fap_performance_frames(s.out)[3].state[3], FAP_ABSENT);
    assert_int_equal(r->fap[48].coded, 0);
    assert_int_equal(r->fap[23].coded, 0);
    end(&s);
}

TEST(coefficients, a_head_at_zero_throughout_was_not_recorded)
{
    const int yaw = FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_YAW, channel[] = { yaw, yaw + 1, yaw + 2 };
    setup s = start(3, channel);

    assert_int_equal(encode(&s)->fap[49].coded, 0);
    fill(&s, 0, 0.2f);
    encode(&s);
    assert_int_equal(value(&s, 9, 49), 20000);
    assert_int_equal(value(&s, 9, 48), 0);
    end(&s);
}

TEST(coefficients, are_cut_to_their_limits_at_the_end_only)
{
    const int channel[] = { shape("JawOpen") };
    setup s = start(1, channel);

    fill(&s, 0, 1.05f);
    *at(&s, 0, 0) = -0.2f;
    const fap_coefficients_report *r = encode(&s);
    assert_float_equal(r->channel[channel[0]].max, 1.05, 1e-6);
    assert_int_equal(r->clamped, FRAMES);
    assert_int_equal(value(&s, 20, 3), fap_arkit_value(channel[0], 3));
    assert_int_equal(value(&s, 0, 3), 0);
    end(&s);
}

TEST(coefficients, another_rate_keeps_the_time)
{
    const int channel[] = { shape("JawOpen") };
    setup s = start(1, channel);

    for (uint32_t f = 0; f < FRAMES; f++)
        *at(&s, f, 0) = (float)f / FRAMES;
    s.cfg.rate_hz = 10;
    s.cfg.start_s = 0.4;
    s.cfg.end_s = 1.2;
    const fap_coefficients_report *r = encode(&s);
    assert_int_equal(r->frames, 9);
    assert_true(fabs(value(&s, 4, 3) - 0.4 * 1095) < 8); /* 0.8 s of 2 */
    end(&s);
}

TEST(coefficients, gaps_are_closed_as_asked)
{
    const int channel[] = { shape("JawOpen") };
    setup s = start(1, channel);

    for (uint32_t f = 20; f < FRAMES; f++)
        *at(&s, f, 0) = 1;
    lose(&s, 10, 12);
    lose(&s, 20, 39);
    const fap_coefficients_report *r = encode(&s);
    assert_int_equal(r->frames_missing, 23);
    assert_int_equal(r->frames_filled, 23);
    assert_int_equal(value(&s, 11, 3), 0);
    assert_true(value(&s, 30, 3) > 400 && value(&s, 30, 3) < 700);

    s.cfg.fill = FAP_FILL_SPLINE;
    r = encode(&s);
    assert_int_equal(r->frames_filled, 3);
    assert_int_equal(fap_performance_frames(s.out)[30].state[3], FAP_ABSENT);

    s.cfg.fill = FAP_FILL_NONE;
    r = encode(&s);
    assert_int_equal(r->frames_filled, 0);
    assert_int_equal(fap_performance_frames(s.out)[11].state[3], FAP_ABSENT);
    end(&s);
}

TEST(coefficients, a_spike_goes_and_a_blink_stays)
{
    const int channel[] = { shape("JawOpen"), shape("EyeBlinkLeft") };
    setup s = start(2, channel);

    *at(&s, 20, 0) = *at(&s, 20, 1) = 0.9f;
    assert_int_equal(encode(&s)->spikes, 1);
    assert_int_equal(value(&s, 20, 3), 0);
    assert_true(value(&s, 20, 19) > 900);
    end(&s);
}

TEST(coefficients, rest_becomes_zero_and_full_stays_full)
{
    const int channel[] = { shape("MouthSmileLeft"), shape("EyeLookDownLeft"), shape("EyeLookUpLeft"),
                            FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_YAW };
    setup s = start(4, channel);

    fill(&s, 0, 0.25f);
    fill(&s, 1, 0.3f);
    fill(&s, 3, 0.1f);
    for (uint32_t f = 40; f < FRAMES; f++) {
        *at(&s, f, 0) = 1;
        *at(&s, f, 1) = 0.1f;
        *at(&s, f, 3) = 0.3f;
    }
    s.cfg.rest = FAP_REST_FRAME;
    s.cfg.neutral_frame = 10;
    const fap_coefficients_report *r = encode(&s);
    assert_float_equal(r->neutral_s, 0.4, 0.05);
    assert_int_equal(value(&s, 5, 59), 0);
    assert_int_equal(value(&s, 45, 59), fap_arkit_value(channel[0], 59));
    assert_int_equal(value(&s, 5, 49), 0);
    assert_int_equal(value(&s, 45, 49), 20000);
    assert_float_equal(fap_performance_arkit(s.out)[45].shape[channel[2]], 0.2, 1e-5); /* less down is up */

    s.cfg.rest = FAP_REST_FOUND;
    assert_true(encode(&s)->neutral_s < 1.6);
    assert_int_equal(value(&s, 5, 59), 0);
    s.cfg.rest = FAP_REST_FRAME;
    s.cfg.neutral_frame = 38;
    s.cfg.neutral_last = 41; /* half of it is the one pose, half the other */
    encode(&s);
    assert_int_equal(value(&s, 5, 49), -10000);
    assert_int_equal(value(&s, 45, 49), 10000);
    s.cfg.neutral_last = FRAMES;
    fap_performance_close(&s.out);
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, NULL), FAP_E_ARG);
    s.cfg.neutral_last = 30; /* before the first */
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, NULL), FAP_E_ARG);
    s.cfg.neutral_last = -1;
    s.cfg.neutral_frame = FRAMES;
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, NULL), FAP_E_ARG);
    end(&s);
}

TEST(coefficients, action_units_go_through_the_table_of_shapes)
{
    const int channel[] = { FAP_CHANNEL_AU + 12, FAP_CHANNEL_AU + 26 };
    setup s = start(2, channel);

    fill(&s, 0, 1);
    encode(&s);
    assert_int_equal(value(&s, 5, 59), fap_arkit_value(shape("MouthSmileLeft"), 59));
    assert_int_equal(value(&s, 5, 60), fap_arkit_value(shape("MouthSmileRight"), 60));
    fill(&s, 0, 0);
    fill(&s, 1, 0.5f);
    encode(&s);
    assert_int_equal(value(&s, 5, 3), lround(0.3 * fap_arkit_value(shape("JawOpen"), 3)));
    end(&s);
}

TEST(coefficients, options_that_do_not_fit_are_refused)
{
    const int channel[] = { shape("JawOpen") };
    setup s = start(1, channel);
    char where[FAP_ERROR_TEXT_SIZE];

    s.cfg.start_s = 5;
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, where), FAP_E_ARG);
    assert_non_null(strstr(where, "--start"));
    s.cfg.start_s = 0;
    lose(&s, 0, FRAMES - 1);
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, where), FAP_E_NOT_FOUND);
    s.take->rate_hz = 0;
    assert_int_equal(fap_coefficients_encode(&s.out, s.take, &s.cfg, where), FAP_E_ARG);
    assert_non_null(strstr(where, "--take-rate"));
    end(&s);
}
