/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What is left of ARKit's coefficients that have been FAPs: of real takes, as coefficients, on the default face, and on ICT-FaceKit,
 * whose shapes are the coefficients' own.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/studio/coefficients.h>

#include "bench.h"
#include "common/file.h"
#include "ict.h"
#include "takes.h"

enum { MAX_BYTES = 64 << 20, MM_STEP = 10 }; /* every tenth frame is posed */
static const double least_mm = 0.1;          /* vertices that move less are not looked at */

static const char *const files[] = { "alex_rom_3.csv", "MySlate_164_iPhone_cal.csv", "dao.gesichter" };
enum { TAKES = sizeof files / sizeof *files };

typedef struct mean {
    double sum, count;
} mean;

static void add(mean *m, double value)
{
    m->sum += value;
    m->count++;
}

static double of(const mean *m)
{
    return m->count > 0 ? m->sum / m->count : -1;
}

/* The frames of a take at its own rate, as read. NULL: it is not there. */
static fap_performance *read_take(const char *name)
{
    char path[256];
    uint8_t *data;
    size_t size;
    fap_coefficients *take;
    fap_coefficients_config cfg;
    fap_performance *p = NULL;

    snprintf(path, sizeof path, "../shared/data/takes/livelink/%s", name);
    if (file_read(path, MAX_BYTES, &data, &size) != FAP_OK)
        return NULL;
    fap_coefficients_config_init(&cfg);
    if (fap_coefficients_read(&take, data, size, NULL, NULL) == FAP_OK) {
        cfg.rate_hz = take->rate_hz;
        if (fap_coefficients_encode(&p, take, &cfg, NULL) != FAP_OK)
            p = NULL;
    }
    fap_coefficients_close(&take);
    free(data);
    return p;
}

/* The mean over all takes of what @p measure says of every frame's coefficients before and after. */
static double each_frame(uint32_t step,
                         void (*measure)(void *user, const fap_arkit *from, const fap_arkit *to, mean *m),
                         void *user)
{
    fap_arkit_fit *fit;
    mean all = { 0, 0 };

    if (fap_arkit_fit_open(&fit, NULL) != FAP_OK)
        return -1;
    for (int i = 0; i < TAKES; i++) {
        fap_performance *p = read_take(files[i]);
        mean m = { 0, 0 };
        for (uint32_t f = 0; p && f < fap_performance_report(p)->frames; f += step) {
            fap_arkit back;
            fap_arkit_from_faps(fit, &fap_performance_frames(p)[f], &back);
            measure(user, &fap_performance_arkit(p)[f], &back, &m);
        }
        if (p)
            bench_note(files[i], of(&m), step == 1 ? "share" : "mm");
        if (m.count > 0)
            add(&all, of(&m));
        fap_performance_close(&p);
    }
    fap_arkit_fit_close(&fit);
    return of(&all);
}

/* --- as coefficients --- */

static void compare_shapes(void *user, const fap_arkit *from, const fap_arkit *to, mean *m)
{
    (void)user;
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        add(m, fabs((double)from->shape[s] - (double)to->shape[s]));
}

double bench_arkit_roundtrip_error(void)
{
    return each_frame(1, compare_shapes, NULL);
}

/* --- on the default face --- */

typedef struct poser {
    fap_bank *bank;
    fap_face *face;
    size_t stride;
    float *from, *to;
} poser;

static double distance(const float *a, const float *b, size_t stride, uint32_t v)
{
    const double x = (double)a[v] - (double)b[v], y = (double)a[stride + v] - (double)b[stride + v],
                 z = (double)a[2 * stride + v] - (double)b[2 * stride + v];
    return sqrt(x * x + y * y + z * z);
}

static void pose(const poser *p, const fap_arkit *arkit, float *out)
{
    fap_frame frame = { .number = 0 };
    fap_arkit still = *arkit;

    still.has_head = 0; /* turning it moves every vertex, and loses nothing */
    fap_arkit_to_faps(&still, &frame);
    fap_face_pose(p->face, &frame, out, NULL);
}

static void compare_poses(void *user, const fap_arkit *from, const fap_arkit *to, mean *m)
{
    const poser *p = user;
    const fap_mesh *mesh = fap_bank_mesh(p->bank);

    pose(p, from, p->from);
    pose(p, to, p->to);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (distance(p->from, mesh->position, p->stride, v) >= least_mm)
            add(m, distance(p->from, p->to, p->stride, v));
}

double bench_arkit_roundtrip_mm(void)
{
    poser p = { .bank = bench_bank() };
    double mm = -1;

    if (p.bank && fap_face_open(&p.face, p.bank, NULL) == FAP_OK) {
        p.stride = fap_face_stride(p.face);
        p.from = aligned_alloc(32, 3 * p.stride * sizeof *p.from);
        p.to = aligned_alloc(32, 3 * p.stride * sizeof *p.to);
        if (p.from && p.to)
            mm = each_frame(MM_STEP, compare_poses, &p);
    }
    free(p.from);
    free(p.to);
    fap_face_close(&p.face);
    fap_bank_close(&p.bank);
    return mm;
}

/* --- on ICT-FaceKit's shapes --- */

typedef struct shapes {
    ict face;
    int shape[ICT_UNITS_MAX]; /* ARKit's number of each; -1: none */
    float (*from)[3], (*to)[3];
} shapes;

/* "mouthSmile_L"; "browInnerUp_L" is half of one that ARKit does not divide. */
static int shape_of(const char *name)
{
    char full[64];
    const size_t length = strlen(name), stem = length > 2 && name[length - 2] == '_' ? length - 2 : length;

    snprintf(full, sizeof full, "%.*s%s", (int)stem, name,
             stem == length            ? ""
             : name[length - 1] == 'L' ? "Left"
                                       : "Right");
    if (fap_arkit_by_name(full) >= 0)
        return fap_arkit_by_name(full);
    full[stem] = '\0';
    return fap_arkit_by_name(full);
}

static void move(const shapes *s, const fap_arkit *arkit, float (*out)[3])
{
    memset(out, 0, s->face.vertex_count * sizeof *out);
    for (int u = 0; u < s->face.unit_count; u++) {
        const float w = s->shape[u] >= 0 ? arkit->shape[s->shape[u]] : 0;
        for (uint32_t v = 0; w != 0 && v < s->face.vertex_count; v++)
            for (int axis = 0; axis < 3; axis++)
                out[v][axis] += w * s->face.delta[u][v][axis];
    }
}

static double length(const float a[3], const float b[3])
{
    const double x = (double)a[0] - (double)b[0], y = (double)a[1] - (double)b[1],
                 z = (double)a[2] - (double)b[2];
    return sqrt(x * x + y * y + z * z);
}

static void compare_shapes_mm(void *user, const fap_arkit *from, const fap_arkit *to, mean *m)
{
    static const float nowhere[3] = { 0 };
    const shapes *s = user;

    move(s, from, s->from);
    move(s, to, s->to);
    for (uint32_t v = 0; v < s->face.vertex_count; v++)
        if (s->face.face[v] && length(s->from[v], nowhere) >= least_mm)
            add(m, length(s->from[v], s->to[v]));
}

static int open_shapes(shapes *s)
{
    if (!ict_open(&s->face))
        return 0;
    for (int u = 0; u < s->face.unit_count; u++)
        s->shape[u] = shape_of(s->face.name[u]);
    s->from = calloc(s->face.vertex_count, sizeof *s->from);
    s->to = calloc(s->face.vertex_count, sizeof *s->to);
    return s->from && s->to;
}

static void close_shapes(shapes *s)
{
    free(s->from);
    free(s->to);
    ict_close(&s->face);
}

double bench_arkit_roundtrip_ict_mm(void)
{
    static shapes s;
    const double mm = open_shapes(&s) ? each_frame(MM_STEP, compare_shapes_mm, &s) : -1;

    close_shapes(&s);
    return mm;
}

/* --- the same shapes against ICT-FaceKit as a bank that FAPs move --- */

typedef struct played {
    shapes shapes;
    poser poser;
} played;

/* What ICT's loader leaves out says nothing on either side. */
static fap_arkit without_eyes(const fap_arkit *in)
{
    fap_arkit out = *in;

    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        if (!strncmp(fap_arkit_name(s), "EyeLook", 7) || !strcmp(fap_arkit_name(s), "MouthClose"))
            out.shape[s] = 0;
    memset(out.angle, 0, sizeof out.angle);
    return out;
}

static void compare_played(void *user, const fap_arkit *from, const fap_arkit *to, mean *m)
{
    static const float nowhere[3] = { 0 };
    const played *p = user;
    const shapes *s = &p->shapes;
    const fap_mesh *mesh = fap_bank_mesh(s->face.bank);
    const size_t stride = p->poser.stride;
    const fap_arkit shown = without_eyes(from);

    (void)to;
    move(s, &shown, s->from);
    pose(&p->poser, &shown, p->poser.from);
    for (uint32_t v = 0; v < s->face.vertex_count; v++) {
        float by_faps[3];
        for (size_t axis = 0; axis < 3; axis++)
            by_faps[axis] = p->poser.from[axis * stride + v] - mesh->position[axis * stride + v];
        if (s->face.face[v] && length(s->from[v], nowhere) >= least_mm)
            add(m, length(s->from[v], by_faps));
    }
}

double bench_arkit_played_ict_mm(void)
{
    static played p;
    double mm = -1;

    if (open_shapes(&p.shapes) && fap_face_open(&p.poser.face, p.shapes.face.bank, NULL) == FAP_OK) {
        p.poser.stride = fap_face_stride(p.poser.face);
        p.poser.from = aligned_alloc(32, 3 * p.poser.stride * sizeof *p.poser.from);
        if (p.poser.from)
            mm = each_frame(MM_STEP, compare_played, &p);
    }
    free(p.poser.from);
    fap_face_close(&p.poser.face);
    close_shapes(&p.shapes);
    return mm;
}
