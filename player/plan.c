/* SPDX-License-Identifier: BSD-2-Clause */
/* See plan.h. */
#include "player/plan.h"

frame_plan frame_plan_make(int64_t from, int64_t to, int64_t moments)
{
    const int64_t span = to - from;
    return (frame_plan){ from, to, moments > 0 && moments < span ? moments : span };
}

int64_t frame_plan_at(const frame_plan *plan, int64_t i)
{
    return plan->from + (2 * i + 1) * (plan->to - plan->from) / (2 * plan->count);
}
