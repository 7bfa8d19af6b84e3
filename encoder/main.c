/* SPDX-License-Identifier: BSD-2-Clause */
/* fapenc: captures to FAPs. */
#include <string.h>

#include "common/tool.h"
#include "encoder/batch/batch.h"
#include "encoder/report.h"
#include "encoder/track/track.h"

int main(int argc, char **argv)
{
    options opt;

    tool_name = "fapenc";
    if (argc > 1 && !strcmp(argv[1], "track"))
        return track_run(argc - 1, argv + 1);
    if (!options_parse(&opt, argc, argv))
        return opt.exit_status;

    if (opt.command == COMMAND_BATCH)
        return batch_run(&opt);
    run_report rep = { 0 };
    const fap_err err = run(&opt, &rep);
    const int status = report_print(&opt, &rep, err);
    run_close(&rep);
    return status;
}
