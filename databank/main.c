/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank makes, measures and shows databanks of faces. */
#include "common/tool.h"
#include "databank/options.h"
#include "databank/report.h"
#include "databank/run.h"

int main(int argc, char **argv)
{
    options opt;
    report rep = { 0 };

    tool_name = "fapbank";
    if (!options_parse(&opt, argc, argv))
        return opt.exit_status;
    const fap_err err = run(&opt, &rep);
    return report_print(&rep, &opt, err);
}
