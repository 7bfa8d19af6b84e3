/* SPDX-License-Identifier: BSD-2-Clause */
/* Spikes, gaps, resampling. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/clean.h>

/* One point on a slow wave: 20 mm at 1 Hz, sampled at 100 Hz. */
static fap_take *wave(uint32_t frames, double hz)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, 1, frames, NULL), FAP_OK);
    take->rate_hz = 100;
    for (uint32_t f = 0; f < frames; f++) {
        const float v[3] = { 20 * (float)sin(6.283185307 * hz * f / 100), 500, (float)f };
        fap_take_set(take, f, 0, v);
    }
    return take;
}

static void clean_take(fap_take *take, fap_clean_report *r)
{
    fap_clean_config cfg;

    fap_clean_config_init(&cfg);
    cfg.methods = FAP_CLEAN_SPLINE;
    assert_int_equal(fap_take_clean(take, &cfg, r, NULL), FAP_OK);
}

TEST(clean, spikes_go_and_motion_stays)
{
    fap_take *take = wave(200, 1), *clean = wave(200, 1);
    fap_clean_report r;

    take->xyz[50][0] += 15;
    take->xyz[51][1] -= 40;
    take->xyz[120][2] += 9;
    clean_take(take, &r);
    assert_int_equal(r.spikes, 3);
    for (uint32_t f = 0; f < 200; f++)
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(take->xyz[f][axis], clean->xyz[f][axis], 0.05);
    clean_take(clean, &r);
    assert_int_equal(r.spikes, 0);
    fap_take_close(&take);
    fap_take_close(&clean);
}

TEST(clean, short_gaps_are_closed_and_long_ones_left)
{
    fap_take *take = wave(300, 1);
    fap_clean_report r;

    memset(take->valid + 40, 0, 20);
    memset(take->valid + 100, 0, 21);
    memset(take->valid, 0, 5);
    clean_take(take, &r);
    assert_int_equal(r.gaps_closed, 1);
    assert_int_equal(r.samples_filled, 20);
    assert_int_equal(r.gaps_left, 2); /* the start of the take is one, too */
    assert_float_equal(take->xyz[50][0], 20 * sin(3.14159265), 2.5);
    assert_float_equal(take->xyz[50][2], 50, 1e-3);
    assert_false(take->valid[110]);
    assert_false(take->valid[0]);
    fap_take_close(&take);
}

static fap_take *resampled(const fap_take *take, double hz, double cutoff)
{
    fap_take *out;

    assert_int_equal(fap_take_resample(take, hz, cutoff, &out), FAP_OK);
    return out;
}

TEST(clean, the_mean_of_three_frames_is_the_thesis_s)
{
    fap_take *take = wave(20, 0);
    fap_clean_config cfg;
    fap_clean_report r;

    take->xyz[10][0] = 9;
    take->valid[14] = 0;
    fap_clean_config_init(&cfg);
    cfg.average = 1;
    cfg.methods = 0;
    assert_int_equal(fap_take_clean(take, &cfg, &r, NULL), FAP_OK);
    assert_int_equal(r.spikes, 0);
    for (uint32_t f = 8; f < 13; f++)
        assert_float_equal(take->xyz[f][0], f >= 9 && f <= 11 ? 3 : 0, 1e-5);
    assert_float_equal(take->xyz[0][2], 0.5, 1e-5); /* of the two there are */
    assert_float_equal(take->xyz[13][2], 12.5, 1e-5);
    assert_false(take->valid[14]);
    fap_take_close(&take);
}

TEST(resample, slow_motion_keeps_its_size_and_its_time)
{
    fap_take *take = wave(400, 1);
    const double rates[] = { 25, 30, 60, 150 };

    for (size_t i = 0; i < 4; i++) {
        fap_take *out = resampled(take, rates[i], 0);
        for (uint32_t f = 0; f < out->frame_count; f++) {
            const double time = f / rates[i];
            /* Ends are reflected, so a curved end is a little off. */
            const double tolerance = time < 0.2 || time > 3.7 ? 0.6 : 0.05;
            assert_float_equal(out->xyz[f][0], 20 * sin(6.283185307 * time), tolerance);
            assert_float_equal(out->xyz[f][2], time * 100, 0.01);
        }
        fap_take_close(&out);
    }
    fap_take_close(&take);
}

TEST(resample, what_the_new_rate_cannot_carry_is_gone)
{
    fap_take *take = wave(400, 20), *out = resampled(take, 25, 0);

    for (uint32_t f = 10; f < 90; f++)
        assert_float_equal(out->xyz[f][0], 0, 0.3);
    fap_take_close(&out);
    fap_take_close(&take);
}

TEST(resample, equal_rates_give_equal_samples)
{
    fap_take *take = wave(50, 7), *out;

    take->valid[20] = 0;
    out = resampled(take, 100, 0);
    assert_memory_equal(out->xyz[3], take->xyz[3], sizeof *take->xyz);
    assert_int_equal(out->frame_count, 50);
    assert_false(out->valid[20]);
    fap_take_close(&out);
    fap_take_close(&take);
}

TEST(resample, a_gap_stays_a_gap)
{
    fap_take *take = wave(400, 1);

    memset(take->valid + 100, 0, 100);
    fap_take *out = resampled(take, 25, 0);
    assert_true(out->valid[24]);
    assert_false(out->valid[25]);
    assert_false(out->valid[49]);
    assert_true(out->valid[50]);
    assert_float_equal(out->xyz[24][2], 96, 0.01);
    fap_take_close(&out);
    fap_take_close(&take);
}

TEST(resample, what_was_filled_is_known_as_that)
{
    fap_take *take = wave(400, 1);
    fap_clean_report r;

    memset(take->valid + 101, 0, 6);
    clean_take(take, &r);
    fap_take *out = resampled(take, 50, 0);
    for (uint32_t f = 40; f < 60; f++)
        assert_int_equal(out->valid[f], f >= 51 && f <= 53 ? FAP_SAMPLE_SPLINE : FAP_SAMPLE_MEASURED);
    assert_string_equal(fap_sample_name(FAP_SAMPLE_EASED), "eased");
    assert_string_equal(fap_sample_name((fap_sample)99), "unknown");
    fap_take_close(&out);
    fap_take_close(&take);
}

TEST(resample, refuses_rates_that_are_none)
{
    fap_take *take = wave(10, 1), *out;

    assert_int_equal(fap_take_resample(take, 0, 0, &out), FAP_E_ARG);
    assert_int_equal(fap_take_resample(take, NAN, 0, &out), FAP_E_ARG);
    assert_int_equal(fap_take_resample(take, 1e12, 0, &out), FAP_E_LIMIT);
    take->rate_hz = 0;
    assert_int_equal(fap_take_resample(take, 25, 0, &out), FAP_E_ARG);
    fap_take_close(&take);
}
