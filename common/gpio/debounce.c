/* SPDX-License-Identifier: BSD-2-Clause */
/* See debounce.h. */
#include "common/gpio/debounce.h"

void debounce_open(debounce *d, int64_t period_ns, int level)
{
    *d = (debounce){ .period_ns = period_ns, .level = level };
}

int64_t debounce_until_ns(const debounce *d)
{
    return d->waits ? d->latest.time_ns + d->period_ns : INT64_MAX;
}

int debounce_due(debounce *d, int64_t now_ns, gpio_event *counts)
{
    if (!d->waits || now_ns < debounce_until_ns(d))
        return 0;
    d->waits = 0;
    if (d->latest.rising == d->level)
        return 0; /* it is back where it was */
    d->level = d->latest.rising;
    *counts = (gpio_event){ d->latest.time_ns + d->period_ns, d->latest.rising };
    return 1;
}

int debounce_edge(debounce *d, const gpio_event *edge, gpio_event *counts)
{
    const int told = debounce_due(d, edge->time_ns, counts);

    d->latest = *edge;
    d->waits = 1;
    return told;
}
