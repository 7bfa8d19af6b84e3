/* SPDX-License-Identifier: BSD-2-Clause */
/* What --neutral may be. */
#include "tests/test.h"

#include "encoder/neutral.h"

static void assert_frames(const char *text, int64_t first, int64_t last)
{
    neutral_option n;
    int64_t got_first, got_last;

    assert_true(neutral_option_parse(&n, text));
    neutral_option_frames(&n, 60, &got_first, &got_last);
    assert_int_equal(got_first, first);
    assert_int_equal(got_last, last);
}

TEST(neutral_option, frames_times_and_stretches_of_both)
{
    assert_frames("auto", -1, -1);
    assert_frames("0", 0, -1);
    assert_frames("120", 120, -1);
    assert_frames("120-135", 120, 135);
    assert_frames("2s", 120, -1);
    assert_frames("2-2.5s", 120, 150);
    assert_frames("2s-2.5s", 120, 150);
    assert_frames("7-7", 7, 7);
}

TEST(neutral_option, nothing_else)
{
    static const char *const bad[] = { "",    "-1",    "1.5",   "9-3", "2.5-2s",     "1-2-3",
                                       "s",   "1s2",   "auto1", "1-",  "-",          "1e3",
                                       "nan", "inf",   "0x10",  "1 2", "2000000000", "1.2.3",
                                       "..s", "1-2.5", "+4",    " 4" };
    neutral_option n;

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (neutral_option_parse(&n, bad[i]))
            fail_msg("'%s' is taken for %g to %g", bad[i], n.from, n.to);
}

TEST(neutral_option, none_means_to_be_found)
{
    const neutral_option none = { 0 };
    int64_t first, last;

    neutral_option_frames(&none, 60, &first, &last);
    assert_int_equal(first, -1);
    assert_int_equal(last, -1);
}
