/* SPDX-License-Identifier: BSD-2-Clause */
/* No window. */
#if !defined HAVE_GLFW || !defined HAVE_CAIRO
#include "common/tool.h"
#include "encoder/track/pick_window.h"

int pick_window_run(pick *p, const fap_picture *picture, fault *f)
{
    (void)p;
    (void)picture;
    return fault_set(f, EXIT_MISSING,
                     "this fapenc was built without GLFW or cairo (Debian: libglfw3-dev, libcairo2-dev), so "
                     "it has no window; "
                     "write where the dots are into a table for --init");
}
#endif
