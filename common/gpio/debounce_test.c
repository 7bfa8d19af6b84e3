/* SPDX-License-Identifier: BSD-2-Clause */
/* Which changes count, from their times alone. Microseconds, with a period of 5000. */
#include "tests/test.h"

#include "common/gpio/debounce.h"

enum { PERIOD_US = 5000 };

static debounce opened(int level)
{
    debounce d;
    debounce_open(&d, PERIOD_US * 1000, level);
    return d;
}

/* The time at which the change before this one counted; -1: it did not. */
static int64_t edge(debounce *d, int64_t at_us, int rising)
{
    const gpio_event e = { at_us * 1000, rising };
    gpio_event counts;
    return debounce_edge(d, &e, &counts) ? counts.time_ns / 1000 : -1;
}

static int64_t due(debounce *d, int64_t now_us)
{
    gpio_event counts;
    return debounce_due(d, now_us * 1000, &counts) ? counts.time_ns / 1000 : -1;
}

TEST(gpio_debounce, an_edge_counts_when_it_has_lasted)
{
    debounce d = opened(0);

    assert_int_equal(edge(&d, 1000, 1), -1);
    assert_int_equal(debounce_until_ns(&d), 6000000);
    assert_int_equal(due(&d, 5999), -1);
    assert_int_equal(due(&d, 6000), 6000);
    assert_int_equal(due(&d, 20000), -1);
    assert_int_equal(debounce_until_ns(&d), INT64_MAX);
}

TEST(gpio_debounce, bouncing_contacts_count_once_from_the_last_edge)
{
    debounce d = opened(0);

    for (int i = 0; i <= 8; i++)
        assert_int_equal(edge(&d, 1000 + 400 * i, !(i & 1)), -1);
    assert_int_equal(due(&d, 9199), -1);
    assert_int_equal(due(&d, 9200), 9200);
}

TEST(gpio_debounce, a_spike_is_nothing)
{
    debounce d = opened(0);

    edge(&d, 1000, 1);
    assert_int_equal(edge(&d, 5999, 0), -1);
    assert_int_equal(due(&d, 100000), -1);
}

TEST(gpio_debounce, looking_late_changes_nothing)
{
    debounce d = opened(0);

    edge(&d, 1000, 1);
    assert_int_equal(edge(&d, 6000, 0), 6000); /* lasted exactly the period */
    assert_int_equal(due(&d, 500000), 11000);
}
