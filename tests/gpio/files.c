/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * GPIO lines that are files, for fapplay-lines: a window cannot be tried in the emulated machine of tests/gpio/run, and where
 * there is a display there is no chip. CHIP is a folder. An input is the named pipe CHIP/LINE, whose bytes 1 and 0 are edges; a
 * thread stamps them when they come, as an interrupt would. What is done to outputs is written to CHIP/log: LINE VALUE.
 */
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/gpio/gpio.h"

typedef struct file_line {
    gpio_request request;
    char name[32];
    int world;     /* the pipe, or the log */
    int events[2]; /* of an input: from the thread */
    pthread_t thread;
    int level;
} file_line;

/* Ends the thread: one that is cancelled upsets the address sanitizer. */
static const char last_byte = '.';

static void *stamp_edges(void *state)
{
    const file_line *l = state;
    char level;

    while (read(l->world, &level, 1) == 1 && level != last_byte) {
        const gpio_event e = { gpio_now_ns(), level == '1' };
        if ((l->request.edge & (e.rising ? GPIO_RISING : GPIO_FALLING)) &&
            write(l->events[1], &e, sizeof e) != sizeof e)
            break;
    }
    return NULL;
}

/* Opened for both ways, so that the pipe never ends. */
static int open_input(file_line *l, const char *path)
{
    l->world = open(path, O_RDWR);
    return l->world >= 0 && !pipe(l->events) && !pthread_create(&l->thread, NULL, stamp_edges, l);
}

static int set_line(void *line, int active)
{
    const file_line *l = line;
    char text[48];
    const size_t length = strlen(l->name);

    memcpy(text, l->name, length);
    memcpy(text + length, active ? " 1\n" : " 0\n", 3);
    return write(l->world, text, length + 3) == (ssize_t)length + 3;
}

static int open_output(file_line *l, const char *chip)
{
    char path[FAP_ERROR_TEXT_SIZE];

    snprintf(path, sizeof path, "%s/log", chip);
    l->world = open(path, O_WRONLY | O_APPEND | O_CREAT, 0666);
    return l->world >= 0 && set_line(l, 0);
}

static gpio_fault open_line(const gpio_request *r, void **line, char *detail)
{
    char path[FAP_ERROR_TEXT_SIZE];
    file_line *l = calloc(1, sizeof *l);

    *line = NULL;
    detail[0] = '\0';
    if (!l)
        abort();
    l->request = *r;
    snprintf(l->name, sizeof l->name, "%s", r->line);
    snprintf(path, sizeof path, "%s/%s", r->chip, r->line);
    if (r->output ? !open_output(l, r->chip) : !open_input(l, path)) {
        free(l);
        return GPIO_NO_LINE;
    }
    *line = l;
    return GPIO_OK;
}

static int wait_line(void *line, int64_t timeout_ns)
{
    const file_line *l = line;
    struct pollfd p = { .fd = l->events[0], .events = POLLIN };

    return poll(&p, 1, (int)(timeout_ns / 1000000)) > 0;
}

static int read_line(void *line, gpio_event *event)
{
    file_line *l = line;

    if (read(l->events[0], event, sizeof *event) != sizeof *event)
        return 0;
    l->level = event->rising;
    return 1;
}

static int get_line(void *line)
{
    const file_line *l = line;
    return l->level;
}

static void close_line(void *line)
{
    file_line *l = line;

    if (!l->request.output) {
        if (write(l->world, &last_byte, 1) == 1)
            pthread_join(l->thread, NULL);
        close(l->events[0]);
        close(l->events[1]);
    }
    close(l->world);
    free(l);
}

/* The kernel's debouncing is not what is tried here. */
const gpio_driver gpio_system = {
    .name = "files",
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
