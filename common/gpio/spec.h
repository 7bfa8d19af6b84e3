/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A line as it is written on a command line: CHIP:LINE, then words about it, each behind a colon.
 *   input    rising, falling, active-low, pull-up, pull-down, pull-off, debounce=5ms, timeout=10s
 *   output   active-low
 *   pulse    active-low, and how long: 250ms, or 250
 * Times take us, ms or s; a bare number is in milliseconds.
 */
#ifndef COMMON_GPIO_SPEC_H
#define COMMON_GPIO_SPEC_H

#include "common/gpio/gpio.h"

typedef enum gpio_use { GPIO_INPUT, GPIO_OUTPUT, GPIO_PULSE } gpio_use;

enum { GPIO_NAME_SIZE = 64 };

typedef struct gpio_spec {
    char chip[GPIO_NAME_SIZE]; /* "": no line was asked for */
    char line[GPIO_NAME_SIZE];
    int active_low;
    gpio_edge edge; /* rising unless said */
    gpio_bias bias;
    int64_t debounce_ns; /* 0: every edge counts */
    int64_t timeout_ns;  /* -1: wait for ever */
    int64_t pulse_ns;    /* 100 ms unless said */
} gpio_spec;

/* 1, or 0 with the reason in @where (FAP_ERROR_TEXT_SIZE bytes). */
int gpio_spec_parse(gpio_spec *spec, const char *text, gpio_use use, char *where);

static inline int gpio_spec_given(const gpio_spec *spec)
{
    return spec->chip[0] != '\0';
}

#endif
