/* SPDX-License-Identifier: BSD-2-Clause */
/* fapplay: FAP to face. */
#include "common/tool.h"
#include "player/live/live.h"
#include "player/options.h"
#include "player/report.h"
#include "player/run.h"

int main(int argc, char **argv)
{
    play_options opt;
    play_report report = { 0 };

    tool_name = "fapplay";
    if (live_options_are(argc, argv))
        return live_run(argc, argv);
    if (!play_options_parse(&opt, argc, argv))
        return opt.exit_status;
    tool_quiet = opt.quiet;
    play_run(&opt, &report);
    return play_report_print(&report, &opt);
}
