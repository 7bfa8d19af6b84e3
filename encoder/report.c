/* SPDX-License-Identifier: BSD-2-Clause */
/* See report.h. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/tool.h"
#include "encoder/report.h"
#include "encoder/report_capture.h"
#include "encoder/report_coefficients.h"
#include "encoder/report_inspect.h"
#include "encoder/report_named.h"
#include "encoder/report_written.h"
#include "encoder/speech/report_speech.h"

static void say_stream_notes(const run_report *rep)
{
    const stream_summary *s = &rep->stream;

    for (int i = 0; i < s->notice_count; i++)
        tool_note("%s %" PRId64 ": %s", strcmp(s->format, "fba") ? "line" : "bit", s->notice[i].where,
                  s->notice[i].text);
    if (s->broken_planes)
        tool_note("%" PRIu64 " plane%s broken and passed over: %s", s->broken_planes,
                  s->broken_planes == 1 ? " is" : "s are", rep->first_broken);
    if (*rep->fit_found)
        tool_note("note: interpolates by %s", rep->fit_found);
}

static void report_transcoded(const options *opt, const run_report *rep)
{
    if (opt->json)
        inspect_json(opt, rep);
    else if (rep->livelink.frames)
        report_livelink_say(opt, rep);
    else if (!rep->written.bits)
        tool_note("%s: %" PRIu64 " frames at %g Hz, %d FAPs", opt->output, rep->stream.frames,
                  rep->stream.header.rate_hz, stream_coded_faps(&rep->stream));
    say_stream_notes(rep);
}

static void report_success(const options *opt, const run_report *rep)
{
    if (opt->command == COMMAND_INSPECT) {
        (opt->json ? inspect_json : inspect_say)(opt, rep);
        return;
    }
    if (rep->spoken.speech)
        (opt->json ? report_speech_json : report_speech_say)(opt, rep);
    else if (rep->capture)
        (opt->json ? report_capture_json : report_capture_say)(opt, rep);
    else if (rep->performance)
        (opt->json ? report_coefficients_json : report_coefficients_say)(opt, rep);
    else
        report_transcoded(opt, rep);
    if (!opt->json)
        report_named_say(opt, rep);
    report_written_say(opt, &rep->written);
}

int report_print(const options *opt, const run_report *rep, fap_err err)
{
    if (err != FAP_OK) {
        tool_error("%s: %s", rep->path, rep->where);
        return rep->no_device ? EXIT_MISSING : tool_exit_code(err);
    }
    report_success(opt, rep);
    return EXIT_OK;
}
