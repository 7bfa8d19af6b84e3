/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How well and how fast dots are followed between two mirrors: films drawn by tests/track, whose truth is known. Lin, Yeh, Ouhyoung
 * 2001 have 1.95 mm in the mean square, 2.94 mm at most, at 30 pictures a second.
 */
#include <stdlib.h>
#include <string.h>

#include <fap/studio/tracks.h>

#include "bench.h"
#include "common/bank_file.h"
#include "tests/track/compare.h"
#include "tests/track/film.h"

enum { COLUMNS = FILM_DOTS * FAP_TRACKS_VIEWS };

/* A second of film and a half: as clean as it gets; as a small camera in a room has it. */
static const struct scenery {
    const char *name;
    double noise, shutter;
    int hides;
} sceneries[] = { { "clean", 0, 0, 0 },
                  { "noise 3 of 255, half a frame's blur, a hand before the mouth", 3, 0.5, 1 } };

enum { SCENERIES = sizeof sceneries / sizeof *sceneries };

typedef struct trial {
    film *film;
    uint8_t *rgb;
    film_dot dot[FILM_DOTS];
    uint8_t has[COLUMNS];
    int count, column[COLUMNS];
    double at[COLUMNS][2];
    fap_tracker *tracker;
    fap_track_point *point; /* [frames][COLUMNS] */
    fap_take *truth, *take;
    int frames;
    double busy_s;
} trial;

/* Measured once, asked for four times. */
typedef struct measured {
    int done, well;
    take_difference difference[SCENERIES];
    double fps;
} measured;

static int make(trial *t, const struct scenery *s, const fap_bank *bank)
{
    film_config cfg;

    film_config_init(&cfg);
    cfg.seconds = 1.5;
    cfg.samples = 4;
    cfg.noise = s->noise;
    cfg.shutter = s->shutter;
    cfg.hides = s->hides;
    t->film = film_open(&cfg, bank);
    if (!t->film)
        return 0;
    t->frames = film_frames(t->film);
    t->rgb = malloc(3 * (size_t)cfg.width_px * (size_t)cfg.height_px);
    t->point = calloc((size_t)t->frames, sizeof *t->point * COLUMNS);
    if (!t->rgb || !t->point || fap_take_create(&t->truth, FILM_DOTS, (uint32_t)t->frames, NULL) != FAP_OK)
        return 0;
    t->truth->rate_hz = cfg.rate_hz;
    for (int i = 0; i < FILM_DOTS; i++)
        strncpy(t->truth->name[i], film_dot_name(i), FAP_TAKE_NAME_SIZE - 1);
    return 1;
}

/* What somebody would click on: what is shown. */
static void click(trial *t)
{
    for (int i = 0; i < COLUMNS; i++) {
        const film_dot *d = &t->dot[i / FAP_TRACKS_VIEWS];
        const int view = i % FAP_TRACKS_VIEWS;
        t->has[i] = d->shown[view] > 0.6;
        if (!t->has[i])
            continue;
        memcpy(t->at[t->count], d->pixel[view], sizeof *t->at);
        t->column[t->count++] = i;
    }
}

static void keep(trial *t, int frame)
{
    for (int i = 0; i < t->count; i++)
        t->point[(size_t)frame * COLUMNS + (size_t)t->column[i]] = fap_tracker_points(t->tracker)[i];
    for (uint32_t i = 0; i < FILM_DOTS; i++) {
        const double *p = t->dot[i].place;
        fap_take_set(t->truth, (uint32_t)frame, i,
                     (const float[3]){ (float)p[0], (float)-p[1], (float)-p[2] });
    }
}

static int follow(trial *t)
{
    const fap_camera *cam = film_camera(t->film);
    const fap_picture picture = { t->rgb, cam->width_px, cam->height_px, 3 * (size_t)cam->width_px };

    for (int f = 0; f < t->frames; f++) {
        film_draw(t->film, f, t->rgb, t->dot);
        if (!f)
            click(t);
        const double begin = bench_now_s();
        const fap_err err =
            f ? fap_tracker_step(t->tracker, &picture, 1)
              : fap_tracker_open(&t->tracker, NULL, &picture, (const double(*)[2])t->at, t->count);
        if (err != FAP_OK)
            return 0;
        t->busy_s += f ? bench_now_s() - begin : 0;
        keep(t, f);
    }
    return 1;
}

static int place(trial *t)
{
    const char *name[FILM_DOTS];
    char where[FAP_ERROR_TEXT_SIZE];
    fap_tracks_report report = { .label = NULL };
    fap_tracks_config cfg;

    for (int i = 0; i < FILM_DOTS; i++)
        name[i] = film_dot_name(i);
    const fap_tracks tracks = { .labels = FILM_DOTS,
                                .mirrors = 2,
                                .frames = (uint32_t)t->frames,
                                .rate_hz = t->truth->rate_hz,
                                .name = name,
                                .has = t->has,
                                .point = t->point };
    fap_tracks_config_init(&cfg);
    cfg.camera = *film_camera(t->film);
    cfg.ruler[0] = FILM_DOTS - 2;
    cfg.ruler[1] = FILM_DOTS - 1;
    cfg.ruler_mm = 100;
    return fap_tracks_place(&t->take, &tracks, &cfg, &report, where) == FAP_OK;
}

static void tidy(trial *t)
{
    fap_tracker_close(&t->tracker);
    fap_take_close(&t->take);
    fap_take_close(&t->truth);
    film_close(&t->film);
    free(t->rgb);
    free(t->point);
    free(t);
}

static int try_scenery(int which, const fap_bank *bank, measured *m)
{
    trial *t = calloc(1, sizeof *t);

    if (!t)
        return 0;
    const int well = make(t, &sceneries[which], bank) && follow(t) && place(t) &&
                     take_compare(t->truth, t->take, &m->difference[which]);
    if (well && !which)
        m->fps = (t->frames - 1) / t->busy_s;
    tidy(t);
    return well;
}

/* The default face where it has been made; its skin has more to be mistaken for a dot. */
static fap_bank *open_bank(void)
{
    char path[BANK_PATH_SIZE], where[FAP_ERROR_TEXT_SIZE];
    fap_bank *bank = NULL;

    if (bank_file_default(path) && bank_file_read(&bank, path, where) == FAP_OK)
        return bank;
    return fap_bank_builtin(&bank, NULL) == FAP_OK ? bank : NULL;
}

static const measured *measure(void)
{
    static measured m;

    if (m.done)
        return &m;
    fap_bank *bank = open_bank();
    m.done = 1;
    m.well = bank != NULL;
    for (int i = 0; m.well && i < SCENERIES; i++)
        m.well = try_scenery(i, bank, &m);
    fap_bank_close(&bank);
    return &m;
}

double bench_mirror_rms_mm(void)
{
    const measured *m = measure();

    for (int i = 0; m->well && i < SCENERIES; i++)
        bench_note(sceneries[i].name, m->difference[i].rms_mm, "mm");
    return m->well ? m->difference[SCENERIES - 1].rms_mm : -1;
}

double bench_mirror_max_mm(void)
{
    const measured *m = measure();

    for (int i = 0; m->well && i < SCENERIES; i++)
        bench_note(sceneries[i].name, m->difference[i].max_mm, "mm");
    return m->well ? m->difference[SCENERIES - 1].max_mm : -1;
}

double bench_mirror_placed_share(void)
{
    const take_difference *d = &measure()->difference[SCENERIES - 1];

    return measure()->well ? d->samples / (double)(d->samples + d->missing) : -1;
}

double bench_track_fps(void)
{
    return measure()->well ? measure()->fps : -1;
}
