/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <fap/studio/take.h>

#include "common/tool.h"
#include "databank/fit/fit_options.h"
#include "player/render/renderer.h"

static const char help[] =
    "Usage: fapbank fit SCAN --landmarks POINTS.csv -o FACE.obj|FACE.ply|FACE.fbank [options]\n"
    "\n"
    "Lays a generic face onto a scan: every vertex then means the same place on every person that was "
    "scanned. SCAN is an OBJ, GLB or\n"
    "PLY of up to 16 million triangles, in any unit and any axes.\n"
    "\n"
    "      --landmarks FILE  places in the scan, a line each: \"8.3,x,y,z\" (a feature point), \"48,x,y,z\" "
    "(of the 68-point\n"
    "                        scheme), or a name and the number of a vertex; 20 and more are good, three the "
    "least\n"
    "  -o, --output FILE     the face in millimetres and the head's axes; as .fbank it has the generic "
    "face's motions too,\n"
    "                        scaled (Zhu's thesis, section 5.1)\n"
    "      --bank B.fbank    the generic face (the default face, else the built-in one; \"builtin\")\n"
    "      --method M        auto: landmarks, then the skin drawn to the scan from coarse to fine\n"
    "                        zhu: landmarks met exactly, then rays to the scan, as the thesis has it\n"
    "                        yano: a flat template over the range image, which is sampled; any scan is made "
    "one\n"
    "                        lorenzo: planar bones between control points, moved until distance, strain "
    "and bending\n"
    "                        cost least\n"
    "      --optimizer O     lorenzo: lbfgs (all control points at once, by gradients) or simplex (one after "
    "the other, by\n"
    "                        values alone; slow)\n"
    "      --control N       lorenzo: this many control points (400)\n"
    "      --subdivide N     zhu: Loop's scheme, yano: one-to-four, 0 to 3 times (0); for -o FACE.obj or "
    ".ply\n"
    "      --minor YES       zhu: the rest of the generic face's 172 labelled points follow the landmarks\n"
    "                        (yes), or no\n"
    "      --project WAY     zhu, lorenzo: cylinder (away from the head's axis) or normal\n"
    "      --limit MM        zhu, lorenzo: how far a ray may go; yano: how far off the landmarks' space "
    "(15)\n"
    "      --unit U          of the scan: mm, cm, m or millimetres in one unit (the one that makes it a "
    "head)\n"
    "      --pin-error MM    how far off a landmark may be (1)\n"
    "      --reach MM        what is farther from the laid face than this is something else (12)\n"
    "      --face-only       without ears, top and back of the head, the same triangles on everybody; for -o "
    "FACE.obj "
    "or .ply\n"
    "      --pictures DIR    points, before, after, distances, wireframe as PNG\n"
    "      --gl NAME         osmesa, egl or glfw: OpenGL by this library\n"
    "      --json            the report as JSON on standard output\n"
    "      --quiet           errors only\n"
    "      --help\n"
    "\n"
    "Examples:\n"
    "  fapbank fit anna.ply --landmarks anna.csv -o anna.fbank --pictures anna_fit\n"
    "  fapplay take.fap --bank anna.fbank\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 a library is missing. docs/shape.md tells more.\n";

enum {
    OPT_LANDMARKS = 256,
    OPT_BANK,
    OPT_METHOD,
    OPT_OPTIMIZER,
    OPT_CONTROL,
    OPT_SUBDIVIDE,
    OPT_MINOR,
    OPT_PROJECT,
    OPT_LIMIT,
    OPT_UNIT,
    OPT_PIN_ERROR,
    OPT_REACH,
    OPT_FACE_ONLY,
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
    { "optimizer", required_argument, NULL, OPT_OPTIMIZER },
    { "control", required_argument, NULL, OPT_CONTROL },
    { "subdivide", required_argument, NULL, OPT_SUBDIVIDE },
    { "minor", required_argument, NULL, OPT_MINOR },
    { "project", required_argument, NULL, OPT_PROJECT },
    { "limit", required_argument, NULL, OPT_LIMIT },
    { "unit", required_argument, NULL, OPT_UNIT },
    { "pin-error", required_argument, NULL, OPT_PIN_ERROR },
    { "reach", required_argument, NULL, OPT_REACH },
    { "face-only", no_argument, NULL, OPT_FACE_ONLY },
    { "pictures", required_argument, NULL, OPT_PICTURES },
    { "gl", required_argument, NULL, OPT_GL },
    { "json", no_argument, NULL, OPT_JSON },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { NULL, 0, NULL, 0 },
};

static int usage(fit_options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int number(fit_options *opt, const char *name, const char *text, double low, double high, double *out)
{
    char *end;

    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high)
        return 1;
    tool_error("--%s %s: expected a number from %g to %g", name, text, low, high);
    return usage(opt);
}

static int parse_method(fit_options *opt, const char *text)
{
    for (int m = 0; fap_registration_name(m); m++)
        if (!strcmp(text, fap_registration_name(m))) {
            opt->fit.method = (fap_registration_method)m;
            return 1;
        }
    tool_error("--method %s: expected auto, zhu, yano or lorenzo", text);
    return usage(opt);
}

static int parse_optimizer(fit_options *opt, const char *text)
{
    for (int o = 0; fap_optimizer_name(o); o++)
        if (!strcmp(text, fap_optimizer_name(o))) {
            opt->fit.optimizer = (fap_optimizer)o;
            return 1;
        }
    tool_error("--optimizer %s: expected lbfgs or simplex", text);
    return usage(opt);
}

static int parse_control(fit_options *opt, const char *text)
{
    double points;

    if (!number(opt, "control", text, FAP_CONTROL_POINTS_MIN, FAP_CONTROL_POINTS_MAX, &points))
        return 0;
    opt->fit.control_points = (int)points;
    return 1;
}

static int parse_project(fit_options *opt, const char *text)
{
    opt->fit.along_normals = !strcmp(text, "normal");
    if (opt->fit.along_normals || !strcmp(text, "cylinder"))
        return 1;
    tool_error("--project %s: expected cylinder or normal", text);
    return usage(opt);
}

static int parse_minor(fit_options *opt, const char *text)
{
    opt->minor = !strcmp(text, "yes");
    if (opt->minor || !strcmp(text, "no"))
        return 1;
    tool_error("--minor %s: expected yes or no", text);
    return usage(opt);
}

static int parse_subdivide(fit_options *opt, const char *text)
{
    double steps;

    if (!number(opt, "subdivide", text, 0, 3, &steps))
        return 0;
    opt->fit.subdivisions = (int)steps;
    return 1;
}

static int parse_unit(fit_options *opt, const char *text)
{
    opt->fit.mm_per_unit = fap_take_unit_mm(text);
    return opt->fit.mm_per_unit > 0 || number(opt, "unit", text, 1e-6, 1e6, &opt->fit.mm_per_unit);
}

static int parse_gl(fit_options *opt, const char *text)
{
    opt->gl = text;
    if (render_gl_known(text))
        return 1;
    tool_error("--gl %s: expected osmesa, egl or glfw", text);
    return usage(opt);
}

static int parse_option(fit_options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_LANDMARKS: opt->landmarks = arg; return 1;
    case OPT_BANK: opt->bank = arg; return 1;
    case OPT_METHOD: return parse_method(opt, arg);
    case OPT_OPTIMIZER: return parse_optimizer(opt, arg);
    case OPT_CONTROL: return parse_control(opt, arg);
    case OPT_SUBDIVIDE: return parse_subdivide(opt, arg);
    case OPT_MINOR: return parse_minor(opt, arg);
    case OPT_PROJECT: return parse_project(opt, arg);
    case OPT_LIMIT: return number(opt, "limit", arg, 0.1, 100, &opt->fit.limit_mm);
    case OPT_UNIT: return parse_unit(opt, arg);
    case OPT_PIN_ERROR: return number(opt, "pin-error", arg, 0.01, 50, &opt->fit.pin_error_mm);
    case OPT_REACH: return number(opt, "reach", arg, 0.5, 200, &opt->fit.reach_mm);
    case OPT_FACE_ONLY: opt->face_only = 1; return 1;
    case OPT_PICTURES: opt->pictures = arg; return 1;
    case OPT_GL: return parse_gl(opt, arg);
    case OPT_JSON: opt->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

static int has_known_ending(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (!strcasecmp(dot, ".obj") || !strcasecmp(dot, ".ply") || !strcasecmp(dot, ".fbank"));
}

static int check(fit_options *opt)
{
    if (!opt->scan)
        tool_error("what to fit to? fapbank fit SCAN --landmarks POINTS.csv -o FACE.fbank");
    else if (!opt->landmarks)
        tool_error("where is the face in it? --landmarks POINTS.csv");
    else if (!opt->output)
        tool_error("where to? -o FACE.obj, FACE.ply or FACE.fbank");
    else if (!has_known_ending(opt->output))
        tool_error("-o %s: expected a name that ends in .obj, .ply or .fbank", opt->output);
    else if (opt->fit.subdivisions && opt->fit.method != FAP_REGISTER_ZHU &&
             opt->fit.method != FAP_REGISTER_YANO)
        tool_error("--subdivide belongs to --method zhu and yano");
    else if (opt->fit.subdivisions && !strcasecmp(strrchr(opt->output, '.'), ".fbank"))
        tool_error("--subdivide: a bank's motions are those of the face as it is; write FACE.obj or .ply");
    else if (opt->face_only && !strcasecmp(strrchr(opt->output, '.'), ".fbank"))
        tool_error("--face-only: a bank's face is whole; write FACE.obj or .ply");
    else {
        opt->minor = opt->minor < 0 ? opt->fit.method == FAP_REGISTER_ZHU : opt->minor;
        return 1;
    }
    return usage(opt);
}

int fit_options_parse(fit_options *opt, int argc, char **argv)
{
    int c;

    *opt = (fit_options){ .minor = -1, .exit_status = EXIT_OK };
    fap_registration_config_init(&opt->fit);
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!parse_option(opt, c, optarg))
            return 0;
    if (optind < argc)
        opt->scan = argv[optind++];
    if (optind < argc) {
        tool_error("one scan at a time, not also %s", argv[optind]);
        return usage(opt);
    }
    return check(opt);
}
