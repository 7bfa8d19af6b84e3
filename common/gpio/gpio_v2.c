/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines by libgpiod 2 (Debian 13): settings become a request, which outlives the chip; the kernel debounces. */
#include <errno.h>
#include <gpiod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/gpio/gpio.h"

typedef struct v2_line {
    struct gpiod_line_request *request;
    struct gpiod_edge_event_buffer *events; /* of an input */
    unsigned offset;
} v2_line;

static void close_line(void *state)
{
    v2_line *l = state;

    gpiod_edge_event_buffer_free(l->events);
    if (l->request)
        gpiod_line_request_release(l->request);
    free(l);
}

/* --- chips --- */

static int has_label(struct gpiod_chip *chip, const char *label)
{
    struct gpiod_chip_info *info = gpiod_chip_get_info(chip);
    const int same = info && !strcmp(gpiod_chip_info_get_label(info), label);

    gpiod_chip_info_free(info);
    return same;
}

/* Chips are numbered, with gaps where one was taken away. */
static struct gpiod_chip *open_label(const char *label)
{
    enum { MOST_CHIPS = 256 };
    char path[32];
    int error = ENOENT;

    for (int i = 0; i < MOST_CHIPS; i++) {
        snprintf(path, sizeof path, "/dev/gpiochip%d", i);
        struct gpiod_chip *chip = gpiod_chip_open(path);
        if (chip && has_label(chip, label))
            return chip;
        if (chip)
            gpiod_chip_close(chip);
        else if (errno == EACCES)
            error = EACCES; /* it may have been this one */
    }
    errno = error;
    return NULL;
}

static struct gpiod_chip *open_chip(const char *chip)
{
    char path[FAP_ERROR_TEXT_SIZE];

    return gpio_chip_path(chip, path, sizeof path) ? gpiod_chip_open(path) : open_label(chip);
}

/* --- lines --- */

static int find_line(struct gpiod_chip *chip, const char *name, unsigned *offset)
{
    struct gpiod_line_info *info;

    if (!gpio_line_number(name, offset)) {
        const int found = gpiod_chip_get_line_offset_from_name(chip, name);
        *offset = (unsigned)found;
        return found >= 0;
    }
    info = gpiod_chip_get_line_info(chip, *offset);
    gpiod_line_info_free(info);
    return info != NULL;
}

static int set_input(struct gpiod_line_settings *s, const gpio_request *r)
{
    static const enum gpiod_line_edge edge[] = {
        [GPIO_RISING] = GPIOD_LINE_EDGE_RISING,
        [GPIO_FALLING] = GPIOD_LINE_EDGE_FALLING,
        [GPIO_BOTH] = GPIOD_LINE_EDGE_BOTH,
    };
    static const enum gpiod_line_bias bias[] = {
        [GPIO_BIAS_AS_IS] = GPIOD_LINE_BIAS_AS_IS,
        [GPIO_BIAS_OFF] = GPIOD_LINE_BIAS_DISABLED,
        [GPIO_PULL_UP] = GPIOD_LINE_BIAS_PULL_UP,
        [GPIO_PULL_DOWN] = GPIOD_LINE_BIAS_PULL_DOWN,
    };
    gpiod_line_settings_set_debounce_period_us(s, (unsigned long)r->debounce_us);
    return !gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_INPUT) &&
           !gpiod_line_settings_set_edge_detection(s, edge[r->edge]) &&
           !gpiod_line_settings_set_bias(s, bias[r->bias]) &&
           !gpiod_line_settings_set_event_clock(s, GPIOD_LINE_CLOCK_MONOTONIC);
}

static int set_output(struct gpiod_line_settings *s)
{
    return !gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_OUTPUT) &&
           !gpiod_line_settings_set_output_value(s, GPIOD_LINE_VALUE_INACTIVE);
}

static int make_settings(struct gpiod_line_settings *s, const gpio_request *r)
{
    gpiod_line_settings_set_active_low(s, r->active_low);
    return r->output ? set_output(s) : set_input(s, r);
}

static struct gpiod_line_request *ask(struct gpiod_chip *chip, unsigned offset, const gpio_request *r)
{
    struct gpiod_line_settings *settings = gpiod_line_settings_new();
    struct gpiod_line_config *lines = gpiod_line_config_new();
    struct gpiod_request_config *config = gpiod_request_config_new();
    struct gpiod_line_request *request = NULL;

    if (settings && lines && config && make_settings(settings, r) &&
        !gpiod_line_config_add_line_settings(lines, &offset, 1, settings)) {
        gpiod_request_config_set_consumer(config, r->consumer);
        request = gpiod_chip_request_lines(chip, config, lines);
    }
    const int error = errno;
    gpiod_request_config_free(config);
    gpiod_line_config_free(lines);
    gpiod_line_settings_free(settings);
    errno = error;
    return request;
}

static void name_owner(struct gpiod_chip *chip, unsigned offset, char *detail)
{
    struct gpiod_line_info *info = gpiod_chip_get_line_info(chip, offset);
    const char *owner = info ? gpiod_line_info_get_consumer(info) : NULL;

    snprintf(detail, GPIO_DETAIL_SIZE, "%s", owner ? owner : "the kernel");
    gpiod_line_info_free(info);
}

static gpio_fault request_line(v2_line *l, struct gpiod_chip *chip, const gpio_request *r, char *detail)
{
    if (!find_line(chip, r->line, &l->offset))
        return GPIO_NO_LINE;
    l->request = ask(chip, l->offset, r);
    if (l->request && !r->output)
        l->events = gpiod_edge_event_buffer_new(1);
    if (l->request && (r->output || l->events))
        return GPIO_OK;
    const gpio_fault fault = gpio_line_fault(errno, detail);
    if (fault == GPIO_BUSY)
        name_owner(chip, l->offset, detail);
    return fault;
}

static gpio_fault open_parts(v2_line *l, const gpio_request *r, char *detail)
{
    struct gpiod_chip *chip = open_chip(r->chip);

    if (!chip)
        return gpio_chip_fault(errno, detail);
    const gpio_fault fault = request_line(l, chip, r, detail);
    gpiod_chip_close(chip);
    return fault;
}

static gpio_fault open_line(const gpio_request *r, void **line, char *detail)
{
    v2_line *l = calloc(1, sizeof *l);

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
    const v2_line *l = state;
    const int got = gpiod_line_request_wait_edge_events(l->request, timeout_ns);

    return got < 0 && errno == EINTR ? 0 : got;
}

static int read_line(void *state, gpio_event *event)
{
    const v2_line *l = state;

    if (gpiod_line_request_read_edge_events(l->request, l->events, 1) < 1)
        return 0;
    struct gpiod_edge_event *e = gpiod_edge_event_buffer_get_event(l->events, 0);
    event->time_ns = (int64_t)gpiod_edge_event_get_timestamp_ns(e);
    event->rising = gpiod_edge_event_get_event_type(e) == GPIOD_EDGE_EVENT_RISING_EDGE;
    return 1;
}

static int get_line(void *state)
{
    const v2_line *l = state;
    return (int)gpiod_line_request_get_value(l->request, l->offset);
}

static int set_line(void *state, int active)
{
    const v2_line *l = state;
    return !gpiod_line_request_set_value(l->request, l->offset,
                                         active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
}

const gpio_driver gpio_system = {
    .name = "libgpiod 2",
    .debounces = 1,
    .open = open_line,
    .wait = wait_line,
    .read = read_line,
    .get = get_line,
    .set = set_line,
    .close = close_line,
    .now_ns = gpio_now_ns,
    .rest = gpio_rest,
};
