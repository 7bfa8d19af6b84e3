/* SPDX-License-Identifier: BSD-2-Clause */
/* C3D: every variant written and read back, cut and broken files, the real ones. */
#include "take/take_test.h"

#include <math.h>

static fap_take *sample_take(uint32_t points, uint32_t frames)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, points, frames, NULL), FAP_OK);
    take->rate_hz = 119.88;
    for (uint32_t p = 0; p < points; p++)
        snprintf(take->name[p], FAP_TAKE_NAME_SIZE, "Face:Point%u", (unsigned)p);
    for (uint32_t f = 0; f < frames; f++)
        for (uint32_t p = 0; p < points; p++) {
            const float v[3] = { 100.5f + (float)f, -3.25f * (float)p - 1, 0.125f * (float)(f * p) };
            if ((f + p) % 7)
                fap_take_set(take, f, p, v);
        }
    return take;
}

static void write_c3d(const fap_take *take, fap_c3d_processor processor, int integer, test_bytes *b)
{
    const fap_writer w = test_bytes_writer(b);
    assert_int_equal(fap_take_write_c3d(take, &w, processor, integer), FAP_OK);
}

static void assert_same_samples(const fap_take *a, const fap_take *b, float tolerance)
{
    assert_int_equal(a->point_count, b->point_count);
    assert_int_equal(a->frame_count, b->frame_count);
    for (size_t i = 0; i < (size_t)a->point_count * a->frame_count; i++) {
        assert_int_equal(a->valid[i], b->valid[i]);
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(a->xyz[i][axis], b->xyz[i][axis], tolerance);
    }
}

static void check_variant(fap_c3d_processor processor, int integer)
{
    fap_take *out = sample_take(30, 50), *in;
    test_bytes b = { 0 };
    char where[FAP_ERROR_TEXT_SIZE];

    write_c3d(out, processor, integer, &b);
    assert_int_equal(b.size % 512, 0);
    assert_int_equal(fap_take_read(&in, b.data, b.size, NULL, where), FAP_OK);
    assert_string_equal(in->format, "c3d");
    assert_string_equal(in->name[7], "Face:Point7");
    assert_float_equal(in->rate_hz, 119.88, 1e-4);
    assert_true(in->unit_known);
    assert_int_equal(in->note_count, 0);
    assert_same_samples(out, in, integer ? 200.0f / 32000 : 0);
    fap_take_close(&out);
    fap_take_close(&in);
    free(b.data);
}

TEST(c3d, all_six_variants_read_back_as_the_same_points)
{
    for (int processor = FAP_C3D_INTEL; processor <= FAP_C3D_SGI; processor++)
        for (int integer = 0; integer < 2; integer++)
            check_variant((fap_c3d_processor)processor, integer);
}

TEST(c3d, more_than_255_names_and_65535_frames_survive)
{
    fap_take *many = sample_take(600, 3), *lengthy = sample_take(1, 70000), *in;
    test_bytes b = { 0 };

    write_c3d(many, FAP_C3D_INTEL, 0, &b);
    assert_int_equal(fap_take_read(&in, b.data, b.size, NULL, NULL), FAP_OK);
    assert_string_equal(in->name[599], "Face:Point599");
    fap_take_close(&in);
    b.size = 0;
    write_c3d(lengthy, FAP_C3D_SGI, 1, &b);
    assert_int_equal(fap_take_read(&in, b.data, b.size, NULL, NULL), FAP_OK);
    assert_int_equal(in->frame_count, 70000);
    fap_take_close(&in);
    fap_take_close(&many);
    fap_take_close(&lengthy);
    free(b.data);
}

TEST(c3d, a_file_cut_anywhere_gives_fewer_frames_or_an_error)
{
    fap_take *out = sample_take(5, 20), *in;
    test_bytes b = { 0 };
    char where[FAP_ERROR_TEXT_SIZE];

    write_c3d(out, FAP_C3D_INTEL, 0, &b);
    for (size_t size = 0; size < b.size; size += 13) {
        uint8_t *cut = malloc(size + 1);
        assert_non_null(cut);
        memcpy(cut, b.data, size);
        if (fap_take_read(&in, cut, size, NULL, where) == FAP_OK)
            assert_true(in->frame_count <= 20);
        else
            assert_string_not_equal(where, "");
        fap_take_close(&in);
        free(cut);
    }
    fap_take_close(&out);
    free(b.data);
}

/* Sets 16-bit word @p word of an Intel header, counted from 1. */
static void poke(test_bytes *b, unsigned word, unsigned value)
{
    b->data[word * 2 - 2] = (uint8_t)value;
    b->data[word * 2 - 1] = (uint8_t)(value >> 8);
}

static fap_err read_poked(unsigned word, unsigned value, fap_take **in)
{
    fap_take *out = sample_take(5, 20);
    test_bytes b = { 0 };

    write_c3d(out, FAP_C3D_INTEL, 0, &b);
    poke(&b, word, value);
    const fap_err err = fap_take_read(in, b.data, b.size, NULL, NULL);
    fap_take_close(&out);
    free(b.data);
    return err;
}

TEST(c3d, numbers_in_the_header_that_promise_too_much_are_bounded)
{
    fap_take *in;

    assert_int_equal(read_poked(2, 65535, &in), FAP_E_LIMIT);
    assert_int_equal(read_poked(9, 65535, &in), FAP_E_NOT_FOUND);
    assert_int_equal(read_poked(5, 65000, &in), FAP_OK); /* POINT:FRAMES knows better */
    assert_int_equal(in->frame_count, 20);
    fap_take_close(&in);
}

TEST(c3d, exact_zeros_are_missing_but_a_reference_point_is_kept)
{
    static const float zero[3] = { 0, 0, 0 };
    fap_take *out = sample_take(3, 10), *in;
    test_bytes b = { 0 };

    for (uint32_t f = 0; f < 10; f++)
        fap_take_set(out, f, 0, zero);
    fap_take_set(out, 4, 1, zero);
    write_c3d(out, FAP_C3D_DEC, 0, &b);
    assert_int_equal(fap_take_read(&in, b.data, b.size, NULL, NULL), FAP_OK);
    assert_non_null(fap_take_sample(in, 4, 0));
    assert_null(fap_take_sample(in, 4, 1));
    assert_non_null(fap_take_sample(in, 3, 1));
    fap_take_close(&in);
    fap_take_close(&out);
    free(b.data);
}

TEST(c3d, a_header_without_parameters_still_gives_points)
{
    fap_take *out = sample_take(5, 20), *in;
    test_bytes b = { 0 };

    write_c3d(out, FAP_C3D_INTEL, 0, &b);
    memset(b.data + 512, 0, 512);
    assert_int_equal(fap_take_read(&in, b.data, b.size, NULL, NULL), FAP_OK);
    assert_int_equal(in->point_count, 5);
    assert_string_equal(in->name[1], "M002");
    assert_false(in->unit_known);
    fap_take_close(&in);
    fap_take_close(&out);
    free(b.data);
}

TEST(c3d, real_files_read_with_their_faults)
{
    static const struct {
        const char *name;
        uint32_t points, frames;
    } files[] = {
        { "format_samples/pc_int.c3d", 36, 89 },
        { "format_samples/Dec_real.c3d", 36, 89 },
        { "format_samples/sgi_int.c3d", 36, 89 },
        { "format_samples/TESTBPI.c3d", 26, 450 },
        { "format_samples/Dance.c3d", 40, 499 },
        { "format_samples/bad_parameter_section.c3d", 45, 332 },
        { "format_samples/shd01.c3d", 27, 237 },
        { "optical_animface/jaw_60hz.c3d", 41, 1590 },
        { "optical_animface/eyebrows_60hz_int16.c3d", 41, 902 },
    };

    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        fap_take *take;
        char where[FAP_ERROR_TEXT_SIZE];
        if (test_read_shared(&take, files[i].name, where) != FAP_OK)
            fail_msg("%s: %s", files[i].name, where);
        if (take->frame_count != files[i].frames || take->point_count > files[i].points)
            fail_msg("%s: %u points, %u frames", files[i].name, take->point_count, take->frame_count);
        fap_take_close(&take);
    }
}

TEST(c3d, a_file_whose_only_data_are_model_outputs_is_refused_with_the_names_it_has)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    assert_int_equal(test_read_shared(&take, "format_samples/parameterOverflow.c3d", where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "LFHD"));
}

TEST(c3d, three_processors_of_one_recording_agree)
{
    static const char *const other[] = { "format_samples/Dec_real.c3d", "format_samples/sgi_int.c3d" };
    fap_take *intel, *take;

    assert_int_equal(test_read_shared(&intel, "format_samples/pc_int.c3d", NULL), FAP_OK);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(test_read_shared(&take, other[i], NULL), FAP_OK);
        assert_same_samples(intel, take, 0.29f); /* one count of the 16-bit files is 0.28 mm */
        assert_string_equal(take->name[3], intel->name[3]);
        fap_take_close(&take);
    }
    fap_take_close(&intel);
}
