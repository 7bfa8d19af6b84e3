/* SPDX-License-Identifier: BSD-2-Clause */
/* GPIO of a build without libgpiod: it says so when a line is opened. */
#include "common/gpio/gpio.h"

static gpio_fault refuse(const gpio_request *r, void **line, char *detail)
{
    (void)r;
    *line = NULL;
    detail[0] = '\0';
    return GPIO_NO_LIBRARY;
}

/* Nothing was opened, so nothing else is called. */
const gpio_driver gpio_system = { .name = "none", .open = refuse, .now_ns = gpio_now_ns, .rest = gpio_rest };
