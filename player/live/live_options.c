/* SPDX-License-Identifier: BSD-2-Clause */
/* See live_options.h. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "player/live/live_options.h"

static const char help[] =
    "usage: fapplay STREAM --send rtp://HOST:PORT [options]\n"
    "       fapplay --listen rtp://HOST:PORT [-o OUT] [options]\n"
    "Sends a stream as it plays, or plays what comes over the network. Without a host it is 127.0.0.1; an "
    "address that others\n"
    "reach has to be given.\n"
    "\n"
    "  --send URL           to whom; STREAM is .fap or .fba and is coded anew, frame by frame\n"
    "  --max-error MM       how far off a feature point may be (0.5)\n"
    "  --intra N            an I plane, with which listeners can begin, at least every N frames (a second)\n"
    "  --aggregate N        frames a packet, 1 to 16: fewer bytes, more delay and more at once when one is "
    "lost (1)\n"
    "  --redundancy WHEN    auto (while listeners report loss), always or never: the plane before is sent "
    "again\n"
    "  --loop               begin again at the end\n"
    "  --sdp FILE.sdp       writes a description of the stream, for listeners\n"
    "\n"
    "  --listen URL         where, or the FILE.sdp of a description; the first source to send three good "
    "packets is listened to, no other\n"
    "  -o, --output OUT     null (the default), NAME.csv or - : a table of every frame, --csv KIND as of "
    "fapplay\n"
    "  --bank B.fbank       the face\n"
    "  --delay MS           how long packets wait for late ones, to begin with; it follows the network (60)\n"
    "  --any-source         listen to whoever sends\n"
    "\n"
    "  --seconds S          stop after that long\n"
    "  --json               report on standard output, for programs\n"
    "  --quiet              errors only\n"
    "\n"
    "Example, in two terminals:\n"
    "  fapplay --listen rtp://127.0.0.1:5004 -o face.csv --seconds 10\n"
    "  fapplay take.fba --send rtp://127.0.0.1:5004\n";

enum {
    OPT_SEND = 256,
    OPT_LISTEN,
    OPT_ERROR,
    OPT_INTRA,
    OPT_AGGREGATE,
    OPT_REDUNDANCY,
    OPT_LOOP,
    OPT_SDP,
    OPT_BANK,
    OPT_CSV,
    OPT_DELAY,
    OPT_ANY_SOURCE,
    OPT_SECONDS,
    OPT_JSON,
    OPT_QUIET,
    OPT_HELP
};

static const struct option long_options[] = {
    { "send", required_argument, NULL, OPT_SEND },
    { "listen", required_argument, NULL, OPT_LISTEN },
    { "output", required_argument, NULL, 'o' },
    { "max-error", required_argument, NULL, OPT_ERROR },
    { "intra", required_argument, NULL, OPT_INTRA },
    { "aggregate", required_argument, NULL, OPT_AGGREGATE },
    { "redundancy", required_argument, NULL, OPT_REDUNDANCY },
    { "sdp", required_argument, NULL, OPT_SDP },
    { "loop", no_argument, NULL, OPT_LOOP },
    { "bank", required_argument, NULL, OPT_BANK },
    { "csv", required_argument, NULL, OPT_CSV },
    { "delay", required_argument, NULL, OPT_DELAY },
    { "any-source", no_argument, NULL, OPT_ANY_SOURCE },
    { "seconds", required_argument, NULL, OPT_SECONDS },
    { "json", no_argument, NULL, OPT_JSON },
    { "quiet", no_argument, NULL, OPT_QUIET },
    { "help", no_argument, NULL, OPT_HELP },
    { NULL, 0, NULL, 0 },
};

int live_options_are(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (!strncmp(argv[i], "--send", 6) || !strncmp(argv[i], "--listen", 8))
            return 1;
    return 0;
}

static int number(const char *name, const char *text, double low, double high, double *out)
{
    char *end;

    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high)
        return 1;
    tool_error("--%s %s: expected a number from %g to %g", name, text, low, high);
    return 0;
}

static int integer(const char *name, const char *text, double low, double high, int *out)
{
    double value;

    if (!number(name, text, low, high, &value))
        return 0;
    *out = (int)value;
    return 1;
}

static int take_redundancy(live_options *o, const char *text)
{
    static const char *const names[] = { "auto", "never", "always" };

    for (int i = 0; i < 3; i++)
        if (!strcmp(text, names[i])) {
            o->redundancy = i - 1;
            return 1;
        }
    tool_error("--redundancy %s: expected auto, always or never", text);
    return 0;
}

static int take_csv(live_options *o, const char *text)
{
    o->csv = csv_kind_by_name(text);
    if (!o->csv)
        tool_error("--csv %s: expected points, vertices, weights, faps or arkit", text);
    return o->csv != NULL;
}

static int take_option(live_options *o, int c, const char *arg)
{
    switch (c) {
    case 'o': o->output = arg; return 1;
    case OPT_SEND: o->send = arg; return 1;
    case OPT_LISTEN: o->listen = arg; return 1;
    case OPT_ERROR: return number("max-error", arg, 0.01, 50, &o->max_error_mm);
    case OPT_INTRA: return integer("intra", arg, 1, 10000, &o->intra);
    case OPT_AGGREGATE: return integer("aggregate", arg, 1, 16, &o->aggregate);
    case OPT_REDUNDANCY: return take_redundancy(o, arg);
    case OPT_SDP: o->sdp = arg; return 1;
    case OPT_LOOP: o->loop = 1; return 1;
    case OPT_BANK: o->bank = arg; return 1;
    case OPT_CSV: return take_csv(o, arg);
    case OPT_DELAY: return integer("delay", arg, 0, 2000, &o->delay_ms);
    case OPT_ANY_SOURCE: o->any_source = 1; return 1;
    case OPT_SECONDS: return number("seconds", arg, 0.01, 1e6, &o->seconds);
    case OPT_JSON: o->json = 1; return 1;
    case OPT_QUIET: tool_quiet = 1; return 1;
    case OPT_HELP:
        fputs(help, stdout);
        o->exit_status = EXIT_OK;
        return 0;
    default: return 0; /* getopt has said what is wrong */
    }
}

static int find_sink(live_options *o)
{
    o->sink = sink_by_name(o->output ? o->output : "null");
    if (o->sink == &sink_null || o->sink == &sink_csv)
        return 1;
    tool_error("-o %s: what is listened to goes to null, NAME.csv or -", o->output);
    return 0;
}

static int check(live_options *o)
{
    if (!o->send == !o->listen)
        tool_error("either --send or --listen");
    else if (o->send && !o->stream)
        tool_error("what to send? fapplay STREAM --send %s", o->send);
    else if (o->listen && o->stream)
        tool_error("--listen plays what comes, not %s", o->stream);
    else if (o->listen && o->sdp)
        tool_error("--sdp belongs to --send; --listen FILE.sdp reads one");
    else if (o->send && o->output)
        tool_error("-o belongs to --listen");
    else if (o->json && o->output && !strcmp(o->output, "-"))
        tool_error("--json and -o - both want standard output");
    else
        return o->send || find_sink(o);
    return 0;
}

int live_options_parse(live_options *o, int argc, char **argv)
{
    int c;

    *o = (live_options){ .max_error_mm = 0.5,
                         .aggregate = 1,
                         .redundancy = -1,

                         .delay_ms = 60,
                         .exit_status = EXIT_USAGE };
    for (int i = 1; i < argc; i++) /* "--send --help" asks what --send is, and is no URL */
        if (!strcmp(argv[i], "--help"))
            return take_option(o, OPT_HELP, NULL);
    while ((c = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        if (!take_option(o, c, optarg))
            return 0;
    if (optind < argc)
        o->stream = argv[optind++];
    if (optind < argc) {
        tool_error("one stream at a time, not also %s", argv[optind]);
        return 0;
    }
    return check(o);
}
