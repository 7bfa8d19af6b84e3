/* SPDX-License-Identifier: BSD-2-Clause */
/* Waiting for the edge that starts something, for tools that do nothing else meanwhile. */
#ifndef COMMON_GPIO_TRIGGER_H
#define COMMON_GPIO_TRIGGER_H

#include "common/gpio/input.h"

/*
 * Edges that came before are forgotten, then a note says that it waits. @in: opened as @spec says.
 * 1: the edge is in @event. 0: none came in time. -1: the line failed. Then a sentence is in @where (FAP_ERROR_TEXT_SIZE
 * bytes).
 */
int gpio_trigger_wait(gpio_input *in, const gpio_spec *spec, gpio_event *event, char *where);
/* The first half of it, for those who look again and again instead of waiting. */
void gpio_trigger_arm(gpio_input *in, const gpio_spec *spec);
/* "no rising edge within 10 s" */
void gpio_trigger_timeout_text(const gpio_spec *spec, char *where);
void gpio_trigger_failure_text(const gpio_spec *spec, char *where);

#endif
