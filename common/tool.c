/* SPDX-License-Identifier: BSD-2-Clause */
/* See tool.h. */
#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "common/tool.h"

const char *tool_name = "fap";
int tool_quiet;

static void say(const char *fmt, va_list args)
{
    fprintf(stderr, "%s: ", tool_name);
    vfprintf(stderr, fmt, args);
    fputc('\n', stderr);
}

void tool_error(const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    say(fmt, args);
    va_end(args);
}

void tool_note(const char *fmt, ...)
{
    if (tool_quiet)
        return;
    va_list args;
    va_start(args, fmt);
    say(fmt, args);
    va_end(args);
}

int tool_exit_code(fap_err err)
{
    return err == FAP_OK ? EXIT_OK : err == FAP_E_ARG ? EXIT_USAGE : EXIT_DATA;
}

static int64_t now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

void progress_start(progress *p, const char *label, int64_t total)
{
    *p = (progress){ label, total, now_us(), 0 };
}

void progress_step(progress *p, int64_t done)
{
    enum { WIDTH = 40, QUIET_US = 1000000, PERIOD_US = 100000 };
    const int64_t now = now_us();

    if (tool_quiet || p->total <= 0 || now - p->started_us < QUIET_US || now - p->drawn_us < PERIOD_US ||
        !isatty(STDERR_FILENO))
        return;
    p->drawn_us = now;
    const int filled = (int)(WIDTH * done / p->total);
    const double left_s = done ? (now - p->started_us) * 1e-6 * (double)(p->total - done) / (double)done : 0;
    fprintf(stderr, "\r%s [%.*s%*s] %3d %%, %.0f s left ", p->label, filled,
            "########################################", WIDTH - filled, "", (int)(100 * done / p->total),
            left_s);
}

void progress_end(progress *p)
{
    if (p->drawn_us)
        fprintf(stderr, "\r\033[K");
    p->drawn_us = 0;
}
