/* SPDX-License-Identifier: BSD-2-Clause */
/* See live.h. */
#include "common/tool.h"
#include "player/live/live.h"

int live_run(int argc, char **argv)
{
    live_options o;
    fault f = { 0 };

    if (!live_options_parse(&o, argc, argv))
        return o.exit_status;
    if ((o.send ? live_send : live_listen)(&o, &f))
        return EXIT_OK;
    tool_error("%s", f.text);
    return f.exit_status;
}
