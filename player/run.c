/* SPDX-License-Identifier: BSD-2-Clause */
/* See run.h. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "common/fit_file.h"
#include "common/tool.h"
#include "player/find_bank.h"
#include "player/plan.h"
#include "player/render/renderer.h"
#include "player/run.h"
#include "player/audio/sound_file.h"
#include "player/timeline.h"

typedef struct player {
    const play_options *opt;
    play_report *report;
    timeline line;
    fap_fit *fit;
    fap_bank *bank;
    fap_face *face;
    float *position, *normal; /* one block; normals are for pictures only */
    float point[FAP_POINT_COUNT][3];
    renderer *renderer;
    image picture;
    frame_plan plan;
    sink_setup setup;
    void *sink_state;
} player;

/* --- what goes in --- */

static const size_t max_stream = (size_t)1 << 30;

/* Lines of a .fap, bits of an .fba; and planes that were lost. */
static void note_deviations(player *p, const stream_summary *s, const char *where)
{
    const char *const place = strcmp(s->format, "fba") ? "line" : "bit";

    for (int i = 0; i < s->notice_count; i++)
        play_report_note(p->report, "%s: %s %" PRId64 ": %s", p->opt->stream, place, s->notice[i].where,
                         s->notice[i].text);
    if (s->broken_planes)
        play_report_note(p->report, "%s: %" PRIu64 " planes are broken: %s", p->opt->stream, s->broken_planes,
                         where);
}

/* The table of --fit; for an .fba, else the one beside it. */
static int find_fit(player *p, int reads_bits)
{
    char where[FAP_ERROR_TEXT_SIZE], beside[REPORT_TEXT_SIZE];
    const char *path = p->opt->fit;

    if (!path && reads_bits && fit_file_beside(p->opt->stream, beside, sizeof beside)) {
        path = beside;
        play_report_note(p->report, "interpolates by %s", path);
    }
    if (path && fit_file_read(&p->fit, path, where))
        return fault_set(&p->report->fault, EXIT_DATA, "%s: %s", path, where);
    return 1;
}

static int load_stream(player *p)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    stream_summary summary;
    uint8_t *data;
    size_t size;
    fap_err err = file_read(p->opt->stream, max_stream, &data, &size);

    if (err)
        return fault_set(&p->report->fault, EXIT_DATA, "%s: %s", p->opt->stream,
                         err == FAP_E_IO ? strerror(errno) : fap_strerror(err));
    if (!find_fit(p, stream_is_bits(data, size))) {
        free(data);
        return 0;
    }
    const stream_options reading = { .fit = p->fit };
    err = timeline_load(&p->line, data, size, &reading, &summary, where);
    free(data);
    if (err)
        return fault_set(&p->report->fault, EXIT_DATA, "%s: %s", p->opt->stream,
                         where[0] ? where : fap_strerror(err));
    note_deviations(p, &summary, where);
    p->report->stream_frames = (int64_t)summary.frames;
    p->report->stream_rate_hz = p->line.rate_hz;
    p->report->stream_s = (double)p->line.end_us * 1e-6;
    p->report->rate_hz = p->opt->rate_hz > 0 ? p->opt->rate_hz : p->line.rate_hz;
    return 1;
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

static int open_face(player *p)
{
    if (!find_bank(&p->bank, p->opt->bank, p->report))
        return 0;
    snprintf(p->report->face, sizeof p->report->face, "%s", fap_bank_name(p->bank));
    const fap_err err = fap_face_open(&p->face, p->bank, &p->opt->face);
    if (err)
        return fault_set(&p->report->fault, EXIT_DATA, "%s: this face cannot be posed: %s", p->report->face,
                         fap_strerror(err));
    const size_t floats = 3 * fap_face_stride(p->face);
    p->position = aligned_alloc(32, 2 * floats * sizeof(float));
    if (!p->position)
        return fault_set(&p->report->fault, EXIT_DATA, "out of memory");
    p->normal = p->opt->sink->needs_picture ? p->position + floats : NULL;
    return 1;
}

/* --- which frames --- */

/* The part of --frames that the stream has. */
static int clip_range(player *p, int64_t *from, int64_t *to)
{
    const int64_t count = timeline_frame_count(&p->line, p->report->rate_hz);

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
    const fap_err err = renderer_create(&p->renderer, o->gl, p->bank, o->width, o->height, where);
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
    return 1;
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
        .bank = p->bank,
    };
    p->sink_state = calloc(1, o->sink->state_size);
    if (!p->sink_state)
        return fault_set(&p->report->fault, EXIT_DATA, "out of memory");
    return o->sink->open(p->sink_state, &p->setup, &p->report->fault);
}

static void pose(player *p, int64_t number)
{
    fap_frame frame;
    fap_face_stats stats;

    timeline_sample(&p->line, timeline_time_us(number, p->report->rate_hz), &frame);
    fap_face_pose(p->face, &frame, p->position, p->normal);
    fap_face_points(p->face, p->point);
    fap_face_last_stats(p->face, &stats);
    p->report->error_mm = fmax(p->report->error_mm, stats.target_error_mm);
    p->report->residual_mm = fmax(p->report->residual_mm, stats.residual_error_mm);
}

static int draw(player *p)
{
    if (!p->renderer)
        return 1;
    const render_scene scene = { p->position, p->normal, .view = render_view_of(p->opt->camera) };
    const fap_err err = renderer_draw(p->renderer, &scene, &p->picture);
    return err ? fault_set(&p->report->fault, EXIT_DATA, "drawing failed: %s", fap_strerror(err)) : 1;
}

static int show_frame(player *p, int64_t number)
{
    pose(p, number);
    if (!draw(p))
        return 0;
    const shown_frame shown = {
        .number = number,
        .time_s = (double)number / p->report->rate_hz,
        .point = (const float(*)[3])p->point,
        .picture = p->renderer ? &p->picture : NULL,
    };
    return p->opt->sink->show(p->sink_state, &shown, &p->report->fault);
}

static int show_all(player *p)
{
    progress bar;
    int ok = 1;

    progress_start(&bar, p->opt->sink->name, p->plan.count);
    for (int64_t i = 0; ok && i < p->plan.count; i++) {
        ok = show_frame(p, frame_plan_at(&p->plan, i));
        p->report->shown_frames += ok;
        progress_step(&bar, i + 1);
    }
    progress_end(&bar);
    return ok;
}

static void close_all(player *p)
{
    if (p->sink_state)
        p->opt->sink->close(p->sink_state);
    free(p->sink_state);
    image_free(&p->picture);
    renderer_destroy(&p->renderer);
    free(p->position);
    fap_face_close(&p->face);
    fap_bank_close(&p->bank);
    timeline_free(&p->line);
    fap_fit_close(&p->fit);
}

void play_run(const play_options *o, play_report *r)
{
    player p = { .opt = o, .report = r };

    if (load_stream(&p) && check_sound(&p) && open_face(&p) && make_plan(&p) && open_renderer(&p) &&
        open_sink(&p) && show_all(&p))
        o->sink->finish(p.sink_state, &r->result, &r->fault);
    close_all(&p);
}
