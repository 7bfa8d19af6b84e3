/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * An output that is inactive unless said otherwise, and inactive again when the program ends: closed, or by a signal. (A
 * line that is only let go of keeps its level on many chips; nobody can act on SIGKILL.) A line that fails is given up and
 * playing goes on: a lamp is not worth a show.
 */
#ifndef COMMON_GPIO_OUTPUT_H
#define COMMON_GPIO_OUTPUT_H

#include "common/gpio/spec.h"

typedef struct gpio_output {
    const gpio_driver *driver; /* NULL: not open */
    void *line;
    int active, failed;
} gpio_output;

/* 1, or 0 with a sentence in @where (FAP_ERROR_TEXT_SIZE bytes). @o must stay where it is until it is closed. */
int gpio_output_open(gpio_output *o, const gpio_driver *driver, const gpio_spec *spec, const char *consumer,
                     char *where);
/* Nothing happens to a line that is not open, has failed, or is so already. */
void gpio_output_set(gpio_output *o, int active);
void gpio_output_close(gpio_output *o); /* harmless on a zeroed one */

/* What a signal does: every open output inactive. */
void gpio_outputs_drop(void);

#endif
