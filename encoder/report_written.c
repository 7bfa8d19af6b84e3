/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_written.h. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/fit_file.h"
#include "common/tool.h"
#include "encoder/report_written.h"

static double kbit_s(const written_report *w)
{
    return w->length_s > 0 ? (double)w->stats.bytes * 8 / 1000 / w->length_s : 0;
}

/* Over two seconds, or all there is where the stream is shorter. */
static double fullest_kbit_s(const written_report *w)
{
    return (double)w->stats.largest_window_bits / 2000;
}

static const char *face(const written_report *w)
{
    return *w->face ? w->face : "a typical face";
}

static const char *plural(int64_t n)
{
    return n == 1 ? "" : "s";
}

/* --- what could not be kept --- */

static void warn_clipped(const options *opt, const fap_encoder_stats *s)
{
    if (!s->clipped)
        return;
    if (opt->bits.mode == FAP_ENCODE_QUANT && opt->bits.quant == 0)
        tool_note("warning: not exact: %" PRId64
                  " value%s beyond +-1860, the most a plane carries at --quant 0; "
                  "they were clipped and the next planes catch up. --quant 1 has room for them",
                  s->clipped, s->clipped == 1 ? " is" : "s are");
    else
        tool_note("warning: %" PRId64
                  " value%s beyond what a plane can carry; they were clipped and the next planes "
                  "catch up",
                  s->clipped, s->clipped == 1 ? " is" : "s are");
}

static void warn_missed(const options *opt, const written_report *w)
{
    const fap_encoder_config *b = &opt->bits;

    if (b->mode == FAP_ENCODE_BITRATE && w->stats.largest_window_bits > 2 * (int64_t)b->bitrate_bps)
        tool_note(
            "warning: --bitrate %g could not be kept: this is the least that the frames can be sent with",
            b->bitrate_bps / 1000.0);
    if (b->mode == FAP_ENCODE_ERROR && w->stats.max_error_mm > b->max_error_mm * 1.0001)
        tool_note("warning: --max-error %g could not be kept everywhere", b->max_error_mm);
}

/* Where players will look for the table, and what they must not find there. */
static void say_table(const options *opt, const written_report *w)
{
    const char *const path = opt->learn_path ? opt->learn_path : opt->fit_path;
    char beside[4096] = "";
    const int is_there = fit_file_beside(opt->output, beside, sizeof beside);

    if (opt->learn_path)
        tool_note("%s: a table that gives %d FAP%s", path, w->fit_gives, plural(w->fit_gives));
    if (!w->stats.derived || (path && !strcmp(beside, path)))
        return;
    if (path)
        tool_note("note: whoever plays %s needs --fit %s", opt->output, path);
    if (is_there)
        tool_note("warning: %s was not made with %s, which players will take for its table: move that file",
                  opt->output, beside);
}

/* --- what was reached --- */

void report_written_say(const options *opt, const written_report *w)
{
    const fap_encoder_stats *s = &w->stats;

    if (!w->bits)
        return;
    tool_note("%s: %" PRId64 " bytes, %.2f s: %.2f kbit/s, %.2f in the fullest 2 s", opt->output, s->bytes,
              w->length_s, kbit_s(w), fullest_kbit_s(w));
    tool_note("  %" PRId64 " frame%s, %" PRId64 " I plane%s, %" PRId64 " skipped; %" PRId64
              " value%s left to the decoder",
              s->frames, plural(s->frames), s->intra_frames, plural(s->intra_frames), s->skipped, s->derived,
              plural(s->derived));
    tool_note("  feature points are off by %.3f mm in the mean, %.3f mm at most (on %s)", s->mean_error_mm,
              s->max_error_mm, face(w));
    say_table(opt, w);
    warn_clipped(opt, s);
    warn_missed(opt, w);
}

void report_written_json(json *j, const options *opt, const written_report *w)
{
    static const char *const modes[] = { "quant", "bitrate", "max-error" };
    const fap_encoder_stats *s = &w->stats;

    if (!w->bits)
        return;
    json_open(j, "written", '{');
    json_string(j, "path", opt->output);
    json_string(j, "mode", modes[opt->bits.mode]);
    json_integer(j, "bytes", s->bytes);
    json_number(j, "length_s", w->length_s);
    json_number(j, "kbit_s", kbit_s(w));
    json_integer(j, "largest_2s_bits", s->largest_window_bits);
    json_number(j, "largest_2s_kbit_s", fullest_kbit_s(w));
    json_integer(j, "frames", s->frames);
    json_integer(j, "intra_frames", s->intra_frames);
    json_integer(j, "skipped_frames", s->skipped);
    json_integer(j, "derived_values", s->derived);
    json_integer(j, "clipped_values", s->clipped);
    json_number(j, "mean_error_mm", s->mean_error_mm);
    json_number(j, "max_error_mm", s->max_error_mm);
    json_string(j, "face", face(w));
    if (opt->learn_path) {
        json_string(j, "fit", opt->learn_path);
        json_integer(j, "fit_gives", w->fit_gives);
    }
    json_close(j, '}');
}
