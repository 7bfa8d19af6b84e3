/* SPDX-License-Identifier: BSD-2-Clause */
/* See fake_gpio.h. The queue holds as many edges as the kernel's does for a line, and drops the newest as it does. */
#include <stdlib.h>
#include <string.h>

#include "tests/fake_gpio.h"

enum { MOST_CHANGES = 256 };

typedef struct fake_line {
    int open, level, sets;
    gpio_request request;
    gpio_event queue[FAKE_QUEUE];
    int queued;
} fake_line;

static struct {
    int64_t now_ns;
    struct {
        int64_t at_ns;
        int line, level;
    } change[MOST_CHANGES];
    int changes, next;
    fake_line line[FAKE_LINES];
    gpio_fault refusal;
    const char *detail;
    int broken;
} chip;

void fake_gpio_reset(void)
{
    memset(&chip, 0, sizeof chip);
}

void fake_gpio_refuse(gpio_fault fault, const char *detail)
{
    chip.refusal = fault;
    chip.detail = detail;
}

void fake_gpio_break(void)
{
    chip.broken = 1;
}

void fake_gpio_change(int line, int64_t at_us, int level)
{
    if (chip.changes == MOST_CHANGES)
        abort();
    chip.change[chip.changes].at_ns = at_us * 1000;
    chip.change[chip.changes].line = line;
    chip.change[chip.changes++].level = level;
}

static void queue_edge(fake_line *l, int64_t at_ns)
{
    const int rising = l->level != l->request.active_low;

    if (l->open && !l->request.output && (l->request.edge & (rising ? GPIO_RISING : GPIO_FALLING)) &&
        l->queued < FAKE_QUEUE)
        l->queue[l->queued++] = (gpio_event){ at_ns, rising };
}

static int64_t next_change_ns(void)
{
    return chip.next < chip.changes ? chip.change[chip.next].at_ns : INT64_MAX;
}

static void change_next(void)
{
    fake_line *l = &chip.line[chip.change[chip.next].line];

    if (l->level != chip.change[chip.next].level) {
        l->level = chip.change[chip.next].level;
        queue_edge(l, chip.change[chip.next].at_ns);
    }
    chip.next++;
}

static void go_to(int64_t ns)
{
    while (next_change_ns() <= ns)
        change_next();
    chip.now_ns = ns;
}

void fake_gpio_pass(int64_t us)
{
    go_to(chip.now_ns + us * 1000);
}

int64_t fake_gpio_time_us(void)
{
    return chip.now_ns / 1000;
}

int fake_gpio_level(int line)
{
    return chip.line[line].level;
}

int fake_gpio_is_open(int line)
{
    return chip.line[line].open;
}

const gpio_request *fake_gpio_request(int line)
{
    return &chip.line[line].request;
}

int fake_gpio_sets(int line)
{
    return chip.line[line].sets;
}

/* --- the driver --- */

static gpio_fault fake_open(const gpio_request *r, void **line, char *detail)
{
    unsigned offset;

    *line = NULL;
    strcpy(detail, chip.detail ? chip.detail : "");
    if (chip.refusal != GPIO_OK)
        return chip.refusal;
    if (strcmp(r->chip, "fake"))
        return GPIO_NO_CHIP;
    if (!gpio_line_number(r->line, &offset) || offset >= FAKE_LINES)
        return GPIO_NO_LINE;
    fake_line *l = &chip.line[offset];
    if (l->open) {
        strcpy(detail, "somebody");
        return GPIO_BUSY;
    }
    l->open = 1;
    l->request = *r;
    if (r->output)
        l->level = r->active_low;
    *line = l;
    return GPIO_OK;
}

static int fake_wait(void *line, int64_t timeout_ns)
{
    const fake_line *l = line;
    const int64_t deadline = chip.now_ns + timeout_ns;

    if (chip.broken)
        return -1;
    while (!l->queued && next_change_ns() <= deadline)
        go_to(next_change_ns());
    if (!l->queued)
        go_to(deadline);
    return l->queued > 0;
}

static int fake_read(void *line, gpio_event *event)
{
    fake_line *l = line;

    if (!l->queued)
        return 0;
    *event = l->queue[0];
    memmove(l->queue, l->queue + 1, (size_t)--l->queued * sizeof *l->queue);
    return 1;
}

static int fake_get(void *line)
{
    const fake_line *l = line;
    return l->level != l->request.active_low;
}

static int fake_set(void *line, int active)
{
    fake_line *l = line;

    if (chip.broken)
        return 0;
    l->level = active != l->request.active_low;
    l->sets++;
    return 1;
}

static void fake_close(void *line)
{
    fake_line *l = line;
    l->open = l->queued = 0;
}

static int64_t fake_now(void)
{
    return chip.now_ns;
}

static void fake_rest(int64_t ns)
{
    if (ns > 0)
        go_to(chip.now_ns + ns);
}

#define FAKE(title, by_kernel)                                                                               \
    {                                                                                                        \
        .name = title, .debounces = by_kernel, .open = fake_open, .wait = fake_wait, .read = fake_read,      \
        .get = fake_get, .set = fake_set, .close = fake_close, .now_ns = fake_now, .rest = fake_rest         \
    }

const gpio_driver fake_gpio = FAKE("fake", 0);
const gpio_driver fake_gpio_debouncing = FAKE("debouncing fake", 1);
