/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include <math.h>

#include <fap/bank.h>

#include "capture/rbf.h"

/* A patch of skin, nine markers 12 mm apart. */
enum { PATCH = 9 };

static void make_patch(rbf_centre c[PATCH])
{
    for (int i = 0; i < PATCH; i++)
        c[i] = (rbf_centre){ .at = { 12 * (i % 3), 12 * (i / 3), 0.02 * (i % 3) * (i / 3) }, .use = 1 };
}

static double value_at(const rbf_mix *m, const double *value)
{
    double sum = 0;

    for (uint32_t i = 0; i < m->count; i++)
        sum += m->weight[i] * value[m->centre[i]];
    return sum;
}

TEST(rbf, a_marker_keeps_its_own_motion)
{
    const double value[PATCH] = { 3, 1, 4, 1, 5, 9, 2, 6, 5 };
    rbf_centre c[PATCH];
    rbf_mix m;

    make_patch(c);
    for (int i = 0; i < PATCH; i++) {
        rbf_mix_at(&m, c, PATCH, c[i].at, 0);
        assert_float_equal(value_at(&m, value), value[i], 1e-6);
    }
}

TEST(rbf, what_all_markers_do_the_skin_between_does)
{
    const double value[PATCH] = { 2, 2, 2, 2, 2, 2, 2, 2, 2 }, at[3] = { 7, 17, 1 };
    rbf_centre c[PATCH];
    rbf_mix m;

    make_patch(c);
    rbf_mix_at(&m, c, PATCH, at, 0);
    assert_float_equal(value_at(&m, value), 2, 1e-6);
}

TEST(rbf, a_turning_patch_turns_between_its_markers)
{
    double value[PATCH];
    const double at[3] = { 15, 9, 0.01 };
    rbf_centre c[PATCH];
    rbf_mix m;

    make_patch(c);
    for (int i = 0; i < PATCH; i++)
        value[i] = 0.1 * c[i].at[0] - 0.05 * c[i].at[1];
    rbf_mix_at(&m, c, PATCH, at, 0);
    assert_float_equal(value_at(&m, value), 0.1 * at[0] - 0.05 * at[1], 0.1);
}

TEST(rbf, nothing_passes_between_the_lips)
{
    double value[PATCH];
    const double at[3] = { 12, 13, 0 };
    rbf_centre c[PATCH];
    rbf_mix m;

    make_patch(c);
    for (int i = 0; i < PATCH; i++) {
        c[i].side = i < 6 ? FAP_MASK_LIP_LOWER : FAP_MASK_LIP_UPPER;
        value[i] = i < 6 ? -10 : 0;
    }
    rbf_mix_at(&m, c, PATCH, at, FAP_MASK_LIP_UPPER);
    assert_float_equal(value_at(&m, value), 0, 1e-9);
    rbf_mix_at(&m, c, PATCH, at, FAP_MASK_LIP_LOWER);
    assert_float_equal(value_at(&m, value), -10, 1e-6);
}

TEST(rbf, markers_in_one_place_and_markers_in_a_row_do_no_harm)
{
    const double at[3] = { 5, 3, 0 };
    rbf_centre c[PATCH];
    rbf_mix m;

    for (int row = 0; row < 2; row++) {
        for (int i = 0; i < PATCH; i++)
            c[i] = (rbf_centre){ .at = { row * i, row * 2 * i, 0 }, .use = 1 };
        rbf_mix_at(&m, c, PATCH, at, 0);
        double sum = 0;
        for (uint32_t i = 0; i < m.count; i++) {
            assert_true(fabs(m.weight[i]) < 5);
            sum += m.weight[i];
        }
        assert_float_equal(sum, 1, 1e-6);
    }
    rbf_mix_at(&m, c, 0, at, 0);
    assert_int_equal(m.count, 0);
}
