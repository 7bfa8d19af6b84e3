/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How long a pose takes. On build/default.fbank where it has been made, else on the built-in face; the same
 * frames of smooth random FAPs every run.
 */
#include <math.h>
#include <stdlib.h>

#include <fap/face.h>

#include "bench.h"
#include "takes.h"

enum { FRAMES = 200, MODELS = 20, SEEDS = 10, PARTS = 3 };

typedef struct rig {
    fap_bank *bank;
    fap_face *face;
    float *position, *normal;
} rig;

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
    free(r->position);
    free(r->normal);
}

static int open_rig(rig *r, fap_blend blend, fap_crossover crossover, uint64_t seed)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.crossover = crossover;
    cfg.seed = seed;
    *r = (rig){ .bank = bench_bank() };
    if (!r->bank || fap_face_open(&r->face, r->bank, &cfg) != FAP_OK) {
        close_rig(r);
        return 0;
    }
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

    if (!open_rig(&r, blend, FAP_CROSSOVER_LINE, 1))
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

/* --- Zhu 2006, table 3.1 --- */

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static int population(const fap_bank *bank, int *key)
{
    int n = 0;

    for (int k = 0; k < fap_bank_key_count(bank) && n < 256; k++)
        if (fap_bank_key_get(bank, k)->kind != FAP_KEY_UNIT)
            key[n++] = k;
    return n;
}

/* A model that is not in the bank: three of its keys, mixed, as FAPs would state it. */
static void unseen(const fap_bank *bank, uint32_t seed, fap_frame *frame)
{
    int key[256], count = population(bank, key), part[PARTS];
    float weight[PARTS];

    for (int i = 0; i < PARTS; i++) {
        part[i] = key[next(&seed) % (uint32_t)count];
        weight[i] = 0.1f + 0.5f * (float)(next(&seed) % 1000) / 1000;
    }
    *frame = (fap_frame){ 0 };
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        float mm = 0;
        if (info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z)
            continue;
        for (int i = 0; i < PARTS; i++)
            mm += weight[i] *
                  fap_bank_key_get(bank, part[i])->point_mm[info->point][info->motion - FAP_MOTION_X];
        frame->state[fap] = FAP_CODED;
        frame->value[fap] =
            (int32_t)lrintf((float)info->sign * mm / fap_fapu_step(fap_bank_fapu(bank), info->unit));
    }
}

static double fitness_of_seed(fap_blend blend, fap_crossover crossover, uint64_t seed)
{
    rig r;
    double sum = 0;

    if (!open_rig(&r, blend, crossover, seed))
        return -1e9;
    for (uint32_t model = 1; model <= MODELS; model++) {
        fap_frame frame;
        fap_face_stats stats;
        unseen(r.bank, 7919 * model, &frame);
        fap_face_pose(r.face, &frame, r.position, NULL);
        fap_face_last_stats(r.face, &stats);
        sum += stats.fitness;
    }
    close_rig(&r);
    return sum / MODELS;
}

static double fitness(fap_blend blend, fap_crossover crossover)
{
    double sum = 0;

    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        sum += fitness_of_seed(blend, crossover, seed);
    return sum / SEEDS;
}

double bench_zhu_fitness_midpoint(void)
{
    return fitness(FAP_BLEND_ZHU, FAP_CROSSOVER_MIDPOINT);
}

double bench_zhu_fitness_line(void)
{
    return fitness(FAP_BLEND_ZHU, FAP_CROSSOVER_LINE);
}

double bench_zhu_fitness_blx(void)
{
    return fitness(FAP_BLEND_ZHU, FAP_CROSSOVER_BLX);
}

double bench_ga_fitness(void)
{
    return fitness_of_seed(FAP_BLEND_GA, FAP_CROSSOVER_LINE, 1);
}
