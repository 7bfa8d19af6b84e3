/* SPDX-License-Identifier: BSD-2-Clause */
/* Surface files: what is good is read the same from every encoding, what is not is refused with the place. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/surface.h>

#include "common/file.h"
#include "shape/bytes.h"
#include "surface/foot.h"
#include "surface/nearest.h"

static char where[FAP_ERROR_TEXT_SIZE];

static fap_err read_text(fap_surface **s, const char *text)
{
    return fap_surface_read(s, text, strlen(text), NULL, where);
}

static int keep(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return 0;
}

static const char square_ply[] =
    "ply\nformat ascii 1.0\ncomment a square of two kinds of corners\nelement vertex 4\n"
    "property float x\nproperty double y\nproperty float z\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nproperty list uchar int neighbours\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 255 0 0 1 7\n1 0 0 0 255 0 0\n1 1 0.5 0 0 255 2 1 2\n0 1 0 9 9 9 0\n4 0 1 2 3\n";

TEST(surface, an_ascii_ply_with_colours_lists_and_a_polygon_is_read)
{
    fap_surface *s;

    assert_int_equal(read_text(&s, square_ply), FAP_OK);
    assert_string_equal(s->format, "ply");
    assert_int_equal(s->vertex_count, 4);
    assert_int_equal(s->triangle_count, 2);
    assert_int_equal(s->triangle[1][0], 0);
    assert_int_equal(s->triangle[1][2], 3);
    assert_float_equal(s->position[2][2], 0.5, 0);
    assert_int_equal(s->colour[1][1], 255);
    assert_int_equal(s->colour[3][3], 255);
    fap_surface_close(&s);
    assert_null(s);
}

TEST(surface, what_is_written_as_ply_or_obj_is_read_back)
{
    fap_surface *s, *again;
    fap_bytes ply = { 0 }, obj = { 0 };
    const fap_writer to_ply = { keep, &ply }, to_obj = { keep, &obj };

    assert_int_equal(read_text(&s, square_ply), FAP_OK);
    assert_int_equal(fap_surface_write_ply(s, &to_ply), FAP_OK);
    assert_int_equal(fap_surface_write_obj(s, &to_obj), FAP_OK);
    assert_int_equal(fap_surface_read(&again, ply.data, ply.size, NULL, where), FAP_OK);
    assert_memory_equal(s->position, again->position, 4 * sizeof *s->position);
    assert_memory_equal(s->triangle, again->triangle, 2 * sizeof *s->triangle);
    assert_memory_equal(s->colour, again->colour, 4 * sizeof *s->colour);
    fap_surface_close(&again);
    assert_int_equal(fap_surface_read(&again, obj.data, obj.size, NULL, where), FAP_OK);
    assert_string_equal(again->format, "obj");
    assert_memory_equal(s->position, again->position, 4 * sizeof *s->position);
    assert_memory_equal(s->triangle, again->triangle, 2 * sizeof *s->triangle);
    fap_surface_close(&again);
    fap_surface_close(&s);
    fap_bytes_free(&ply);
    fap_bytes_free(&obj);
}

TEST(surface, big_endian_numbers_and_strips_are_read)
{
    static const char head[] =
        "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 4\r\nproperty short x\r\n"
        "property short y\r\nproperty float z\r\nelement tristrips 1\r\n"
        "property list uchar short vertex_indices\r\nend_header\r\n";
    static const uint8_t body[] = { 0, 1, 0, 2, 0x3f, 0x80, 0, 0, 0, 0, 0xff, 0xfe, 0, 0, 0, 0, 1, 0, 0, 0, 0,
                                    0, 0, 0, 0, 9,    0,    9, 0, 0, 0, 0,    4,    0, 0, 0, 1, 0, 2, 0, 3 };
    uint8_t file[sizeof head - 1 + sizeof body];
    fap_surface *s;

    memcpy(file, head, sizeof head - 1);
    memcpy(file + sizeof head - 1, body, sizeof body);
    assert_int_equal(fap_surface_read(&s, file, sizeof file, NULL, where), FAP_OK);
    assert_float_equal(s->position[0][1], 2, 0);
    assert_float_equal(s->position[0][2], 1, 0);
    assert_float_equal(s->position[1][1], -2, 0);
    assert_int_equal(s->triangle_count, 2);
    assert_int_equal(s->triangle[1][0], 2); /* the second of a strip turns the other way */
    assert_int_equal(s->triangle[1][1], 1);
    fap_surface_close(&s);
    for (size_t cut = 4; cut < sizeof file; cut++)
        assert_int_not_equal(fap_surface_read(&s, file, cut, NULL, where), FAP_OK);
}

TEST(surface, a_range_image_without_faces_is_meshed_where_it_was_seen)
{
    fap_surface *s;

    assert_int_equal(
        read_text(&s, "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 2\nelement vertex 5\n"
                      "property float x\nproperty float y\nproperty float z\nelement range_grid 6\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 1 0\n1 1 0\n2 1 0\n0 0 0\n1 0 0\n1 0\n1 1\n1 2\n1 3\n1 4\n0\n"),
        FAP_OK);
    assert_int_equal(s->columns, 3);
    assert_int_equal(s->rows, 2);
    assert_true(s->grid[5] == UINT32_MAX);
    assert_int_equal(s->triangle_count, 2); /* the right square lacks a corner that both its triangles need */
    fap_surface_close(&s);
}

TEST(surface, triangles_without_an_area_are_left_out_and_counted)
{
    fap_surface *s;

    assert_int_equal(read_text(&s, "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 4\nf 1 2 4\n"),
                     FAP_OK);
    assert_int_equal(s->triangle_count, 1);
    assert_int_equal(s->dropped, 2);
    assert_int_equal(s->note_count, 1);
    fap_surface_close(&s);
}

TEST(surface, nonsense_is_refused_with_its_place)
{
    static const struct {
        const char *text, *says;
        fap_err err;
    } bad[] = {
        { "solid cube\n", "neither", FAP_E_UNKNOWN_FORMAT },
        { "v 0 0 0\nv 1 0\n", "line 2", FAP_E_SYNTAX },
        { "v 0 0 0\nf 1 2 3\n", "line 2", FAP_E_SYNTAX },
        { "ply\nformat ascii 1.0\nelement vertex 1\n", "does not end", FAP_E_SYNTAX },
        { "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty "
          "float z\n"
          "end_header\n",
          "more than the file", FAP_E_DATA },
        { "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "x, y and z",
          FAP_E_DATA },
        { "ply\nformat ascii 1.0\nelement vertex 1\nproperty complex x\nend_header\n", "line 4",
          FAP_E_SYNTAX },
        { "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
          "z\nelement face 1\n"
          "property list uchar int vertex_index\nend_header\n1 2 3\n3 0 1 2\n",
          "names vertex 2 of 1", FAP_E_DATA },
        { "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
          "z\nend_header\n"
          "1 2 3\n4 five 6\n",
          "no number", FAP_E_DATA },
    };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fap_surface *s;
        assert_int_equal(read_text(&s, bad[i].text), bad[i].err);
        assert_null(s);
        assert_non_null(strstr(where, bad[i].says));
    }
}

TEST(surface, a_census_counts_pieces_borders_and_what_is_no_manifold)
{
    fap_surface *s;
    fap_surface_census c;

    /* Two triangles that share an edge, a third on it, one that is turned, one apart, a loose vertex. */
    assert_int_equal(
        read_text(&s, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 9 9 9\nv 10 9 9\nv 9 10 9\nv 5 5 5\n"
                      "f 1 2 3\nf 2 4 3\nf 2 3 5\nf 6 7 8\n"),
        FAP_OK);
    assert_int_equal(fap_surface_count(s, &c), FAP_OK);
    assert_int_equal(c.pieces, 2);
    assert_int_equal(c.crowded_edges, 1);
    assert_int_equal(c.border_edges, 9);
    assert_int_equal(c.loose, 1);
    assert_int_equal(c.turned_edges, 0);
    fap_surface_close(&s);
    assert_int_equal(read_text(&s, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n"), FAP_OK);
    assert_int_equal(fap_surface_count(s, &c), FAP_OK);
    assert_int_equal(c.turned_edges, 1);
    assert_float_equal(c.area, 1, 1e-9);
    fap_surface_close(&s);
}

TEST(surface, the_foot_on_a_triangle_is_in_each_of_its_seven_regions)
{
    static const float a[3] = { 0, 0, 0 }, b[3] = { 4, 0, 0 }, c[3] = { 0, 4, 0 };
    static const struct {
        float at[3], foot[3];
    } cases[] = { { { 1, 1, 5 }, { 1, 1, 0 } },  { { -1, -2, 1 }, { 0, 0, 0 } },
                  { { 6, -1, 0 }, { 4, 0, 0 } }, { { -1, 7, 2 }, { 0, 4, 0 } },
                  { { 2, -3, 1 }, { 2, 0, 0 } }, { { -3, 2, 1 }, { 0, 2, 0 } },
                  { { 3, 3, 1 }, { 2, 2, 0 } } };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float share[3], foot[3];
        surface_foot(a, b, c, cases[i].at, share, foot);
        assert_float_equal(share[0] + share[1] + share[2], 1, 1e-6);
        for (int k = 0; k < 3; k++)
            assert_float_equal(foot[k], cases[i].foot[k], 1e-6);
    }
}

/* A bumpy sheet of 20 x 20 squares. */
static fap_surface *make_sheet(void)
{
    fap_surface *s;
    uint32_t t = 0;

    assert_int_equal(fap_surface_create(&s, 21 * 21, 800, NULL), FAP_OK);
    for (uint32_t i = 0; i < 21 * 21; i++) {
        s->position[i][0] = (float)(i % 21);
        s->position[i][1] = (float)(i / 21);
        s->position[i][2] = 2 * sinf((float)i);
    }
    for (uint32_t y = 0; y < 20; y++)
        for (uint32_t x = 0; x < 20; x++, t += 2) {
            const uint32_t v = 21 * y + x;
            memcpy(s->triangle[t], (uint32_t[3]){ v, v + 1, v + 22 }, sizeof *s->triangle);
            memcpy(s->triangle[t + 1], (uint32_t[3]){ v, v + 22, v + 21 }, sizeof *s->triangle);
        }
    return s;
}

static float nearest_of_all(const fap_surface *s, const float at[3])
{
    float least = INFINITY;

    for (uint32_t t = 0; t < s->triangle_count; t++) {
        float share[3], foot[3];
        const uint32_t *v = s->triangle[t];
        surface_foot(s->position[v[0]], s->position[v[1]], s->position[v[2]], at, share, foot);
        least = fminf(least,
                      sqrtf(powf(foot[0] - at[0], 2) + powf(foot[1] - at[1], 2) + powf(foot[2] - at[2], 2)));
    }
    return least;
}

static int is_even(const void *user, uint32_t triangle)
{
    (void)user;
    return triangle % 2 == 0;
}

TEST(surface, the_nearest_place_is_what_looking_at_every_triangle_finds)
{
    fap_surface *s = make_sheet();
    surface_index *index;

    if (surface_index_open(&index, (const float(*)[3])s->position, s->vertex_count,
                           (const uint32_t(*)[3])s->triangle, s->triangle_count) == FAP_E_UNSUPPORTED) {
        fap_surface_close(&s);
        skip();
    }
    for (int i = 0; i < 200; i++) {
        const float at[3] = { 10 + 12 * sinf((float)i), 10 + 12 * cosf(3.1F * (float)i),
                              4 * sinf(7 * (float)i) };
        surface_hit h;
        assert_true(surface_index_nearest(index, at, 100, NULL, NULL, &h));
        assert_float_equal(h.distance, nearest_of_all(s, at), 1e-5);
        assert_true(surface_index_nearest(index, at, 100, is_even, NULL, &h));
        assert_int_equal(h.triangle % 2, 0);
    }
    const float far[3] = { 100, 0, 0 }, above[3] = { 5.3F, 5.4F, 50 }, down[3] = { 0, 0, -1 };
    surface_hit h;
    assert_false(surface_index_nearest(index, far, 5, NULL, NULL, &h));
    assert_true(surface_index_ray(index, above, down, 100, &h));
    assert_float_equal(h.at[0], 5.3F, 1e-5);
    assert_true(h.at[2] > -2 && h.at[2] < 2);
    assert_false(surface_index_ray(index, above, down, 10, &h));
    surface_index_close(&index);
    fap_surface_close(&s);
}

static fap_surface *read_corpus(const char *path)
{
    uint8_t *data;
    size_t size;
    fap_surface *s;

    assert_int_equal(file_read(path, 1 << 20, &data, &size), FAP_OK);
    assert_int_equal(fap_surface_read(&s, data, size, NULL, where), FAP_OK);
    free(data);
    return s;
}

TEST(surface, a_glb_has_its_nodes_transforms_and_its_targets_names)
{
    fap_surface *s = read_corpus("tests/fuzz/corpus/surface/square.glb");

    assert_string_equal(s->format, "gltf");
    assert_int_equal(s->vertex_count, 4);
    assert_int_equal(s->triangle_count, 2);
    assert_float_equal(s->position[2][0], 12, 0); /* twice as large, ten to the side */
    assert_float_equal(s->position[2][1], 2, 0);
    assert_int_equal(s->target_count, 2);
    assert_string_equal(s->target[1].name, "one corner");
    assert_float_equal(s->target[0].delta[3][2], 2, 0);
    assert_float_equal(s->target[1].delta[2][1], 12, 0); /* sparse: 6, and the others none */
    assert_float_equal(s->target[1].delta[1][1], 0, 0);
    fap_surface_close(&s);
}

TEST(surface, a_strip_in_a_glb_turns_at_every_triangle)
{
    fap_surface *s = read_corpus("tests/fuzz/corpus/surface/strip.glb");

    assert_int_equal(s->triangle_count, 2);
    assert_int_equal(s->triangle[0][0], 0);
    assert_int_equal(s->triangle[1][0], 2);
    assert_int_equal(s->triangle[1][1], 1);
    assert_float_equal(s->position[1][0], 0, 1e-6); /* turned by a quarter about z */
    assert_float_equal(s->position[1][1], 1, 1e-6);
    fap_surface_close(&s);
}

TEST(surface, a_glb_cut_anywhere_is_refused_or_smaller_never_a_crash)
{
    uint8_t *data;
    size_t size;

    assert_int_equal(file_read("tests/fuzz/corpus/surface/square.glb", 1 << 20, &data, &size), FAP_OK);
    for (size_t cut = 0; cut < size; cut++) {
        uint8_t *part = malloc(cut + 1);
        fap_surface *s;
        memcpy(part, data, cut);
        if (fap_surface_read(&s, part, cut, NULL, where) == FAP_OK)
            fap_surface_close(&s);
        free(part);
    }
    free(data);
}

TEST(surface, a_real_scan_is_read_whole)
{
    uint8_t *data;
    size_t size;
    fap_surface *s;

    assert_int_equal(file_read(test_shared("data/faces/scans/lps_head.ply"), 1 << 26, &data, &size), FAP_OK);
    assert_int_equal(fap_surface_read(&s, data, size, NULL, where), FAP_OK);
    assert_int_equal(s->vertex_count, 8839);
    assert_int_equal(s->triangle_count + s->dropped, 17678);
    fap_surface_close(&s);
    free(data);
}
