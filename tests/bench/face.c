/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How long a pose takes. On build/default.fbank where it has been made, else on the built-in face; the same frames of
 * smooth random FAPs every run.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/face.h>

#include "bench.h"

enum { FRAMES = 200 };

typedef struct rig {
    fap_bank *bank;
    fap_face *face;
    float *position, *normal;
} rig;

static size_t take(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

static fap_bank *load(void)
{
    fap_bank *bank = NULL;
    FILE *f = fopen("build/default.fbank", "rb");
    fap_err err = FAP_E_IO;

    if (f) {
        const fap_reader reader = { take, f };
        err = fap_bank_read(&bank, &reader, NULL);
        fclose(f);
    }
    if (err)
        err = fap_bank_builtin(&bank, NULL);
    return err ? NULL : bank;
}

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
    free(r->position);
    free(r->normal);
}

static int open_rig(rig *r, fap_blend blend)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    *r = (rig){ .bank = load() };
    double t0=bench_now_s(); if (!r->bank || fap_face_open(&r->face, r->bank, &cfg) != FAP_OK) {
        close_rig(r);
        return 0;
    }
    if(getenv("T"))printf("face open %g ms\n",1e3*(bench_now_s()-t0));
    const size_t bytes = 3 * fap_face_stride(r->face) * sizeof(float);
    r->position = aligned_alloc(32, bytes);
    r->normal = aligned_alloc(32, bytes);
    return 1;
}

static void wave(fap_frame *frame, int t)
{
    *frame = (fap_frame){ .number = t, .pts_us = 40000 * (int64_t)t };
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        frame->state[fap] = FAP_CODED;
        frame->value[fap] = (int32_t)lrint(150 * sin(0.05 * t * (1 + fap % 5) + fap));
    }
}

/* Microseconds a frame. */
static double measure(fap_blend blend, int with_normals)
{
    rig r;

    if (!open_rig(&r, blend))
        return -1;
    const double start = bench_now_s();
    for (int t = 0; t < FRAMES; t++) {
        fap_frame frame;
        wave(&frame, t);
        fap_face_pose(r.face, &frame, r.position, with_normals ? r.normal : NULL);
    }
    const double seconds = bench_now_s() - start;
    close_rig(&r);
    return 1e6 * seconds / FRAMES;
}

double bench_face_ga_us(void)
{
    return measure(FAP_BLEND_GA, 0);
}

double bench_face_qp_us(void)
{
    return measure(FAP_BLEND_QP, 0);
}

double bench_face_zhu_us(void)
{
    return measure(FAP_BLEND_ZHU, 0);
}

double bench_face_normals_us(void)
{
    const double without = measure(FAP_BLEND_QP, 0), with = measure(FAP_BLEND_QP, 1);
    return without < 0 || with < 0 ? -1 : with - without;
}
