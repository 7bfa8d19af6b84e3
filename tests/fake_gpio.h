/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A GPIO chip for tests: lines 0 to 7 of the chip "fake", and a time that passes only where somebody waits. The test says
 * beforehand when the world outside changes a line, and reads afterwards what was done to outputs.
 */
#ifndef TESTS_FAKE_GPIO_H
#define TESTS_FAKE_GPIO_H

#include "common/gpio/gpio.h"

enum { FAKE_LINES = 8, FAKE_QUEUE = 16 };

extern const gpio_driver fake_gpio, fake_gpio_debouncing;

/* A new chip at the time 0: nothing is open, all lines are low. */
void fake_gpio_reset(void);
/* What opening any line gives from now on. */
void fake_gpio_refuse(gpio_fault fault, const char *detail);
/* Every line fails from now on. */
void fake_gpio_break(void);
/* The world sets @line to @level at @at_us, which is not before what was said so far. */
void fake_gpio_change(int line, int64_t at_us, int level);
/* Time passes without anybody looking. */
void fake_gpio_pass(int64_t us);
int64_t fake_gpio_time_us(void);

int fake_gpio_level(int line); /* of the pin, whatever active-low says */
int fake_gpio_is_open(int line);
const gpio_request *fake_gpio_request(int line); /* as it was last asked for */
/* How often an open output was set. */
int fake_gpio_sets(int line);

#endif
