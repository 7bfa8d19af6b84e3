/* SPDX-License-Identifier: BSD-2-Clause */
/* See report.h. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/tool.h"
#include "encoder/report.h"
#include "encoder/report_capture.h"
#include "encoder/report_inspect.h"

static void say_stream_notes(const stream_summary *s)
{
    for (int i = 0; i < s->notice_count; i++)
        tool_note("%s %" PRId64 ": %s", strcmp(s->format, "fba") ? "line" : "bit", s->notice[i].where,
                  s->notice[i].text);
    if (s->broken_planes)
        tool_note("%" PRIu64 " planes are broken and were passed over", s->broken_planes);
}

static void say_written(const options *opt, const run_report *rep)
{
    const fap_encoder_stats *w = &rep->written;

    if (w->frames)
        tool_note("%s: %" PRId64 " bytes, %" PRId64 " I planes", opt->output, w->bytes, w->intra_frames);
    if (w->clipped)
        tool_note("note: %" PRId64
                  " values are beyond what a plane can carry at this --quant; later planes catch up",
                  w->clipped);
}

static void report_transcoded(const options *opt, const run_report *rep)
{
    if (opt->json)
        inspect_json(opt, rep);
    else
        tool_note("%s: %" PRIu64 " frames at %g Hz, %d FAPs", opt->output, rep->stream.frames,
                  rep->stream.header.rate_hz, stream_coded_faps(&rep->stream));
    say_stream_notes(&rep->stream);
}

static void report_success(const options *opt, const run_report *rep)
{
    if (opt->command == COMMAND_INSPECT) {
        (opt->json ? inspect_json : inspect_say)(opt, rep);
        return;
    }
    if (rep->capture)
        (opt->json ? report_capture_json : report_capture_say)(opt, rep);
    else
        report_transcoded(opt, rep);
    say_written(opt, rep);
}

int report_print(const options *opt, const run_report *rep, fap_err err)
{
    if (err != FAP_OK) {
        tool_error("%s: %s", rep->path, rep->where);
        return tool_exit_code(err);
    }
    report_success(opt, rep);
    return EXIT_OK;
}
