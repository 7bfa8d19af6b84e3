/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines by libgpiod 1.6 (Debian 12): chip and line are objects, events are the line's; this API cannot debounce. */
#include <errno.h>
#include <gpiod.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/gpio/gpio.h"

typedef struct v1_line {
    struct gpiod_chip *chip;
    struct gpiod_line *line; /* the chip's */
} v1_line;

static void close_line(void *state)
{
    v1_line *l = state;

    if (l->line)
        gpiod_line_release(l->line);
    if (l->chip)
        gpiod_chip_close(l->chip);
    free(l);
}

static struct gpiod_chip *open_chip(const char *chip)
{
    char path[FAP_ERROR_TEXT_SIZE];

    return gpio_chip_path(chip, path, sizeof path) ? gpiod_chip_open(path) : gpiod_chip_open_by_label(chip);
}

static struct gpiod_line *find_line(struct gpiod_chip *chip, const char *name)
{
    unsigned offset;

    if (!gpio_line_number(name, &offset))
        return gpiod_chip_find_line(chip, name);
    return offset < gpiod_chip_num_lines(chip) ? gpiod_chip_get_line(chip, offset) : NULL;
}

static int flags(const gpio_request *r)
{
    static const int bias[] = {
        [GPIO_BIAS_OFF] = GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE,
        [GPIO_PULL_UP] = GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP,
        [GPIO_PULL_DOWN] = GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN,
    };
    return bias[r->bias] | (r->active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0);
}

static int request_type(const gpio_request *r)
{
    static const int events[] = {
        [GPIO_RISING] = GPIOD_LINE_REQUEST_EVENT_RISING_EDGE,
        [GPIO_FALLING] = GPIOD_LINE_REQUEST_EVENT_FALLING_EDGE,
        [GPIO_BOTH] = GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES,
    };
    return r->output ? GPIOD_LINE_REQUEST_DIRECTION_OUTPUT : events[r->edge];
}

static gpio_fault request(v1_line *l, const gpio_request *r, char *detail)
{
    const struct gpiod_line_request_config config = { r->consumer, request_type(r), flags(r) };

    if (!gpiod_line_request(l->line, &config, 0))
        return GPIO_OK;
    const gpio_fault fault = gpio_line_fault(errno, detail);
    const char *owner = gpiod_line_consumer(l->line);
    if (fault == GPIO_BUSY)
        snprintf(detail, GPIO_DETAIL_SIZE, "%s", owner ? owner : "the kernel");
    return fault;
}

static gpio_fault open_parts(v1_line *l, const gpio_request *r, char *detail)
{
    l->chip = open_chip(r->chip);
    if (!l->chip)
        return gpio_chip_fault(errno, detail);
    l->line = find_line(l->chip, r->line);
    return l->line ? request(l, r, detail) : GPIO_NO_LINE;
}

static gpio_fault open_line(const gpio_request *r, void **line, char *detail)
{
    v1_line *l = calloc(1, sizeof *l);

    *line = NULL;
    detail[0] = '\0';
    const gpio_fault fault = l ? open_parts(l, r, detail) : gpio_line_fault(ENOMEM, detail);
    if (fault == GPIO_OK)
        *line = l;
    else if (l)
        close_line(l);
    return fault;
}

static int wait_line(void *state, int64_t timeout_ns)
{
    const v1_line *l = state;
    const struct timespec t = { (time_t)(timeout_ns / 1000000000), (long)(timeout_ns % 1000000000) };
    const int got = gpiod_line_event_wait(l->line, &t);

    return got < 0 && errno == EINTR ? 0 : got;
}

static int read_line(void *state, gpio_event *event)
{
    const v1_line *l = state;
    struct gpiod_line_event e;

    if (gpiod_line_event_read(l->line, &e))
        return 0;
    event->time_ns = (int64_t)e.ts.tv_sec * 1000000000 + e.ts.tv_nsec;
    event->rising = e.event_type == GPIOD_LINE_EVENT_RISING_EDGE;
    return 1;
}

static int get_line(void *state)
{
    const v1_line *l = state;
    return gpiod_line_get_value(l->line);
}

static int set_line(void *state, int active)
{
    const v1_line *l = state;
    return !gpiod_line_set_value(l->line, active);
}

const gpio_driver gpio_system = {
    .name = "libgpiod 1",
    .open = open_line,
    .wait = wait_line,
    .read = read_line,
    .get = get_line,
    .set = set_line,
    .close = close_line,
    .now_ns = gpio_now_ns,
    .rest = gpio_rest,
};
