/* SPDX-License-Identifier: BSD-2-Clause */
/* No window. */
#if !defined HAVE_GLFW || !defined HAVE_CAIRO
#include "common/canvas/window.h"
#include "common/tool.h"

int canvas_window_run(const canvas_window *w, const char *instead, fault *f)
{
    (void)w;
    return fault_set(
        f, EXIT_MISSING,
        "this %s was built without GLFW or cairo (Debian: libglfw3-dev, libcairo2-dev), so it has no "
        "window; %s",
        tool_name, instead);
}
#endif
