/* SPDX-License-Identifier: BSD-2-Clause */
/* Names with a number. */
#include "tests/test.h"

#include <stdlib.h>

#include "player/name_pattern.h"

static void makes(const char *text, int64_t number, const char *name)
{
    name_pattern p;

    assert_true(name_pattern_parse(&p, text));
    char *made = name_pattern_make(&p, number);
    assert_string_equal(made, name);
    free(made);
}

static int refused(const char *text)
{
    name_pattern p;
    return !name_pattern_parse(&p, text);
}

TEST(name_pattern, number_is_padded_and_never_cut)
{
    makes("out_%04d.png", 7, "out_0007.png");
    makes("out_%04d.png", 123456, "out_123456.png");
    makes("%d.png", 0, "0.png");
    makes("d/%09d", 12, "d/000000012");
}

TEST(name_pattern, name_without_a_number_stays_as_it_is)
{
    makes("out.png", 5, "out.png");
}

TEST(name_pattern, anything_but_one_number_is_refused)
{
    assert_true(refused("%s.png"));
    assert_true(refused("%n.png"));
    assert_true(refused("%%d.png"));
    assert_true(refused("%4d.png"));
    assert_true(refused("%00d.png"));
    assert_true(refused("%012d.png"));
    assert_true(refused("%0*d.png"));
    assert_true(refused("%ld.png"));
    assert_true(refused("%04d_%04d.png"));
    assert_true(refused("100%"));
    assert_true(refused("%0"));
}
