/* SPDX-License-Identifier: BSD-2-Clause */
/* An input and its edges: those that were asked for, debounced by the kernel where it can, else here. */
#ifndef COMMON_GPIO_INPUT_H
#define COMMON_GPIO_INPUT_H

#include "common/gpio/debounce.h"
#include "common/gpio/spec.h"

typedef struct gpio_input {
    const gpio_driver *driver; /* NULL: not open */
    void *line;
    gpio_edge edge;
    int filters; /* debounces here */
    debounce filter;
} gpio_input;

/* 1, or 0 with a sentence in @where (FAP_ERROR_TEXT_SIZE bytes). @consumer: who asks, for others. */
int gpio_input_open(gpio_input *in, const gpio_driver *driver, const gpio_spec *spec, const char *consumer,
                    char *where);
/* 1: an edge, in @event. 0: none within @timeout_ns (0: only looks, negative: waits for ever). -1: the line failed. */
int gpio_input_wait(gpio_input *in, int64_t timeout_ns, gpio_event *event);
/* Forgets the edges that came until now. */
void gpio_input_drain(gpio_input *in);
void gpio_input_close(gpio_input *in); /* harmless on a zeroed one */

#endif
