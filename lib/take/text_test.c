/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers and cells of tables. */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include "take/text.h"

static text t(const char *s)
{
    return (text){ s, strlen(s) };
}

static void assert_number(const char *s, double want)
{
    double got = -12345;

    assert_int_equal(text_number(t(s), &got), TEXT_NUMBER);
    assert_true(fabs(got - want) <= 1e-15 * fabs(want));
}

TEST(text, numbers_do_not_depend_on_the_locale)
{
    assert_number("0", 0);
    assert_number("-12.5", -12.5);
    assert_number("+3,25", 3.25);
    assert_number(".5", 0.5);
    assert_number("1e3", 1000);
    assert_number("2.5E-2", 0.025);
    assert_number("136.264", 136.264);
    assert_number("123456789012345678901234567890", 123456789012345678e12);
}

TEST(text, what_is_missing_and_what_is_no_number_differ)
{
    static const char *const missing[] = { "", "-", "NaN", "nan", "NA", "n/a" };
    static const char *const other[] = { "x", "1x", "1.2.3", "e5", "1e", "1e+", "--1", "+", "." };
    double v;

    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
        assert_int_equal(text_number(t(missing[i]), &v), TEXT_MISSING);
    for (size_t i = 0; i < sizeof other / sizeof *other; i++)
        if (text_number(t(other[i]), &v) != TEXT_OTHER)
            fail_msg("'%s' is a number?", other[i]);
}

TEST(text, exponents_without_end_are_bounded)
{
    double v;

    assert_int_equal(text_number(t("1e999999999999999999"), &v), TEXT_NUMBER);
    assert_int_equal(text_number(t("1e-999999999999999999"), &v), TEXT_NUMBER);
    assert_true(v == 0);
}

TEST(text, cells_lose_blanks_and_quotes)
{
    static text_row row;

    text_split(t(" a , \"b,c\" ,,d"), ',', &row);
    assert_int_equal(row.count, 4);
    assert_true(text_is(row.cell[0], "A"));
    assert_true(text_is(row.cell[1], "b,c"));
    assert_int_equal(row.cell[2].length, 0);
    assert_int_equal(text_cell(&row, 99).length, 0);
}

TEST(text, rows_with_too_many_cells_are_cut)
{
    static char line[TEXT_MAX_CELLS + 100];
    static text_row row;

    memset(line, ',', sizeof line);
    text_split((text){ line, sizeof line }, ',', &row);
    assert_int_equal(row.count, TEXT_MAX_CELLS);
}
