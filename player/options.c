/* SPDX-License-Identifier: BSD-2-Clause */
/* See options.h. A row of the table is an option: its name, whether it takes a value, who stores it, what it
 * expects. */
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/version.h>

#include "common/tool.h"
#include "player/options.h"
#include "player/sinks/csv.h"

enum {
    DEFAULT_SIZE = 720,
    WINDOW_WIDTH = 1180,
    WINDOW_HEIGHT = 780,
    DEFAULT_SHEET_SIZE = 320,
    MAX_RATE_HZ = 1000,
    MAX_GENERATIONS = 100000,
    MAX_OFFSET_MS = 60000
};

/* --- numbers and names --- */

/* Digits only, so that no sign, blank or hexadecimal slips in; *end is what follows. */
static int parse_integer(const char *text, int64_t max, int64_t *value, const char **end)
{
    *value = 0;
    if (*text < '0' || *text > '9')
        return 0;
    for (; *text >= '0' && *text <= '9'; text++) {
        if (*value > (max - (*text - '0')) / 10)
            return 0;
        *value = *value * 10 + (*text - '0');
    }
    *end = text;
    return 1;
}

static int whole_integer(const char *text, int64_t min, int64_t max, int64_t *value)
{
    const char *end;
    return parse_integer(text, max, value, &end) && !*end && *value >= min;
}

static int small_integer(const char *text, int min, int max, int *out)
{
    int64_t value;

    if (!whole_integer(text, min, max, &value))
        return 0;
    *out = (int)value;
    return 1;
}

static int real_number(const char *text, double min, double max, double *out)
{
    char *end;

    errno = 0;
    const double value = strtod(text, &end);
    if (end == text || *end || errno || !(value >= min && value <= max))
        return 0;
    *out = value;
    return 1;
}

/* Index of @text in @names (NULL at the end), -1: not there. */
static int name_index(const char *text, const char *const *names)
{
    for (int i = 0; names[i]; i++)
        if (!strcmp(text, names[i]))
            return i;
    return -1;
}

/* --- what each option does --- */

static int set_output(play_options *o, const char *text)
{
    o->output = text;
    return text[0] != '\0';
}

static int set_fit(play_options *o, const char *text)
{
    o->fit = text;
    return text[0] != '\0';
}

static int set_bank(play_options *o, const char *text)
{
    o->bank = text;
    return text[0] != '\0';
}

static int set_blend(play_options *o, const char *text)
{
    int i = 0;

    while (fap_blend_name(i) && strcmp(text, fap_blend_name(i)))
        i++;
    o->face.blend = (fap_blend)i;
    return fap_blend_name(i) != NULL;
}

static int set_regions(play_options *o, const char *text)
{
    return small_integer(text, 1, 4, &o->face.regions) && o->face.regions != 3;
}

static int set_overlap(play_options *o, const char *text)
{
    double percent;

    if (!real_number(text, 0, 50, &percent))
        return 0;
    o->face.overlap_percent = (float)percent;
    return 1;
}

static int set_crossover(play_options *o, const char *text)
{
    static const char *const names[] = { "midpoint", "line", "blx", NULL };
    const int i = name_index(text, names);

    o->face.crossover = (fap_crossover)i;
    return i >= 0;
}

static int set_generations(play_options *o, const char *text)
{
    return small_integer(text, 0, MAX_GENERATIONS, &o->face.generations);
}

static int set_temporal(play_options *o, const char *text)
{
    double mm2;

    if (!real_number(text, 0, 1e6, &mm2))
        return 0;
    o->face.temporal_mm2 = (float)mm2;
    return 1;
}

static int set_emphasis(play_options *o, const char *text)
{
    double c;

    if (!real_number(text, 0, 10, &c))
        return 0;
    o->face.emphasis = (float)c;
    return 1;
}

static int set_seed(play_options *o, const char *text)
{
    int64_t seed;

    if (!whole_integer(text, 0, INT64_MAX, &seed))
        return 0;
    o->face.seed = (uint64_t)seed;
    return 1;
}

static int set_no_residual(play_options *o, const char *text)
{
    (void)text;
    o->face.residual = 0;
    return 1;
}

static int set_blink(play_options *o, const char *text)
{
    (void)text;
    o->face.blink = 1;
    return 1;
}

static int set_csv(play_options *o, const char *text)
{
    o->csv = csv_kind_by_name(text);
    return o->csv != NULL;
}

static int set_audio(play_options *o, const char *text)
{
    o->audio = text;
    return text[0] != '\0';
}

static int set_size(play_options *o, const char *text)
{
    int64_t width, height;
    const char *x;

    if (!parse_integer(text, RENDER_MAX_SIZE, &width, &x) || *x != 'x' ||
        !whole_integer(x + 1, 1, RENDER_MAX_SIZE, &height))
        return 0;
    o->width = (int)width;
    o->height = (int)height;
    return width > 0;
}

static int set_rate(play_options *o, const char *text)
{
    return real_number(text, 0.001, MAX_RATE_HZ, &o->rate_hz);
}

/* A:B, and either may be left out. */
static int set_frames(play_options *o, const char *text)
{
    const int64_t most = INT64_MAX / 4;
    const char *colon = text;

    o->has_range = 1;
    o->from = 0;
    o->to = INT64_MAX;
    if (*text != ':' && !parse_integer(text, most, &o->from, &colon))
        return 0;
    if (*colon != ':')
        return 0;
    return !colon[1] || (whole_integer(colon + 1, 1, most, &o->to) && o->from < o->to);
}

static int set_camera(play_options *o, const char *text)
{
    const int i = render_camera_by_name(text);

    o->camera = (render_camera)i;
    return i >= 0;
}

static int set_background(play_options *o, const char *text)
{
    return dress_parse_background(&o->dress, text);
}

static int set_texture(play_options *o, const char *text)
{
    o->dress.skin = text;
    return text[0] != '\0';
}

static int set_y4m(play_options *o, const char *text)
{
    (void)text;
    o->y4m = 1;
    return 1;
}

static int set_gl(play_options *o, const char *text)
{
    o->gl = text;
    return render_gl_known(text);
}

static int set_sheet(play_options *o, const char *text)
{
    return small_integer(text, 1, PLAY_MAX_MOMENTS, &o->moments);
}

static int set_golden(play_options *o, const char *text)
{
    o->golden = text;
    return text[0] != '\0';
}

static int set_update(play_options *o, const char *text)
{
    (void)text;
    o->update = 1;
    return 1;
}

static int set_tolerance(play_options *o, const char *text)
{
    return small_integer(text, 0, 255, &o->tolerance);
}

static int set_audio_offset(play_options *o, const char *text)
{
    return real_number(text, -MAX_OFFSET_MS, MAX_OFFSET_MS, &o->audio_offset_ms);
}

static int set_loop(play_options *o, const char *text)
{
    (void)text;
    o->loop = 1;
    return 1;
}

static int set_paused(play_options *o, const char *text)
{
    (void)text;
    o->paused = 1;
    return 1;
}

static int set_fullscreen(play_options *o, const char *text)
{
    (void)text;
    o->fullscreen = 1;
    return 1;
}

/* --- lines of GPIO chips --- */

static int set_trigger(play_options *o, const char *text)
{
    return gpio_spec_parse(&o->lines.trigger, text, GPIO_INPUT, o->why);
}

static int set_tally(play_options *o, const char *text)
{
    return gpio_spec_parse(&o->lines.tally, text, GPIO_OUTPUT, o->why);
}

static int set_frame_sync(play_options *o, const char *text)
{
    return gpio_spec_parse(&o->lines.frame_sync, text, GPIO_OUTPUT, o->why);
}

static int set_end_pulse(play_options *o, const char *text)
{
    return gpio_spec_parse(&o->lines.end_pulse, text, GPIO_PULSE, o->why);
}

static int set_button(play_options *o, const char *text)
{
    if (o->lines.button_count == LINES_MAX_BUTTONS) {
        snprintf(o->why, sizeof o->why, "%d buttons are all there can be", LINES_MAX_BUTTONS);
        return 0;
    }
    return line_button_parse(&o->lines.button[o->lines.button_count++], text, o->why);
}

static int set_json(play_options *o, const char *text)
{
    (void)text;
    o->json = 1;
    return 1;
}

static int set_quiet(play_options *o, const char *text)
{
    (void)text;
    o->quiet = 1;
    return 1;
}

typedef struct option_row {
    const char *name;
    int (*set)(play_options *o, const char *text);
    const char *expects; /* NULL: takes no value */
} option_row;

static const option_row rows[] = {
    { "output", set_output, "a file name" },
    { "fit", set_fit, "an interpolation table" },
    { "bank", set_bank, "a .fbank file or 'builtin'" },
    { "blend", set_blend, "ga, zhu, qp, pca, rbf, fat or bones" },
    { "regions", set_regions, "1, 2 or 4" },
    { "overlap", set_overlap, "a percentage from 0 to 50" },
    { "crossover", set_crossover, "midpoint, line or blx" },
    { "generations", set_generations, "a number from 0 to 100000" },
    { "emphasis", set_emphasis, "a number from 0 to 10" },
    { "temporal", set_temporal, "square millimetres, 0 to 1000000" },
    { "seed", set_seed, "a whole number, not negative" },
    { "no-residual", set_no_residual, NULL },
    { "blink", set_blink, NULL },
    { "csv", set_csv, "points, vertices, weights, faps or arkit" },
    { "audio", set_audio, "a sound file" },
    { "size", set_size, "WxH, each from 1 to 8192 pixels" },
    { "fps", set_rate, "frames a second, from 0.001 to 1000" },
    { "frames", set_frames, "A:B, the first frame and the one behind the last" },
    { "camera", set_camera, "front, left, right or three-quarter" },
    { "gl", set_gl, "osmesa or egl" },
    { "y4m", set_y4m, NULL },
    { "background", set_background, "studio, none, a colour such as #204060 or a PNG file" },
    { "texture", set_texture, "a PNG file" },
    { "sheet", set_sheet, "a number from 1 to 1024" },
    { "golden", set_golden, "a folder" },
    { "update", set_update, NULL },
    { "tolerance", set_tolerance, "a number from 0 to 255" },
    { "audio-offset", set_audio_offset, "milliseconds, from -60000 to 60000" },
    { "loop", set_loop, NULL },
    { "paused", set_paused, NULL },
    { "fullscreen", set_fullscreen, NULL },
    { "trigger", set_trigger, "a line" },
    { "tally", set_tally, "a line" },
    { "frame-sync", set_frame_sync, "a line" },
    { "end-pulse", set_end_pulse, "a line" },
    { "button", set_button, "a line and what it does" },
    { "json", set_json, NULL },
    { "quiet", set_quiet, NULL },
};

enum {
    ROW_COUNT = sizeof rows / sizeof *rows,
    CODE_ROW = 256,
    CODE_HELP = CODE_ROW + ROW_COUNT,
    CODE_VERSION
};

/* --- help --- */

static const char help_text[] =
    "usage: fapplay STREAM [options]            in a window\n"
    "       fapplay STREAM -o OUT [options]     without one\n"
    "       fapplay STREAM --send rtp://HOST:PORT, fapplay --listen rtp://HOST:PORT: fapplay --send --help\n"
    "Shows a stream of MPEG-4 face animation parameters on a face. STREAM is .fap or .fba, or - for standard "
    "input.\n"
    "\n"
    "The window: space plays and pauses, arrows step, ? shows all keys; the mouse turns (left), moves "
    "(right) and "
    "zooms\n"
    "(wheel); .fap, .fba, .fbank and sounds may be dropped on it.\n"
    "  --audio F                sound, which is the time\n"
    "  --audio-offset MS        the sound begins that much after the stream; negative: before (0)\n"
    "  --loop, --paused, --fullscreen    how it begins\n"
    "\n"
    "Where to instead (-o, --output OUT):\n"
    "  NAME.png                 one picture: frame A of --frames, else the middle one\n"
    "  NAME_%04d.png            a picture of every frame\n"
    "  NAME.mp4, .webm, .mkv    a film (needs the program ffmpeg; mkv is lossless)\n"
    "  NAME.webp, .gif          a picture that moves, for pages (needs ffmpeg)\n"
    "  NAME.y4m, - with --y4m   uncompressed video, for other encoders\n"
    "  NAME.csv, -              a table of every frame, by default of the feature points in millimetres\n"
    "      --csv KIND           points, vertices (millimetres), weights (of the key models), faps (as "
    "shown),\n"
    "                           arkit (52 coefficients, as Live Link Face writes them)\n"
    "  NAME.glb                 the moving face as glTF 2.0, for Blender, three.js and viewers\n"
    "  null, NAME.null          nowhere: poses every frame and keeps nothing\n"
    "  --sheet N                N moments in one picture, -o NAME.png (- for standard output)\n"
    "  --golden DIR             compare with DIR/NNNN.png; what differs is left in the folder OUT\n"
    "                           (build/golden/NAME without -o); exit 1 when anything does\n"
    "      --update             write those DIR/NNNN.png that differ or are missing\n"
    "      --tolerance T        allowed difference of a channel, 0 to 255 (2)\n"
    "\n"
    "The stream:\n"
    "  --fit FILE               interpolation table for FAPs that are not sent (take.fit beside take.fba is "
    "found by itself)\n"
    "\n"
    "The face:\n"
    "  --bank B.fbank           the face (the default face; the built-in one where there is none); or "
    "'builtin'\n"
    "  --blend METHOD           ga, zhu, qp, pca, rbf, fat or bones: how feature points become a face (ga)\n"
    "  --regions 1|2|4          of the face, each solved by itself by ga and zhu (1)\n"
    "  --overlap PCT            of the face on either side of a border, shared by both regions (20)\n"
    "  --crossover X            of the genetic algorithm: midpoint, line or blx (line)\n"
    "  --generations N          of the genetic algorithm (70)\n"
    "  --emphasis C             targets times C before blending (1)\n"
    "  --temporal MM2           qp and ga: price of changing a weight by one from frame to frame, calms "
    "noisy takes (0)\n"
    "  --seed N                 equal seeds give equal faces (1)\n"
    "  --no-residual            leave the feature points where blending puts them\n"
    "  --blink                  blink now and then while the stream does not move the lids\n"
    "\n"
    "Pictures and time:\n"
    "  --size WxH               pixels (720x720; of a sheet's pictures 320x320, of the window 1180x780); "
    "even for "
    "films\n"
    "  --camera C               front, left, right or three-quarter (front)\n"
    "  --background B           studio, a colour as #RRGGBB, a PNG file that fills the frame, or none: -o "
    "PNG is\n"
    "                           transparent round the face (studio)\n"
    "  --texture F.png          laid on the skin by the face's texture coordinates, in place of its own "
    "colours\n"
    "  --gl osmesa|egl|glfw     OpenGL without a window by this library (the first that works)\n"
    "  --fps R                  frames a second (as the stream)\n"
    "  --frames A:B             from frame A up to, without, frame B, at the output's rate; either may be "
    "left out\n"
    "  --audio F                sound of the film; begins with the stream\n"
    "\n"
    "Lines of a GPIO chip (docs/gpio.md), CHIP:LINE such as gpiochip0:17:\n"
    "  --trigger CHIP:LINE      start at an edge; behind it :rising or :falling, :active-low, :pull-up or "
    ":pull-down,\n"
    "                           :debounce=5ms, :timeout=10s\n"
    "  --tally CHIP:LINE        high exactly while playing\n"
    "  --frame-sync CHIP:LINE   toggles at every frame shown while playing\n"
    "  --end-pulse CHIP:LINE[:MS]    a pulse at the end, 100 ms without MS\n"
    "  --button CHIP:LINE=DO    of the window: pause, next, start, stop or expression:joy (to surprise)\n"
    "\n"
    "  --json                   report on standard output, for programs\n"
    "  --quiet                  errors only\n"
    "  --help, --version\n"
    "\n"
    "Exit codes: 0 success, 1 bad data or pictures that differ, 2 wrong usage, 3 missing library, "
    "program or device.\n"
    "\n"
    "Examples:\n"
    "  fapplay hello.fap --audio hello.wav\n"
    "  fapplay hello.fap --audio hello.wav -o hello.mp4\n"
    "  fapplay hello.fap --frames 40: --camera three-quarter -o frame40.png\n"
    "  fapplay hello.fap --sheet 12 -o sheet.png\n"
    "  fapplay hello.fap --fps 100 -o points.csv\n"
    "  fapplay hello.fap --csv weights -o weights.csv\n"
    "  fapplay hello.fap -o hello.glb\n"
    "  fapplay hello.fap --trigger gpiochip0:17:pull-up:falling:debounce=5ms --tally gpiochip0:27 -o "
    "hello.mp4\n"
    "  fapplay hello.fap --bank builtin --size 256x256 --frames 0:3 --golden tests/golden/hello\n";

/* --- parsing --- */

static void set_defaults(play_options *o)
{
    *o = (play_options){ .to = INT64_MAX, .tolerance = 2, .exit_status = EXIT_USAGE };
    fap_face_config_init(&o->face);
}

static void list_options(struct option *list)
{
    for (int i = 0; i < ROW_COUNT; i++)
        list[i] = (struct option){ rows[i].name, rows[i].expects ? required_argument : no_argument, NULL,
                                   CODE_ROW + i };
    list[ROW_COUNT] = (struct option){ "help", no_argument, NULL, CODE_HELP };
    list[ROW_COUNT + 1] = (struct option){ "version", no_argument, NULL, CODE_VERSION };
    list[ROW_COUNT + 2] = (struct option){ 0 };
}

static int print(play_options *o, const char *text)
{
    fputs(text, stdout);
    o->exit_status = EXIT_OK;
    return 0;
}

static int refuse(const char *what, const char *text)
{
    tool_error("%s %s (see fapplay --help)", what, text);
    return 0;
}

/* One option that getopt recognised, or what it did not. */
static int take_option(play_options *o, int code, char **argv)
{
    if (code == CODE_HELP)
        return print(o, help_text);
    if (code == CODE_VERSION)
        return print(o, "fapplay " FAP_VERSION_STRING "\n");
    if (code == ':')
        return refuse("a value is missing behind", argv[optind - 1]);
    if (code == '?')
        return refuse("unknown or ambiguous option", argv[optind - 1]);
    const option_row *row = code == 'o' ? &rows[0] : &rows[code - CODE_ROW];
    if (row->set(o, optarg))
        return 1;
    if (o->why[0])
        tool_error("--%s %s: %s", row->name, optarg, o->why);
    else
        tool_error("--%s %s: expected %s", row->name, optarg, row->expects);
    return 0;
}

static int take_options(play_options *o, int argc, char **argv)
{
    struct option list[ROW_COUNT + 3];
    int code;

    list_options(list);
    optind = 0; /* glibc: start over, tests parse more than once */
    while ((code = getopt_long(argc, argv, ":o:", list, NULL)) != -1)
        if (!take_option(o, code, argv))
            return 0;
    return 1;
}

static int take_stream(play_options *o, int argc, char **argv)
{
    if (optind >= argc)
        return refuse("no stream:", "fapplay STREAM");
    if (optind + 1 < argc)
        return refuse("one stream only, not also", argv[optind + 1]);
    o->stream = argv[optind];
    return 1;
}

static int no_such_output(const play_options *o)
{
    tool_error(
        "-o %s: expected NAME.png, NAME_%%04d.png, NAME.mp4, NAME.webm, NAME.mkv, NAME.webp, NAME.gif, "
        "NAME.y4m, NAME.csv, NAME.glb, - or null",
        o->output);
    return 0;
}

/* What a window has no use for would be a misunderstanding. */
static int check_window(const play_options *o)
{
    if (o->has_range)
        return refuse("--frames needs", "-o OUT");
    return o->gl ? refuse("--gl needs", "-o OUT") : 1;
}

/* And what only a window has a use for. */
static int check_offscreen(const play_options *o)
{
    if (o->loop || o->paused || o->fullscreen || o->audio_offset_ms != 0)
        return refuse("--loop, --paused, --fullscreen and --audio-offset are the window's, not of",
                      o->output ? o->output : o->golden);
    if (o->audio && o->sink != &sink_video)
        return refuse("--audio needs a film, not", o->output ? o->output : o->golden);
    if (o->lines.button_count)
        return refuse("--button is the window's, not of", o->output ? o->output : o->golden);
    return 1;
}

static int choose_sink(play_options *o)
{
    if (o->golden && o->moments)
        return refuse("either --golden or", "--sheet");
    if (o->update && !o->golden)
        return refuse("--update needs", "--golden DIR");
    if (o->golden && o->output && (!strcmp(o->output, "-") || sink_by_name(o->output)))
        return refuse("with --golden, -o is a folder for what differs, not", o->output);
    if (o->y4m && (o->golden || o->moments || o->csv || !o->output || strcmp(o->output, "-")))
        return refuse("--y4m needs", "-o -");
    if (!o->golden && !o->output && o->csv)
        return refuse("--csv needs", "-o NAME.csv");
    if (!o->golden && !o->output)
        return o->moments ? refuse("--sheet needs", "-o NAME.png") : check_window(o);
    o->sink = o->golden ? &sink_golden : sink_by_name(o->output);
    if (o->moments && o->sink != &sink_png && strcmp(o->output, "-"))
        return refuse("--sheet needs -o NAME.png, not", o->output);
    if (o->moments)
        o->sink = &sink_sheet;
    if (o->y4m)
        o->sink = &sink_y4m;
    if (o->csv && o->sink && o->sink != &sink_csv)
        return refuse("--csv needs -o NAME.csv, not", o->golden ? o->golden : o->output);
    return o->sink ? 1 : no_such_output(o);
}

static int check_sizes(play_options *o)
{
    const int side = o->sink == &sink_sheet ? DEFAULT_SHEET_SIZE : DEFAULT_SIZE;

    if (!o->width && !o->sink) {
        o->width = WINDOW_WIDTH;
        o->height = WINDOW_HEIGHT;
    }
    if (!o->width)
        o->width = o->height = side;
    if (o->sink == &sink_video && (o->width % 2 || o->height % 2)) {
        tool_error("--size %dx%d: films need even numbers", o->width, o->height);
        return 0;
    }
    return 1;
}

static int check(play_options *o)
{
    if (!choose_sink(o) || !check_sizes(o))
        return 0;
    if (o->dress.backdrop == BACKDROP_NOTHING && o->sink != &sink_png && o->sink != &sink_png_sequence)
        return refuse("--background none needs a PNG, not", o->golden   ? "--golden"
                                                            : o->output ? o->output
                                                                        : "the window");
    if (o->sink && !check_offscreen(o))
        return 0;
    if (o->json && o->output && !strcmp(o->output, "-"))
        return refuse("--json and -o - both want standard output:", "name a file");
    return 1;
}

int play_options_parse(play_options *o, int argc, char **argv)
{
    set_defaults(o);
    return take_options(o, argc, argv) && take_stream(o, argc, argv) && check(o);
}
