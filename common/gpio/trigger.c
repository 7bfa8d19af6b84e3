/* SPDX-License-Identifier: BSD-2-Clause */
/* See trigger.h. */
#include <stdio.h>

#include "common/gpio/trigger.h"
#include "common/tool.h"

static const char *edge_name(const gpio_spec *spec)
{
    return spec->edge == GPIO_FALLING ? "falling" : "rising";
}

void gpio_trigger_timeout_text(const gpio_spec *spec, char *where)
{
    snprintf(where, FAP_ERROR_TEXT_SIZE, "%s:%s: no %s edge within %g s", spec->chip, spec->line,
             edge_name(spec), (double)spec->timeout_ns * 1e-9);
}

void gpio_trigger_failure_text(const gpio_spec *spec, char *where)
{
    snprintf(where, FAP_ERROR_TEXT_SIZE, "%s:%s: this GPIO line failed while it was waited for", spec->chip,
             spec->line);
}

void gpio_trigger_arm(gpio_input *in, const gpio_spec *spec)
{
    gpio_input_drain(in);
    tool_note("waiting for a %s edge at %s:%s", edge_name(spec), spec->chip, spec->line);
}

int gpio_trigger_wait(gpio_input *in, const gpio_spec *spec, gpio_event *event, char *where)
{
    gpio_trigger_arm(in, spec);
    const int got = gpio_input_wait(in, spec->timeout_ns, event);
    if (got == 0)
        gpio_trigger_timeout_text(spec, where);
    else if (got < 0)
        gpio_trigger_failure_text(spec, where);
    return got;
}
