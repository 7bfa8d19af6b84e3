/* SPDX-License-Identifier: BSD-2-Clause */
/* What went wrong in a tool: words for people, and the exit code they come with. */
#ifndef COMMON_FAULT_H
#define COMMON_FAULT_H

typedef struct fault {
    int exit_status; /* EXIT_OK: nothing yet */
    char text[1024];
} fault;

/* Notes the first fault and keeps it. Always returns 0, so that a failing function can `return
 * fault_set(...)`. */
int fault_set(fault *f, int exit_status, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

#endif
