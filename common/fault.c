/* SPDX-License-Identifier: BSD-2-Clause */
/* See fault.h. */
#include <stdarg.h>
#include <stdio.h>

#include "common/fault.h"
#include "common/tool.h"

int fault_set(fault *f, int exit_status, const char *fmt, ...)
{
    if (f->exit_status != EXIT_OK)
        return 0; /* what follows the first fault is its consequence */
    va_list args;
    va_start(args, fmt);
    vsnprintf(f->text, sizeof f->text, fmt, args);
    va_end(args);
    f->exit_status = exit_status;
    return 0;
}
