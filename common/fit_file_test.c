/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the table of a stream is looked for. */
#include "tests/test.h"

#include <string.h>

#include "common/fit_file.h"

static void check(const char *stream, const char *expected)
{
    char path[64];

    assert_int_equal(fit_file_name(stream, path, sizeof path), expected != NULL);
    if (expected)
        assert_string_equal(path, expected);
}

TEST(fit_file, is_named_like_the_stream)
{
    check("take.fba", "take.fit");
    check("a/b.c/take.fba", "a/b.c/take.fit");
    check("a/b.c/take", "a/b.c/take.fit");
    check("take.1.fba", "take.1.fit");
    check("-", NULL);
}

TEST(fit_file, does_not_cut_long_names)
{
    char path[9];

    assert_int_equal(fit_file_name("take.fba", path, sizeof path), 1);
    assert_int_equal(fit_file_name("takes.fba", path, sizeof path), 0);
}
