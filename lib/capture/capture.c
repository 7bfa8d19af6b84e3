/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The order of things: crop, clean, resample, map, head, neutral, axes, points, FAPU, FAPs. See
 * <fap/studio/capture.h>.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "capture/performance.h"

/* Of a point of the take, at rest, head axes. */
typedef struct marker_place {
    uint8_t known, on_face;
    float mm[3];
    fap_capture_spot spot;
} marker_place;

struct fap_capture {
    fap_allocator alloc;
    fap_frame *frames;
    uint8_t (*seen)[FAP_POINT_COUNT]; /* [report.frames], a fap_sample each */
    marker_place *place;              /* [report.take_points] */
    float (*moved)[4];                /* [report.frames][report.take_points]: x, y, z, seen */
    double face_scale;
    fap_clean_point *cleaned; /* [report.take_points] */
    fap_capture_report report;
};

void fap_capture_config_init(fap_capture_config *cfg)
{
    *cfg = (fap_capture_config){
        .struct_size = sizeof *cfg, .rate_hz = 25, .neutral_frame = -1, .neutral_last = -1, .fill = FAP_FILL_ALL
    };
}

const char *fap_origin_name(fap_origin origin)
{
    switch (origin) {
    case FAP_ORIGIN_GIVEN: return "given";
    case FAP_ORIGIN_SET: return "marker set";
    case FAP_ORIGIN_FOUND: return "found";
    case FAP_ORIGIN_MEASURED: return "measured";
    case FAP_ORIGIN_SCALED: return "typical, scaled";
    case FAP_ORIGIN_BANK: return "bank, scaled";
    case FAP_ORIGIN_NONE: break;
    }
    return "none";
}

const char *fap_how_name(fap_how how)
{
    switch (how) {
    case FAP_HOW_DIRECT: return "direct";
    case FAP_HOW_RBF: return "RBF";
    case FAP_HOW_DERIVED: return "derived";
    case FAP_HOW_COPIED: return "copied";
    case FAP_HOW_NONE: break;
    }
    return "none";
}

fap_err performance_fail(performance *p, fap_err err, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    vsnprintf(p->where, FAP_ERROR_TEXT_SIZE, fmt, args);
    va_end(args);
    return err;
}

void performance_note(performance *p, const char *fmt, ...)
{
    if (p->report->note_count == FAP_TAKE_MAX_NOTES)
        return;
    va_list args;
    va_start(args, fmt);
    vsnprintf(p->report->note[p->report->note_count++], FAP_TAKE_NOTE_SIZE, fmt, args);
    va_end(args);
}

/* --- preparing the take --- */

static fap_err crop(performance *p, const fap_take *take, fap_take **out)
{
    const double start = ceil(p->cfg->start_s * take->rate_hz - 1e-6);
    const double end =
        p->cfg->end_s > 0 ? floor(p->cfg->end_s * take->rate_hz + 1e-6) + 1 : take->frame_count;
    const double first = fmax(start, 0), count = fmin(end, take->frame_count) - first;

    if (!(count >= 1))
        return performance_fail(p, FAP_E_ARG, "--start and --end leave nothing of a take of %.2f s",
                                take->frame_count / take->rate_hz);
    const fap_err err = fap_take_create(out, take->point_count, (uint32_t)count, &take->alloc);
    if (err != FAP_OK)
        return err;
    const size_t skip = (size_t)first * take->point_count, samples = (size_t)count * take->point_count;
    memcpy((*out)->name, take->name, take->point_count * sizeof *take->name);
    memcpy((*out)->xyz, take->xyz + skip, samples * sizeof *take->xyz);
    memcpy((*out)->valid, take->valid + skip, samples);
    (*out)->rate_hz = take->rate_hz;
    return FAP_OK;
}

static fap_err clean(performance *p, fap_take *take)
{
    static const uint32_t methods[] = { [FAP_FILL_NONE] = 0,
                                        [FAP_FILL_SPLINE] = FAP_CLEAN_SPLINE,
                                        [FAP_FILL_TAKE] = FAP_CLEAN_TAKE,
                                        [FAP_FILL_ALL] = FAP_CLEAN_TAKE };
    fap_clean_config cfg;

    fap_clean_config_init(&cfg);
    cfg.average = p->cfg->average;
    cfg.methods = (unsigned)p->cfg->fill <= FAP_FILL_ALL ? methods[p->cfg->fill] : 0;
    p->cleaned = fap_mem_calloc(&take->alloc, take->point_count, sizeof *p->cleaned);
    return p->cleaned ? fap_take_clean(take, &cfg, &p->report->clean, p->cleaned) : FAP_E_NOMEM;
}

static fap_err prepare(performance *p, const fap_take *take)
{
    fap_take *cropped;

    if (!(take->rate_hz > 0))
        return performance_fail(p, FAP_E_ARG, "the take does not say its frame rate; give it with --rate");
    const fap_err err = crop(p, take, &cropped);
    if (err != FAP_OK)
        return err;
    fap_err made = clean(p, cropped);
    if (made == FAP_OK)
        made = fap_take_resample(cropped, p->cfg->rate_hz, p->cfg->smooth_hz, &p->take);
    fap_take_close(&cropped);
    if (made != FAP_OK)
        return performance_fail(p, made, "%g frames a second cannot be made of this take", p->cfg->rate_hz);
    p->frames = p->take->frame_count;
    return FAP_OK;
}

static fap_err make_room(performance *p)
{
    const fap_allocator *a = &p->take->alloc;

    p->pose = fap_mem_calloc(a, p->frames, sizeof *p->pose);
    p->posed = fap_mem_calloc(a, p->frames, 1);
    p->place = fap_mem_calloc(a, p->take->point_count, sizeof *p->place);
    p->placed = fap_mem_calloc(a, p->take->point_count, 1);
    p->point = fap_mem_calloc(a, p->frames, sizeof *p->point);
    p->seen = fap_mem_calloc(a, p->frames, sizeof *p->seen);
    p->out = fap_mem_calloc(a, p->frames, sizeof *p->out);
    return p->pose && p->posed && p->place && p->placed && p->point && p->seen && p->out ? FAP_OK
                                                                                         : FAP_E_NOMEM;
}

static void tidy(performance *p, const fap_allocator *alloc)
{
    const fap_allocator a = *alloc;
    fap_mem_free(&a, p->cleaned);
    fap_mem_free(&a, p->pose);
    fap_mem_free(&a, p->posed);
    fap_mem_free(&a, p->place);
    fap_mem_free(&a, p->placed);
    fap_mem_free(&a, p->point);
    fap_mem_free(&a, p->seen);
    fap_mem_free(&a, p->out);
    face_close(p);
    fap_take_close(&p->take);
}

/* --- the chain --- */

static fap_err map_markers(performance *p)
{
    const fap_capture_config *cfg = p->cfg;
    fap_markers *map = &p->report->markers;
    fap_err err = fap_markers_map(map, p->take, cfg->markers, cfg->markers_size, p->where);

    if (err == FAP_E_NOT_FOUND)
        err = unlabelled_map(p);
    if (err != FAP_OK || !cfg->rigid)
        return err;
    return fap_markers_set_rigid(map, p->take, cfg->rigid, p->where);
}

static fap_err understand_face(performance *p)
{
    fap_err err = head_find(p);

    if (err == FAP_OK)
        err = neutral_find(p);
    if (err == FAP_OK)
        err = axes_find(p);
    if (err != FAP_OK)
        return err;
    rings_assign(p);
    points_place(p);
    err = fapu_settle(p);
    if (err == FAP_OK)
        err = points_by_bank(p);
    points_ease(p);
    if (err == FAP_OK)
        err = points_retarget(p);
    if (err == FAP_OK)
        gaze_settle(p);
    return err;
}

static fap_err encode(performance *p, const fap_take *take)
{
    fap_capture_report *r = p->report;

    r->format = take->format;
    r->take_rate_hz = take->rate_hz;
    r->take_frames = take->frame_count;
    r->take_points = take->point_count;
    r->take_length_s = take->rate_hz > 0 ? take->frame_count / take->rate_hz : 0;
    r->rate_hz = p->cfg->rate_hz;
    fap_err err = prepare(p, take);
    if (err == FAP_OK)
        err = make_room(p);
    if (err == FAP_OK)
        err = map_markers(p);
    if (err == FAP_OK)
        err = understand_face(p);
    if (err != FAP_OK)
        return err;
    faps_extract(p);
    r->frames = p->frames;
    return FAP_OK;
}

static int has_faps(const fap_capture_report *r)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (r->fap[fap].coded)
            return 1;
    return 0;
}

static void keep_spot(marker_place *m, const face_spot *spot)
{
    m->on_face = spot->known && spot->share[0] + spot->share[1] + spot->share[2] > 0.5f;
    m->spot.off_mm = (float)spot->off_mm;
    for (int i = 0; i < 3; i++) {
        m->spot.mm[i] = (float)spot->at[i];
        m->spot.vertex[i] = spot->vertex[i];
        m->spot.share[i] = spot->share[i];
    }
}

static fap_err keep_places(fap_capture *c, const performance *p)
{
    const uint32_t n = p->take->point_count;

    c->face_scale = p->face.scale;
    c->place = fap_mem_calloc(&c->alloc, n, sizeof *c->place);
    c->moved = fap_mem_calloc(&c->alloc, (size_t)n * p->frames, sizeof *c->moved);
    if (!c->place || !c->moved)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < n; i++) {
        c->place[i].known = head_place(p, i, c->place[i].mm) != 0;
        keep_spot(&c->place[i], &p->face.spot[i]);
    }
    for (uint32_t f = 0; f < p->frames; f++)
        for (uint32_t i = 0; i < n; i++) {
            float *m = c->moved[(size_t)f * n + i];
            m[3] = marker_moved(p, f, i, m) ? 1 : 0;
        }
    return FAP_OK;
}

static void forget(fap_capture *c)
{
    const fap_allocator a = c->alloc;

    fap_mem_free(&a, c->frames);
    fap_mem_free(&a, c->seen);
    fap_mem_free(&a, c->place);
    fap_mem_free(&a, c->cleaned);
    fap_mem_free(&a, c->moved);
    fap_mem_free(&a, c);
}

fap_err fap_capture_encode(fap_capture **out, const fap_take *take, const fap_capture_config *cfg,
                           char *where)
{
    char text[FAP_ERROR_TEXT_SIZE] = "";
    fap_capture_config defaults;

    *out = NULL;
    fap_capture_config_init(&defaults);
    fap_capture *c = fap_mem_calloc(&take->alloc, 1, sizeof *c);
    if (!c)
        return FAP_E_NOMEM;
    c->alloc = take->alloc;
    performance p = { .cfg = cfg ? cfg : &defaults, .report = &c->report, .where = text };
    fap_err err = encode(&p, take);
    if (err == FAP_OK && !has_faps(&c->report))
        err = performance_fail(&p, FAP_E_NOT_FOUND, "the markers are known, but none of them carries a FAP");
    if (err == FAP_OK)
        err = keep_places(c, &p);
    if (err == FAP_OK) {
        c->frames = p.out;
        c->seen = p.seen;
        c->cleaned = p.cleaned;
        p.cleaned = NULL;
        p.out = NULL;
        p.seen = NULL;
        *out = c;
    } else {
        forget(c);
        if (where)
            memcpy(where, text, sizeof text);
    }
    tidy(&p, &take->alloc);
    return err;
}

const fap_frame *fap_capture_frames(const fap_capture *c)
{
    return c->frames;
}

const fap_clean_point *fap_capture_clean_points(const fap_capture *c)
{
    return c->cleaned;
}

fap_sample fap_capture_fill_of(const fap_capture *c, uint32_t frame, int fap)
{
    if (frame >= c->report.frames || fap < 1 || fap > FAP_COUNT || c->frames[frame].state[fap] != FAP_CODED)
        return FAP_SAMPLE_MISSING;
    const int point = c->report.fap[fap].point;
    return point < 0 ? FAP_SAMPLE_MEASURED : (fap_sample)c->seen[frame][point];
}

const fap_capture_report *fap_capture_report_get(const fap_capture *c)
{
    return &c->report;
}

int fap_capture_marker_place(const fap_capture *c, uint32_t point, float xyz_mm[3])
{
    if (point >= c->report.take_points || !c->place[point].known)
        return 0;
    memcpy(xyz_mm, c->place[point].mm, sizeof c->place[point].mm);
    return 1;
}

int fap_capture_marker_on_face(const fap_capture *c, uint32_t point, fap_capture_spot *out)
{
    if (point >= c->report.take_points || !c->place[point].on_face)
        return 0;
    *out = c->place[point].spot;
    return 1;
}

double fap_capture_face_scale(const fap_capture *c)
{
    return c->face_scale;
}

int fap_capture_marker_moved(const fap_capture *c, uint32_t frame, uint32_t point, float xyz_mm[3])
{
    if (frame >= c->report.frames || point >= c->report.take_points)
        return 0;
    const float *m = c->moved[(size_t)frame * c->report.take_points + point];
    memcpy(xyz_mm, m, 3 * sizeof *m);
    return m[3] > 0;
}

void fap_capture_close(fap_capture **c)
{
    if (!*c)
        return;
    forget(*c);
    *c = NULL;
}
