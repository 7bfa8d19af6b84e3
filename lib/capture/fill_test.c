/* SPDX-License-Identifier: BSD-2-Clause */
/* Gaps of all lengths: filled by what fits, joined without a jump, and never from nothing. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/clean.h>

#include "capture/curve.h"

enum { POINTS = 10, FRAMES = 400 };

static const float places[POINTS][3] = { { 60, 80, 0 },   { -60, 80, 0 }, { 0, 110, 40 },  { 40, 40, 60 },
                                         { -40, 40, 60 }, { 0, -20, 90 }, { 15, -18, 88 }, { -15, -18, 88 },
                                         { 0, -30, 89 },  { 0, -60, 80 } };

/* Points 5 to 9 move as a mouth, each by its own share of two motions; the head sways. */
static void place(uint32_t frame, uint32_t point, float out[3])
{
    const float t = (float)frame / 60, open = 3 + 3 * sinf(5 * t), wide = 3 * sinf(2.2f * t + 1);
    const float share = point < 5 ? 0 : 0.25f * (float)(point - 4);

    out[0] = places[point][0] + wide * share * (places[point][0] > 0 ? 1 : -1) + 15 * sinf(0.7f * t);
    out[1] = places[point][1] - open * share + 10 * sinf(0.4f * t);
    out[2] = places[point][2] + 0.3f * wide * share;
}

static fap_take *mouth(void)
{
    fap_take *take;
    float v[3];

    assert_int_equal(fap_take_create(&take, POINTS, FRAMES, NULL), FAP_OK);
    take->rate_hz = 60;
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t p = 0; p < POINTS; p++) {
            place(f, p, v);
            fap_take_set(take, f, p, v);
        }
    return take;
}

static void hide(fap_take *take, uint32_t point, uint32_t first, uint32_t length)
{
    for (uint32_t f = first; f < first + length; f++) {
        take->valid[f * POINTS + point] = 0;
        take->xyz[f * POINTS + point][0] = NAN;
    }
}

static void clean(fap_take *take, uint32_t methods, fap_clean_point points[POINTS])
{
    fap_clean_config cfg;
    fap_clean_report r;

    fap_clean_config_init(&cfg);
    cfg.spike_mm = 0;
    cfg.methods = methods;
    assert_int_equal(fap_take_clean(take, &cfg, &r, points), FAP_OK);
}

static double farthest(const fap_take *take, uint32_t point, uint32_t first, uint32_t length)
{
    double most = 0;
    float v[3];

    for (uint32_t f = first; f < first + length; f++) {
        const float *x = take->xyz[f * POINTS + point];
        place(f, point, v);
        assert_true(take->valid[f * POINTS + point]);
        most = fmax(most, sqrt(pow(x[0] - v[0], 2) + pow(x[1] - v[1], 2) + pow(x[2] - v[2], 2)));
    }
    return most;
}

TEST(fill, a_brief_gap_is_closed_by_a_curve)
{
    fap_take *take = mouth();
    fap_clean_point points[POINTS];

    hide(take, 8, 100, 5);
    clean(take, FAP_CLEAN_TAKE, points);
    assert_true(farthest(take, 8, 100, 5) < 0.05);
    assert_int_equal(take->valid[102 * POINTS + 8], FAP_SAMPLE_SPLINE);
    assert_int_equal(points[8].filled[FAP_SAMPLE_SPLINE], 5);
    assert_int_equal(points[7].gaps, 0);
    fap_take_close(&take);
}

TEST(fill, in_a_long_one_the_others_tell)
{
    fap_take *take = mouth();
    fap_clean_point points[POINTS];

    hide(take, 8, 100, 120);
    clean(take, FAP_CLEAN_TAKE, points);
    assert_true(farthest(take, 8, 100, 120) < 0.5);
    assert_int_equal(points[8].filled[FAP_SAMPLE_MOTION], 120);
    assert_int_equal(points[8].longest_gap, 120);
    assert_true(points[8].error_mm > 0 && points[8].error_mm < 0.5f);
    fap_take_close(&take);
}

TEST(fill, each_method_alone_joins_its_ends)
{
    static const fap_sample methods[] = { FAP_SAMPLE_SURFACE, FAP_SAMPLE_MOTION };

    for (int m = 0; m < 2; m++) {
        fap_take *take = mouth();
        fap_clean_point points[POINTS];
        hide(take, 8, 100, 60);
        clean(take, 1u << methods[m], points);
        assert_int_equal(points[8].filled[methods[m]], 60);
        assert_true(farthest(take, 8, 100, 60) < 3);
        assert_true(farthest(take, 8, 100, 2) < 0.3);
        assert_true(farthest(take, 8, 158, 2) < 0.3);
        fap_take_close(&take);
    }
}

TEST(fill, a_point_on_the_skull_goes_with_the_skull)
{
    fap_take *take = mouth();
    fap_clean_point points[POINTS];

    hide(take, 2, 0, 150); /* the start of the take: nothing to come from */
    clean(take, 1u << FAP_SAMPLE_RIGID, points);
    assert_true(farthest(take, 2, 0, 150) < 0.2);
    fap_take_close(&take);
}

TEST(fill, what_nobody_tells_stays_open)
{
    fap_take *take = mouth();
    fap_clean_point points[POINTS];

    for (uint32_t p = 0; p < POINTS; p++)
        hide(take, p, 100, 60);
    hide(take, 3, 0, FRAMES);
    clean(take, FAP_CLEAN_TAKE, points);
    for (uint32_t p = 0; p < POINTS; p++)
        assert_int_equal(points[p].unfilled, p == 3 ? FRAMES : 60);
    fap_take_close(&take);
}

TEST(fill, takes_that_are_no_face_do_no_harm)
{
    fap_clean_point points[POINTS];

    for (int kind = 0; kind < 4; kind++) {
        fap_take *take = mouth();
        for (uint32_t i = 0; i < FRAMES * POINTS; i++) {
            float *v = take->xyz[i];
            if (kind == 0)
                v[0] = v[1] = v[2] = 7; /* all in one place */
            else if (kind == 1)
                v[0] = v[1] = v[2] = (float)(i % POINTS); /* in a line */
            else if (kind == 2)
                v[0] = v[1] = 1e30f;
            else
                take->valid[i] = 0;
        }
        for (uint32_t p = 0; p < POINTS; p++)
            hide(take, p, 40 + 9 * p, 20 + 8 * p);
        clean(take, FAP_CLEAN_TAKE, points);
        for (uint32_t i = 0; i < FRAMES * POINTS; i++)
            for (int axis = 0; axis < 3 && take->valid[i]; axis++)
                assert_true(isfinite(take->xyz[i][axis]));
        fap_take_close(&take);
    }
}

TEST(curve, lines_stay_lines_and_a_remainder_fades)
{
    double t[16], v[16][3], out[3];
    curve c;

    for (int i = 0; i < 16; i++) {
        t[i] = i < 8 ? i : i + 30;
        for (int axis = 0; axis < 3; axis++)
            v[i][axis] = 5 + axis * t[i];
    }
    assert_true(curve_fit(&c, CURVE_SPLINE, 15, t, (const double(*)[3])v, 16));
    curve_value(&c, 22, out);
    assert_float_equal(out[2], 49, 1e-6);
    assert_true(curve_fit(&c, CURVE_REMAINDER, 2, t, (const double(*)[3])v, 16));
    curve_value(&c, 22, out);
    assert_float_equal(out[2], 0, 0.1);
    curve_value(&c, 7, out);
    assert_float_equal(out[0], 5, 0.01);
    assert_false(curve_fit(&c, CURVE_SPLINE, 15, t, (const double(*)[3])v, 0));
}
