/* SPDX-License-Identifier: BSD-2-Clause */
/* See <fap/studio/tracks.h>. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/tracks.h>

#include "base/mem.h"
#include "track/vector.h"

/* A face's distance where no ruler says it: arm's length. */
static const double usual_distance_mm = 600;

typedef struct placing {
    const fap_tracks *t;
    const fap_tracks_config *cfg;
    fap_tracks_report *report;
    char *where;
    double f_px, tolerance;  /* pixels of a ray; as a ray */
    fap_mirror_views *views; /* [frames * labels] */
    double (*place)[3];      /* the same, camera coordinates */
    uint8_t *placed;
    fap_mirror_pair *pair;   /* work: all pairs of a mirror */
    fap_tracks_label *label; /* [labels], the caller's where there is one */
} placing;

void fap_tracks_config_init(fap_tracks_config *cfg)
{
    *cfg = (fap_tracks_config){ .struct_size = sizeof *cfg, .ruler = { -1, -1 }, .tolerance_px = 2.5 };
}

static fap_err fail(placing *p, fap_err err, const char *text)
{
    snprintf(p->where, FAP_ERROR_TEXT_SIZE, "%s", text);
    return err;
}

/* --- pixels to rays --- */

static const fap_track_point *point_of(const fap_tracks *t, size_t at, int view)
{
    return &t->point[at * FAP_TRACKS_VIEWS + (size_t)view];
}

static void make_rays(placing *p)
{
    const fap_tracks *t = p->t;

    for (size_t at = 0; at < (size_t)t->frames * (size_t)t->labels; at++)
        for (int view = 0; view <= t->mirrors; view++) {
            const fap_track_point *k = point_of(t, at, view);
            p->views[at].seen[view] = t->has[at % (size_t)t->labels * FAP_TRACKS_VIEWS + (size_t)view] &&
                                      k->state == FAP_TRACK_SEEN;
            fap_camera_ray(&p->cfg->camera, (const double[2]){ k->x_px, k->y_px }, p->views[at].ray[view]);
        }
}

/* --- mirrors --- */

static int collect_pairs(const placing *p, int mirror)
{
    enum { ENOUGH = 20000 };
    const size_t count = (size_t)p->t->frames * (size_t)p->t->labels, step = count / ENOUGH + 1;
    int found = 0;

    /* Labels in turn: a step that were a multiple of their number would always meet the same one. */
    for (size_t at = 0; at < count; at += step + (step > 1 && step % (size_t)p->t->labels == 0)) {
        const fap_mirror_views *v = &p->views[at];
        if (!v->seen[0] || !v->seen[1 + mirror])
            continue;
        memcpy(p->pair[found].direct, v->ray[0], sizeof v->ray[0]);
        memcpy(p->pair[found].mirrored, v->ray[1 + mirror], sizeof v->ray[0]);
        found++;
    }
    return found;
}

static fap_err find_mirrors(placing *p)
{
    fap_mirror_plane *m = p->report->mirror;
    const int count = (int)((size_t)p->t->frames * (size_t)p->t->labels);
    char why[FAP_ERROR_TEXT_SIZE];

    for (int i = 0; i < p->t->mirrors; i++) {
        const fap_err err =
            fap_mirror_find(&m[i], p->pair, collect_pairs(p, i), p->tolerance, &p->report->fit[i], why);
        if (err == FAP_OK)
            continue;
        snprintf(p->where, FAP_ERROR_TEXT_SIZE, "mirror %d: %.150s", i + 1, why);
        return err;
    }
    if (p->t->mirrors == 2 && !fap_mirror_join(m, p->views, count))
        return fail(p, FAP_E_DATA,
                    "no point is seen directly and in both mirrors: their distances cannot be compared");
    /* Ever more by those that agree: a dot wrongly followed in one view is wrong in many pictures. */
    for (double tolerance = p->tolerance; p->t->mirrors && tolerance > 0.05 * p->tolerance; tolerance /= 4)
        fap_mirror_refine(m, p->t->mirrors, p->views, count, tolerance);
    return FAP_OK;
}

/* --- places --- */

/* Without mirrors every place is as far away as the next. */
static int flat_place(const fap_mirror_views *v, double place[3])
{
    if (!v->seen[0])
        return 0;
    place[0] = v->ray[0][0];
    place[1] = v->ray[0][1];
    place[2] = 1;
    return 1;
}

/* Views that contradict each other by more than this show two things, or a wrong one. */
static int agree(const placing *p, double off_px)
{
    return off_px <= 2 * p->cfg->tolerance_px;
}

static int locate(const placing *p, size_t at, double *off_px)
{
    double off = 0;
    const int found =
        p->t->mirrors ? fap_mirror_locate(p->report->mirror, p->t->mirrors, &p->views[at], p->place[at], &off)
                      : flat_place(&p->views[at], p->place[at]);
    *off_px = off * p->f_px;
    return found && agree(p, *off_px);
}

static void locate_all(placing *p, fap_tracks_label *label)
{
    const size_t labels = (size_t)p->t->labels;
    double all = 0, off;
    uint64_t count = 0;

    for (size_t at = 0; at < p->t->frames * labels; at++) {
        fap_tracks_label *l = &label[at % labels];
        l->seen += p->views[at].seen[0];
        p->placed[at] = (uint8_t)locate(p, at, &off);
        if (!p->placed[at])
            continue;
        l->placed++;
        l->rms_px += off * off;
        all += off * off;
        count++;
    }
    p->report->rms_px = count ? sqrt(all / (double)count) : 0;
    for (size_t i = 0; i < labels; i++)
        if (label[i].placed)
            label[i].rms_px = sqrt(label[i].rms_px / label[i].placed);
}

/* --- sizes --- */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The middle one of the ruler's lengths. 0: never seen; -1: no memory. */
static double ruler_length(placing *p)
{
    const fap_allocator *a = &p->cfg->alloc;
    const size_t labels = (size_t)p->t->labels;
    double *length = fap_mem_calloc(a, p->t->frames, sizeof *length);
    uint32_t found = 0;

    if (!length)
        return -1;
    for (size_t f = 0; f < p->t->frames; f++) {
        const size_t one = f * labels + (size_t)p->cfg->ruler[0],
                     other = f * labels + (size_t)p->cfg->ruler[1];
        double gap[3];
        if (!p->placed[one] || !p->placed[other])
            continue;
        memcpy(gap, p->place[one], sizeof gap);
        add_scaled3(gap, p->place[other], -1);
        length[found++] = sqrt(dot3(gap, gap));
    }
    qsort(length, found, sizeof *length, by_size);
    const double middle = found ? length[found / 2] : 0;
    p->report->ruler_frames = found;
    fap_mem_free(a, length);
    return middle;
}

static double mean_distance(const placing *p)
{
    double sum = 0;
    size_t count = 0;

    for (size_t at = 0; at < p->t->frames * (size_t)p->t->labels; at++)
        if (p->placed[at]) {
            sum += p->place[at][2];
            count++;
        }
    return count ? sum / (double)count : 0;
}

static fap_err find_scale(placing *p, double *scale)
{
    const double distance = mean_distance(p);

    if (!(distance > 0))
        return fail(p, FAP_E_DATA, "no point is seen in two views of one frame");
    *scale = usual_distance_mm / distance;
    if (p->cfg->ruler[0] >= 0) {
        const double length = ruler_length(p);
        if (length < 0)
            return FAP_E_NOMEM;
        if (!(length > 0))
            return fail(p, FAP_E_DATA, "the ruler's ends are never placed together: no size can be told");
        *scale = p->cfg->ruler_mm / length;
        p->report->mm_per_unit = *scale;
    }
    p->report->distance_mm = distance * *scale;
    fap_mirror_scale(p->report->mirror, p->t->mirrors, *scale);
    return FAP_OK;
}

/* --- strays --- */

static int is_ruler(const fap_tracks_config *cfg, int label)
{
    return label == cfg->ruler[0] || label == cfg->ruler[1];
}

/*
 * A dot that was mistaken for another for long is smooth, and two views of it may well agree; but skin does not stretch without end, so
 * what is much farther from most of its neighbours than it usually is, or much nearer, is somewhere else.
 */
enum { NEIGHBOURS = 5, LOOKED_AT = 64 };
static const double most_stretch_mm = 6;

static double gap(const placing *p, size_t frame, int one, int other)
{
    const size_t row = frame * (size_t)p->t->labels;
    double way[3];

    memcpy(way, p->place[row + (size_t)one], sizeof way);
    add_scaled3(way, p->place[row + (size_t)other], -1);
    return sqrt(dot3(way, way));
}

static int both_placed(const placing *p, size_t frame, int one, int other)
{
    const uint8_t *row = p->placed + frame * (size_t)p->t->labels;

    return row[one] && row[other];
}

/* The middle one of the distances in pictures all over the take; INFINITY: they are hardly ever placed together. */
static double usual_gap(const placing *p, int one, int other)
{
    const size_t step = p->t->frames / LOOKED_AT + 1;
    double length[LOOKED_AT + 1];
    size_t found = 0;

    for (size_t f = 0; f < p->t->frames && found <= LOOKED_AT; f += step)
        if (both_placed(p, f, one, other))
            length[found++] = gap(p, f, one, other);
    qsort(length, found, sizeof *length, by_size);
    return found > 2 ? length[found / 2] : INFINITY;
}

typedef struct neighbour {
    int label;
    double gap;
} neighbour;

static int find_neighbours(const placing *p, int label, neighbour found[NEIGHBOURS])
{
    int count = 0;

    for (int other = 0; other < p->t->labels; other++) {
        const double usual =
            other == label || is_ruler(p->cfg, other) ? INFINITY : usual_gap(p, label, other);
        int at = count < NEIGHBOURS ? count : NEIGHBOURS - 1;
        if (!(usual < INFINITY) || (count == NEIGHBOURS && usual >= found[at].gap))
            continue;
        for (; at > 0 && usual < found[at - 1].gap; at--)
            found[at] = found[at - 1];
        found[at] = (neighbour){ other, usual };
        count += count < NEIGHBOURS;
    }
    return count;
}

/* By how much its neighbours' distances have changed, without the one that changed most: that neighbour may be the stray. */
static int is_stray(const placing *p, size_t frame, int label, const neighbour *near, int count, double scale)
{
    double changed = 0, most = 0, usual = 0;
    int asked = 0;

    for (int i = 0; i < count; i++) {
        if (!both_placed(p, frame, label, near[i].label))
            continue;
        const double by = scale * (gap(p, frame, label, near[i].label) - near[i].gap);
        changed += by * by;
        most = fmax(most, by * by);
        usual += scale * near[i].gap;
        asked++;
    }
    return asked > 2 && sqrt((changed - most) / (asked - 1)) > most_stretch_mm + 0.05 * usual / asked;
}

/* Marked first and dropped later: where one is a stray, its neighbours are not to be judged by whoever is left. */
static void drop_strays(placing *p, double scale)
{
    enum { STRAY = 2 };
    const size_t labels = (size_t)p->t->labels;
    neighbour near[NEIGHBOURS];

    for (int label = 0; label < p->t->labels; label++) {
        const int count = is_ruler(p->cfg, label) ? 0 : find_neighbours(p, label, near);
        for (size_t f = 0; count && f < p->t->frames; f++) {
            uint8_t *placed = &p->placed[f * labels + (size_t)label];
            if (*placed && is_stray(p, f, label, near, count, scale))
                *placed = STRAY;
        }
    }
    for (size_t at = 0; at < p->t->frames * labels; at++) {
        if (p->placed[at] != STRAY)
            continue;
        p->placed[at] = 0;
        p->label[at % labels].placed--;
        p->label[at % labels].strays++;
    }
}

/* --- the take --- */

/* From the camera's axes to the face's: it looks at the lens. */
static void put(fap_take *take, uint32_t frame, uint32_t point, const double place[3], double scale, int flat)
{
    const float at[3] = { (float)(place[0] * scale), (float)(-place[1] * scale),
                          flat ? 0 : (float)(-place[2] * scale) };
    fap_take_set(take, frame, point, at);
}

static fap_err make_take(const placing *p, double scale, fap_take **out)
{
    const fap_tracks *t = p->t;
    const uint32_t rulers = p->cfg->ruler[0] >= 0 ? 2 : 0;
    fap_take *take;
    uint32_t point = 0;

    const fap_err err = fap_take_create(&take, (uint32_t)t->labels - rulers, t->frames, &p->cfg->alloc);
    if (err != FAP_OK)
        return err;
    take->rate_hz = t->rate_hz;
    take->mm_per_unit = 1;
    take->unit_known = p->report->mm_per_unit > 0;
    for (int label = 0; label < t->labels; label++) {
        if (is_ruler(p->cfg, label))
            continue;
        snprintf(take->name[point], FAP_TAKE_NAME_SIZE, "%s", t->name[label]);
        for (uint32_t f = 0; f < t->frames; f++) {
            const size_t at = (size_t)f * (size_t)t->labels + (size_t)label;
            if (p->placed[at])
                put(take, f, point, p->place[at], scale, !t->mirrors);
        }
        point++;
    }
    *out = take;
    return FAP_OK;
}

/* --- the whole --- */

static fap_err make_room(placing *p)
{
    const fap_allocator *a = &p->cfg->alloc;
    const size_t count = (size_t)p->t->frames * (size_t)p->t->labels;

    if (count > FAP_TAKE_MAX_SAMPLES / 4)
        return FAP_E_LIMIT;
    p->views = fap_mem_calloc(a, count, sizeof *p->views);
    p->place = fap_mem_calloc(a, count, sizeof *p->place);
    p->placed = fap_mem_calloc(a, count, 1);
    p->pair = fap_mem_calloc(a, count, sizeof *p->pair);
    p->label =
        p->report->label ? p->report->label : fap_mem_calloc(a, (size_t)p->t->labels, sizeof *p->label);
    return p->views && p->place && p->placed && p->pair && p->label ? FAP_OK : FAP_E_NOMEM;
}

static void tidy(placing *p)
{
    const fap_allocator *a = &p->cfg->alloc;

    fap_mem_free(a, p->views);
    fap_mem_free(a, p->place);
    fap_mem_free(a, p->placed);
    fap_mem_free(a, p->pair);
    if (p->label != p->report->label)
        fap_mem_free(a, p->label);
}

static fap_err place(placing *p, fap_take **take)
{
    double scale;

    fap_err err = make_room(p);
    if (err != FAP_OK)
        return err;
    make_rays(p);
    err = find_mirrors(p);
    if (err != FAP_OK)
        return err;
    locate_all(p, p->label);
    err = find_scale(p, &scale);
    if (err != FAP_OK)
        return err;
    if (p->t->mirrors)
        drop_strays(p, scale);
    return make_take(p, scale, take);
}

static int is_valid(const fap_tracks *t, const fap_tracks_config *cfg)
{
    const int *r = cfg->ruler;
    const int has_ruler = r[0] >= 0 && r[1] >= 0;

    return t->labels > (has_ruler ? 2 : 0) && t->frames > 0 && t->mirrors >= 0 &&
           t->mirrors <= FAP_MIRROR_MAX && r[0] < t->labels && r[1] < t->labels && (r[0] < 0) == (r[1] < 0) &&
           (!has_ruler || r[0] != r[1]) && (!has_ruler || cfg->ruler_mm > 0) && cfg->camera.fx_px > 0 &&
           cfg->camera.fy_px > 0 && cfg->tolerance_px > 0;
}

fap_err fap_tracks_place(fap_take **take, const fap_tracks *tracks, const fap_tracks_config *cfg,
                         fap_tracks_report *report, char *where)
{
    fap_tracks_config own = *cfg;
    fap_tracks_label *const label = report->label;

    *take = NULL;
    *where = '\0';
    own.alloc = fap_mem_allocator(&cfg->alloc);
    *report = (fap_tracks_report){ .label = label };
    if (!is_valid(tracks, cfg))
        return FAP_E_ARG;
    if (label)
        memset(label, 0, (size_t)tracks->labels * sizeof *label);
    placing p = { .t = tracks, .cfg = &own, .report = report, .where = where };
    p.f_px = (cfg->camera.fx_px + cfg->camera.fy_px) / 2;
    p.tolerance = cfg->tolerance_px / p.f_px;
    const fap_err err = place(&p, take);
    for (int i = 0; i < FAP_MIRROR_MAX; i++)
        report->fit[i].residual *= p.f_px;
    tidy(&p);
    return err;
}
