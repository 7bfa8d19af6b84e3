/* SPDX-License-Identifier: BSD-2-Clause */
/* See output.h. */
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>

#include "common/gpio/output.h"
#include "common/signals.h"

/* What a signal puts to rest. One thread opens and closes; the handler reads. */
static _Atomic(gpio_output *) open_outputs[8];

enum { OPEN_COUNT = sizeof open_outputs / sizeof *open_outputs };

void gpio_outputs_drop(void)
{
    for (int i = 0; i < OPEN_COUNT; i++) {
        const gpio_output *const o = atomic_load(&open_outputs[i]);
        if (o)
            o->driver->set(o->line, 0);
    }
}

/* 1, or 0: no room for @now. */
static int replace(gpio_output *old, gpio_output *now)
{
    for (int i = 0; i < OPEN_COUNT; i++)
        if (atomic_load(&open_outputs[i]) == old) {
            atomic_store(&open_outputs[i], now);
            return 1;
        }
    return 0;
}

static gpio_fault open_line(gpio_output *o, const gpio_driver *driver, const gpio_request *r, char *detail)
{
    void *line;
    const gpio_fault fault = driver->open(r, &line, detail);

    if (fault != GPIO_OK)
        return fault;
    *o = (gpio_output){ .driver = driver, .line = line };
    if (replace(NULL, o))
        return GPIO_OK;
    driver->close(line);
    *o = (gpio_output){ 0 };
    snprintf(detail, GPIO_DETAIL_SIZE, "more than %d outputs", OPEN_COUNT);
    return GPIO_FAILED;
}

int gpio_output_open(gpio_output *o, const gpio_driver *driver, const gpio_spec *spec, const char *consumer,
                     char *where)
{
    const gpio_request request = { .chip = spec->chip,
                                   .line = spec->line,
                                   .consumer = consumer,
                                   .output = 1,
                                   .active_low = spec->active_low };
    char detail[GPIO_DETAIL_SIZE];
    sigset_t before;

    *o = (gpio_output){ 0 };
    signals_call(gpio_outputs_drop);
    signals_hold(&before);
    const gpio_fault fault = open_line(o, driver, &request, detail);
    signals_release(&before);
    if (fault != GPIO_OK)
        gpio_fault_text(fault, &request, detail, where);
    return fault == GPIO_OK;
}

void gpio_output_set(gpio_output *o, int active)
{
    if (!o->driver || o->failed || o->active == active)
        return;
    o->failed = !o->driver->set(o->line, active);
    o->active = active;
}

void gpio_output_close(gpio_output *o)
{
    sigset_t before;

    if (!o->driver)
        return;
    gpio_output_set(o, 0);
    signals_hold(&before);
    replace(o, NULL);
    o->driver->close(o->line);
    signals_release(&before);
    *o = (gpio_output){ 0 };
}
