/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_line.h. */
#include <stdio.h>

#include "encoder/report_line.h"

void report_line_add(report_line *l, const char *separator, const char *text)
{
    const size_t room = sizeof l->text - l->used;
    const int n = snprintf(l->text + l->used, room, "%s%s", l->used ? separator : "", text);

    l->used += (size_t)n < room ? (size_t)n : room - 1;
}
