/* SPDX-License-Identifier: BSD-2-Clause */
/* The take of the demo, and files that are no sounds. */
#include "common/sound_file.h"
#include "tests/test.h"

static const char demo[] = "tests/assets/demo_take.wav";

static fap_err load(sound *s, const char *path)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    const fap_err err = sound_load(s, path, where);

    if (err == FAP_E_UNSUPPORTED)
        skip();
    if (err)
        assert_true(where[0]);
    return err;
}

TEST(sound_file, is_loaded_as_long_as_it_is_measured)
{
    char where[FAP_ERROR_TEXT_SIZE];
    double duration_s;
    sound s;

    assert_int_equal(load(&s, demo), FAP_OK);
    assert_int_equal(sound_measure(demo, &duration_s, where), FAP_OK);
    assert_true(duration_s > 1);
    assert_float_equal((double)s.frame_count / s.rate_hz, duration_s, 1e-9);
    int loudest = 0;
    for (int64_t i = 0; i < s.frame_count * s.channels; i++)
        loudest = s.sample[i] > loudest ? s.sample[i] : loudest;
    assert_true(loudest > 1000);
    sound_free(&s);
}

TEST(sound_file, refuses_what_is_none)
{
    sound s;

    assert_int_equal(load(&s, "Makefile"), FAP_E_DATA);
    assert_null(s.sample);
    assert_int_equal(load(&s, "tests/no-such-file.wav"), FAP_E_DATA);
}
