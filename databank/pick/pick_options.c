/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>

#include "common/tool.h"
#include "databank/pick/pick_options.h"

static const char help[] =
    "Usage: fapbank pick SCAN -o POINTS.csv [options]\n"
    "\n"
    "Shows a scan from its right, from the front and from its left, and asks for 28 places, one after the "
    "other; the generic face in\n"
    "the corner shows where each is. 144 more follow as soon as four are known. The table is what fapbank "
    "fit "
    "--landmarks reads.\n"
    "\n"
    "  -o, --output FILE     the places, a line each: name, x, y, z in the scan's unit and axes\n"
    "      --landmarks FILE  places that are known already, as for fapbank fit\n"
    "      --minor           write the feature points that followed, too\n"
    "      --bank B.fbank    the generic face (the default face, else the built-in one; \"builtin\")\n"
    "      --quiet           errors only\n"
    "      --help\n"
    "\n"
    "In the window: arrows and R turn the scan by a quarter until the middle picture is its face; a click "
    "puts "
    "the place that is\n"
    "asked for, in any of the three pictures; Space leaves it out, Backspace goes back, Return writes, "
    "Escape "
    "gives up.\n"
    "\n"
    "Examples:\n"
    "  fapbank pick anna.ply -o anna.csv; fapbank fit anna.ply --landmarks anna.csv -o anna.fbank\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 no display, or a library is missing. docs/shape.md tells "
    "more.\n";

enum { OPT_LANDMARKS = 256, OPT_MINOR, OPT_BANK, OPT_QUIET, OPT_HELP };

static const struct option long_options[] = {
    { "output", required_argument, NULL, 'o' },
    { "landmarks", required_argument, NULL, OPT_LANDMARKS },
    { "minor", no_argument, NULL, OPT_MINOR },
    { "bank", required_argument, NULL, OPT_BANK },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { NULL, 0, NULL, 0 },
};

static int usage(pick_options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int parse_option(pick_options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_LANDMARKS: opt->landmarks = arg; return 1;
    case OPT_MINOR: opt->minor = 1; return 1;
    case OPT_BANK: opt->bank = arg; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

int pick_options_parse(pick_options *opt, int argc, char **argv)
{
    int c;

    *opt = (pick_options){ .exit_status = EXIT_OK };
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!parse_option(opt, c, optarg))
            return 0;
    if (argc - optind != 1)
        tool_error("one scan: fapbank pick SCAN -o POINTS.csv");
    else if (!opt->output)
        tool_error("where to? -o POINTS.csv");
    else {
        opt->scan = argv[optind];
        return 1;
    }
    return usage(opt);
}
