/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What is left of markers that have been FAPs: a real take is encoded, the default face plays it, and its skin is looked at
 * where the markers would be glued to it. Along axes that have a FAP the face should do what the marker did; along the
 * others nobody told it; and coding in between adds its steps. Everything in millimetres of the performer's face.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/face.h>
#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"
#include "takes.h"

static const struct source {
    const char *path;
    double rate_hz; /* where the file says none */
} sources[] = {
    { "../shared/data/takes/optical_animface/jaw_60hz.c3d", 0 },
    { "../shared/data/takes/optical_animface/eyebrows_60hz_nexus.csv", 0 },
    { "../shared/data/takes/optical_blenderface/Subject_01.csv", 25 },
    { "../shared/data/takes/openface/openfacer_lara_0001-0600.csv", 0 },
    { "../shared/data/takes/openface/OpenFace_Test.csv", 25 },
    { "../shared/data/takes/mediapipe/wolfgang_facemesh478_24fps.csv", 0 },
    { "../shared/data/takes/mediapipe/face_noface_facemesh478.csv", 0 },
};

enum { SOURCES = sizeof sources / sizeof *sources };

/* Distances, and what they are of. */
typedef struct values {
    float *value;
    size_t count, room;
} values;

static void add_value(values *v, double value)
{
    if (v->count == v->room) {
        const size_t room = 2 * v->room + 4096;
        float *larger = realloc(v->value, room * sizeof *larger);
        if (!larger)
            return;
        v->value = larger;
        v->room = room;
    }
    v->value[v->count++] = (float)value;
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double mean_of(const values *v)
{
    double sum = 0;

    for (size_t i = 0; i < v->count; i++)
        sum += (double)v->value[i];
    return v->count ? sum / (double)v->count : -1;
}

/* Sorts. */
static double share_of(values *v, double share)
{
    if (!v->count)
        return -1;
    qsort(v->value, v->count, sizeof *v->value, by_size);
    return (double)v->value[(size_t)(share * (double)(v->count - 1))];
}

/* --- a take and its face --- */

typedef struct played {
    fap_bank *bank;
    fap_face *face;
    fap_capture *capture;
    const fap_capture_report *report;
    bench_take coded; /* as it comes out of a .fba */
    float *position;
    size_t stride;
    int8_t fap[FAP_POINT_COUNT][3]; /* the FAP along each axis of a feature point; 0: none */
} played;

static void find_axes(played *p)
{
    memset(p->fap, 0, sizeof p->fap);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const fap_capture_fap *f = &p->report->fap[fap];
        const int axis = fap_info_get(fap)->motion - FAP_MOTION_X;
        if (f->coded && f->point >= 0 && axis >= 0 && axis < 3)
            p->fap[f->point][axis] = (int8_t)fap;
    }
}

static fap_err encode_take(played *p, const struct source *s, const uint8_t *data, size_t size)
{
    fap_capture_config cfg;
    fap_take *take;
    fap_err err = fap_take_read(&take, data, size, NULL, NULL);

    if (err != FAP_OK)
        return err;
    if (!(take->rate_hz > 0))
        take->rate_hz = s->rate_hz;
    fap_capture_config_init(&cfg);
    cfg.bank = p->bank;
    err = fap_capture_encode(&p->capture, take, &cfg, NULL);
    fap_take_close(&take);
    return err;
}

static int open_take(played *p, const struct source *s)
{
    uint8_t *data = NULL;
    size_t size = 0;
    const int ok =
        file_read(s->path, 1 << 26, &data, &size) == FAP_OK && encode_take(p, s, data, size) == FAP_OK;

    free(data);
    if (!ok)
        return 0;
    p->report = fap_capture_report_get(p->capture);
    find_axes(p);
    return 1;
}

static int open_played(played *p, const struct source *s)
{
    *p = (played){ .bank = bench_bank() };
    if (!p->bank || fap_face_open(&p->face, p->bank, NULL) != FAP_OK || !open_take(p, s))
        return 0;
    p->stride = fap_face_stride(p->face);
    p->position = aligned_alloc(32, 3 * p->stride * sizeof *p->position);
    return p->position != NULL;
}

static void close_played(played *p)
{
    free(p->position);
    free(p->coded.frame);
    free(p->coded.data);
    fap_capture_close(&p->capture);
    fap_face_close(&p->face);
    fap_bank_close(&p->bank);
}

/* --- markers on the face --- */

/* Without the head's turning: the markers are told without it. */
static void pose(played *p, const fap_frame *frame)
{
    fap_frame still = *frame;

    for (int fap = 48; fap <= 50; fap++)
        still.state[fap] = FAP_ABSENT;
    fap_face_pose(p->face, &still, p->position, NULL);
}

/* How far the skin below a marker went, along an axis, in millimetres of the take. */
static double skin_moved(const played *p, const fap_capture_spot *spot, int axis, int fap)
{
    const fap_mesh *mesh = fap_bank_mesh(p->bank);
    const float *now = p->position + (size_t)axis * p->stride;
    const float *rest = mesh->position + (size_t)axis * mesh->stride;
    double sum = 0;

    for (int i = 0; i < 3; i++)
        sum += (double)(spot->share[i] * (now[spot->vertex[i]] - rest[spot->vertex[i]]));
    if (!fap)
        return sum / fap_capture_face_scale(p->capture);
    const fap_unit unit = fap_info_get(fap)->unit;
    return sum *
           (double)(fap_fapu_step(&p->report->fapu, unit) / fap_fapu_step(fap_bank_fapu(p->bank), unit));
}

/* What is to be known of each marker of a feature point, in each frame and along each axis. */
typedef void visit(played *p, uint32_t frame, uint32_t marker, const fap_capture_spot *spot,
                   const int8_t fap[3], values *out);

static void visit_markers(played *p, uint32_t frame, visit *v, values *out)
{
    for (int point = 0; point < FAP_POINT_COUNT; point++) {
        const fap_marker_source *s = &p->report->markers.point[point];
        fap_capture_spot spot;
        for (int k = 0; k < s->count; k++)
            if (fap_capture_marker_on_face(p->capture, (uint32_t)s->index[k], &spot))
                v(p, frame, (uint32_t)s->index[k], &spot, p->fap[point], out);
    }
}

static void along_faps(played *p, uint32_t frame, uint32_t marker, const fap_capture_spot *spot,
                       const int8_t fap[3], values *out)
{
    float moved[3];

    if (!fap_capture_marker_moved(p->capture, frame, marker, moved))
        return;
    for (int axis = 0; axis < 3; axis++)
        if (fap[axis] && fap_capture_frames(p->capture)[frame].state[fap[axis]] == FAP_CODED)
            add_value(out, fabs(skin_moved(p, spot, axis, fap[axis]) - (double)moved[axis]));
}

static void along_others(played *p, uint32_t frame, uint32_t marker, const fap_capture_spot *spot,
                         const int8_t fap[3], values *out)
{
    float moved[3];

    if (!fap_capture_marker_moved(p->capture, frame, marker, moved) || !(fap[0] || fap[1] || fap[2]))
        return;
    for (int axis = 0; axis < 3; axis++)
        if (!fap[axis])
            add_value(out, fabs(skin_moved(p, spot, axis, 0) - (double)moved[axis]));
}

static void places_along_faps(played *p, uint32_t frame, uint32_t marker, const fap_capture_spot *spot,
                              const int8_t fap[3], values *out)
{
    (void)frame;
    (void)marker;
    for (int axis = 0; axis < 3; axis++)
        if (fap[axis])
            add_value(out, skin_moved(p, spot, axis, fap[axis]));
}

/* --- through a stream --- */

static int code_take(played *p)
{
    fap_encoder_config cfg;
    fap_decoder *d;
    fap_frame f;
    bench_take *t = &p->coded;

    for (uint32_t i = 0; i < p->report->frames; i++)
        if (!bench_take_add_frame(t, &fap_capture_frames(p->capture)[i]))
            return 0;
    t->rate_hz = p->report->rate_hz;
    fap_encoder_config_init(&cfg);
    if (!bench_take_encode(t, &cfg, NULL) || fap_decoder_open(&d, NULL) != FAP_OK)
        return 0;
    int count = 0;
    if (fap_decoder_send(d, t->data, t->size) == FAP_OK)
        while (count < t->count && fap_decoder_receive(d, &f) == FAP_OK)
            t->frame[count++] = f;
    fap_decoder_close(&d);
    return count == t->count;
}

/* --- figures --- */

static void measure_errors(played *p, visit *v, values *out)
{
    for (uint32_t f = 0; f < p->report->frames; f++) {
        pose(p, &fap_capture_frames(p->capture)[f]);
        visit_markers(p, f, v, out);
    }
}

static void measure_coding(played *p, values *out)
{
    values before = { 0 }, after = { 0 };

    for (uint32_t f = 0; f < p->report->frames; f++) {
        pose(p, &fap_capture_frames(p->capture)[f]);
        visit_markers(p, f, places_along_faps, &before);
        pose(p, &p->coded.frame[f]);
        visit_markers(p, f, places_along_faps, &after);
    }
    for (size_t i = 0; i < before.count && i < after.count; i++)
        add_value(out, fabs((double)before.value[i] - (double)after.value[i]));
    free(before.value);
    free(after.value);
}

static const char *file_name(const char *path)
{
    return strrchr(path, '/') + 1;
}

static void note(const struct source *s, const char *what, double mm)
{
    char name[96];

    snprintf(name, sizeof name, "%.60s %s", file_name(s->path), what);
    bench_note(name, mm, "mm");
}

static int measure_source(const struct source *s, visit *v, values *all)
{
    values one = { 0 };
    played p;

    const int ok = open_played(&p, s) && (v || code_take(&p));
    if (ok && v)
        measure_errors(&p, v, &one);
    else if (ok)
        measure_coding(&p, &one);
    close_played(&p);
    if (one.count) {
        note(s, "mean", mean_of(&one));
        note(s, "p95", share_of(&one, 0.95));
        note(s, "max", share_of(&one, 1));
    }
    for (size_t i = 0; i < one.count; i++)
        add_value(all, (double)one.value[i]);
    free(one.value);
    return ok;
}

/* @p share: 0 the mean. */
static double measure(visit *v, double share)
{
    values all = { 0 };

    for (int i = 0; i < SOURCES; i++)
        measure_source(&sources[i], v, &all);
    const double value = share > 0 ? share_of(&all, share) : mean_of(&all);
    free(all.value);
    return value;
}

double bench_reencode_error_mm(void)
{
    return measure(along_faps, 0);
}

double bench_reencode_axes_mm(void)
{
    return measure(along_others, 0);
}

double bench_reencode_quant_mm(void)
{
    return measure(NULL, 1);
}
