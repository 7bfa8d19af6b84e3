/* SPDX-License-Identifier: BSD-2-Clause */
/* Articulography: Carstens' positions and MATLAB's files. */
#include "take/take_test.h"

/* --- .pos --- */

static void put_float(test_bytes *b, float v)
{
    uint32_t bits;
    uint8_t out[4];

    memcpy(&bits, &v, sizeof v);
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(bits >> 8 * i);
    test_bytes_write(b, out, sizeof out);
}

/* Three channels, the second without a sensor. */
static test_bytes make_pos(int frames)
{
    static const char head[] = "AG50xDATA_V003\n00000067\nNumberOfChannels=3\nSamplingFrequencyHz=250\n";
    test_bytes b = { 0 };

    assert_int_equal(sizeof head - 1, 67);
    test_bytes_write(&b, head, sizeof head - 1);
    for (int f = 0; f < frames; f++)
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < 7; i++)
                put_float(&b, c == 1 ? 0 : (float)(100 * c + 10 * i + f));
    return b;
}

static fap_err read_bytes(fap_take **take, const test_bytes *b, size_t size, char *where)
{
    return fap_take_read(take, b->data, size, NULL, where);
}

TEST(ema_pos, channels_with_sensors_in_the_heads_axes)
{
    char where[FAP_ERROR_TEXT_SIZE];
    test_bytes b = make_pos(5);
    fap_take *take;

    assert_int_equal(read_bytes(&take, &b, b.size, where), FAP_OK);
    assert_string_equal(take->format, "ema");
    assert_int_equal(take->frame_count, 5);
    assert_int_equal(take->point_count, 2);
    assert_float_equal(take->rate_hz, 250, 0);
    assert_string_equal(take->name[1], "Sensor3");
    /* x forward, y left, z up becomes x left, y up, z forward. */
    const float *at = fap_take_sample(take, 2, 1);
    assert_float_equal(at[0], 212, 0);
    assert_float_equal(at[1], 222, 0);
    assert_float_equal(at[2], 202, 0);
    fap_take_close(&take);
    /* Cut anywhere. */
    for (size_t size = 0; size < b.size; size++)
        if (read_bytes(&take, &b, size, where) == FAP_OK)
            fap_take_close(&take);
    memcpy(b.data + 15, "99999999", 8);
    assert_int_equal(read_bytes(&take, &b, b.size, where), FAP_E_SYNTAX);
    free(b.data);
}

/* --- .mat --- */

static void put_u32(test_bytes *b, uint32_t v)
{
    uint8_t out[4];

    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(v >> 8 * i);
    test_bytes_write(b, out, sizeof out);
}

static void put_element(test_bytes *b, uint32_t type, const void *data, size_t size)
{
    static const uint8_t zeros[8];

    put_u32(b, type);
    put_u32(b, (uint32_t)size);
    test_bytes_write(b, data, size);
    test_bytes_write(b, zeros, (8 - size % 8) % 8);
}

/* An array's head, whose size is filled in by close_array(). */
static size_t open_array(test_bytes *b, uint32_t class, uint32_t rows, uint32_t columns, const char *name)
{
    const uint32_t flags[2] = { class, 0 }, dimensions[2] = { rows, columns };
    const size_t at = b->size;

    put_u32(b, 14);
    put_u32(b, 0);
    put_element(b, 6, flags, sizeof flags);
    put_element(b, 5, dimensions, sizeof dimensions);
    put_element(b, 1, name, strlen(name));
    return at;
}

static void close_array(test_bytes *b, size_t at)
{
    const uint32_t size = (uint32_t)(b->size - at - 8);

    for (int i = 0; i < 4; i++)
        b->data[at + 4 + (size_t)i] = (uint8_t)(size >> 8 * i);
}

static void put_text(test_bytes *b, const char *text)
{
    const size_t at = open_array(b, 4, 1, (uint32_t)strlen(text), "");

    put_element(b, 16, text, strlen(text));
    close_array(b, at);
}

static void put_signal(test_bytes *b, uint32_t rows, uint32_t columns, float base)
{
    float value[256];
    const size_t at = open_array(b, 7, rows, columns, "");

    for (uint32_t i = 0; i < rows * columns; i++)
        value[i] = base + (float)i;
    put_element(b, 7, value, rows * columns * sizeof *value);
    close_array(b, at);
}

/* A sound, two sensors, and one of another length. */
static test_bytes make_mat(void)
{
    static const struct {
        const char *name;
        uint32_t rows, columns;
    } member[4] = { { "AUDIO", 40, 1 }, { "TT", 4, 6 }, { "UL", 4, 3 }, { "LL", 5, 3 } };
    const int32_t name_size = 8;
    const uint8_t rate = 100;
    test_bytes b = { 0 };

    test_bytes_write(&b, "MATLAB 5.0 MAT-file", 19);
    while (b.size < 124)
        test_bytes_write(&b, " ", 1);
    test_bytes_write(&b, "\0\1IM", 4);
    const size_t at = open_array(&b, 2, 1, 4, "take");
    put_element(&b, 5, &name_size, 4);
    put_element(&b, 1, "NAME\0\0\0\0SRATE\0\0\0SIGNAL\0\0", 24);
    for (int i = 0; i < 4; i++) {
        put_text(&b, member[i].name);
        const size_t number = open_array(&b, 6, 1, 1, "");
        put_element(&b, 2, &rate, 1);
        close_array(&b, number);
        put_signal(&b, member[i].rows, member[i].columns, (float)(100 * i));
    }
    close_array(&b, at);
    return b;
}

TEST(ema_mat, sensors_of_one_length)
{
    char where[FAP_ERROR_TEXT_SIZE];
    test_bytes b = make_mat();
    fap_take *take;

    assert_int_equal(read_bytes(&take, &b, b.size, where), FAP_OK);
    assert_string_equal(take->format, "ema");
    assert_int_equal(take->point_count, 2);
    assert_int_equal(take->frame_count, 4);
    assert_float_equal(take->rate_hz, 100, 0);
    assert_string_equal(take->name[0], "TT");
    assert_string_equal(take->name[1], "UL");
    assert_int_equal(take->note_count, 1);
    /* Column by column: x 101, y 105, z 109 of the second row of 100 and on. */
    const float *at = fap_take_sample(take, 1, 0);
    assert_float_equal(at[0], 105, 0);
    assert_float_equal(at[1], 109, 0);
    assert_float_equal(at[2], 101, 0);
    fap_take_close(&take);
    free(b.data);
}

TEST(ema_mat, what_is_cut_or_damaged_is_harmless)
{
    char where[FAP_ERROR_TEXT_SIZE];
    test_bytes b = make_mat();
    fap_take *take;

    for (size_t size = 0; size < b.size; size++)
        if (read_bytes(&take, &b, size, where) == FAP_OK)
            fap_take_close(&take);
    for (size_t at = 126; at < b.size; at++) {
        const uint8_t was = b.data[at];
        b.data[at] = 0xFF;
        if (read_bytes(&take, &b, b.size, where) == FAP_OK)
            fap_take_close(&take);
        b.data[at] = was;
    }
    assert_int_equal(read_bytes(&take, &b, 200, where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "SIGNAL"));
    free(b.data);
}

/* --- real ones --- */

TEST(ema, real_takes_of_both_kinds)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    assert_int_equal(test_read_shared(&take, "ema/ag501_0021.pos", where), FAP_OK);
    assert_int_equal(take->frame_count, 5021);
    assert_float_equal(take->rate_hz, 250, 0);
    assert_string_equal(take->name[0], "Sensor1");
    fap_take_close(&take);
#ifdef HAVE_ZLIB
    assert_int_equal(test_read_shared(&take, "ema/F01_B01_S01_R01_N.mat", where), FAP_OK);
    assert_int_equal(take->frame_count, 262);
    assert_int_equal(take->point_count, 8);
    assert_float_equal(take->rate_hz, 100, 0);
    const int upper = fap_take_find(take, "UL"), tongue = fap_take_find(take, "TT"),
              left = fap_take_find(take, "ML");
    /* The lips are in front of the tongue, the left corner is left. */
    assert_true(fap_take_sample(take, 0, (uint32_t)upper)[2] > fap_take_sample(take, 0, (uint32_t)tongue)[2]);
    assert_true(fap_take_sample(take, 0, (uint32_t)left)[0] >
                fap_take_sample(take, 0, (uint32_t)upper)[0] + 10);
    fap_take_close(&take);
#endif
}
