/* SPDX-License-Identifier: BSD-2-Clause */
/* Writing TRC: what the reader reads is what was written. */
#include "take/take_test.h"

static fap_take *small_take(void)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, 3, 4, NULL), FAP_OK);
    take->rate_hz = 29.97;
    strcpy(take->name[0], "8.4");
    strcpy(take->name[1], "left\tbrow");
    strcpy(take->name[2], "nose");
    for (uint32_t f = 0; f < 4; f++)
        for (uint32_t i = 0; i < 3; i++)
            if (f + i != 3)
                fap_take_set(take, f, i,
                             (const float[3]){ (float)f - 0.25F, -0.00001F * (float)i, 1234.56F });
    return take;
}

TEST(trc_write, what_is_read_is_what_was_written)
{
    fap_take *take = small_take(), *read;
    char where[FAP_ERROR_TEXT_SIZE];
    test_bytes b = { 0 };
    const fap_writer w = test_bytes_writer(&b);

    assert_int_equal(fap_take_write_trc(take, "a.trc", &w), FAP_OK);
    assert_int_equal(fap_take_read(&read, b.data, b.size, NULL, where), FAP_OK);
    assert_string_equal(read->format, "trc");
    assert_int_equal(read->frame_count, 4);
    assert_int_equal(read->point_count, 3);
    assert_true(read->unit_known && read->note_count == 0);
    assert_float_equal(read->rate_hz, 29.97, 1e-6);
    assert_string_equal(read->name[1], "left_brow");
    for (uint32_t f = 0; f < 4; f++)
        for (uint32_t i = 0; i < 3; i++) {
            const float *want = fap_take_sample(take, f, i), *is = fap_take_sample(read, f, i);
            assert_int_equal(want != NULL, is != NULL);
            for (int k = 0; want && k < 3; k++)
                assert_float_equal(is[k], want[k], 1e-4);
        }
    free(b.data);
    fap_take_close(&take);
    fap_take_close(&read);
}

static int refuse(void *user, const void *data, size_t size)
{
    (void)data;
    (void)size;
    return ++*(int *)user > 20;
}

TEST(trc_write, a_full_disk_is_told_and_a_take_without_a_rate_refused)
{
    fap_take *take = small_take();
    int calls = 0;
    const fap_writer w = { refuse, &calls };

    assert_int_equal(fap_take_write_trc(take, "a.trc", &w), FAP_E_IO);
    assert_int_equal(calls, 21);
    take->rate_hz = 0;
    assert_int_equal(fap_take_write_trc(take, "a.trc", &w), FAP_E_ARG);
    fap_take_close(&take);
}
