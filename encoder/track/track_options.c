/* SPDX-License-Identifier: BSD-2-Clause */
/* See track_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/tool.h"
#include "encoder/track/track_options.h"

static const char help[] =
    "Usage: fapenc track VIDEO --init POINTS.csv -o TAKE.trc|TAKE.c3d [options]\n"
    "\n"
    "Follows coloured dots on a face through a video. With one or two mirrors beside the face the take has "
    "depth.\n"
    "\n"
    "      --init FILE       where the dots are in the first picture, a line each: \"8.4,302.5,288\", and "
    "two numbers\n"
    "                        more for each mirror, empty where a dot is not seen; pixels, 0 is the middle of "
    "the first\n"
    "      --pick FILE       show where they are in a window, and write that table; with -o it is then used\n"
    "      --mirrors N       to pick in: 0, 1 or 2 (2)\n"
    "      --labels FILE     what to pick, one a line; else the feature points people put dots on\n"
    "  -o, --output FILE     the take: .trc or .c3d, millimetres\n"
    "      --camera FILE     what the camera was measured to be: JSON with width, height, fx, fy, cx, cy and "
    "k, or as\n"
    "                        OpenCV's calibration writes it\n"
    "      --view DEGREES    what the camera sees from left to right, where nobody measured it (50)\n"
    "      --ruler A,B,MM    the labels at a ruler's ends, and its length: without it sizes are guessed\n"
    "      --interlaced I    auto, no, tff (top field first) or bff: fields are followed one by one\n"
    "      --radius PX       of the dots; else each is measured in the first picture\n"
    "      --start T --end T the part of the video, in seconds; POINTS.csv is of the picture at T\n"
    "      --overlay OUT.mp4 the video again, with what was followed drawn on it\n"
    "      --json            the report as JSON on standard output\n"
    "      --quiet           errors only\n"
    "      --help\n"
    "\n"
    "Examples:\n"
    "  fapenc track anna.mp4 --init anna.csv --camera camera.json --ruler \"ruler A,ruler B,100\" -o "
    "anna.trc\n"
    "  fapenc anna.trc -o anna.fap\n"
    "  fapenc track anna.mp4 --pick anna.csv --mirrors 1 -o anna.trc\n"
    "  fapenc track anna.mp4 --init anna.csv --overlay look.mp4 --json -o anna.c3d > report.json\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 ffmpeg or a display is missing. docs/track.md says how to "
    "film.\n";

enum {
    OPT_INIT = 256,
    OPT_PICK,
    OPT_MIRRORS,
    OPT_LABELS,
    OPT_CAMERA,
    OPT_VIEW,
    OPT_RULER,
    OPT_INTERLACED,
    OPT_RADIUS,
    OPT_START,
    OPT_END,
    OPT_OVERLAY,
    OPT_JSON,
    OPT_QUIET,
    OPT_HELP
};

static const struct option long_options[] = {
    { "init", required_argument, NULL, OPT_INIT },
    { "pick", required_argument, NULL, OPT_PICK },
    { "mirrors", required_argument, NULL, OPT_MIRRORS },
    { "labels", required_argument, NULL, OPT_LABELS },
    { "output", required_argument, NULL, 'o' },
    { "camera", required_argument, NULL, OPT_CAMERA },
    { "view", required_argument, NULL, OPT_VIEW },
    { "ruler", required_argument, NULL, OPT_RULER },
    { "interlaced", required_argument, NULL, OPT_INTERLACED },
    { "radius", required_argument, NULL, OPT_RADIUS },
    { "start", required_argument, NULL, OPT_START },
    { "end", required_argument, NULL, OPT_END },
    { "overlay", required_argument, NULL, OPT_OVERLAY },
    { "json", no_argument, NULL, OPT_JSON },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { NULL, 0, NULL, 0 },
};

static int usage(track_options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int number(track_options *opt, const char *name, const char *text, double low, double high,
                  double *out)
{
    char *end;

    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high)
        return 1;
    tool_error("--%s %s: expected a number from %g to %g", name, text, low, high);
    return usage(opt);
}

static int parse_ruler(track_options *opt, const char *text)
{
    const char *first = strchr(text, ','), *second = first ? strchr(first + 1, ',') : NULL;

    if (!second || first == text || second == first + 1 || first - text >= FAP_TAKE_NAME_SIZE ||
        second - first > FAP_TAKE_NAME_SIZE) {
        tool_error("--ruler %s: expected LABEL,LABEL,MILLIMETRES", text);
        return usage(opt);
    }
    memcpy(opt->ruler[0], text, (size_t)(first - text));
    memcpy(opt->ruler[1], first + 1, (size_t)(second - first - 1));
    return number(opt, "ruler", second + 1, 0.1, 1e5, &opt->ruler_mm);
}

static int parse_fields(track_options *opt, const char *text)
{
    static const char *const names[] = { "auto", "no", "tff", "bff" };

    for (int i = 0; i < 4; i++)
        if (!strcmp(text, names[i])) {
            opt->fields = (track_fields)i;
            return 1;
        }
    tool_error("--interlaced %s: expected auto, no, tff or bff", text);
    return usage(opt);
}

static int parse_mirrors(track_options *opt, const char *text)
{
    double mirrors;

    if (!number(opt, "mirrors", text, 0, 2, &mirrors))
        return 0;
    opt->mirrors = (int)mirrors;
    return 1;
}

static int parse_option(track_options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_INIT: opt->init_path = arg; return 1;
    case OPT_PICK: opt->pick_path = arg; return 1;
    case OPT_MIRRORS: return parse_mirrors(opt, arg);
    case OPT_LABELS: opt->labels_path = arg; return 1;
    case OPT_CAMERA: opt->camera_path = arg; return 1;
    case OPT_VIEW: return number(opt, "view", arg, 5, 150, &opt->view_deg);
    case OPT_RULER: return parse_ruler(opt, arg);
    case OPT_INTERLACED: return parse_fields(opt, arg);
    case OPT_RADIUS: return number(opt, "radius", arg, 0.5, 100, &opt->radius_px);
    case OPT_START: return number(opt, "start", arg, 0, 1e6, &opt->start_s);
    case OPT_END: return number(opt, "end", arg, 0, 1e6, &opt->end_s);
    case OPT_OVERLAY: opt->overlay_path = arg; return 1;
    case OPT_JSON: opt->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

static int ends_with(const char *name, const char *ending)
{
    const char *dot = strrchr(name, '.');
    return dot && !strcasecmp(dot, ending);
}

int track_options_want_c3d(const track_options *opt)
{
    return ends_with(opt->output, ".c3d");
}

static int check_output(track_options *opt)
{
    if (!ends_with(opt->output, ".trc") && !ends_with(opt->output, ".c3d"))
        tool_error("-o %s: a take ends in .trc or .c3d; fapenc then makes FAPs of it", opt->output);
    else if (!opt->init_path && !opt->pick_path)
        tool_error("where are the dots? --init POINTS.csv, a line each: LABEL,X,Y of the first picture; or "
                   "--pick POINTS.csv");
    else
        return 1;
    return usage(opt);
}

static int check(track_options *opt)
{
    if (!opt->video)
        tool_error("what to follow? fapenc track VIDEO --init POINTS.csv -o TAKE.trc; fapenc track --help "
                   "tells more");
    else if (!opt->output && !opt->pick_path)
        tool_error("where to? -o TAKE.trc or -o TAKE.c3d");
    else if (opt->init_path && opt->pick_path)
        tool_error("--init %s and --pick %s: the dots are known, or they are to be shown", opt->init_path,
                   opt->pick_path);
    else if (opt->labels_path && !opt->pick_path)
        tool_error("--labels belongs to --pick");
    else if (opt->overlay_path && !ends_with(opt->overlay_path, ".mp4"))
        tool_error("--overlay %s: expected a name that ends in .mp4", opt->overlay_path);
    else if (opt->end_s > 0 && opt->end_s <= opt->start_s)
        tool_error("--end %g is not after --start %g", opt->end_s, opt->start_s);
    else if (opt->camera_path && opt->view_deg > 0)
        tool_error("--camera and --view: a measured camera needs no guess");
    else
        return !opt->output || check_output(opt);
    return usage(opt);
}

int track_options_parse(track_options *opt, int argc, char **argv)
{
    int c;

    *opt = (track_options){ .mirrors = 2, .exit_status = EXIT_OK };
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!parse_option(opt, c, optarg))
            return 0;
    if (optind < argc)
        opt->video = argv[optind++];
    if (optind < argc) {
        tool_error("one video at a time, not also %s", argv[optind]);
        return usage(opt);
    }
    return check(opt);
}
