/* SPDX-License-Identifier: BSD-2-Clause */
/* Banks written and read back: what comes out is what went in, and damage never gets through. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/bank_build.h>

#include "bank/format.h"
#include "shape/bank_file_test.h"

TEST(bank_file, crc_is_the_one_of_zip)
{
    assert_int_equal(fbank_crc32((const uint8_t *)"123456789", 9), 0xcbf43926);
}

TEST(bank_file, what_was_written_is_what_is_read)
{
    fap_bytes file = test_bank_file(0);
    fap_bank *a, *b;

    assert_int_equal(fap_bank_builtin(&a, NULL), FAP_OK);
    assert_int_equal(fap_bank_load(&b, file.data, file.size, NULL), FAP_OK);
    assert_string_equal(fap_bank_name(b), fap_bank_name(a));
    assert_int_equal(fap_bank_mesh(b)->vertex_count, fap_bank_mesh(a)->vertex_count);
    assert_int_equal(fap_bank_mesh(b)->triangle_count, fap_bank_mesh(a)->triangle_count);
    assert_int_equal((uintptr_t)fap_bank_mesh(b)->position % 32, 0);
    assert_float_equal(fap_bank_fapu(b)->es_mm, fap_bank_fapu(a)->es_mm, 1e-4);
    assert_int_equal(fap_bank_key_count(b), fap_bank_key_count(a));
    for (int k = 0; k < fap_bank_key_count(a); k++) {
        const fap_key *x = fap_bank_key_get(a, k);
        const fap_key *y = fap_bank_key_get(b, fap_bank_key_find(b, (fap_key_kind)x->kind, x->name));
        assert_non_null(y);
        assert_int_equal(x->number, y->number);
        for (int p = 0; p < FAP_POINT_COUNT; p++)
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabsf(x->point_mm[p][axis] - y->point_mm[p][axis]) < 0.002f);
    }
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(fap_bank_point_get(a, p)->position_mm[axis],
                               fap_bank_point_get(b, p)->position_mm[axis], 1e-4);
    fap_bank_close(&a);
    fap_bank_close(&b);
    fap_bytes_free(&file);
}

TEST(bank_file, points_move_with_their_vertices)
{
    fap_bytes file = test_bank_file(0);
    fap_bank *bank;

    assert_int_equal(fap_bank_load(&bank, file.data, file.size, NULL), FAP_OK);
    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        const int chin = fap_point_by_name("2.1");
        const uint32_t v = fap_bank_point_get(bank, chin)->vertex[0];
        float y = 0;
        for (uint32_t b = 0; b < key->block_count; b++)
            if (key->block[b] == v / FAP_BLOCK)
                y = key->scale_mm * key->delta[(b * 3 + 1) * FAP_BLOCK + v % FAP_BLOCK];
        assert_true(fabsf(y - key->point_mm[chin][1]) <= key->scale_mm + 0.0011f);
    }
    fap_bank_close(&bank);
    fap_bytes_free(&file);
}

TEST(bank_file, cut_anywhere_is_refused)
{
    fap_bytes file = test_bank_file(0);

    for (size_t size = 0; size < file.size; size += size < 1024 ? 1 : 997)
        assert_int_not_equal(test_bank_load(file.data, size), FAP_OK);
    assert_int_equal(test_bank_load(file.data, file.size), FAP_OK);
    fap_bytes_free(&file);
}

TEST(bank_file, one_wrong_bit_is_noticed)
{
    fap_bytes file = test_bank_file(0);
    const size_t data_end =
        test_get32(test_bank_entry(&file, "KPNT") + 4) + test_get32(test_bank_entry(&file, "KPNT") + 8);

    for (size_t at = test_get32(test_bank_entry(&file, "VPOS") + 4); at < data_end; at += 1009) {
        const size_t in_padding = at % FBANK_ALIGN; /* zeros between chunks are not covered by a checksum */
        file.data[at] ^= 1;
        const fap_err err = test_bank_load(file.data, file.size);
        file.data[at] ^= 1;
        assert_true(err == FAP_E_DATA || in_padding);
    }
    fap_bytes_free(&file);
}

TEST(bank_file, other_formats_and_versions_are_told_apart)
{
    fap_bytes file = test_bank_file(0);

    assert_int_equal(test_bank_load((const uint8_t *)"# not a bank at all, just text", 30),
                     FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(test_bank_load(NULL, 0), FAP_E_UNKNOWN_FORMAT);
    file.data[8] = FBANK_MAJOR + 1;
    assert_int_equal(test_bank_load(file.data, file.size), FAP_E_UNSUPPORTED);
    file.data[8] = FBANK_MAJOR;
    file.data[10] = 9; /* a later minor version is welcome */
    assert_int_equal(test_bank_load(file.data, file.size), FAP_OK);
    fap_bytes_free(&file);
}

/* Each writes one bad value; checksums are made right again, the loader must still refuse. */
static const struct damage {
    const char *tag;
    uint32_t offset, value;
} damages[] = {
    { "TRIS", 0, 100000 },      { "TRIS", 8, 0xffffffff },  { "HEAD", 0, 0 },
    { "HEAD", 0, 0x7fffffff },  { "HEAD", 4, 0x7fffffff },  { "HEAD", 8, 5000 },
    { "HEAD", 8, 84 },          { "HEAD", 12, 0xffffffff }, { "HEAD", 16, 0xffffffff },
    { "HEAD", 20, 83 },         { "VPOS", 4, 0x7fc00000 },  { "VPOS", 4, 0x7f800000 },
    { "VPRT", 0, 0x07070707 },  { "FAPU", 8, 0 },           { "FAPU", 8, 0x7fc00000 },
    { "EYES", 12, 0xbf800000 }, { "PNTS", 0, 2 },           { "PNTS", 16, 0xfffffff0 },
    { "PNTS", 20, 0xfffffff0 }, { "PVTX", 0, 100000 },      { "KEYS", 0, 0 },
    { "KEYS", 32, 9 },          { "KEYS", 32, 0 },          { "KEYS", 36, 0xfffffff0 },
    { "KEYS", 40, 0 },          { "KEYS", 40, 0x7fc00000 }, { "KEYS", 44, 0xfffffff0 },
    { "KBLK", 0, 0xffffffff },  { "KPNT", 0, 0x7fc00000 },
};

TEST(bank_file, bad_values_behind_good_checksums_are_refused)
{
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        fap_bytes file = test_bank_file(0);
        test_put32(test_bank_chunk(&file, damages[i].tag) + damages[i].offset, damages[i].value);
        test_bank_seal(&file);
        const fap_err err = test_bank_load(file.data, file.size);
        if (err != FAP_E_DATA && err != FAP_E_LIMIT)
            fail_msg("%s + %u: %d", damages[i].tag, damages[i].offset, err);
        fap_bytes_free(&file);
    }
}

TEST(bank_file, bad_tables_are_refused)
{
    static const struct {
        int field;
        uint32_t value;
    } bad[] = { { 4, 0xffffffe0 }, { 4, 1 }, { 4, 0 }, { 8, 0xffffffff } };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fap_bytes file = test_bank_file(0);
        test_put32(test_bank_entry(&file, "VPRT") + bad[i].field, bad[i].value);
        test_bank_seal(&file);
        assert_int_equal(test_bank_load(file.data, file.size), FAP_E_DATA);
        fap_bytes_free(&file);
    }
    fap_bytes file = test_bank_file(0);
    memcpy(test_bank_entry(&file, "VHDW"), "VPRT", 4); /* twice the same chunk */
    test_bank_seal(&file);
    assert_int_equal(test_bank_load(file.data, file.size), FAP_E_DATA);
    fap_bytes_free(&file);
}

/* Hands out the file in small pieces, and fails past @c fail_at. */
typedef struct drip {
    const fap_bytes *file;
    size_t at, fail_at;
} drip;

static size_t read_drip(void *user, void *buf, size_t size)
{
    drip *d = user;
    size_t n = d->file->size - d->at;

    if (d->at > d->fail_at)
        return (size_t)-1;
    n = n > 1000 ? 1000 : n;
    n = n > size ? size : n;
    memcpy(buf, d->file->data + d->at, n);
    d->at += n;
    return n;
}

TEST(bank_file, is_read_through_callbacks)
{
    fap_bytes file = test_bank_file(0);
    drip whole = { &file, 0, SIZE_MAX }, broken = { &file, 0, 5000 };
    fap_bank *bank;

    assert_int_equal(fap_bank_read(&bank, &(fap_reader){ read_drip, &whole }, NULL), FAP_OK);
    fap_bank_close(&bank);
    assert_int_equal(fap_bank_read(&bank, &(fap_reader){ read_drip, &broken }, NULL), FAP_E_IO);
    assert_null(bank);
    fap_bytes_free(&file);
}

static void *scarce(void *user, size_t size)
{
    int *left = user;
    return (*left)-- > 0 ? malloc(size) : NULL;
}

static void give_back(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

TEST(bank_file, survives_a_failing_allocator)
{
    fap_bytes file = test_bank_file(0);
    fap_err err = FAP_E_NOMEM;

    for (int allowed = 0; err == FAP_E_NOMEM; allowed++) {
        int left = allowed;
        const fap_allocator a = { scarce, give_back, &left };
        drip d = { &file, 0, SIZE_MAX };
        fap_bank *bank;
        err = fap_bank_read(&bank, &(fap_reader){ read_drip, &d }, &a);
        assert_true((err == FAP_OK) == (bank != NULL));
        fap_bank_close(&bank);
    }
    assert_int_equal(err, FAP_OK);
    fap_bytes_free(&file);
}

/* One triangle: enough for the builder's checks. */
static const float corners[3][3] = { { 0, 0, 0 }, { 10, 0, 0 }, { 0, 10, 0 } };
static const uint8_t part[3] = { 0 }, weight[3] = { 255, 255, 255 }, colour[3][4] = { { 0 } };
static const uint32_t triangle[1][3] = { { 0, 1, 2 } };

static fap_build_mesh one_triangle(void)
{
    return (fap_build_mesh){ 3, 1, corners, NULL, part, weight, colour, triangle };
}

TEST(bank_builder, refuses_meshes_that_do_not_hold_together)
{
    static const uint32_t beyond[1][3] = { { 0, 1, 3 } };
    static const uint8_t parts[3] = { 0, 0, 1 }, no_part[3] = { 0, 0, FAP_PART_COUNT };
    static const float nowhere[3][3] = { { 0, NAN, 0 } };
    fap_bank_builder *b;
    fap_build_mesh m = one_triangle();

    m.triangle = beyond;
    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_E_DATA);
    m = one_triangle(), m.part = parts;
    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_E_DATA);
    m.part = no_part;
    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_E_DATA);
    m = one_triangle(), m.position = nowhere;
    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_E_DATA);
    m = one_triangle(), m.vertex_count = 0;
    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_E_DATA);
    assert_null(b);
}

TEST(bank_builder, refuses_bad_keys_and_points)
{
    static const float bad[3][3] = { { INFINITY, 0, 0 } };
    const fap_build_mesh m = one_triangle();
    const uint32_t v = 2, beyond = 3;
    fap_bank_builder *b;

    assert_int_equal(fap_bank_builder_open(&b, "x", &m), FAP_OK);
    assert_int_equal(fap_bank_builder_point(b, 0, &v, 1), FAP_OK);
    assert_int_equal(fap_bank_builder_point(b, 0, &beyond, 1), FAP_E_ARG);
    assert_int_equal(fap_bank_builder_point(b, 84, &v, 1), FAP_E_ARG);
    assert_int_equal(fap_bank_builder_key(b, FAP_KEY_UNIT, 0, "", corners), FAP_E_ARG);
    assert_int_equal(
        fap_bank_builder_key(b, FAP_KEY_UNIT, 0, "a name of more than thirty-one bytes", corners), FAP_E_ARG);
    assert_int_equal(fap_bank_builder_key(b, FAP_KEY_VISEME, 15, "x", corners), FAP_E_ARG);
    assert_int_equal(fap_bank_builder_key(b, FAP_KEY_UNIT, 0, "x", bad), FAP_E_DATA);
    assert_int_equal(fap_bank_builder_key(b, FAP_KEY_UNIT, 0, "x", corners), FAP_OK);
    fap_bytes file = { 0 };
    assert_int_equal(fap_bank_builder_write(b, &(fap_writer){ test_bank_take, &file }),
                     FAP_E_DATA); /* no FAPU without points */
    fap_bytes_free(&file);
    fap_bank_builder_close(&b);
    assert_null(b);
}
