/* SPDX-License-Identifier: BSD-2-Clause */
/* See masks_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/take.h>

#include "common/tool.h"
#include "databank/masks/masks_options.h"
#include "player/render/renderer.h"

static const char help[] =
    "Usage: fapbank masks FACE --landmarks POINTS.csv -o MASKS.csv [options]\n"
    "\n"
    "Finds which vertices of a face of any structure are of the upper and the lower lip, and of the upper "
    "and "
    "the lower lid of each\n"
    "eye: a bank's face, whose masks are known, is laid onto it, and a cylindrical projection brings its "
    "masks "
    "over. FACE is an OBJ,\n"
    "GLB or PLY. What comes out has a line for each vertex and side, \"1207,lip_upper\" (0 is the first "
    "vertex), for a recipe's\n"
    "\"masks MASKS.csv\".\n"
    "\n"
    "      --landmarks FILE  places on the face, as for fapbank fit\n"
    "  -o, --output FILE     the masks\n"
    "      --bank B.fbank    whose masks (the default face, else the built-in one; \"builtin\")\n"
    "      --method M        how its face is laid: lorenzo (the default) or another of fapbank fit\n"
    "      --unit U          of FACE: mm, cm, m or millimetres in one unit (the one that makes it a head)\n"
    "      --pictures DIR    masks.png: lips red and blue, lids orange and green; laid.png: the bank's face\n"
    "      --gl NAME         osmesa, egl or glfw: OpenGL by this library\n"
    "      --json            the report as JSON on standard output\n"
    "      --quiet           errors only\n"
    "      --help\n"
    "\n"
    "Example:\n"
    "  fapbank masks troll.obj --landmarks troll.csv -o troll_masks.csv --pictures troll_masks\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 a library is missing. docs/shape.md tells more.\n";

enum {
    OPT_LANDMARKS = 256,
    OPT_BANK,
    OPT_METHOD,
    OPT_UNIT,
    OPT_PICTURES,
    OPT_GL,
    OPT_JSON,
    OPT_QUIET,
    OPT_HELP
};

static const struct option long_options[] = {
    { "landmarks", required_argument, NULL, OPT_LANDMARKS },
    { "output", required_argument, NULL, 'o' },
    { "bank", required_argument, NULL, OPT_BANK },
    { "method", required_argument, NULL, OPT_METHOD },
    { "unit", required_argument, NULL, OPT_UNIT },
    { "pictures", required_argument, NULL, OPT_PICTURES },
    { "gl", required_argument, NULL, OPT_GL },
    { "json", no_argument, NULL, OPT_JSON },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { NULL, 0, NULL, 0 },
};

static int usage(masks_options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int parse_method(masks_options *opt, const char *text)
{
    for (int m = 0; fap_registration_name(m); m++)
        if (!strcmp(text, fap_registration_name(m))) {
            opt->fit.method = (fap_registration_method)m;
            return 1;
        }
    tool_error("--method %s: there is no such method; see fapbank fit --help", text);
    return usage(opt);
}

static int parse_unit(masks_options *opt, const char *text)
{
    char *end;
    double *unit = &opt->fit.mm_per_unit;

    *unit = fap_take_unit_mm(text);
    if (!(*unit > 0))
        *unit = strtod(text, &end);
    else
        return 1;
    if (end != text && !*end && *unit >= 1e-6 && *unit <= 1e6)
        return 1;
    tool_error("--unit %s: expected mm, cm, m or a number", text);
    return usage(opt);
}

static int parse_gl(masks_options *opt, const char *text)
{
    opt->gl = text;
    if (render_gl_known(text))
        return 1;
    tool_error("--gl %s: expected osmesa, egl or glfw", text);
    return usage(opt);
}

static int parse_option(masks_options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_LANDMARKS: opt->landmarks = arg; return 1;
    case OPT_BANK: opt->bank = arg; return 1;
    case OPT_METHOD: return parse_method(opt, arg);
    case OPT_UNIT: return parse_unit(opt, arg);
    case OPT_PICTURES: opt->pictures = arg; return 1;
    case OPT_GL: return parse_gl(opt, arg);
    case OPT_JSON: opt->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

static int check(masks_options *opt)
{
    if (!opt->face)
        tool_error("masks for what? fapbank masks FACE --landmarks POINTS.csv -o MASKS.csv");
    else if (!opt->landmarks)
        tool_error("where are mouth and eyes on it? --landmarks POINTS.csv");
    else if (!opt->output)
        tool_error("where to? -o MASKS.csv");
    else
        return 1;
    return usage(opt);
}

int masks_options_parse(masks_options *opt, int argc, char **argv)
{
    int c;

    *opt = (masks_options){ .exit_status = EXIT_OK };
    fap_registration_config_init(&opt->fit);
    opt->fit.method = FAP_REGISTER_LORENZO;
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!parse_option(opt, c, optarg))
            return 0;
    if (optind < argc)
        opt->face = argv[optind++];
    if (optind < argc) {
        tool_error("one face at a time, not also %s", argv[optind]);
        return usage(opt);
    }
    return check(opt);
}
