/* SPDX-License-Identifier: BSD-2-Clause */
/* Mirrors are found again from points that were projected through known ones. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <fap/error.h>
#include <fap/studio/mirror.h>

#include "capture/rigid.h"
#include "tests/test.h"
#include "track/vector.h"

enum { DOTS = 60, FRAMES = 20, POINTS = DOTS * FRAMES };

static const double focal = 900, two_pixels = 2.0 / 900;

/* The same numbers each time, about 0 and of variance 1: twelve evenly spread ones added. */
static double noise(uint32_t *state)
{
    double sum = -6;

    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525U + 1013904223U;
        sum += (*state >> 8) / 16777216.0;
    }
    return sum;
}

/* Beside a face half a metre away, turned towards it. */
static void make_mirrors(fap_mirror_plane m[2])
{
    for (int i = 0; i < 2; i++) {
        m[i] = (fap_mirror_plane){ { i ? -0.77 : 0.74, 0.05, -0.64 }, i ? -390 : -400 };
        unit3(m[i].normal);
    }
}

/* Dots on a bulge; from frame to frame the head turns and moves. */
static void place_of(int i, double place[3])
{
    const int dot = i % DOTS, frame = i / DOTS;
    const double turn = 2.4 * dot, size = 70 * sqrt((dot + 0.5) / DOTS), yaw = 0.15 * sin(frame);
    const double x = size * cos(turn), y = 1.3 * size * sin(turn), z = 0.008 * (x * x + 0.3 * y * y) - 20;

    place[0] = x * cos(yaw) + z * sin(yaw) + 15 * sin(0.7 * frame);
    place[1] = y + 10 * cos(1.3 * frame);
    place[2] = 600 + z * cos(yaw) - x * sin(yaw) + 20 * sin(0.4 * frame);
}

static void see(const fap_mirror_plane m[2], int i, double pixels, uint32_t *state, fap_mirror_views *v)
{
    double at[3], image[3];

    place_of(i, at);
    *v = (fap_mirror_views){ .seen = { 1, 1, 1 } };
    for (int view = 0; view < 3; view++) {
        memcpy(image, at, sizeof at);
        if (view)
            fap_mirror_reflect(&m[view - 1], at, image);
        assert_true(image[2] > 0);
        for (int k = 0; k < 2; k++)
            v->ray[view][k] = image[k] / image[2] + pixels / focal * noise(state);
    }
}

static void see_all(const fap_mirror_plane m[2], double pixels, fap_mirror_views *v)
{
    uint32_t state = 7;

    for (int i = 0; i < POINTS; i++)
        see(m, i, pixels, &state, &v[i]);
}

static void pairs_of(const fap_mirror_views *v, int mirror, fap_mirror_pair *pair)
{
    for (int i = 0; i < POINTS; i++) {
        memcpy(pair[i].direct, v[i].ray[0], sizeof pair[i].direct);
        memcpy(pair[i].mirrored, v[i].ray[1 + mirror], sizeof pair[i].mirrored);
    }
}

static double degrees_between(const double a[3], const double b[3])
{
    return acos(fmin(1, fabs(dot3(a, b)))) * 180 / 3.14159265358979;
}

/* RMS distance from the truth of the first frame's dots; @p aligned: wherever the camera is. */
static double place_error(const fap_mirror_plane *m, const fap_mirror_views *v, int aligned)
{
    double got[DOTS][3], want[DOTS][3], weight[DOTS], sum = 0;
    rigid_pose pose;

    for (int i = 0; i < DOTS; i++) {
        assert_true(fap_mirror_locate(m, 2, &v[i], got[i], NULL));
        place_of(i, want[i]);
        weight[i] = 1;
    }
    if (aligned)
        assert_true(rigid_fit((const double(*)[3])got, (const double(*)[3])want, weight, DOTS, &pose));
    for (int i = 0; i < DOTS; i++) {
        if (aligned)
            rigid_apply(&pose, got[i], got[i]);
        add_scaled3(got[i], want[i], -1);
        sum += dot3(got[i], got[i]);
    }
    return sqrt(sum / DOTS);
}

/* As with a ruler: two dots that are known to be so far apart. */
static double ruler_factor(const fap_mirror_plane *m, const fap_mirror_views *v)
{
    double a[3], b[3], ta[3], tb[3];

    assert_true(fap_mirror_locate(m, 2, &v[DOTS - 1], a, NULL) &&
                fap_mirror_locate(m, 2, &v[DOTS - 9], b, NULL));
    place_of(DOTS - 1, ta);
    place_of(DOTS - 9, tb);
    add_scaled3(a, b, -1);
    add_scaled3(ta, tb, -1);
    return sqrt(dot3(ta, ta) / dot3(a, a));
}

TEST(mirror, exact_pairs_give_the_exact_mirror)
{
    fap_mirror_plane truth[2], got;
    fap_mirror_views v[POINTS];
    fap_mirror_pair pair[POINTS];
    fap_mirror_fit fit;

    make_mirrors(truth);
    see_all(truth, 0, v);
    for (int i = 0; i < 2; i++) {
        pairs_of(v, i, pair);
        assert_int_equal(fap_mirror_find(&got, pair, POINTS, two_pixels, &fit, NULL), FAP_OK);
        assert_true(degrees_between(got.normal, truth[i].normal) < 1e-6);
        assert_true(got.normal[2] < 0);
        assert_int_equal(fit.fitting, POINTS);
    }
}

TEST(mirror, places_are_exact_where_pictures_are)
{
    fap_mirror_plane m[2];
    fap_mirror_views v[POINTS];
    fap_mirror_pair pair[POINTS];

    make_mirrors(m);
    see_all(m, 0, v);
    pairs_of(v, 1, pair);
    for (int i = 0; i < POINTS; i++) {
        double got[3], want[3];
        place_of(i, want);
        assert_true(fap_mirror_place(&m[1], &pair[i], got));
        add_scaled3(got, want, -1);
        assert_true(dot3(got, got) < 1e-12);
    }
    assert_true(place_error(m, v, 0) < 1e-6);
}

TEST(mirror, a_third_of_wrong_pairs_does_no_harm)
{
    fap_mirror_plane truth[2], got;
    fap_mirror_views v[POINTS];
    fap_mirror_pair pair[POINTS];
    fap_mirror_fit fit;

    make_mirrors(truth);
    see_all(truth, 0.3, v);
    pairs_of(v, 0, pair);
    for (int i = 0; i < POINTS; i += 3)
        memcpy(pair[i].mirrored, v[(i + 25) % DOTS].ray[1], sizeof pair[i].mirrored);
    assert_int_equal(fap_mirror_find(&got, pair, POINTS, two_pixels, &fit, NULL), FAP_OK);
    assert_true(degrees_between(got.normal, truth[0].normal) < 1);
    assert_in_range(fit.fitting, POINTS * 2 / 3 - 40, POINTS * 2 / 3 + 60);
}

TEST(mirror, half_a_pixel_of_noise_costs_less_than_the_paper_s_millimetres)
{
    fap_mirror_plane truth[2], m[2];
    fap_mirror_views v[POINTS];
    fap_mirror_pair pair[POINTS];
    fap_mirror_fit fit;

    make_mirrors(truth);
    see_all(truth, 0.5, v);
    for (int i = 0; i < 2; i++) {
        pairs_of(v, i, pair);
        assert_int_equal(fap_mirror_find(&m[i], pair, POINTS, two_pixels, &fit, NULL), FAP_OK);
    }
    assert_true(fap_mirror_join(m, v, POINTS) >= 100);
    fap_mirror_scale(m, 2, ruler_factor(m, v));
    const double before = place_error(m, v, 1);
    fap_mirror_refine(m, 2, v, POINTS, two_pixels);
    fap_mirror_scale(m, 2, ruler_factor(m, v));
    const double after = place_error(m, v, 1);
    assert_true(after <= before);
    assert_true(after < 1.95);
    assert_true(degrees_between(m[0].normal, truth[0].normal) < 0.3);
}

TEST(mirror, a_point_that_is_hidden_from_the_lens_is_seen_by_two_mirrors)
{
    fap_mirror_plane m[2];
    fap_mirror_views v[POINTS];

    make_mirrors(m);
    see_all(m, 0, v);
    for (int i = 0; i < POINTS; i++)
        v[i].seen[0] = 0;
    assert_true(place_error(m, v, 0) < 1e-6);
    v[0].seen[1] = 0;
    double place[3];
    assert_false(fap_mirror_locate(m, 2, &v[0], place, NULL));
}

TEST(mirror, what_determines_no_mirror_is_refused_with_the_reason)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_mirror_plane got;
    fap_mirror_fit fit;
    fap_mirror_pair same[4] = { { { 0.1, 0.2 }, { 0.1, 0.2 } },
                                { { 0.2, 0.1 }, { 0.2, 0.1 } },
                                { { 0, 0 }, { 0, 0 } },
                                { { -0.1, 0 }, { -0.1, 0 } } };
    const fap_mirror_pair line[3] = { { { 0.1, 0 }, { 0.3, 0 } },
                                      { { 0.2, 0 }, { 0.35, 0 } },
                                      { { 0, 0 }, { 0.4, 0 } } };

    assert_int_equal(fap_mirror_find(&got, same, 1, two_pixels, &fit, where), FAP_E_DATA);
    assert_non_null(strstr(where, "two points"));
    assert_int_equal(fap_mirror_find(&got, same, 4, two_pixels, &fit, where), FAP_E_DATA);
    assert_int_equal(fap_mirror_find(&got, line, 3, two_pixels, &fit, where), FAP_E_DATA);
    same[0].direct[0] = NAN;
    assert_int_equal(fap_mirror_find(&got, same, 4, two_pixels, &fit, NULL), FAP_E_DATA);
}

TEST(mirror, a_camera_s_rays_lead_back_to_its_pixels)
{
    fap_camera cam;

    fap_camera_guess(&cam, 720, 480, 50);
    cam.k[0] = -0.12;
    cam.k[1] = 0.03;
    cam.k[2] = 0.001;
    cam.k[3] = -0.002;
    for (int x = 0; x < 720; x += 90)
        for (int y = 0; y < 480; y += 60) {
            const double pixel[2] = { x, y };
            double ray[2], back[2];
            fap_camera_ray(&cam, pixel, ray);
            assert_true(fap_camera_project(&cam, (const double[3]){ 5 * ray[0], 5 * ray[1], 5 }, back));
            assert_true(fabs(back[0] - x) < 1e-6 && fabs(back[1] - y) < 1e-6);
        }
}
