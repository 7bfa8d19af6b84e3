/* SPDX-License-Identifier: BSD-2-Clause */
/* What a film says of itself is true: dots are drawn where it says, and mirrors are where their pictures put them. */
#include <math.h>
#include <stdlib.h>

#include "film.h"
#include "tests/test.h"

enum { WIDTH = 320, HEIGHT = 240 };

typedef struct shot {
    fap_bank *bank;
    film *film;
    film_dot dot[FILM_DOTS];
    uint8_t rgb[3 * WIDTH * HEIGHT];
} shot;

static shot *shoot(const film_config *cfg, int frame)
{
    shot *s = calloc(1, sizeof *s);

    assert_non_null(s);
    assert_int_equal(fap_bank_builtin(&s->bank, NULL), FAP_OK);
    s->film = film_open(cfg, s->bank);
    assert_non_null(s->film);
    film_draw(s->film, frame, s->rgb, s->dot);
    return s;
}

static void drop(shot *s)
{
    film_close(&s->film);
    fap_bank_close(&s->bank);
    free(s);
}

static film_config small(void)
{
    film_config cfg;

    film_config_init(&cfg);
    cfg.width_px = WIDTH;
    cfg.height_px = HEIGHT;
    cfg.dot_mm = 7;
    cfg.seconds = 1;
    return cfg;
}

static int at(const shot *s, double x, double y, int channel)
{
    return s->rgb[3 * (lrint(y) * WIDTH + lrint(x)) + channel];
}

static int seen(const film_dot *d, int view)
{
    return d->shown[view] > 0.9;
}

TEST(film, most_dots_are_seen_directly_and_in_the_mirror_on_their_side)
{
    const film_config cfg = small();
    shot *s = shoot(&cfg, 0);
    int direct = 0, mirrored = 0, both = 0;

    for (int i = 0; i < FILM_DOTS; i++) {
        direct += seen(&s->dot[i], 0);
        mirrored += seen(&s->dot[i], 1) || seen(&s->dot[i], 2);
        both += seen(&s->dot[i], 1) && seen(&s->dot[i], 2);
    }
    assert_in_range(direct, FILM_DOTS - 14, FILM_DOTS);
    assert_in_range(mirrored, FILM_DOTS - 14, FILM_DOTS);
    assert_in_range(both, 3, FILM_DOTS / 2);
    drop(s);
}

/* How much a pixel differs from another; 0 where that is hardly to be seen. */
static double stands_out(const shot *s, int x, int y, int x0, int y0)
{
    double sum = -20;

    for (int k = 0; k < 3; k++)
        sum += fabs((double)at(s, x, y, k) - at(s, x0, y0, k));
    return fmax(0, sum);
}

/* The ruler's ends are balls before the dark wall. */
static void centre_of(const shot *s, const film_dot *d, int view, double centre[2])
{
    const int x0 = (int)d->pixel[view][0], y0 = (int)d->pixel[view][1], reach = 4;
    double sum = 0, x = 0, y = 0;

    for (int v = y0 - reach; v <= y0 + reach; v++)
        for (int u = x0 - reach; u <= x0 + reach; u++) {
            const double w = stands_out(s, u, v, x0 - reach, y0 - reach);
            sum += w, x += w * u, y += w * v;
        }
    centre[0] = x / sum;
    centre[1] = y / sum;
}

TEST(film, what_is_drawn_is_where_the_truth_says)
{
    film_config cfg = small();

    cfg.samples = 16;
    shot *s = shoot(&cfg, 0);
    int looked_at = 0;
    for (int i = FILM_DOTS - 2; i < FILM_DOTS; i++)
        for (int view = 0; view < FILM_VIEWS; view++) {
            double centre[2];
            if (!seen(&s->dot[i], view))
                continue;
            looked_at++;
            centre_of(s, &s->dot[i], view, centre);
            assert_true(fabs(centre[0] - s->dot[i].pixel[view][0]) < 0.15);
            assert_true(fabs(centre[1] - s->dot[i].pixel[view][1]) < 0.15);
        }
    assert_in_range(looked_at, 4, 6);
    drop(s);
}

TEST(film, reflections_and_places_agree)
{
    const film_config cfg = small();
    shot *s = shoot(&cfg, 12);

    for (int i = 0; i < FILM_DOTS; i++) {
        fap_mirror_views v = { .seen = { 1, 1, 1 } };
        double place[3], residual;
        for (int view = 0; view < FILM_VIEWS; view++)
            fap_camera_ray(film_camera(s->film), s->dot[i].pixel[view], v.ray[view]);
        assert_true(fap_mirror_locate(film_mirror(s->film), 2, &v, place, &residual));
        for (int k = 0; k < 3; k++)
            assert_true(fabs(place[k] - s->dot[i].place[k]) < 1e-5);
        assert_true(residual < 1e-8);
    }
    drop(s);
}

TEST(film, the_ball_hides_dots_of_the_mouth_and_goes)
{
    film_config cfg = small();
    int hidden[3] = { 0 };

    cfg.hides = 1;
    for (int i = 0; i < 3; i++) {
        shot *s = shoot(&cfg, 15 * i);
        for (int d = 0; d < FILM_DOTS; d++)
            hidden[i] += !seen(&s->dot[d], 0);
        drop(s);
    }
    assert_true(hidden[1] >= hidden[0] + 3);
    assert_true(hidden[1] >= hidden[2] + 3);
}

TEST(film, a_film_is_the_same_each_time_and_seeds_differ)
{
    film_config cfg = small();

    cfg.noise = 4;
    shot *a = shoot(&cfg, 3), *b = shoot(&cfg, 3);
    assert_memory_equal(a->rgb, b->rgb, sizeof a->rgb);
    cfg.seed = 2;
    shot *c = shoot(&cfg, 3);
    assert_memory_not_equal(a->rgb, c->rgb, sizeof a->rgb);
    drop(a);
    drop(b);
    drop(c);
}
