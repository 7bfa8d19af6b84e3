/* SPDX-License-Identifier: BSD-2-Clause */
/* Which frames are shown. */
#include "tests/test.h"

#include "player/plan.h"

TEST(plan, without_moments_every_frame_is_shown)
{
    const frame_plan plan = frame_plan_make(10, 15, 0);

    assert_int_equal(plan.count, 5);
    for (int i = 0; i < 5; i++)
        assert_int_equal(frame_plan_at(&plan, i), 10 + i);
}

TEST(plan, one_moment_is_the_middle)
{
    const frame_plan plan = frame_plan_make(0, 9, 1);

    assert_int_equal(plan.count, 1);
    assert_int_equal(frame_plan_at(&plan, 0), 4);
}

TEST(plan, moments_are_evenly_spread_and_inside_the_range)
{
    const frame_plan plan = frame_plan_make(0, 100, 4);
    const int64_t expected[] = { 12, 37, 62, 87 };

    for (int i = 0; i < 4; i++)
        assert_int_equal(frame_plan_at(&plan, i), expected[i]);
}

TEST(plan, moments_never_repeat)
{
    for (int span = 1; span < 40; span++) {
        const frame_plan plan = frame_plan_make(3, 3 + span, 16);
        assert_int_equal(plan.count, span < 16 ? span : 16);
        for (int i = 1; i < plan.count; i++)
            assert_true(frame_plan_at(&plan, i) > frame_plan_at(&plan, i - 1));
        assert_true(frame_plan_at(&plan, 0) >= 3);
        assert_true(frame_plan_at(&plan, plan.count - 1) < 3 + span);
    }
}
