/* SPDX-License-Identifier: BSD-2-Clause */
/* See input.h. */
#include "common/gpio/input.h"

int gpio_input_open(gpio_input *in, const gpio_driver *driver, const gpio_spec *spec, const char *consumer,
                    char *where)
{
    const int filters = spec->debounce_ns > 0 && !driver->debounces;
    const gpio_request request = {
        .chip = spec->chip,
        .line = spec->line,
        .consumer = consumer,
        .active_low = spec->active_low,
        .edge = filters ? GPIO_BOTH : spec->edge,
        .bias = spec->bias,
        .debounce_us = driver->debounces ? (spec->debounce_ns + 999) / 1000 : 0,
    };
    char detail[GPIO_DETAIL_SIZE];
    void *line;
    const gpio_fault fault = driver->open(&request, &line, detail);

    *in = (gpio_input){ 0 };
    if (fault != GPIO_OK) {
        gpio_fault_text(fault, &request, detail, where);
        return 0;
    }
    *in = (gpio_input){ .driver = driver, .line = line, .edge = spec->edge, .filters = filters };
    debounce_open(&in->filter, spec->debounce_ns, driver->get(line) > 0);
    return 1;
}

/*
 * Nothing is left to read, it seems. The line itself has the last word: it may have changed just now, and a queue that ran
 * over has lost edges.
 */
static int settle(gpio_input *in, gpio_event *event)
{
    const gpio_event seen = { in->driver->now_ns(), in->driver->get(in->line) > 0 };

    if (seen.time_ns < debounce_until_ns(&in->filter))
        return 0;
    if (seen.rising == in->filter.latest.rising)
        return debounce_due(&in->filter, seen.time_ns, event);
    if (in->driver->wait(in->line, 0) == 0)
        in->filter.latest = seen;
    return 0;
}

/* One edge that is there. 1: it, or with a filter the one before it, counts. -1: failed. */
static int read_edge(gpio_input *in, gpio_event *event)
{
    gpio_event raw;

    if (!in->driver->read(in->line, &raw))
        return -1;
    if (in->filters)
        return debounce_edge(&in->filter, &raw, event);
    *event = raw;
    return 1;
}

/* Everything that can be known without waiting. */
static int look(gpio_input *in, gpio_event *event)
{
    int got;

    while ((got = in->driver->wait(in->line, 0)) > 0)
        if ((got = read_edge(in, event)) != 0)
            return got;
    return got < 0 ? -1 : in->filters ? settle(in, event) : 0;
}

static int64_t earlier(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

int gpio_input_wait(gpio_input *in, int64_t timeout_ns, gpio_event *event)
{
    const int64_t longest_ns = (int64_t)3600 * 1000000000;
    const int64_t deadline = timeout_ns < 0 ? INT64_MAX : in->driver->now_ns() + timeout_ns;

    for (;;) {
        const int got = look(in, event);
        if (got < 0 || (got > 0 && ((event->rising ? GPIO_RISING : GPIO_FALLING) & in->edge)))
            return got;
        if (got > 0)
            continue;
        const int64_t left = earlier(deadline, debounce_until_ns(&in->filter)) - in->driver->now_ns();
        if (left <= 0 && in->driver->now_ns() >= deadline)
            return 0;
        if (left > 0 && in->driver->wait(in->line, earlier(left, longest_ns)) < 0)
            return -1;
    }
}

void gpio_input_drain(gpio_input *in)
{
    gpio_event ignored;

    while (gpio_input_wait(in, 0, &ignored) > 0)
        ;
}

void gpio_input_close(gpio_input *in)
{
    if (in->driver)
        in->driver->close(in->line);
    *in = (gpio_input){ 0 };
}
