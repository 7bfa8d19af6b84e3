/* SPDX-License-Identifier: BSD-2-Clause */
/* Range images become surfaces that keep their grid. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/range.h>

static char where[FAP_ERROR_TEXT_SIZE];
static const fap_range_camera camera = {
    .fx = 100, .fy = 100, .cx = 1, .cy = 1, .unit_mm = 0.5, .depth = "d"
};

static fap_surface *mesh(const float *depth, uint32_t columns, uint32_t rows)
{
    const fap_range_image im = { .columns = columns, .rows = rows, .depth = depth };
    fap_surface *s;

    assert_int_equal(fap_range_surface(&s, &im, &camera, NULL), FAP_OK);
    return s;
}

TEST(range, a_pixel_is_where_the_camera_saw_it)
{
    const float depth[9] = { 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1002 };
    fap_surface *s = mesh(depth, 3, 3);

    assert_int_equal(s->vertex_count, 9);
    assert_int_equal(s->triangle_count, 8);
    assert_float_equal(s->position[s->grid[0]][0], -5, 1e-4);
    assert_float_equal(s->position[s->grid[0]][1], 5, 1e-4);
    assert_float_equal(s->position[s->grid[0]][2], -500, 1e-4);
    assert_float_equal(s->position[s->grid[8]][2], -501, 1e-4);
    assert_float_equal(s->uv[s->grid[4]][0], 0.5, 1e-6);
    fap_surface_close(&s);
}

TEST(range, triangles_look_at_the_camera)
{
    const float depth[4] = { 1000, 1000, 1000, 1000 };
    fap_surface *s = mesh(depth, 2, 2);

    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const float *a = s->position[s->triangle[t][0]], *b = s->position[s->triangle[t][1]],
                    *c = s->position[s->triangle[t][2]];
        assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    fap_surface_close(&s);
}

TEST(range, what_was_not_seen_and_what_is_behind_is_not_joined)
{
    const float unseen[6] = { 1000, 0, 1000, 1000, 1000, NAN }, behind[4] = { 1000, 1000, 1000, 1200 };
    fap_surface *s = mesh(unseen, 3, 2);

    assert_int_equal(s->vertex_count, 4);
    assert_int_equal(s->triangle_count, 1);
    assert_true(s->grid[1] == UINT32_MAX && s->grid[5] == UINT32_MAX);
    fap_surface_close(&s);
    s = mesh(behind, 2, 2);
    assert_int_equal(s->triangle_count, 0);
    fap_surface_close(&s);
}

TEST(range, an_empty_or_impossible_picture_is_refused)
{
    const float depth[4] = { 0, -1, NAN, INFINITY };
    fap_range_image im = { .columns = 2, .rows = 2, .depth = depth };
    fap_range_camera bad = camera;
    fap_surface *s;

    assert_int_equal(fap_range_surface(&s, &im, &camera, NULL), FAP_E_NOT_FOUND);
    assert_null(s);
    bad.fx = NAN;
    assert_int_equal(fap_range_surface(&s, &im, &bad, NULL), FAP_E_ARG);
    im.rows = 1;
    assert_int_equal(fap_range_surface(&s, &im, &camera, NULL), FAP_E_ARG);
    im.rows = FAP_RANGE_MAX_SIDE + 1;
    assert_int_equal(fap_range_surface(&s, &im, &camera, NULL), FAP_E_LIMIT);
}

/* --- files --- */

static fap_err read_camera(const char *text)
{
    fap_range_camera c;
    return fap_range_camera_read(&c, text, strlen(text), where);
}

TEST(range, a_camera_is_read_from_json)
{
    static const char text[] =
        "{ \"note\": [1, {}], \"depth\": \"a b.png\", \"color\": \"c.png\", \"fx\": 5e2, \"fy\": 501,\n"
        " \"cx\": 320.5, \"cy\": 240, \"unit_mm\": 0.1 }";
    fap_range_camera c;

    assert_int_equal(fap_range_camera_read(&c, text, sizeof text - 1, where), FAP_OK);
    assert_string_equal(c.depth, "a b.png");
    assert_string_equal(c.colour, "c.png");
    assert_true(c.fx == 500 && c.fy == 501 && c.cx == 320.5 && c.cy == 240 && c.unit_mm == 0.1);
}

TEST(range, what_is_no_camera_is_refused)
{
    assert_int_equal(read_camera("[]"), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(read_camera("{}"), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(read_camera("{ \"depth\": \"d.png\", "), FAP_E_SYNTAX);
    assert_int_equal(read_camera("{ \"depth\": \"/etc/passwd\" }"), FAP_E_DATA);
    assert_int_equal(read_camera("{ \"depth\": \"..\" }"), FAP_E_DATA);
    assert_int_equal(
        read_camera("{ \"depth\": \"d\", \"fx\": -1, \"fy\": 1, \"cx\": 0, \"cy\": 0, \"unit_mm\": 1 }"),
        FAP_E_DATA);
    assert_int_equal(read_camera("{ \"depth\": \"d\", \"fx\": 1, \"fy\": 1, \"unit_mm\": 1 }"), FAP_E_DATA);
    assert_non_null(strstr(where, "cx"));
}

static fap_err read_pfm(const void *data, size_t size, float **depth)
{
    uint32_t columns, rows;
    return fap_range_read_pfm(depth, &columns, &rows, data, size, NULL);
}

TEST(range, a_float_map_is_turned_to_run_from_the_top_in_either_byte_order)
{
    static const uint8_t little[] = "Pf 1 2\n-1.0\n\0\0\x80\x3f\0\0\0\x40",
                         big[] = "Pf\n1 2\n1\n\x3f\x80\0\0\x40\0\0\0";
    float *depth;

    assert_int_equal(read_pfm(little, sizeof little - 1, &depth), FAP_OK);
    assert_true(depth[0] == 2 && depth[1] == 1);
    free(depth);
    assert_int_equal(read_pfm(big, sizeof big - 1, &depth), FAP_OK);
    assert_true(depth[0] == 2 && depth[1] == 1);
    free(depth);
}

TEST(range, a_float_map_that_is_cut_or_too_large_is_refused)
{
    static const uint8_t cut[] = "Pf 1 2\n-1.0\n\0\0\x80\x3f\0\0\0";
    float *depth;

    assert_int_equal(read_pfm(cut, sizeof cut - 1, &depth), FAP_E_DATA);
    assert_int_equal(read_pfm("Pf 99999 2\n-1\n", 14, &depth), FAP_E_LIMIT);
    assert_int_equal(read_pfm("Pf 0 2\n-1\n", 10, &depth), FAP_E_DATA);
    assert_int_equal(read_pfm("PF 1 1\n-1\n", 10, &depth), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(read_pfm("Pf 1 1\n", 7, &depth), FAP_E_DATA);
    assert_null(depth);
}
