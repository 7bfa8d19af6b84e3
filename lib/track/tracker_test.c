/* SPDX-License-Identifier: BSD-2-Clause */
/* Discs on a speckled ground are followed: how exactly, through noise and blur, behind things, past each other. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/track.h>

#include "tests/test.h"
#include "track/kalman.h"

enum { WIDTH = 200, HEIGHT = 160, MAX_DISCS = 12 };

typedef struct scene {
    uint8_t rgb[HEIGHT][WIDTH][3];
    double at[MAX_DISCS][2], radius;
    uint8_t colour[MAX_DISCS][3];
    int discs;
    double blur[2]; /* how far discs move while the shutter is open */
    double noise;
    uint32_t random;
    int bar; /* columns from here to 30 further are covered; -1: none */
} scene;

static double next(scene *s)
{
    s->random = s->random * 1664525U + 1013904223U;
    return (s->random >> 8) / 16777216.0;
}

static double covered(const scene *s, int i, double x, double y)
{
    enum { MOMENTS = 5 };
    double sum = 0;

    for (int m = 0; m < MOMENTS; m++) {
        const double t = (double)m / (MOMENTS - 1) - 0.5;
        const double from = hypot(x - s->at[i][0] - t * s->blur[0], y - s->at[i][1] - t * s->blur[1]);
        sum += fmin(1, fmax(0, s->radius + 0.5 - from));
    }
    return sum / MOMENTS;
}

static void draw(scene *s)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double shade = 8 * sin(0.11 * x) + 6 * cos(0.07 * y + 0.05 * x);
            double c[3] = { 200 + shade, 150 + shade, 130 + shade };
            for (int i = 0; i < s->discs; i++) {
                const double w = covered(s, i, x, y);
                for (int k = 0; k < 3; k++)
                    c[k] += w * (s->colour[i][k] - c[k]);
            }
            for (int k = 0; k < 3; k++) {
                if (s->bar >= 0 && x >= s->bar && x < s->bar + 30)
                    c[k] = 90;
                const double grain = s->noise * (next(s) + next(s) + next(s) + next(s) - 2) * 1.73;
                s->rgb[y][x][k] = (uint8_t)fmin(255, fmax(0, c[k] + grain + 0.5));
            }
        }
}

static fap_picture picture_of(const scene *s)
{
    return (fap_picture){ &s->rgb[0][0][0], WIDTH, HEIGHT, sizeof s->rgb[0] };
}

static scene *make_scene(int discs)
{
    static const uint8_t colours[3][3] = { { 20, 60, 190 }, { 20, 150, 60 }, { 210, 30, 40 } };
    scene *s = calloc(1, sizeof *s);

    assert_non_null(s);
    s->radius = 3.2;
    s->discs = discs;
    s->bar = -1;
    s->random = 5;
    for (int i = 0; i < discs; i++) {
        memcpy(s->colour[i], colours[i % 3], 3);
        s->at[i][0] = 30.3 + 37 * (i % 4);
        s->at[i][1] = 30.7 + 36 * (i / 4);
    }
    return s;
}

static fap_tracker *open_on(scene *s)
{
    fap_tracker *t;

    draw(s);
    const fap_picture first = picture_of(s);
    assert_int_equal(fap_tracker_open(&t, NULL, &first, (const double(*)[2])s->at, s->discs), FAP_OK);
    return t;
}

static void step(fap_tracker *t, scene *s)
{
    draw(s);
    const fap_picture p = picture_of(s);
    assert_int_equal(fap_tracker_step(t, &p, 1), FAP_OK);
}

static double error_of(const fap_tracker *t, const scene *s, int i)
{
    const fap_track_point *p = &fap_tracker_points(t)[i];
    return hypot(p->x_px - s->at[i][0], p->y_px - s->at[i][1]);
}

/* Circles of 6 pixels, once in 30 pictures; another phase for each. */
static void move(scene *s, const double (*home)[2], int frame)
{
    for (int i = 0; i < s->discs; i++) {
        const double turn = 0.21 * frame + i;
        s->at[i][0] = home[i][0] + 6 * (cos(turn) - cos(i));
        s->at[i][1] = home[i][1] + 6 * (sin(turn) - sin(i));
    }
}

static double rms_along(scene *s, double noise, double blur)
{
    double home[MAX_DISCS][2], sum = 0;
    const int frames = 40;

    memcpy(home, s->at, sizeof home);
    s->noise = noise;
    s->blur[0] = blur;
    fap_tracker *t = open_on(s);
    for (int f = 1; f <= frames; f++) {
        move(s, (const double(*)[2])home, f);
        step(t, s);
        for (int i = 0; i < s->discs; i++) {
            assert_int_equal(fap_tracker_points(t)[i].state, FAP_TRACK_SEEN);
            sum += error_of(t, s, i) * error_of(t, s, i);
        }
    }
    fap_tracker_close(&t);
    return sqrt(sum / (frames * s->discs));
}

TEST(tracker, moving_discs_are_followed_to_a_fraction_of_a_pixel)
{
    scene *s = make_scene(12);

    assert_true(rms_along(s, 0, 0) < 0.12);
    free(s);
}

TEST(tracker, noise_and_blur_cost_little)
{
    scene *s = make_scene(12);

    assert_true(rms_along(s, 8, 0) < 0.25);
    free(s);
    s = make_scene(12);
    assert_true(rms_along(s, 4, 4) < 0.3);
    free(s);
}

TEST(tracker, the_radius_is_measured)
{
    for (double radius = 2; radius < 9; radius += 1.7) {
        scene *s = make_scene(4);
        s->radius = radius;
        fap_tracker *t = open_on(s);
        for (int i = 0; i < s->discs; i++)
            assert_true(fabs(fap_tracker_radius(t, i) - radius) < 1);
        fap_tracker_close(&t);
        free(s);
    }
}

TEST(tracker, a_carelessly_placed_point_moves_to_its_disc)
{
    scene *s = make_scene(12);
    double truth[MAX_DISCS][2];
    fap_tracker *t;

    draw(s);
    memcpy(truth, s->at, sizeof truth);
    for (int i = 0; i < s->discs; i++)
        s->at[i][i % 2] += 1.4;
    const fap_picture first = picture_of(s);
    assert_int_equal(fap_tracker_open(&t, NULL, &first, (const double(*)[2])s->at, s->discs), FAP_OK);
    memcpy(s->at, truth, sizeof truth);
    for (int i = 0; i < s->discs; i++)
        assert_true(error_of(t, s, i) < 0.3);
    fap_tracker_close(&t);
    free(s);
}

TEST(tracker, what_is_hidden_is_said_and_found_again)
{
    scene *s = make_scene(12);
    int hidden = 0;

    fap_tracker *t = open_on(s);
    /* A bar passes over everything while the discs drift. */
    for (int f = 0; f < 60; f++) {
        for (int i = 0; i < s->discs; i++)
            s->at[i][1] += 0.4;
        s->bar = f < 50 ? -30 + 5 * f : -1;
        step(t, s);
        for (int i = 0; i < s->discs; i++) {
            const int covered_now = s->bar > -1 && s->at[i][0] > s->bar + 5 && s->at[i][0] < s->bar + 25;
            hidden += covered_now;
            if (covered_now)
                assert_int_not_equal(fap_tracker_points(t)[i].state, FAP_TRACK_SEEN);
            assert_true(error_of(t, s, i) < 3);
        }
    }
    assert_true(hidden > 20);
    for (int i = 0; i < s->discs; i++) {
        assert_int_equal(fap_tracker_points(t)[i].state, FAP_TRACK_SEEN);
        assert_true(error_of(t, s, i) < 0.3);
    }
    fap_tracker_close(&t);
    free(s);
}

TEST(tracker, neighbours_of_one_colour_that_pass_do_not_change_places)
{
    scene *s = make_scene(2);

    memcpy(s->colour[1], s->colour[0], 3);
    s->at[0][0] = 40;
    s->at[1][0] = 120;
    s->at[0][1] = 80;
    s->at[1][1] = 88;
    fap_tracker *t = open_on(s);
    for (int f = 0; f < 30; f++) {
        s->at[0][0] += 2.5;
        s->at[1][0] -= 2.5;
        step(t, s);
    }
    for (int i = 0; i < 2; i++)
        assert_true(error_of(t, s, i) < 0.5);
    fap_tracker_close(&t);
    free(s);
}

TEST(tracker, a_lost_dot_stays_in_the_picture)
{
    scene *s = make_scene(4);

    fap_tracker *t = open_on(s);
    s->discs = 0;
    for (int f = 0; f < 200; f++)
        step(t, s);
    for (int i = 0; i < 4; i++) {
        const fap_track_point *p = &fap_tracker_points(t)[i];
        assert_int_equal(p->state, FAP_TRACK_LOST);
        assert_true(p->x_px >= 0 && p->x_px < WIDTH && p->y_px >= 0 && p->y_px < HEIGHT);
        assert_true(isfinite(p->variance_px2));
    }
    fap_tracker_close(&t);
    free(s);
}

TEST(tracker, wrong_arguments_are_refused)
{
    scene *s = make_scene(4);
    fap_tracker *t;
    const double outside[1][2] = { { WIDTH, 3 } }, nowhere[1][2] = { { NAN, 3 } };

    draw(s);
    fap_picture p = picture_of(s);
    assert_int_equal(fap_tracker_open(&t, NULL, &p, (const double(*)[2])outside, 1), FAP_E_ARG);
    assert_null(t);
    assert_int_equal(fap_tracker_open(&t, NULL, &p, (const double(*)[2])nowhere, 1), FAP_E_ARG);
    assert_int_equal(fap_tracker_open(&t, NULL, &p, (const double(*)[2])s->at, 0), FAP_E_ARG);
    assert_int_equal(fap_tracker_open(&t, NULL, &p, (const double(*)[2])s->at, FAP_TRACK_MAX_POINTS + 1),
                     FAP_E_LIMIT);
    assert_int_equal(fap_tracker_open(&t, NULL, &p, (const double(*)[2])s->at, 1), FAP_OK);
    p.width_px--;
    assert_int_equal(fap_tracker_step(t, &p, 1), FAP_E_ARG);
    fap_tracker_close(&t);
    fap_tracker_close(&t);
    free(s);
}

TEST(kalman, a_steady_motion_is_predicted)
{
    kalman k;

    kalman_start(&k, (const double[2]){ 10, 20 }, 0.04);
    for (int i = 1; i <= 30; i++) {
        kalman_predict(&k, 1, 0.01);
        kalman_measure(&k, (const double[2]){ 10 + 1.5 * i, 20 - 0.5 * i }, 0.04);
    }
    kalman_predict(&k, 2, 0.01);
    assert_true(fabs(k.p[0] - (10 + 1.5 * 32)) < 0.05 && fabs(k.p[1] - (20 - 0.5 * 32)) < 0.05);
}

TEST(kalman, a_bad_measurement_counts_little_and_uncertainty_grows_without_one)
{
    kalman k;

    kalman_start(&k, (const double[2]){ 0, 0 }, 0.04);
    for (int i = 0; i < 20; i++) {
        kalman_predict(&k, 1, 0.1);
        kalman_measure(&k, (const double[2]){ 0, 0 }, 0.04);
    }
    const double before = k.pp;
    kalman_predict(&k, 1, 0.1);
    assert_true(k.pp > before);
    kalman_measure(&k, (const double[2]){ 10, 0 }, 100);
    assert_true(k.p[0] < 0.1);
}
