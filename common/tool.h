/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How every tool speaks: exit codes, one-line errors on stderr, a progress bar on a terminal.
 */
#ifndef COMMON_TOOL_H
#define COMMON_TOOL_H

#include <stdint.h>

#include <fap/error.h>

/* Exit codes of all tools. */
enum { EXIT_OK = 0, EXIT_DATA = 1, EXIT_USAGE = 2, EXIT_MISSING = 3 };

/* The tool's name for messages; set once in main. */
extern const char *tool_name;
/* --quiet: no notes and no progress, errors only. */
extern int tool_quiet;

/* "fapenc: take.c3d: ...". A message says what, where and what to do next. */
void tool_error(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
void tool_note(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
/* The exit code that @p err asks for. */
int tool_exit_code(fap_err err);

/* A bar on stderr, drawn only on a terminal and only when the work lasts over a second. */
typedef struct progress {
    const char *label;
    int64_t total, started_us, drawn_us;
} progress;

void progress_start(progress *p, const char *label, int64_t total);
void progress_step(progress *p, int64_t done);
void progress_end(progress *p);

#endif
