/* SPDX-License-Identifier: BSD-2-Clause */
/* See export_limit.h. */
#include <inttypes.h>

#include "common/tool.h"
#include "player/sinks/export_limit.h"

static const double most = 1e9;

int export_fits(const sink_setup *setup, double size, fault *f)
{
    if (size <= most)
        return 1;
    return fault_set(f, EXIT_USAGE,
                     "%s: %" PRId64
                     " frames would be some %.1f GB, at most %g GB are written: ask for fewer with "
                     "--frames A:B or --fps R",
                     setup->output, setup->count, size * 1e-9, most * 1e-9);
}
