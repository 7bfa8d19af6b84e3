/* SPDX-License-Identifier: BSD-2-Clause */
/* A line of a report in the making. */
#ifndef ENCODER_REPORT_LINE_H
#define ENCODER_REPORT_LINE_H

#include <stddef.h>

/* Of things that there may be hundreds of, as many are named; --json has all. */
enum { REPORT_MOST = 12 };

/* Text that is cut at the end of its room. */
typedef struct report_line {
    char text[1024];
    size_t used;
} report_line;

/* @p separator: before all but the first. */
void report_line_add(report_line *l, const char *separator, const char *text);

#endif
