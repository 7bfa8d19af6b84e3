/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank makes, measures and shows databanks of faces. */
#include <string.h>

#include "common/tool.h"
#include "databank/fit/fit.h"
#include "databank/masks/masks.h"
#include "databank/options.h"
#include "databank/pick/pick_run.h"
#include "databank/report.h"
#include "databank/retarget/retarget.h"
#include "databank/run.h"

int main(int argc, char **argv)
{
    options opt;
    report rep = { 0 };

    tool_name = "fapbank";
    if (argc > 1 && !strcmp(argv[1], "fit"))
        return fit_run(argc - 1, argv + 1);
    if (argc > 1 && !strcmp(argv[1], "masks"))
        return masks_run(argc - 1, argv + 1);
    if (argc > 1 && !strcmp(argv[1], "pick"))
        return pick_run(argc - 1, argv + 1);
    if (argc > 1 && !strcmp(argv[1], "retarget"))
        return retarget_run(argc - 1, argv + 1);
    if (!options_parse(&opt, argc, argv))
        return opt.exit_status;
    const fap_err err = run(&opt, &rep);
    return report_print(&rep, &opt, err);
}
