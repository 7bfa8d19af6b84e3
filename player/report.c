/* SPDX-License-Identifier: BSD-2-Clause */
/* See report.h. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include <fap/tables.h>

#include "common/json.h"
#include "common/tool.h"
#include "player/report.h"

void play_report_note(play_report *r, const char *fmt, ...)
{
    if (r->note_count == REPORT_MAX_NOTES)
        return;
    va_list args;
    va_start(args, fmt);
    vsnprintf(r->note[r->note_count++], REPORT_TEXT_SIZE, fmt, args);
    va_end(args);
}

static void put_golden(json *j, const sink_result *result)
{
    json_open(j, "golden", '{');
    json_integer(j, "same", result->same);
    json_integer(j, "different", result->different);
    json_integer(j, "updated", result->updated);
    json_integer(j, "missing", result->missing);
    json_integer(j, "stale", result->stale);
    json_integer(j, "worst", result->worst);
    json_number(j, "structure", result->structure);
    json_string(j, "page", result->left);
    json_close(j, '}');
}

static void put_view(json *j, const session *s)
{
    json_open(j, "view", '{');
    json_string(j, "camera", s->camera >= 0 ? render_camera_name((render_camera)s->camera) : "free");
    json_number(j, "yaw_degrees", s->view.yaw_degrees);
    json_number(j, "pitch_degrees", s->view.pitch_degrees);
    json_number(j, "distance", s->view.distance);
    json_close(j, '}');
}

static void put_session(json *j, const session *s)
{
    json_bool(j, "playing", s->playing);
    json_number(j, "position_s", (double)s->at_us * 1e-6);
    json_integer(j, "frame", session_frame(s));
    json_integer(j, "frame_count", s->frame_count);
    json_number(j, "speed", s->speed);
    json_bool(j, "loop", s->loop);
    json_integer(j, "loops", s->loops);
    json_integer(j, "late_frames", s->late_frames);
    json_string(j, "blend", fap_blend_name((int)s->blend));
    json_string(j, "expression", fap_expression_name(s->expression));
    json_bool(j, "wireframe", s->wireframe);
    json_bool(j, "points", s->points);
    json_bool(j, "bars", s->bars);
    json_bool(j, "panels", s->panels);
    json_bool(j, "fullscreen", s->fullscreen);
    put_view(j, s);
}

static void put_window(json *j, const window_report *w)
{
    json_open(j, "window", '{');
    json_string(j, "clock", w->clock);
    json_number(j, "av_offset_ms", w->av_offset_ms);
    json_number(j, "av_offset_mean_ms", w->av_offset_mean_ms);
    json_integer(j, "screenshots", w->screenshot_count);
    if (w->screenshot_count)
        json_string(j, "screenshot", w->screenshot);
    put_session(j, &w->session);
    json_close(j, '}');
}

static void put_notes(json *j, const play_report *r)
{
    json_open(j, "notes", '[');
    for (int i = 0; i < r->note_count; i++)
        json_string(j, NULL, r->note[i]);
    json_close(j, ']');
}

static void put_json(const play_report *r, const play_options *o)
{
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "stream", o->stream);
    json_bool(&j, "ok", r->fault.exit_status == EXIT_OK);
    if (r->fault.exit_status != EXIT_OK)
        json_string(&j, "error", r->fault.text);
    json_string(&j, "sink", o->sink ? o->sink->name : "window");
    if (o->output)
        json_string(&j, "output", o->output);
    json_string(&j, "face", r->face);
    if (r->renderer[0])
        json_string(&j, "renderer", r->renderer);
    json_integer(&j, "stream_frames", r->stream_frames);
    json_number(&j, "stream_rate_hz", r->stream_rate_hz);
    json_number(&j, "stream_s", r->stream_s);
    json_integer(&j, "shown_frames", r->shown_frames);
    json_number(&j, "rate_hz", r->rate_hz);
    if (o->audio)
        json_number(&j, "sound_s", r->sound_s);
    json_number(&j, "worst_blend_error_mm", r->error_mm);
    json_number(&j, "worst_error_mm", r->residual_mm);
    if (r->triggers)
        json_number(&j, "trigger_ms", r->trigger_ms);
    if (r->result.has_error) {
        json_number(&j, "export_worst_error_mm", r->result.worst_error_mm);
        json_number(&j, "export_rms_error_mm", r->result.rms_error_mm);
    }
    if (o->golden)
        put_golden(&j, &r->result);
    if (!o->sink && r->window.session.frame_count)
        put_window(&j, &r->window);
    put_notes(&j, r);
    json_close(&j, '}');
}

static void say_update(const sink_result *r, const char *golden)
{
    tool_note("%s: %" PRId64 " written, %" PRId64 " the same as before", golden, r->updated, r->same);
    if (r->left[0])
        tool_note("what was replaced, and by what: %s", r->left);
}

/* Golden pictures that nothing was compared with. */
static void say_stale(const sink_result *r, const char *golden)
{
    if (r->stale)
        tool_note("%s: %" PRId64
                  " more there, of frames that were not shown: of a longer stream, or of other "
                  "--frames",
                  golden, r->stale);
}

static void say_success(const play_report *r, const play_options *o)
{
    if (r->triggers)
        tool_note("the first frame was shown %.1f ms after the edge", r->trigger_ms);
    if (!o->sink)
        return; /* a window speaks for itself */
    if (o->golden && o->update)
        say_update(&r->result, o->golden);
    else if (o->golden)
        tool_note("%s: %" PRId64 " picture%s, all the same", o->golden, r->result.same,
                  r->result.same == 1 ? "" : "s");
    else
        tool_note("%s: %" PRId64 " frame%s at %g Hz (the stream lasts %.2f s)", o->output, r->shown_frames,
                  r->shown_frames == 1 ? "" : "s", r->rate_hz, r->stream_s);
    if (o->golden)
        say_stale(&r->result, o->golden);
    if (r->result.has_error)
        tool_note("%s: vertices within %.3g mm of the player's, %.2g mm RMS", o->output,
                  r->result.worst_error_mm, r->result.rms_error_mm);
}

int play_report_print(const play_report *r, const play_options *o)
{
    for (int i = 0; i < r->note_count; i++)
        tool_note("%s", r->note[i]);
    if (r->fault.exit_status != EXIT_OK)
        tool_error("%s", r->fault.text);
    else
        say_success(r, o);
    if (o->json)
        put_json(r, o);
    return r->fault.exit_status;
}
