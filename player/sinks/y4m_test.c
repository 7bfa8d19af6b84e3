/* SPDX-License-Identifier: BSD-2-Clause */
/* Colours as ITU-R BT.709 has them, and rates that readers know. */
#include "tests/test.h"

#include <stdlib.h>

#include "player/sinks/y4m.h"

static image filled(int width, int height, int r, int g, int b)
{
    image im;

    assert_int_equal(image_create(&im, width, height), FAP_OK);
    for (int i = 0; i < width * height; i++) {
        im.rgba[4 * i] = (uint8_t)r;
        im.rgba[4 * i + 1] = (uint8_t)g;
        im.rgba[4 * i + 2] = (uint8_t)b;
    }
    return im;
}

static void converts(int r, int g, int b, int y, int u, int v)
{
    image im = filled(2, 2, r, g, b);
    y4m_picture p;

    assert_true(y4m_picture_make(&p, 2, 2));
    y4m_picture_set(&p, &im);
    assert_int_equal(p.y[0], y);
    assert_int_equal(p.y[3], y);
    assert_int_equal(*p.u, u);
    assert_int_equal(*p.v, v);
    free(p.y);
    image_free(&im);
}

/* Expected: Y = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B) and so on, worked out by hand. */
TEST(y4m, colours_are_those_of_bt709)
{
    converts(0, 0, 0, 16, 128, 128);
    converts(255, 255, 255, 235, 128, 128);
    converts(255, 0, 0, 63, 102, 240);
    converts(0, 255, 0, 173, 42, 26);
    converts(0, 0, 255, 32, 240, 118);
    converts(128, 128, 128, 126, 128, 128);
}

TEST(y4m, odd_sides_have_colour_to_the_border)
{
    image im = filled(3, 3, 255, 0, 0);
    y4m_picture p;

    assert_true(y4m_picture_make(&p, 3, 3));
    assert_int_equal(p.size, 9 + 4 + 4);
    y4m_picture_set(&p, &im);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(p.u[i], 102);
        assert_int_equal(p.v[i], 240);
    }
    free(p.y);
    image_free(&im);
}

static void is_rate(double hz, int64_t frames, int64_t seconds)
{
    const y4m_rate r = y4m_rate_of(hz);

    assert_int_equal(r.frames, frames);
    assert_int_equal(r.seconds, seconds);
}

TEST(y4m, rates_are_fractions)
{
    is_rate(25, 25, 1);
    is_rate(60, 60, 1);
    is_rate(30000.0 / 1001, 30000, 1001);
    is_rate(29.97, 30000, 1001);
    is_rate(23.976, 24000, 1001);
    is_rate(59.94, 60000, 1001);
    is_rate(12.5, 125, 10);
    is_rate(0.001, 1, 1000);
    is_rate(1000, 1000, 1);
    is_rate(100.0 / 3, 33333333, 1000000);
}
