/* SPDX-License-Identifier: BSD-2-Clause */
/* See retarget_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/studio/take.h>

#include "common/tool.h"
#include "databank/retarget/retarget_options.h"

static const char help[] =
    "Usage: fapbank retarget B.fbank --to FACE.obj -o B2.fbank\n"
    "       fapbank retarget B.fbank --from SHAPES --landmarks POINTS.csv -o B2.fbank\n"
    "\n"
    "The first puts a bank's motions on another face of the same structure, such as fapbank fit makes, "
    "scaled by how much larger\n"
    "that is (Zhu's thesis, section 5.1). The second puts the motions of a face of any structure on the "
    "bank's face (section 5.2).\n"
    "\n"
    "      --to FACE         .obj or .ply, the bank's vertices in their order, millimetres\n"
    "      --from SHAPES     a folder with neutral.obj and a mesh for each shape, called like it; or a file "
    "with morph targets.\n"
    "                        Shapes called as ARKit's become units, \"joy\" to \"surprise\" and \"PP\" to "
    "\"ou\" key models\n"
    "      --landmarks FILE  where the face is on its neutral one, as for fapbank fit\n"
    "      --unit U          of SHAPES: mm, cm, m or millimetres in one unit (the one that makes it a head)\n"
    "  -o, --output FILE     the new bank\n"
    "      --pictures DIR    each motion, on the face that it comes from and on the one that it comes to\n"
    "      --json            the report as JSON on standard output\n"
    "      --quiet           errors only\n"
    "      --help\n"
    "\n"
    "Examples:\n"
    "  fapbank fit anna.ply --landmarks anna.csv -o anna.obj; fapbank retarget default.fbank --to anna.obj "
    "-o anna.fbank\n"
    "  fapbank retarget anna.fbank --from faceware/ --landmarks neutral.csv -o anna2.fbank\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 a library is missing. docs/shape.md tells more.\n";

enum { OPT_TO = 256, OPT_FROM, OPT_LANDMARKS, OPT_UNIT, OPT_PICTURES, OPT_JSON, OPT_QUIET, OPT_HELP };

static const struct option long_options[] = {
    { "output", required_argument, NULL, 'o' },    { "to", required_argument, NULL, OPT_TO },
    { "from", required_argument, NULL, OPT_FROM }, { "landmarks", required_argument, NULL, OPT_LANDMARKS },
    { "unit", required_argument, NULL, OPT_UNIT }, { "pictures", required_argument, NULL, OPT_PICTURES },
    { "json", no_argument, NULL, OPT_JSON },       { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },       { NULL, 0, NULL, 0 },
};

static int usage(retarget_options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int parse_unit(retarget_options *opt, const char *text)
{
    char *end;

    opt->mm_per_unit = fap_take_unit_mm(text);
    if (opt->mm_per_unit > 0)
        return 1;
    opt->mm_per_unit = strtod(text, &end);
    if (end != text && !*end && opt->mm_per_unit > 1e-6 && opt->mm_per_unit < 1e6)
        return 1;
    tool_error("--unit %s: expected mm, cm, m or a number of millimetres", text);
    return usage(opt);
}

static int parse_option(retarget_options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_TO: opt->to = arg; return 1;
    case OPT_FROM: opt->from = arg; return 1;
    case OPT_LANDMARKS: opt->landmarks = arg; return 1;
    case OPT_UNIT: return parse_unit(opt, arg);
    case OPT_PICTURES: opt->pictures = arg; return 1;
    case OPT_JSON: opt->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

static int check(retarget_options *opt)
{
    if (!opt->bank)
        tool_error("which bank? fapbank retarget B.fbank --to FACE.obj -o B2.fbank");
    else if (!opt->to == !opt->from)
        tool_error("either --to FACE, the same structure, or --from SHAPES, another one");
    else if (opt->from && !opt->landmarks)
        tool_error("where is the face on %s? --landmarks POINTS.csv", opt->from);
    else if (opt->to && (opt->landmarks || opt->mm_per_unit > 0))
        tool_error("--landmarks and --unit belong to --from SHAPES");
    else if (!opt->output)
        tool_error("where to? -o B2.fbank");
    else
        return 1;
    return usage(opt);
}

int retarget_options_parse(retarget_options *opt, int argc, char **argv)
{
    int c;

    *opt = (retarget_options){ .exit_status = EXIT_OK };
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!parse_option(opt, c, optarg))
            return 0;
    if (optind < argc)
        opt->bank = argv[optind++];
    if (optind < argc) {
        tool_error("one bank at a time, not also %s", argv[optind]);
        return usage(opt);
    }
    return check(opt);
}
