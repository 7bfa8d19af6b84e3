/* SPDX-License-Identifier: BSD-2-Clause */
/* What FAP units mean in nanometres, and how far frames are apart. */
#include "tests/test.h"

#include <string.h>

#include <fap/sensitivity.h>

#include "bank/sensitivity.h"

static fap_sensitivity typical(void)
{
    fap_sensitivity s;
    fap_sensitivity_typical(&s);
    return s;
}

static fap_frame frame_of(int fap, int32_t value)
{
    fap_frame f = { 0 };
    f.state[fap] = FAP_CODED;
    f.value[fap] = value;
    return f;
}

TEST(sensitivity, roots_are_rounded_down)
{
    for (uint64_t i = 1; i < 5000; i++) {
        assert_int_equal(fap_isqrt(i * i), i);
        assert_int_equal(fap_isqrt(i * i - 1), i - 1);
    }
    assert_int_equal(fap_isqrt(0), 0);
    assert_int_equal(fap_isqrt(UINT64_MAX), UINT32_MAX);
}

TEST(sensitivity, a_typical_face_gives_every_fap_a_length)
{
    const fap_sensitivity s = typical();

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        assert_in_range(s.nm[fap], 1, 200000);
    assert_int_equal(s.nm[3], 20508);  /* 21 mm / 1024 */
    assert_int_equal(s.nm[23], 120);   /* 12 mm * 1e-5 */
    assert_int_equal(s.nm[29], 5713);  /* 11.7 mm / 2048 */
    assert_int_equal(s.nm[48], 1500);  /* the crown */
    assert_int_equal(s.nm[49], 1150);  /* the nose */
    assert_int_equal(s.nm[1], 190476); /* 12 mm / 63 */
}

TEST(sensitivity, a_bank_is_measured)
{
    fap_bank *bank;
    fap_sensitivity s;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    const fap_fapu *fapu = fap_bank_fapu(bank);
    fap_sensitivity_of_bank(bank, &s);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (info->motion <= FAP_MOTION_Z)
            assert_float_equal((float)s.nm[fap], fap_fapu_step(fapu, info->unit) * 1e6f, 1);
        assert_true(s.nm[fap] > 0);
    }
    assert_int_equal(s.nm[24], 120);
    assert_in_range(s.nm[50], 1000, 2000);
    assert_in_range(s.nm[1], 50000, 500000);
    assert_in_range(s.nm[2], 50000, 500000);
    fap_bank_close(&bank);
}

TEST(sensitivity, equal_frames_are_not_apart)
{
    const fap_sensitivity s = typical();
    fap_frame f = frame_of(5, 77);
    fap_frame_error e;

    f.state[1] = FAP_CODED;
    f.viseme = (fap_viseme){ 3, 3, 20, 0 };
    fap_sensitivity_compare(&s, &f, &f, &e);
    assert_int_equal(e.items, 2);
    assert_int_equal(e.max_nm, 0);
    assert_int_equal(e.max_fap, 0);
    f.viseme.blend = 50; /* of the same two: no other face */
    const fap_frame g = f;
    f.viseme.blend = 1;
    assert_int_equal(fap_sensitivity_error_nm(&s, &f, &g), 0);
    assert_int_equal(fap_sensitivity_error_nm(&s, &(fap_frame){ 0 }, &f), 0);
}

TEST(sensitivity, axes_of_one_point_are_taken_together)
{
    fap_sensitivity s = typical();
    fap_frame want = frame_of(3, 3), got = { 0 };
    fap_frame_error e;

    s.nm[3] = s.nm[14] = s.nm[15] = 1000;
    want.state[15] = FAP_HELD;
    want.value[15] = -4;
    fap_sensitivity_compare(&s, &want, &got, &e);
    assert_int_equal(e.items, 1);
    assert_int_equal(e.max_nm, 5000);
    want.state[18] = FAP_CODED; /* another point, at rest */
    assert_int_equal(fap_sensitivity_error_nm(&s, &want, &got), 2500);
    got.state[14] = FAP_CODED; /* not commanded: free */
    got.value[14] = 1000;
    assert_int_equal(fap_sensitivity_error_nm(&s, &want, &got), 2500);
}

TEST(sensitivity, head_eyes_and_pupils_are_places_of_their_own)
{
    const fap_sensitivity s = typical();
    fap_frame want = { 0 }, got = { 0 };
    fap_frame_error e;

    for (int fap = 23; fap <= 30; fap++)
        want.state[fap] = FAP_CODED;
    for (int fap = 48; fap <= 50; fap++)
        want.state[fap] = FAP_CODED;
    want.value[24] = 1000;
    fap_sensitivity_compare(&s, &want, &got, &e);
    assert_int_equal(e.items, 5);
    assert_int_equal(e.max_nm, 120000);
    assert_int_equal(e.sum_nm, 120000);
    assert_int_equal(e.mean_nm, 24000);
}

TEST(sensitivity, mixes_differ_by_what_is_more_in_either)
{
    const fap_viseme a = { 3, 0, 63, 0 }, b = { 4, 0, 60, 0 };
    const fap_expression joy = { 1, 40, 0, 63, 0, 0 }, more = { 0, 9, 1, 50, 0, 0 };

    assert_int_equal(fap_viseme_distance(&a, &b), 63 + 60);
    assert_int_equal(fap_viseme_distance(&a, &a), 0);
    assert_int_equal(fap_expression_distance(&joy, &more), 10);
}

TEST(sensitivity, absurd_values_do_not_overflow)
{
    fap_sensitivity s = typical();
    fap_frame want = { 0 }, got = { 0 };
    fap_frame_error e;

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        s.nm[fap] = UINT32_MAX;
        want.state[fap] = got.state[fap] = FAP_CODED;
        want.value[fap] = INT32_MAX;
        got.value[fap] = INT32_MIN;
    }
    want.viseme = (fap_viseme){ 255, 255, 255, 0 };
    fap_sensitivity_compare(&s, &want, &got, &e);
    assert_in_range(e.max_nm, INT32_MAX, UINT32_MAX);
    assert_in_range(e.mean_nm, 1, e.max_nm);
}
