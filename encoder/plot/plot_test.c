/* SPDX-License-Identifier: BSD-2-Clause */
/* Plots are read back: what is sent, not sent and filled can be seen in them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "encoder/plot/plot.h"
#include "player/render/image.h"
#include "tests/test.h"

#if defined HAVE_CAIRO && defined HAVE_PNG
enum { FRAMES = 100 };

/* Two seconds of one FAP, not sent from frame 40 to 59. */
static void make_frames(fap_frame *f)
{
    memset(f, 0, FRAMES * sizeof *f);
    for (int i = 0; i < FRAMES; i++) {
        f[i].pts_us = i * 20000;
        f[i].state[3] = i < 40 || i >= 60 ? FAP_CODED : FAP_ABSENT;
        f[i].value[3] = (int)lround(200 * sin(0.1 * i));
    }
}

static int late_is_filled(const void *user, size_t frame, int fap)
{
    (void)user;
    return fap == 3 && frame >= 80;
}

static size_t count_colour(const image *im, int r, int g, int b)
{
    size_t count = 0;

    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++)
        count += im->rgba[4 * i] == r && im->rgba[4 * i + 1] == g && im->rgba[4 * i + 2] == b;
    return count;
}

static void plot(const plot_content *p, image *im)
{
    char folder[] = "/tmp/plot_test_XXXXXX", path[64], where[FAP_ERROR_TEXT_SIZE];

    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/p.png", folder);
    assert_int_equal(plot_write(path, p, where), FAP_OK);
    assert_int_equal(image_read_png(im, path), FAP_OK);
    unlink(path);
    rmdir(folder);
}

TEST(plot, what_is_not_sent_is_grey_and_what_is_filled_is_orange)
{
    fap_frame frames[FRAMES];
    image without, with;

    make_frames(frames);
    plot_content p = { .title = "t", .subtitle = "", .frame = frames, .frame_count = FRAMES, .rate_hz = 50 };
    plot(&p, &without);
    /* A fifth of the panel's width, in its whole height, less the lines of the grid and the key. */
    assert_in_range(count_colour(&without, 0xe8, 0xe8, 0xec), 15000, 25000);
    assert_int_equal(count_colour(&without, 0xf2, 0xa6, 0x3a), 0);
    p.filled = late_is_filled;
    plot(&p, &with);
    assert_in_range(count_colour(&with, 0xf2, 0xa6, 0x3a), 500, 1200);
    assert_int_equal(without.height, with.height);
    image_free(&without);
    image_free(&with);
}

TEST(plot, a_panel_for_every_part_that_moves)
{
    fap_frame frames[FRAMES];
    image one, two;

    make_frames(frames);
    plot_content p = { .title = "t", .subtitle = "", .frame = frames, .frame_count = FRAMES, .rate_hz = 50 };
    plot(&p, &one);
    for (int i = 0; i < FRAMES; i++)
        frames[i].state[48] = FAP_CODED;
    plot(&p, &two);
    assert_true(two.height > one.height + 100);
    image_free(&one);
    image_free(&two);
}

TEST(plot, nothing_to_draw_is_an_error_and_leaves_no_file)
{
    const char path[] = "/tmp/plot_test_none.png";
    char where[FAP_ERROR_TEXT_SIZE];
    const plot_content p = { .title = "t", .subtitle = "", .rate_hz = 50 };

    unlink(path);
    assert_int_equal(plot_write(path, &p, where), FAP_E_NOT_FOUND);
    assert_int_equal(access(path, F_OK), -1);
}
#endif

TEST(plot, names_are_png_and_svg)
{
    assert_true(plot_name_known("a.png"));
    assert_true(plot_name_known("a.b/c.SVG"));
    assert_false(plot_name_known("a.jpg"));
    assert_false(plot_name_known("png"));
}
