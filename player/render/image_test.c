/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures: PNG there and back, comparison, cutting at borders. */
#include "tests/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "player/render/image.h"

static image pattern(int width, int height)
{
    image im;

    assert_int_equal(image_create(&im, width, height), FAP_OK);
    for (int i = 0; i < width * height * 4; i++)
        im.rgba[i] = i % 4 == 3 ? 255 : (uint8_t)(i * 37 + i / 11);
    return im;
}

/* Writes bytes to a temporary file and returns its name. */
static const char *temporary(const void *data, size_t size)
{
    static char path[64];
    strcpy(path, "/tmp/fap_image_test_XXXXXX");
    const int fd = mkstemp(path);
    FILE *f = fdopen(fd, "wb");
    fwrite(data, 1, size, f);
    fclose(f);
    return path;
}

TEST(image, sizes_have_limits)
{
    image im;
    assert_int_equal(image_create(&im, 0, 4), FAP_E_LIMIT);
    assert_int_equal(image_create(&im, 4, -1), FAP_E_LIMIT);
    assert_int_equal(image_create(&im, 1 << 20, 1), FAP_E_LIMIT);
    assert_null(im.rgba);
}

TEST(image, png_gives_back_the_pixels_written)
{
    image in = pattern(19, 7), out;
    char *bytes = NULL;
    size_t size;
    FILE *f = open_memstream(&bytes, &size);

    if (image_write_png(&in, f, 1) == FAP_E_UNSUPPORTED)
        skip();
    fclose(f);
    const char *path = temporary(bytes, size);
    assert_int_equal(image_read_png(&out, path), FAP_OK);
    unlink(path);
    assert_int_equal(out.width, 19);
    assert_int_equal(out.height, 7);
    assert_memory_equal(in.rgba, out.rgba, 19 * 7 * 4);
    image_free(&out);

    for (size_t cut = 0; cut < size; cut += 5) { /* a file cut anywhere is refused or read, never more */
        path = temporary(bytes, cut);
        if (image_read_png(&out, path) == FAP_OK)
            image_free(&out);
        unlink(path);
    }
    free(bytes);
    image_free(&in);
    assert_int_equal(image_read_png(&out, "/tmp/fap_no_such_file.png"), FAP_E_NOT_FOUND);
}

TEST(image, png_keeps_alpha_only_where_it_means_something)
{
    for (int transparent = 0; transparent < 2; transparent++) {
        image in = pattern(3, 3), out;
        char *bytes = NULL;
        size_t size;
        FILE *f = open_memstream(&bytes, &size);

        in.rgba[3] = 77;
        in.transparent = transparent;
        if (image_write_png(&in, f, 1) == FAP_E_UNSUPPORTED)
            skip();
        fclose(f);
        const char *path = temporary(bytes, size);
        assert_int_equal(image_read_png(&out, path), FAP_OK);
        unlink(path);
        assert_int_equal(out.rgba[3], transparent ? 77 : 255);
        image_free(&out);
        image_free(&in);
        free(bytes);
    }
}

/* A wide soft edge at @x. */
static image edge_at(int x, int brighter)
{
    image im;

    assert_int_equal(image_create(&im, 64, 64), FAP_OK);
    for (int i = 0; i < 64 * 64; i++) {
        const int from = 16 * (i % 64 - x) + 110, v = (from < 20 ? 20 : from > 200 ? 200 : from) + brighter;
        memset(im.rgba + 4 * i, v, 3);
    }
    return im;
}

TEST(image, structure_is_of_shapes_and_not_of_light)
{
    image a = edge_at(30, 0), same = edge_at(30, 0), lit = edge_at(30, 12), moved = edge_at(36, 0);

    assert_true(image_structure(&a, &same) == 1);
    assert_true(image_structure(&a, &lit) > image_structure(&a, &moved));
    assert_true(image_structure(&a, &moved) < 0.95);
    image_free(&a);
    image_free(&same);
    image_free(&lit);
    image_free(&moved);
}

/* However far colours may be apart, what moved is not the same. */
TEST(image, tolerance_of_colours_is_none_of_shapes)
{
    image a = edge_at(30, 0), lit = edge_at(30, 3), moved = edge_at(40, 0);
    image_difference d;

    assert_int_equal(image_compare(&a, &lit, 255, &d, NULL), FAP_OK);
    assert_true(image_same(&d));
    assert_int_equal(image_compare(&a, &moved, 255, &d, NULL), FAP_OK);
    assert_int_equal(d.far_count, 0);
    assert_false(image_same(&d));
    image_free(&a);
    image_free(&lit);
    image_free(&moved);
}

TEST(image, noise_of_renderers_leaves_the_structure)
{
    image a = edge_at(30, 0), noisy = edge_at(30, 0);
    uint32_t seed = 1;

    for (int i = 0; i < 4 * 64 * 64; i++) {
        seed = seed * 1664525u + 1013904223u;
        noisy.rgba[i] = (uint8_t)(noisy.rgba[i] + (int)(seed >> 24) % 5 - 2);
    }
    assert_true(image_structure(&a, &noisy) > 0.95);
    image_free(&a);
    image_free(&noisy);
}

TEST(image, pictures_smaller_than_a_window_have_structure_too)
{
    image a = pattern(3, 2), b = pattern(3, 2);

    assert_true(image_structure(&a, &b) == 1);
    image_free(&a);
    image_free(&b);
}

TEST(image, comparison_allows_a_few_pixels_and_no_more)
{
    image a = pattern(100, 100), b = pattern(100, 100), diff;
    image_difference d;

    assert_int_equal(image_compare(&a, &b, 2, &d, NULL), FAP_OK);
    assert_int_equal(d.worst, 0);
    assert_true(image_same(&d));

    a.rgba[0] = 10, b.rgba[0] = 12; /* within the tolerance */
    for (int i = 1; i <= 5; i++)
        a.rgba[400 * i] = 0, b.rgba[400 * i] = 200; /* 5 of 10,000 is the limit */
    assert_int_equal(image_compare(&a, &b, 2, &d, &diff), FAP_OK);
    assert_int_equal(d.far_count, 5);
    assert_int_equal(d.worst, 200);
    assert_true(image_same(&d));
    assert_int_equal(diff.rgba[400], 255);
    assert_int_equal(diff.rgba[401], 0);
    image_free(&diff);

    a.rgba[0] = 13 - 4;
    assert_int_equal(image_compare(&a, &b, 2, &d, NULL), FAP_OK);
    assert_false(image_same(&d));
    image_free(&b);

    b = pattern(100, 99);
    assert_int_equal(image_compare(&a, &b, 2, &d, NULL), FAP_E_DATA);
    image_free(&a);
    image_free(&b);
}

TEST(image, blits_and_letters_are_cut_at_the_border)
{
    static const uint8_t white[3] = { 255, 255, 255 };
    image page = pattern(16, 16), stamp = pattern(8, 8);

    for (int at = -12; at < 24; at += 4) {
        image_blit(&page, &stamp, at, 20 - at);
        image_text(&page, at, 12 - at, 2, white, "Ag1?\xe4");
    }
    image_blit(&page, &stamp, 4, 5);
    assert_memory_equal(page.rgba + 4 * (5 * 16 + 4), stamp.rgba, 8 * 4);
    image_free(&page);
    image_free(&stamp);
}

TEST(image, sheets_hold_every_picture)
{
    for (int count = 1; count <= 60; count++) {
        int columns, rows;
        image_sheet_grid(count, &columns, &rows);
        assert_true(columns * rows >= count);
        assert_true(columns * (rows - 1) < count);
    }
}
