/* SPDX-License-Identifier: BSD-2-Clause */
/* See track_report.h. */
#include <math.h>
#include <stdio.h>

#include "common/json.h"
#include "common/tool.h"
#include "encoder/track/track_report.h"

/* --- what is said more than once --- */

static uint32_t samples_of(const fap_take *take)
{
    uint32_t count = 0;

    for (size_t i = 0; i < (size_t)take->frame_count * take->point_count; i++)
        count += take->valid[i] != 0;
    return count;
}

static double missing_share(const fap_take *take)
{
    return 1 - samples_of(take) / ((double)take->frame_count * take->point_count);
}

static double tracked_hz(const track_work *w)
{
    return w->seen.busy_us ? (w->seen.frames - 1) * 1e6 / (double)w->seen.busy_us : 0;
}

/* How far the glass is turned from facing the camera, degrees. */
static double aside_deg(const fap_mirror_plane *m)
{
    return acos(fmin(1, fabs(m->normal[2]))) * 180 / 3.14159265358979323846;
}

static int is_ruler(const track_work *w, int dot)
{
    return dot == w->ruler[0] || dot == w->ruler[1];
}

/* Followed in at least two views where there are mirrors. */
static int has_depth(const fap_track_dot *d)
{
    return d->has[0] + d->has[1] + d->has[2] > 1;
}

/* --- words --- */

static void say_mirrors(const track_work *w)
{
    for (int i = 0; i < w->dots.mirrors; i++) {
        const fap_mirror_fit *fit = &w->report.fit[i];
        tool_note("mirror %d: %.1f degrees aside; %d of %d pairs agree, off by %.2f pixels rms", i + 1,
                  aside_deg(&w->report.mirror[i]), fit->fitting, fit->pairs, fit->residual);
    }
    if (w->dots.mirrors)
        tool_note("places: off by %.2f pixels rms in all views", w->report.rms_px);
    else
        tool_note("places: flat, as there is no mirror");
}

static void say_size(const track_work *w)
{
    const fap_tracks_report *r = &w->report;

    if (w->ruler[0] >= 0)
        tool_note("size: by the ruler, placed in %u pictures; the face is %.0f mm away",
                  (unsigned)r->ruler_frames, r->distance_mm);
    else
        tool_note("size: guessed, a face %.0f mm away; --ruler A,B,MM measures it", r->distance_mm);
}

/* Dots that would be missed. */
static void say_dots(const track_work *w)
{
    const uint32_t frames = w->seen.frames;

    for (int i = 0; i < w->dots.count; i++) {
        const fap_track_dot *d = &w->dots.dot[i];
        const uint32_t placed = w->report.label[i].placed;
        if (is_ruler(w, i))
            continue;
        if (w->dots.mirrors && !has_depth(d))
            tool_note("  %s is in one view only: it has no place", d->name);
        else if (placed < frames - frames / 20)
            tool_note("  %s has a place in %u of %u pictures", d->name, (unsigned)placed, (unsigned)frames);
        if (w->report.label[i].strays)
            tool_note("  %s was somewhere else in %u pictures: look at --overlay", d->name,
                      (unsigned)w->report.label[i].strays);
    }
}

void track_report_say(const track_work *w)
{
    tool_note("%s: %d x %d, %g %s a second, %u of them; %d dots, %d mirror%s; followed %.0f a second",
              w->opt->video, w->seen.width_px, w->seen.height_px, w->video.rate_hz,
              w->video.fields ? "fields" : "pictures", (unsigned)w->seen.frames, w->dots.count,
              w->dots.mirrors, w->dots.mirrors == 1 ? "" : "s", tracked_hz(w));
    if (!w->camera_known)
        tool_note("camera: nobody measured it; taken as %.0f degrees wide",
                  w->opt->view_deg > 0 ? w->opt->view_deg : 50);
    say_mirrors(w);
    say_size(w);
    say_dots(w);
    tool_note("%s: %u points, %u frames at %g Hz, %.1f %% missing", w->opt->output,
              (unsigned)w->take->point_count, (unsigned)w->take->frame_count, w->take->rate_hz,
              100 * missing_share(w->take));
}

/* --- JSON --- */

static void put_mirror(json *j, const track_work *w, int i)
{
    const fap_mirror_plane *m = &w->report.mirror[i];
    const fap_mirror_fit *fit = &w->report.fit[i];

    json_open(j, NULL, '{');
    json_open(j, "normal", '[');
    for (int k = 0; k < 3; k++)
        json_number(j, NULL, m->normal[k]);
    json_close(j, ']');
    json_number(j, "distance_mm", m->distance);
    json_integer(j, "pairs", fit->pairs);
    json_integer(j, "pairs_that_agree", fit->fitting);
    json_number(j, "residual_px", fit->residual);
    json_close(j, '}');
}

static void put_dot(json *j, const track_work *w, int i)
{
    const fap_tracks_label *l = &w->report.label[i];

    json_open(j, NULL, '{');
    json_string(j, "label", w->dots.dot[i].name);
    json_bool(j, "ruler", is_ruler(w, i));
    json_integer(j, "views", w->dots.dot[i].has[0] + w->dots.dot[i].has[1] + w->dots.dot[i].has[2]);
    json_integer(j, "seen", l->seen);
    json_integer(j, "placed", l->placed);
    json_integer(j, "strays", l->strays);
    json_number(j, "rms_px", l->rms_px);
    json_close(j, '}');
}

static void put_video(json *j, const track_work *w)
{
    json_open(j, "video", '{');
    json_string(j, "file", w->opt->video);
    json_integer(j, "width", w->seen.width_px);
    json_integer(j, "height", w->seen.height_px);
    json_number(j, "rate_hz", w->video.rate_hz);
    json_bool(j, "fields", w->video.fields);
    json_integer(j, "pictures", w->seen.frames);
    json_number(j, "followed_hz", tracked_hz(w));
    json_close(j, '}');
}

static void put_camera(json *j, const track_work *w)
{
    json_open(j, "camera", '{');
    json_bool(j, "measured", w->camera_known);
    json_number(j, "fx", w->camera.fx_px);
    json_number(j, "fy", w->camera.fy_px);
    json_number(j, "cx", w->camera.cx_px);
    json_number(j, "cy", w->camera.cy_px);
    json_close(j, '}');
}

static void put_take(json *j, const track_work *w)
{
    json_open(j, "take", '{');
    json_string(j, "file", w->opt->output);
    json_integer(j, "points", w->take->point_count);
    json_integer(j, "frames", w->take->frame_count);
    json_number(j, "missing_share", missing_share(w->take));
    json_bool(j, "depth", w->dots.mirrors > 0);
    json_bool(j, "size_measured", w->take->unit_known);
    json_number(j, "distance_mm", w->report.distance_mm);
    json_number(j, "rms_px", w->report.rms_px);
    json_close(j, '}');
}

void track_report_json(const track_work *w)
{
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    put_video(&j, w);
    put_camera(&j, w);
    json_open(&j, "mirrors", '[');
    for (int i = 0; i < w->dots.mirrors; i++)
        put_mirror(&j, w, i);
    json_close(&j, ']');
    json_open(&j, "dots", '[');
    for (int i = 0; i < w->dots.count; i++)
        put_dot(&j, w, i);
    json_close(&j, ']');
    put_take(&j, w);
    json_close(&j, '}');
}
