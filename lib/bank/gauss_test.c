/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include "bank/gauss.h"

TEST(gauss, solves_what_needs_a_swap)
{
    double a[3][4] = { { 0, 2, 1, 7 }, { 1, 0, 0, 1 }, { 3, 1, -1, 2 } }, x[3];

    fap_gauss_solve(a[0], 4, 3, 1e-9, x);
    assert_float_equal(x[0], 1, 1e-12);
    assert_float_equal(x[1], 2, 1e-12);
    assert_float_equal(x[2], 3, 1e-12);
}

/* The second equation is the first: the others keep their answers whichever is looked at first. */
TEST(gauss, an_equation_said_twice_costs_one_unknown_and_no_other)
{
    double a[4][5] = { { 1, 1, 0, 2, 5 }, { 1, 1, 0, 2, 5 }, { 0, 0, 4, 0, 8 }, { 0, 0, 1, 3, 8 } }, x[4];

    fap_gauss_solve(a[0], 5, 4, 1e-9, x);
    assert_float_equal(x[0] + x[1] + 2 * x[3], 5, 1e-12);
    assert_float_equal(x[2], 2, 1e-12);
    assert_float_equal(x[3], 2, 1e-12);
}
