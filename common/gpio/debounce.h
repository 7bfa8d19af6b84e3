/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What the kernel does for libgpiod 2, for libgpiod 1: an edge counts once the line has stayed as it is for the period, and
 * its time is the moment it counts. Shorter spikes leave no trace. Times are those of the events, so a program that looks
 * late decides as one that looks at once.
 */
#ifndef COMMON_GPIO_DEBOUNCE_H
#define COMMON_GPIO_DEBOUNCE_H

#include "common/gpio/gpio.h"

typedef struct debounce {
    int64_t period_ns;
    int level;         /* as it was last told */
    int waits;         /* an edge that does not count yet: */
    gpio_event latest; /* the line has been so since then */
} debounce;

/* @level: what the line is. */
void debounce_open(debounce *d, int64_t period_ns, int level);
/* The line changed. 1: the change before it had lasted, and is in @counts. */
int debounce_edge(debounce *d, const gpio_event *edge, gpio_event *counts);
/* It is @now_ns and no other change is known of. 1: the last one counts. */
int debounce_due(debounce *d, int64_t now_ns, gpio_event *counts);
/* When to ask again; INT64_MAX: after the next edge. */
int64_t debounce_until_ns(const debounce *d);

#endif
