/* SPDX-License-Identifier: BSD-2-Clause */
/* See run.h. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "common/sound_file.h"
#include "player/lines.h"
#include "player/plan.h"
#include "player/render/renderer.h"
#include "player/run.h"
#include "player/scene.h"
#include "player/window/window.h"

typedef struct player {
    const play_options *opt;
    play_report *report;
    scene scene;
    renderer *renderer; /* NULL: the sink wants no pictures */
    image picture;
    frame_plan plan;
    sink_setup setup;
    void *sink_state;
    gpio_lines lines;
} player;

/* --- what goes in --- */

static int load_scene(player *p)
{
    const play_options *o = p->opt;
    play_report *r = p->report;

    if (!scene_load_stream(&p->scene, o->stream, o->fit, r))
        return 0;
    r->rate_hz = o->rate_hz > 0 ? o->rate_hz : r->stream_rate_hz;
    return scene_load_bank(&p->scene, o->bank, &o->face, o->sink->needs_picture, r);
}

/* Before anything is drawn: a long film should not end at a sound that is none. */
static int check_sound(player *p)
{
    play_report *r = p->report;
    char where[FAP_ERROR_TEXT_SIZE];

    if (!p->opt->audio)
        return 1;
    const fap_err err = sound_measure(p->opt->audio, &r->sound_s, where);
    if (err)
        return fault_set(&r->fault, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : EXIT_DATA, "%s: %s",
                         p->opt->audio, where);
    if (!p->opt->has_range && fabs(r->sound_s - r->stream_s) > 0.5)
        play_report_note(r, "%s lasts %.2f s, the stream %.2f s; the film is as long as the stream",
                         p->opt->audio, r->sound_s, r->stream_s);
    return 1;
}

/* --- which frames --- */

/* The part of --frames that the stream has. */
static int clip_range(player *p, int64_t *from, int64_t *to)
{
    const int64_t count = timeline_frame_count(&p->scene.line, p->report->rate_hz);

    *from = p->opt->from;
    *to = p->opt->to < count ? p->opt->to : count;
    if (*from >= count)
        return fault_set(&p->report->fault, EXIT_USAGE,
                         "--frames: %s ends in front of frame %" PRId64 " (%" PRId64 " frames)",
                         p->opt->stream, *from, count);
    if (p->opt->to != INT64_MAX && p->opt->to > count)
        play_report_note(p->report, "--frames: %s ends in front of frame %" PRId64, p->opt->stream, count);
    return 1;
}

static int make_plan(player *p)
{
    int64_t from, to;

    if (!clip_range(p, &from, &to))
        return 0;
    switch (p->opt->sink->choice) {
    case SINK_ALL_FRAMES: p->plan = frame_plan_make(from, to, 0); break;
    case SINK_MOMENTS: p->plan = frame_plan_make(from, to, p->opt->moments); break;
    case SINK_FIRST_FRAME: p->plan = frame_plan_make(from, p->opt->has_range ? from + 1 : to, 1); break;
    }
    return 1;
}

/* --- what comes out --- */

static int open_renderer(player *p)
{
    const play_options *o = p->opt;
    char where[FAP_ERROR_TEXT_SIZE] = "";

    if (!o->sink->needs_picture)
        return 1;
    const fap_err err = renderer_create(&p->renderer, o->gl, p->scene.bank, o->width, o->height, where);
    if (err == FAP_E_UNSUPPORTED)
        return fault_set(
            &p->report->fault, EXIT_MISSING,
            "no pictures here: %s; install OSMesa or EGL (Debian: apt install libosmesa6-dev libegl-dev) and "
            "build again, or ask for -o NAME.csv",
            where);
    if (err || image_create(&p->picture, o->width, o->height))
        return fault_set(&p->report->fault, EXIT_DATA, "cannot draw %d x %d pixels: %s", o->width, o->height,
                         where[0] ? where : fap_strerror(err ? err : FAP_E_NOMEM));
    snprintf(p->report->renderer, sizeof p->report->renderer, "%s", renderer_description(p->renderer));
    p->picture.transparent = o->dress.backdrop == BACKDROP_NOTHING;
    return dress_renderer(p->renderer, &o->dress, &p->report->fault);
}

static int open_sink(player *p)
{
    const play_options *o = p->opt;

    p->setup = (sink_setup){
        .output = o->output,
        .golden = o->golden,
        .audio = o->audio,
        .update = o->update,
        .tolerance = o->tolerance,
        .width = o->width,
        .height = o->height,
        .rate_hz = p->report->rate_hz,
        .from = frame_plan_at(&p->plan, 0),
        .count = p->plan.count,
        .bank = p->scene.bank,
        .csv = o->csv,
        .texture = o->dress.skin,
    };
    p->sink_state = calloc(1, o->sink->state_size);
    if (!p->sink_state)
        return fault_set(&p->report->fault, EXIT_DATA, "out of memory");
    return o->sink->open(p->sink_state, &p->setup, &p->report->fault);
}

static void pose(player *p, int64_t i)
{
    const int64_t number = frame_plan_at(&p->plan, i);
    scene_pose(&p->scene, timeline_time_us(number, p->report->rate_hz), 0, p->report);
}

/* The first frame is ready before the trigger is waited for: from the edge on it only has to be shown. */
static int await_trigger(player *p)
{
    if (!gpio_lines_await(&p->lines))
        return 0;
    gpio_on_start(&p->lines);
    return 1;
}

static int show(player *p, int64_t i, int pass, const float (*point)[3])
{
    const int64_t number = frame_plan_at(&p->plan, i);
    shown_frame shown = {
        .number = number,
        .time_s = (double)number / p->report->rate_hz,
        .point = point,
        .picture = p->renderer ? &p->picture : NULL,
        .pass = pass,
    };

    if (!p->renderer) {
        shown.frame = &p->scene.frame;
        shown.position = p->scene.position;
        shown.weight = fap_face_weights(p->scene.face);
    }
    if (i == 0 && !await_trigger(p))
        return 0;
    if (!p->opt->sink->show(p->sink_state, &shown, &p->report->fault))
        return 0;
    gpio_on_frame(&p->lines);
    p->report->shown_frames = i + 1;
    return 1;
}

static int pass_count(const player *p)
{
    return p->opt->sink->passes > 1 ? p->opt->sink->passes : 1;
}

static int show_poses(player *p, progress *bar)
{
    for (int pass = 0; pass < pass_count(p); pass++)
        for (int64_t i = 0; i < p->plan.count; i++) {
            pose(p, i);
            if (!show(p, i, pass, (const float(*)[3])p->scene.point))
                return 0;
            progress_step(bar, pass * p->plan.count + i + 1);
        }
    return 1;
}

static int drawn(player *p, fap_err err)
{
    return err ? fault_set(&p->report->fault, EXIT_DATA, "drawing failed: %s", fap_strerror(err)) : 1;
}

static int begin_picture(player *p)
{
    const render_scene what = { p->scene.position, p->scene.normal, .view = render_view_of(p->opt->camera) };
    return drawn(p, renderer_begin(p->renderer, &what));
}

/* While a picture is drawn, the next frame is posed and the picture before is written. */
static int show_pictures(player *p, progress *bar)
{
    const int64_t count = p->plan.count;
    float point[FAP_POINT_COUNT][3]; /* of the frame that is drawn */

    pose(p, 0);
    if (!begin_picture(p))
        return 0;
    for (int64_t i = 0; i < count; i++) {
        memcpy(point, p->scene.point, sizeof point);
        if (i + 1 < count)
            pose(p, i + 1);
        if (!drawn(p, renderer_finish(p->renderer, &p->picture)))
            return 0;
        if ((i + 1 < count && !begin_picture(p)) || !show(p, i, 0, (const float(*)[3])point))
            return 0;
        progress_step(bar, i + 1);
    }
    return 1;
}

static int show_all(player *p)
{
    progress bar;

    progress_start(&bar, p->opt->sink->name, pass_count(p) * p->plan.count);
    const int ok = p->renderer ? show_pictures(p, &bar) : show_poses(p, &bar);
    progress_end(&bar);
    gpio_on_stop(&p->lines);
    if (ok)
        gpio_on_end(&p->lines);
    return ok;
}

static void close_all(player *p)
{
    gpio_lines_close(&p->lines);
    if (p->sink_state)
        p->opt->sink->close(p->sink_state);
    free(p->sink_state);
    image_free(&p->picture);
    renderer_destroy(&p->renderer);
    scene_free(&p->scene);
}

void play_run(const play_options *o, play_report *r)
{
    player p = { .opt = o, .report = r };

    if (!o->sink) {
        window_run(o, r);
        return;
    }
    if (gpio_lines_open(&p.lines, &gpio_system, &o->lines, r) && load_scene(&p) && check_sound(&p) &&
        make_plan(&p) && open_renderer(&p) && open_sink(&p) && show_all(&p))
        o->sink->finish(p.sink_state, &r->result, &r->fault);
    close_all(&p);
}
