/* SPDX-License-Identifier: BSD-2-Clause */
/* What is left of FAPs that have been ARKit coefficients: 52 numbers are fewer than 66, and none is negative. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/arkit.h>
#include <fap/face.h>

#include "bench.h"
#include "takes.h"

enum { ROUNDS = 20 };
static const double least_mm =
    0.1; /* RMS of all that a stream asks for: one that stands still loses nothing */

static void round_trip(fap_arkit_fit *fit, const fap_frame *from, fap_frame *to)
{
    fap_arkit arkit;

    fap_arkit_from_faps(fit, from, &arkit);
    *to = *from;
    fap_arkit_to_faps(&arkit, to);
}

/* --- at the feature points --- */

typedef struct errors {
    double square, count, asked; /* asked: squares of what was commanded */
} errors;

static void count_frame(fap_arkit_fit *fit, const fap_fapu *fapu, const fap_frame *from,
                        errors group[FAP_GROUPS + 1])
{
    fap_frame to;

    round_trip(fit, from, &to);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const int moves_a_point = info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z;
        const double e = ((double)to.value[fap] - from->value[fap]) * fap_fapu_step(fapu, info->unit);
        if (from->state[fap] == FAP_ABSENT || !moves_a_point)
            continue;
        const double asked = from->value[fap] * (double)fap_fapu_step(fapu, info->unit);
        group[info->group].square += e * e;
        group[info->group].asked += asked * asked;
        group[info->group].count++;
    }
}

static double rms_of(const errors *group, int count)
{
    errors all = { 0 };

    for (int g = 0; g < count; g++) {
        all.square += group[g].square;
        all.asked += group[g].asked;
        all.count += group[g].count;
    }
    return sqrt(all.asked / all.count) >= least_mm ? sqrt(all.square / all.count) : -1;
}

static double measure_stream(fap_arkit_fit *fit, const bench_take *t, const fap_fapu *fapu,
                             errors all[FAP_GROUPS + 1])
{
    errors group[FAP_GROUPS + 1] = { { 0 } };

    for (int i = 0; i < t->count; i++)
        count_frame(fit, fapu, &t->frame[i], group);
    for (int g = 0; g <= FAP_GROUPS; g++) {
        all[g].square += group[g].square;
        all[g].count += group[g].count;
    }
    return rms_of(group, FAP_GROUPS + 1);
}

static void note_groups(const errors group[FAP_GROUPS + 1])
{
    for (int g = 1; g <= FAP_GROUPS; g++) {
        char name[32];
        snprintf(name, sizeof name, "group_%d", g);
        if (group[g].count > 0 && rms_of(&group[g], 1) >= 0)
            bench_note(name, rms_of(&group[g], 1), "mm");
    }
}

double bench_arkit_fap_mm(void)
{
    static bench_takes takes;
    errors group[FAP_GROUPS + 1] = { { 0 } };
    double rms[BENCH_MAX_TAKES];
    int count = 0;
    fap_bank *bank = bench_bank();
    fap_arkit_fit *fit = NULL;

    if (!bank || fap_arkit_fit_open(&fit, NULL) != FAP_OK)
        return -1;
    bench_takes_add_every(&takes);
    for (int i = 0; i < takes.count; i++) {
        const double mm = measure_stream(fit, &takes.take[i], fap_bank_fapu(bank), group);
        if (mm < 0)
            continue; /* nothing, or visemes and expressions alone */
        bench_note(takes.take[i].name, mm, "mm");
        rms[count++] = mm;
    }
    note_groups(group);
    bench_takes_free(&takes);
    fap_arkit_fit_close(&fit);
    fap_bank_close(&bank);
    return bench_median(rms, count);
}

/* --- on the face --- */

typedef struct faces {
    fap_bank *bank;
    fap_face *face;
    fap_arkit_fit *fit;
    size_t stride;
    float *from, *to;
} faces;

static int open_faces(faces *f)
{
    f->bank = bench_bank();
    if (!f->bank || fap_face_open(&f->face, f->bank, NULL) != FAP_OK ||
        fap_arkit_fit_open(&f->fit, NULL) != FAP_OK)
        return 0;
    f->stride = fap_face_stride(f->face);
    f->from = aligned_alloc(32, 3 * f->stride * sizeof *f->from);
    f->to = aligned_alloc(32, 3 * f->stride * sizeof *f->to);
    return f->from && f->to;
}

static void close_faces(faces *f)
{
    free(f->from);
    free(f->to);
    fap_arkit_fit_close(&f->fit);
    fap_face_close(&f->face);
    fap_bank_close(&f->bank);
}

static double distance(const float *a, const float *b, size_t stride, uint32_t v)
{
    const double x = a[v] - b[v], y = a[stride + v] - b[stride + v],
                 z = a[2 * stride + v] - b[2 * stride + v];
    return sqrt(x * x + y * y + z * z);
}

static void compare_frame(const faces *f, const fap_frame *from, errors *sum)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);
    float points[FAP_POINT_COUNT][3];
    fap_frame shown = *from, to;

    fap_face_pose(f->face, from, f->from, NULL);
    fap_face_points(f->face, points);
    fap_face_complete(f->bank, (const float(*)[3])points, &shown);
    round_trip(f->fit, &shown, &to);
    fap_face_pose(f->face, &to, f->to, NULL);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (distance(f->from, mesh->position, f->stride, v) < 0.1)
            continue;
        sum->square += distance(f->from, f->to, f->stride, v); /* a mean, of lengths */
        sum->count++;
    }
}

double bench_arkit_face_mm(void)
{
    static bench_takes takes;
    faces f = { 0 };
    double mm[BENCH_MAX_TAKES];
    int count = 0;
    const int ok = open_faces(&f);

    bench_takes_add_every(&takes);
    for (int i = 0; ok && i < takes.count; i++) {
        errors sum = { 0 };
        for (int k = 0; k < takes.take[i].count; k++)
            compare_frame(&f, &takes.take[i].frame[k], &sum);
        if (sum.count == 0)
            continue;
        mm[count++] = sum.square / sum.count;
        bench_note(takes.take[i].name, sum.square / sum.count, "mm");
    }
    bench_takes_free(&takes);
    close_faces(&f);
    return ok ? bench_median(mm, count) : -1;
}

double bench_arkit_us(void)
{
    static bench_takes takes;
    fap_arkit_fit *fit;
    fap_arkit out;

    bench_takes_add_every(&takes);
    if (!takes.count || fap_arkit_fit_open(&fit, NULL) != FAP_OK)
        return -1;
    const bench_take *demo = &takes.take[takes.count - 1];
    const double start = bench_now_s();
    for (int k = 0; k < ROUNDS; k++)
        for (int i = 0; i < demo->count; i++)
            fap_arkit_from_faps(fit, &demo->frame[i], &out);
    const double us = 1e6 * (bench_now_s() - start) / (ROUNDS * demo->count);
    bench_takes_free(&takes);
    fap_arkit_fit_close(&fit);
    return us;
}
