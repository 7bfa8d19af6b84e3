/* SPDX-License-Identifier: BSD-2-Clause */
/* See options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <fap/version.h>

#include "common/tool.h"
#include "encoder/options.h"
#include "encoder/plot/plot.h"

static const char help[] =
    "Usage: fapenc TAKE -o OUT [options]       encode a capture; OUT is .fap (text) or .fba (bits)\n"
    "       fapenc --batch FOLDER -o OUTFOLDER encode every capture in a folder\n"
    "       fapenc IN -o OUT [options]         .fap or .fba to .fap or .fba; -o OUT.csv: ARKit's "
    "coefficients\n"
    "       fapenc inspect FILE [--planes]     what is inside a .fap or .fba\n"
    "       fapenc [--speech SOUND] --phonemes FILE | --text WORDS -o OUT   a mouth that speaks\n"
    "       fapenc track VIDEO --init POINTS.csv -o TAKE.trc   dots in a video to a take; fapenc track "
    "--help\n"
    "\n"
    "TAKE is a marker capture: C3D, TRC, Vicon Nexus, OptiTrack Motive or OpenFace CSV, EMA .pos and .mat,\n"
    "a table with NAME_x, NAME_y, NAME_z columns, or landmarks as JSON; or coefficients: Live Link Face CSV "
    "or\n"
    "recorded packets, OpenFace action units (docs/markers.md, docs/coefficients.md). The\n"
    "content decides, not the name. \"-\" is standard input, -o - standard output.\n"
    "\n"
    "  -o, --output FILE     where the FAPs go\n"
    "      --markers MAP.csv marker to feature point, a line each: \"LMouthCorner,8.4\", \"Head1,rigid\", "
    "\"X,none\"\n"
    "      --neutral N|T|auto    when the face is at rest: frame 120 of the take, the first is 0; 4.8s; the "
    "mean of\n"
    "                        120-135 or 4.8-5.4s; auto finds a moment\n"
    "      --fapu FILE|auto  the face's FAPU in millimetres, a line each: \"ES 62.5\"; auto measures\n"
    "      --axes XYZ|auto   the take's axes that are the head's left, up and forward, as in x-zy\n"
    "      --unit U          mm, cm, m, or the millimetres in one unit of the take\n"
    "      --fps R           frames a second of the output (25)\n"
    "      --take-rate R     frames a second of the take, where the file is silent or wrong\n"
    "      --rigid A,B,C     markers that follow the head\n"
    "      --head M          rigid; nose: its tip carries the head, the rigid markers turn it (Zhu's "
    "thesis)\n"
    "      --smooth M        auto, none, a cut-off frequency in Hz, or zhu (the mean of three frames)\n"
    "      --fill M          none, spline (gaps to 0.2 s), take (longer ones by the other markers), all\n"
    "      --start T --end T the part of the take to encode, in seconds\n"
    "      --visemes, --expressions   find FAP 1 and FAP 2 as well: names for what the face does\n"
    "      --plot OUT.png|svg  the FAPs as curves, gaps and fills marked; where the markers are on the face\n"
    "      --batch FOLDER -o OUT   every take in FOLDER and below; goes on where it was stopped; "
    "docs/batch.md\n"
    "  -j, --jobs N          takes at a time (as many as there are processors)\n"
    "      --to fap|fba      what a batch writes (fap; fba where --quant, --bitrate or --max-error is "
    "given)\n"
    "      --trigger CHIP:LINE   do not read before an edge of this GPIO line: with - as TAKE, the start of "
    "a "
    "live\n"
    "                        capture. :falling, :active-low, :pull-up, :debounce=5ms, :timeout=10s "
    "(docs/gpio.md)\n"
    "\n"
    "Speech (docs/speech.md):\n"
    "      --speech SOUND    what is heard, WAV or any file of sound: how long it is and, with --text, when "
    "it begins\n"
    "      --phonemes FILE   what is said when: Praat TextGrid, Rhubarb JSON, or lines of start, end, "
    "phoneme\n"
    "      --tier NAME       of a TextGrid (the one that looks like phonemes)\n"
    "      --text WORDS      what is said, by espeak-ng's rules (needs fap-phonemes)\n"
    "      --language L      of the text (en-us)\n"
    "      --lips            FAPs of lips, jaw and tongue instead of FAP 1\n"
    "\n"
    "Bits (.fba), whatever the input:\n"
    "      --quant Q         keep the coarseness: 0 to 31; 1. At 0 values are sent as they are; those that a "
    "plane\n"
    "                        cannot carry, beyond +-1860, are clipped and counted: then take 1 and more\n"
    "      --bitrate KBPS    keep the bits: in any 2 seconds never more than that, start codes included\n"
    "      --max-error MM    keep the error: no feature point farther off than that\n"
    "      --bank B.fbank    the face to measure millimetres on (the default face, else a typical one)\n"
    "      --intra N         at least one I plane in so many frames; 250\n"
    "      --look-ahead N    frames to choose by; 250. 0: as live, every frame a packet of its own\n"
    "      --derive, --no-derive   leave FAPs to the decoder that it can derive (yes, unless --quant)\n"
    "      --skip, --no-skip       leave frames out that change nothing (yes, unless --quant)\n"
    "      --learn-fit FILE  find an interpolation table for the take, write it and use it; OUT.fit is found "
    "by "
    "itself\n"
    "      --fit FILE        use that table, for reading an .fba too\n"
    "      --time-codes      I planes on a full second carry their time\n"
    "      --plane-codes     a start code in front of every plane\n"
    "      --gender G        what the stream suggests: female (default) or male\n"
    "      --strict          FAP streams that deviate from the standard are errors\n"
    "\n"
    "      --planes          inspect: a line for every plane\n"
    "      --json            the report as JSON on standard output\n"
    "      --quiet           errors only\n"
    "      --help, --version\n"
    "\n"
    "Examples:\n"
    "  fapenc jaw.c3d -o jaw.fap\n"
    "  fapenc take.csv --unit 184.8 --take-rate 25 --markers dots.csv -o take.fap\n"
    "  fapenc take.trc --neutral 120 --fapu anna.fapu --fps 30 --json -o take.fap > report.json\n"
    "  fapenc take.fap --bitrate 2 -o take.fba\n"
    "  fapenc take.c3d --max-error 0.5 --bank anna.fbank --learn-fit take.fit -o take.fba\n"
    "  fapenc take.fap --quant 4 --intra 50 --look-ahead 0 -o take.fba\n"
    "  fapenc take.fba -o take.fap\n"
    "  fapenc MySlate_1_iPhone.csv -o take.fap; fapenc take.fap -o take_livelink.csv\n"
    "  fapenc --speech hello.wav --phonemes hello.TextGrid -o hello.fap; fapplay hello.fap --audio "
    "hello.wav\n"
    "  fapenc --speech hallo.wav --text \"Hallo Welt\" --language de -o hallo.fba\n"
    "  fapenc inspect take.fba\n"
    "  tracker | fapenc - --trigger gpiochip0:17:pull-up:falling -o take.fba\n"
    "\n"
    "Exit: 0 success, 1 bad data, 2 bad usage, 3 missing device or library. docs/markers.md says how to map "
    "markers.\n";

enum {
    OPT_MARKERS = 256,
    OPT_NEUTRAL,
    OPT_FAPU,
    OPT_AXES,
    OPT_UNIT,
    OPT_FPS,
    OPT_TAKE_RATE,
    OPT_RIGID,
    OPT_HEAD,
    OPT_SMOOTH,
    OPT_FILL,
    OPT_START,
    OPT_END,
    OPT_PLOT,
    OPT_BATCH,
    OPT_TO,
    OPT_VISEMES,
    OPT_EXPRESSIONS,
    OPT_SPEECH,
    OPT_PHONEMES,
    OPT_TIER,
    OPT_TEXT,
    OPT_LANGUAGE,
    OPT_LIPS,
    OPT_TRIGGER,
    OPT_QUANT,
    OPT_BITRATE,
    OPT_MAX_ERROR,
    OPT_BANK,
    OPT_INTRA,
    OPT_LOOK_AHEAD,
    OPT_DERIVE,
    OPT_NO_DERIVE,
    OPT_SKIP,
    OPT_NO_SKIP,
    OPT_FIT,
    OPT_LEARN_FIT,
    OPT_TIME_CODES,
    OPT_PLANE_CODES,
    OPT_GENDER,
    OPT_STRICT,
    OPT_PLANES,
    OPT_JSON,
    OPT_QUIET,
    OPT_HELP,
    OPT_VERSION
};

static const struct option long_options[] = {
    { "output", required_argument, NULL, 'o' },
    { "markers", required_argument, NULL, OPT_MARKERS },
    { "neutral", required_argument, NULL, OPT_NEUTRAL },
    { "fapu", required_argument, NULL, OPT_FAPU },
    { "axes", required_argument, NULL, OPT_AXES },
    { "unit", required_argument, NULL, OPT_UNIT },
    { "fps", required_argument, NULL, OPT_FPS },
    { "take-rate", required_argument, NULL, OPT_TAKE_RATE },
    { "rigid", required_argument, NULL, OPT_RIGID },
    { "head", required_argument, NULL, OPT_HEAD },
    { "smooth", required_argument, NULL, OPT_SMOOTH },
    { "fill", required_argument, NULL, OPT_FILL },
    { "start", required_argument, NULL, OPT_START },
    { "end", required_argument, NULL, OPT_END },
    { "batch", required_argument, NULL, OPT_BATCH },
    { "jobs", required_argument, NULL, 'j' },
    { "to", required_argument, NULL, OPT_TO },
    { "plot", required_argument, NULL, OPT_PLOT },
    { "visemes", no_argument, NULL, OPT_VISEMES },
    { "expressions", no_argument, NULL, OPT_EXPRESSIONS },
    { "speech", required_argument, NULL, OPT_SPEECH },
    { "phonemes", required_argument, NULL, OPT_PHONEMES },
    { "tier", required_argument, NULL, OPT_TIER },
    { "text", required_argument, NULL, OPT_TEXT },
    { "language", required_argument, NULL, OPT_LANGUAGE },
    { "lips", no_argument, NULL, OPT_LIPS },
    { "trigger", required_argument, NULL, OPT_TRIGGER },
    { "quant", required_argument, NULL, OPT_QUANT },
    { "bitrate", required_argument, NULL, OPT_BITRATE },
    { "max-error", required_argument, NULL, OPT_MAX_ERROR },
    { "bank", required_argument, NULL, OPT_BANK },
    { "intra", required_argument, NULL, OPT_INTRA },
    { "look-ahead", required_argument, NULL, OPT_LOOK_AHEAD },
    { "derive", no_argument, NULL, OPT_DERIVE },
    { "no-derive", no_argument, NULL, OPT_NO_DERIVE },
    { "skip", no_argument, NULL, OPT_SKIP },
    { "no-skip", no_argument, NULL, OPT_NO_SKIP },
    { "fit", required_argument, NULL, OPT_FIT },
    { "learn-fit", required_argument, NULL, OPT_LEARN_FIT },
    { "time-codes", no_argument, NULL, OPT_TIME_CODES },
    { "plane-codes", no_argument, NULL, OPT_PLANE_CODES },
    { "gender", required_argument, NULL, OPT_GENDER },
    { "strict", no_argument, NULL, OPT_STRICT },
    { "planes", no_argument, NULL, OPT_PLANES },
    { "json", no_argument, NULL, OPT_JSON },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { "version", no_argument, NULL, OPT_VERSION },
    { NULL, 0, NULL, 0 },
};

static int usage(options *opt)
{
    opt->exit_status = EXIT_USAGE;
    return 0;
}

static int number(options *opt, const char *name, const char *text, double low, double high, double *out)
{
    char *end;

    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high)
        return 1;
    tool_error("--%s %s: expected a number from %g to %g", name, text, low, high);
    return usage(opt);
}

static const char *unless_auto(const char *text)
{
    return strcmp(text, "auto") ? text : NULL;
}

static int whole_number(options *opt, const char *name, const char *text, int low, int high, int *out)
{
    double v;

    if (!number(opt, name, text, low, high, &v))
        return 0;
    *out = (int)v;
    return 1;
}

static int parse_neutral(options *opt, const char *text)
{
    if (neutral_option_parse(&opt->neutral, text))
        return 1;
    tool_error("--neutral %s: expected a frame (120), a time (4.8s), a stretch (120-135, 4.8-5.4s) or auto",
               text);
    return usage(opt);
}

static int parse_unit(options *opt, const char *text)
{
    opt->mm_per_unit = fap_take_unit_mm(text);
    return opt->mm_per_unit > 0 || number(opt, "unit", text, 1e-6, 1e6, &opt->mm_per_unit);
}

static int parse_head(options *opt, const char *text)
{
    opt->capture.head = strcmp(text, "nose") ? FAP_HEAD_RIGID : FAP_HEAD_NOSE;
    if (opt->capture.head == FAP_HEAD_NOSE || !strcmp(text, "rigid"))
        return 1;
    tool_error("--head %s: expected rigid or nose", text);
    return usage(opt);
}

static int parse_smooth(options *opt, const char *text)
{
    opt->capture.smooth_hz = 0;
    opt->capture.average = !strcmp(text, "zhu");
    if (!strcmp(text, "none"))
        opt->capture.smooth_hz = -1;
    else if (!opt->capture.average && unless_auto(text))
        return number(opt, "smooth", text, 0.5, 1000, &opt->capture.smooth_hz);
    return 1;
}

static int parse_fill(options *opt, const char *text)
{
    static const char *const names[] = { "none", "spline", "take", "all" };

    for (int i = 0; i <= FAP_FILL_ALL; i++)
        if (!strcmp(text, names[i])) {
            opt->capture.fill = (fap_fill)i;
            return 1;
        }
    tool_error("--fill %s: expected none, spline, take or all", text);
    return usage(opt);
}

/* One thing can be kept constant. */
static int set_rate(options *opt, const char *name, fap_encoder_mode mode)
{
    if (opt->rate_option && strcmp(opt->rate_option, name)) {
        tool_error("%s and %s: only one of --quant, --bitrate and --max-error can be kept", opt->rate_option,
                   name);
        return usage(opt);
    }
    opt->rate_option = name;
    opt->bits.mode = mode;
    return 1;
}

static int parse_bitrate(options *opt, const char *text)
{
    double kbps;

    if (!number(opt, "bitrate", text, 0.1, 100000, &kbps))
        return 0;
    opt->bits.bitrate_bps = (int)lround(kbps * 1000);
    return 1;
}

static int parse_gender(options *opt, const char *text)
{
    opt->bits.gender = !strcmp(text, "male");
    if (opt->bits.gender || !strcmp(text, "female"))
        return 1;
    tool_error("--gender %s: expected female or male", text);
    return usage(opt);
}

static int parse_trigger(options *opt, const char *text)
{
    char why[FAP_ERROR_TEXT_SIZE];

    if (gpio_spec_parse(&opt->trigger, text, GPIO_INPUT, why))
        return 1;
    tool_error("--trigger %s: %s", text, why);
    return usage(opt);
}

static int parse_plot(options *opt, const char *text)
{
    opt->plot_path = text;
    if (plot_name_known(text))
        return 1;
    tool_error("--plot %s: expected a name that ends in .png or .svg", text);
    return usage(opt);
}

static int parse_to(options *opt, const char *text)
{
    opt->batch_bits = !strcmp(text, "fba");
    opt->to_given = 1;
    if (opt->batch_bits || !strcmp(text, "fap"))
        return 1;
    tool_error("--to %s: expected fap or fba", text);
    return usage(opt);
}

static int parse_option(options *opt, int c, const char *arg)
{
    switch (c) {
    case 'o': opt->output = arg; return 1;
    case OPT_MARKERS: opt->markers_path = arg; return 1;
    case OPT_NEUTRAL: return parse_neutral(opt, arg);
    case OPT_FAPU: opt->fapu_path = unless_auto(arg); return 1;
    case OPT_AXES: opt->capture.axes = unless_auto(arg); return 1;
    case OPT_UNIT: return parse_unit(opt, arg);
    case OPT_FPS: opt->rate_given = 1; return number(opt, "fps", arg, 1, 1000, &opt->capture.rate_hz);
    case OPT_TAKE_RATE: return number(opt, "take-rate", arg, 0.5, 20000, &opt->take_rate_hz);
    case OPT_RIGID: opt->capture.rigid = unless_auto(arg); return 1;
    case OPT_HEAD: return parse_head(opt, arg);
    case OPT_SMOOTH: return parse_smooth(opt, arg);
    case OPT_FILL: return parse_fill(opt, arg);
    case OPT_START: return number(opt, "start", arg, 0, 1e6, &opt->capture.start_s);
    case OPT_END: return number(opt, "end", arg, 0, 1e6, &opt->capture.end_s);
    case OPT_BATCH:
        opt->command = COMMAND_BATCH;
        opt->batch_path = arg;
        return 1;
    case 'j': return whole_number(opt, "jobs", arg, 1, 256, &opt->jobs);
    case OPT_TO: return parse_to(opt, arg);
    case OPT_PLOT: return parse_plot(opt, arg);
    case OPT_VISEMES: opt->visemes = 1; return 1;
    case OPT_EXPRESSIONS: opt->expressions = 1; return 1;
    case OPT_SPEECH: opt->speech.sound = arg; return 1;
    case OPT_PHONEMES: opt->speech.phonemes = arg; return 1;
    case OPT_TIER: opt->speech.tier = arg; return 1;
    case OPT_TEXT: opt->speech.text = arg; return 1;
    case OPT_LANGUAGE: opt->speech.language = arg; return 1;
    case OPT_LIPS: opt->speech.lips = 1; return 1;
    case OPT_TRIGGER: return parse_trigger(opt, arg);
    case OPT_QUANT:
        return set_rate(opt, "--quant", FAP_ENCODE_QUANT) &&
               whole_number(opt, "quant", arg, 0, 31, &opt->bits.quant);
    case OPT_BITRATE: return set_rate(opt, "--bitrate", FAP_ENCODE_BITRATE) && parse_bitrate(opt, arg);
    case OPT_MAX_ERROR:
        return set_rate(opt, "--max-error", FAP_ENCODE_ERROR) &&
               number(opt, "max-error", arg, 0.001, 100, &opt->bits.max_error_mm);
    case OPT_BANK: opt->bank_path = arg; return 1;
    case OPT_LOOK_AHEAD: return whole_number(opt, "look-ahead", arg, 0, 10000, &opt->bits.look_ahead);
    case OPT_DERIVE: opt->bits.derive = 1; return 1;
    case OPT_NO_DERIVE: opt->bits.derive = 0; return 1;
    case OPT_SKIP: opt->bits.skip = 1; return 1;
    case OPT_NO_SKIP: opt->bits.skip = 0; return 1;
    case OPT_FIT: opt->fit_path = arg; return 1;
    case OPT_LEARN_FIT: opt->learn_path = arg; return 1;
    case OPT_TIME_CODES: opt->bits.time_codes = 1; return 1;
    case OPT_PLANE_CODES: opt->bits.plane_codes = 1; return 1;
    case OPT_GENDER: return parse_gender(opt, arg);
    case OPT_STRICT: opt->strict = 1; return 1;
    case OPT_INTRA: return whole_number(opt, "intra", arg, 1, 10000, &opt->bits.intra);
    case OPT_PLANES: opt->planes = 1; return 1;
    case OPT_JSON: opt->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP: fputs(help, stdout); return 0;
    case OPT_VERSION: printf("fapenc %s\n", fap_version()); return 0;
    default: return usage(opt); /* getopt has said what is wrong */
    }
}

static int ends_with(const char *name, const char *ending)
{
    const char *dot = name ? strrchr(name, '.') : NULL;
    return dot && !strcasecmp(dot, ending);
}

int options_want_bits(const options *opt)
{
    return ends_with(opt->output, ".fba");
}

int options_want_livelink(const options *opt)
{
    return ends_with(opt->output, ".csv");
}

static int check_span(options *opt)
{
    if (!(opt->capture.end_s > 0) || opt->capture.end_s > opt->capture.start_s)
        return 1;
    tool_error("--end %g is not after --start %g", opt->capture.end_s, opt->capture.start_s);
    return usage(opt);
}

static int check_batch(options *opt)
{
    opt->batch_bits |= opt->rate_option && !opt->to_given;
    if (opt->input)
        tool_error("--batch %s has its own inputs, not also %s", opt->batch_path, opt->input);
    else if (!opt->output || !strcmp(opt->output, "-"))
        tool_error("where to? --batch FOLDER -o OUTFOLDER");
    else if (opt->plot_path || opt->learn_path || gpio_spec_given(&opt->trigger))
        tool_error(
            "--plot, --learn-fit and --trigger belong to one take; a batch plots every take by itself");
    else
        return 1;
    return usage(opt);
}

static int is_speech(const options *opt)
{
    const speech_options *s = &opt->speech;
    return s->sound || s->phonemes || s->text || s->language || s->tier || s->lips;
}

static int check_output(options *opt)
{
    if (!opt->output)
        tool_error("where to? -o OUT.fap, or -o - for standard output");
    else if (opt->json && !strcmp(opt->output, "-"))
        tool_error("-o - and --json would both write to standard output");
    else if (opt->learn_path && !options_want_bits(opt))
        tool_error("--learn-fit %s: a table is learnt for an .fba that is written, -o OUT.fba",
                   opt->learn_path);
    else if (opt->learn_path && !strcmp(opt->learn_path, opt->output))
        tool_error("--learn-fit and -o name the same file");
    else if (opt->plot_path && !strcmp(opt->plot_path, opt->output))
        tool_error("--plot and -o name the same file");
    else
        return 1;
    return usage(opt);
}

/* The phonemes stand where a take would. */
static int check_speech(options *opt)
{
    speech_options *s = &opt->speech;

    if (opt->visemes || opt->expressions)
        tool_error("--visemes and --expressions are found in captures; speech has its visemes already");
    else if (opt->command != COMMAND_ENCODE || opt->input)
        tool_error(
            "speech is no take: --speech SOUND --phonemes FILE, or --text WORDS, and nothing else to read");
    else if (!s->phonemes == !s->text)
        tool_error("what is said? Either --phonemes FILE or --text WORDS");
    else if (s->tier && !s->phonemes)
        tool_error("--tier is of --phonemes FILE.TextGrid");
    else if (s->language && !s->text)
        tool_error("--language is of --text WORDS");
    else if (options_want_livelink(opt))
        tool_error("-o %s: speech becomes FAPs, .fap or .fba; those become a .csv", opt->output);
    else {
        opt->command = COMMAND_SPEECH;
        opt->input = s->phonemes ? s->phonemes : "speech";
        s->language = s->language ? s->language : "en-us";
        return check_output(opt);
    }
    return usage(opt);
}

static int check(options *opt)
{
    if (opt->command != COMMAND_BATCH && (opt->jobs || opt->to_given))
        tool_error("--jobs and --to belong to --batch FOLDER");
    else if (!opt->input)
        tool_error("what to read? fapenc TAKE -o OUT.fap; fapenc --help tells more");
    else if (opt->learn_path && opt->command == COMMAND_INSPECT)
        tool_error("--learn-fit %s: a table is learnt for an .fba that is written, -o OUT.fba",
                   opt->learn_path);
    else if (opt->planes && opt->command != COMMAND_INSPECT)
        tool_error("--planes belongs to fapenc inspect");
    else if (opt->command == COMMAND_INSPECT && gpio_spec_given(&opt->trigger))
        tool_error("--trigger starts a capture; fapenc inspect has none");
    else if (opt->command == COMMAND_INSPECT && opt->plot_path)
        tool_error("--plot draws what is encoded; fapenc inspect encodes nothing");
    else
        return (opt->command == COMMAND_INSPECT || check_output(opt)) && check_span(opt);
    return usage(opt);
}

/* What is encoded does not depend on where it goes and what is told about it. */
static int keep_given(options *opt, int c, int index)
{
    static const int elsewhere[] = { 'o', 'j', OPT_BATCH, OPT_PLOT, OPT_JSON, OPT_QUIET };
    const size_t used = strlen(opt->given), room = sizeof opt->given - used;

    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
        if (c == elsewhere[i])
            return 1;
    if (snprintf(opt->given + used, room, "--%s=%s\n", long_options[index].name, optarg ? optarg : "") <
        (int)room)
        return 1;
    tool_error("the options are longer than %zu letters", sizeof opt->given);
    return usage(opt);
}

int options_parse(options *opt, int argc, char **argv)
{
    int c, index;

    *opt = (options){ .exit_status = EXIT_OK };
    fap_capture_config_init(&opt->capture);
    fap_encoder_config_init(&opt->bits);
    while ((c = getopt_long(argc, argv, "o:j:", long_options, &index)) != -1)
        if (!parse_option(opt, c, optarg) || !keep_given(opt, c, index))
            return 0;
    if (optind < argc && !strcmp(argv[optind], "inspect")) {
        opt->command = COMMAND_INSPECT;
        optind++;
    }
    if (optind < argc)
        opt->input = argv[optind++];
    if (optind < argc) {
        tool_error("one input at a time, not also %s", argv[optind]);
        return usage(opt);
    }
    if (is_speech(opt))
        return check_speech(opt);
    return opt->command == COMMAND_BATCH ? check_batch(opt) : check(opt);
}
