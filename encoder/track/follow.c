/* SPDX-License-Identifier: BSD-2-Clause */
/* See follow.h. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/tool.h"
#include "encoder/track/follow.h"

/* The tracker knows places, not dots and views: which is which. */
typedef struct places {
    int count;
    int column[FAP_TRACK_MAX_POINTS]; /* dot * FAP_TRACKS_VIEWS + view */
    double at[FAP_TRACK_MAX_POINTS][2];
} places;

typedef struct following {
    video_in *video;
    const fap_track_dots *dots;
    double radius_px;
    overlay *over;
    fault *f;
    followed *out;
    places where;
    fap_tracker *tracker;
    uint32_t room; /* frames */
} following;

static uint64_t now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000 + (uint64_t)t.tv_nsec / 1000;
}

static size_t row_size(const following *w)
{
    return (size_t)w->dots->count * FAP_TRACKS_VIEWS;
}

static void list_places(places *p, const fap_track_dots *dots)
{
    p->count = 0;
    for (int i = 0; i < dots->count; i++)
        for (int view = 0; view < FAP_TRACKS_VIEWS; view++)
            if (dots->dot[i].has[view]) {
                p->column[p->count] = i * FAP_TRACKS_VIEWS + view;
                memcpy(p->at[p->count++], dots->dot[i].at_px[view], sizeof *p->at);
            }
}

/* --- the first picture --- */

static int outside(const following *w)
{
    static const char *const view[] = { "", " in mirror 1", " in mirror 2" };
    const fap_picture *p = &w->video->picture;

    for (int i = 0; i < w->where.count; i++) {
        const double *at = w->where.at[i];
        if (at[0] < 0 || at[1] < 0 || at[0] > p->width_px - 1 || at[1] > p->height_px - 1)
            return fault_set(
                w->f, EXIT_DATA, "%s%s at %g, %g is outside of the picture, which has %d x %d pixels",
                w->dots->dot[w->where.column[i] / FAP_TRACKS_VIEWS].name,
                view[w->where.column[i] % FAP_TRACKS_VIEWS], at[0], at[1], p->width_px, p->height_px);
    }
    return fault_set(w->f, EXIT_DATA, "the dots cannot be followed");
}

static int open_tracker(following *w)
{
    fap_tracker_config cfg;

    fap_tracker_config_init(&cfg);
    cfg.radius_px = w->radius_px;
    const fap_err err = fap_tracker_open(&w->tracker, &cfg, &w->video->picture,
                                         (const double(*)[2])w->where.at, w->where.count);
    if (err == FAP_OK)
        return 1;
    return err == FAP_E_ARG ? outside(w) : fault_set(w->f, EXIT_DATA, "%s", fap_strerror(err));
}

/* --- every picture --- */

static int make_room(following *w)
{
    if (w->out->frames < w->room)
        return 1;
    const uint32_t room = w->room ? 2 * w->room : 512;
    if (room > FAP_TAKE_MAX_SAMPLES / row_size(w))
        return fault_set(w->f, EXIT_DATA, "%s: too long for %d dots; --start and --end cut it",
                         w->video->path, w->dots->count);
    fap_track_point *more = realloc(w->out->point, room * row_size(w) * sizeof *more);
    if (!more)
        return fault_set(w->f, EXIT_DATA, "out of memory");
    w->out->point = more;
    w->room = room;
    return 1;
}

static int keep(following *w)
{
    const fap_track_point *now = fap_tracker_points(w->tracker);

    if (!make_room(w))
        return 0;
    fap_track_point *row = w->out->point + w->out->frames++ * row_size(w);
    memset(row, 0, row_size(w) * sizeof *row);
    for (int i = 0; i < w->where.count; i++)
        row[w->where.column[i]] = now[i];
    return overlay_draw(w->over, &w->video->picture, w->tracker, w->where.count, w->f);
}

static int step(following *w)
{
    const uint64_t begin = now_us();
    const fap_err err = fap_tracker_step(w->tracker, &w->video->picture, w->video->fields ? 0.5 : 1);

    w->out->busy_us += now_us() - begin;
    return err == FAP_OK || fault_set(w->f, EXIT_DATA, "%s: picture %u has another size than the first",
                                      w->video->path, w->video->pictures);
}

static int follow_all(following *w)
{
    progress bar;

    if (!video_in_next(w->video, w->f) || !open_tracker(w) || !keep(w))
        return 0;
    w->out->width_px = w->video->picture.width_px;
    w->out->height_px = w->video->picture.height_px;
    progress_start(&bar, "following", w->video->expected);
    int well = 1;
    while (well && video_in_next(w->video, w->f)) {
        well = step(w) && keep(w);
        progress_step(&bar, w->out->frames);
    }
    progress_end(&bar);
    return w->f->exit_status == EXIT_OK;
}

int follow(followed *out, video_in *v, const fap_track_dots *dots, double radius_px, overlay *o, fault *f)
{
    following *w = calloc(1, sizeof *w);

    *out = (followed){ 0 };
    if (!w)
        return fault_set(f, EXIT_DATA, "out of memory");
    *w = (following){ .video = v, .dots = dots, .radius_px = radius_px, .over = o, .f = f, .out = out };
    list_places(&w->where, dots);
    const int well = follow_all(w);
    fap_tracker_close(&w->tracker);
    free(w);
    if (!well)
        followed_free(out);
    return well;
}

void followed_free(followed *out)
{
    free(out->point);
    out->point = NULL;
}
