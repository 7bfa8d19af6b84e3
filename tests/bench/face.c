/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How long blending and posing take, how well the genetic algorithms do in the thesis's own measure, how much a still
 * face trembles. On build/default.fbank where it has been made, else on the built-in face; the same input every run.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bench.h"
#include "bank/pca.h"
#include "bank/qp.h"
#include "base/mem.h"
#include "takes.h"

enum { BATCHES = 40, FRAMES = 20, MODELS = 20, SEEDS = 10, PARTS = 3, QP_TARGETS = 50, QP_ROWS = 180 };

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

static int open_rig(rig *r, const fap_face_config *cfg)
{
    *r = (rig){ .bank = bench_bank() };
    if (!r->bank || fap_face_open(&r->face, r->bank, cfg) != FAP_OK) {
        close_rig(r);
        return 0;
    }
    const size_t bytes = 3 * fap_face_stride(r->face) * sizeof(float);
    r->position = aligned_alloc(32, bytes);
    r->normal = aligned_alloc(32, bytes);
    return r->position && r->normal;
}

static fap_face_config config(fap_blend blend, int regions)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.regions = regions;
    return cfg;
}

void bench_wave(fap_frame *frame, int t, int step)
{
    *frame = (fap_frame){ .number = t, .pts_us = 40000 * (int64_t)t };
    for (int fap = 3; fap <= FAP_COUNT; fap += step) {
        frame->state[fap] = FAP_CODED;
        frame->value[fap] = (int32_t)lrint(150 * sin(0.05 * t * (1 + fap % 5) + fap));
    }
}

/* Microseconds a frame; the best of a few batches, others use the machine, too. */
static double measure(fap_blend blend, int regions, int with_normals)
{
    const fap_face_config cfg = config(blend, regions);
    double best = INFINITY;
    rig r;

    if (!open_rig(&r, &cfg))
        return -1;
    for (int b = 0; b < BATCHES; b++) {
        const double start = bench_now_s();
        for (int t = 0; t < FRAMES; t++) {
            fap_frame frame;
            bench_wave(&frame, FRAMES * b + t, 1);
            fap_face_pose(r.face, &frame, r.position, with_normals ? r.normal : NULL);
        }
        best = fmin(best, (bench_now_s() - start) / FRAMES);
    }
    close_rig(&r);
    return 1e6 * best;
}

double bench_blend_us_ga(void)
{
    return measure(FAP_BLEND_GA, 1, 0);
}

double bench_blend_us_ga4(void)
{
    return measure(FAP_BLEND_GA, 4, 0);
}

double bench_blend_us_qp(void)
{
    return measure(FAP_BLEND_QP, 1, 0);
}

double bench_blend_us_zhu(void)
{
    return measure(FAP_BLEND_ZHU, 1, 0);
}

double bench_blend_us_zhu4(void)
{
    return measure(FAP_BLEND_ZHU, 4, 0);
}

double bench_pose_us_default(void)
{
    return measure(FAP_BLEND_GA, 1, 1);
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

/* A model that is not in the bank: three of its keys, mixed; all feature points, as the thesis takes them. */
static void unseen(const fap_bank *bank, uint32_t seed, float mm[FAP_POINT_COUNT][3])
{
    int key[256], count = population(bank, key);

    memset(mm, 0, FAP_POINT_COUNT * sizeof *mm);
    for (int i = 0; i < PARTS; i++) {
        const fap_key *part = fap_bank_key_get(bank, key[next(&seed) % (uint32_t)count]);
        const float weight = 0.1f + 0.5f * (float)(next(&seed) % 1000) / 1000;
        for (int k = 0; k < 3 * FAP_POINT_COUNT; k++)
            mm[k / 3][k % 3] += weight * part->point_mm[k / 3][k % 3];
    }
}

static double fitness_of_seed(fap_face_config cfg, uint64_t seed)
{
    uint8_t wanted[FAP_POINT_COUNT][3];
    float mm[FAP_POINT_COUNT][3];
    double sum = 0;
    rig r;

    cfg.seed = seed;
    if (!open_rig(&r, &cfg))
        return -1e9;
    memset(wanted, 1, sizeof wanted);
    for (uint32_t model = 1; model <= MODELS; model++) {
        fap_face_stats stats;
        unseen(r.bank, 7919 * model, mm);
        fap_face_pose_points(r.face, (const float(*)[3])mm, (const uint8_t(*)[3])wanted, r.position, NULL);
        fap_face_last_stats(r.face, &stats);
        sum += stats.fitness;
    }
    close_rig(&r);
    return sum / MODELS;
}

static double fitness(fap_blend blend, int regions, fap_crossover crossover)
{
    fap_face_config cfg = config(blend, regions);
    double sum = 0;

    cfg.crossover = crossover;
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        sum += fitness_of_seed(cfg, seed);
    return sum / SEEDS;
}

double bench_fitness_zhu_midpoint(void)
{
    return fitness(FAP_BLEND_ZHU, 1, FAP_CROSSOVER_MIDPOINT);
}

double bench_fitness_zhu_line(void)
{
    return fitness(FAP_BLEND_ZHU, 1, FAP_CROSSOVER_LINE);
}

double bench_fitness_zhu_blx(void)
{
    return fitness(FAP_BLEND_ZHU, 1, FAP_CROSSOVER_BLX);
}

double bench_fitness_zhu2(void)
{
    return fitness(FAP_BLEND_ZHU, 2, FAP_CROSSOVER_LINE);
}

double bench_fitness_zhu4(void)
{
    return fitness(FAP_BLEND_ZHU, 4, FAP_CROSSOVER_LINE);
}

double bench_fitness_ga(void)
{
    return fitness(FAP_BLEND_GA, 1, FAP_CROSSOVER_LINE);
}

/* --- trembling --- */

static float tremble(uint32_t *seed)
{
    return 0.1f * ((float)(next(seed) % 20001) / 10000 - 1) * 1.7320508f; /* uniform, RMS 0.1 */
}

/* RMS over vertices and frames of the way from one frame to the next; a still target gives 0. */
static double jitter_mm(float temporal_mm2)
{
    fap_face_config cfg = config(FAP_BLEND_GA, 1);
    uint8_t wanted[FAP_POINT_COUNT][3];
    float mm[FAP_POINT_COUNT][3], noisy[FAP_POINT_COUNT][3], *last;
    double sum = 0;
    uint32_t seed = 5;
    rig r;

    cfg.temporal_mm2 = temporal_mm2;
    cfg.residual = temporal_mm2 <= 0; /* it would put the points on their noise again */
    if (!open_rig(&r, &cfg))
        return -1;
    const uint32_t count = fap_bank_mesh(r.bank)->vertex_count;
    const size_t stride = fap_face_stride(r.face);
    last = r.normal; /* not needed otherwise */
    memset(wanted, 1, sizeof wanted);
    unseen(r.bank, 7919, mm);
    for (int t = 0; t <= FRAMES; t++) {
        for (int k = 0; k < 3 * FAP_POINT_COUNT; k++)
            noisy[k / 3][k % 3] = mm[k / 3][k % 3] + tremble(&seed);
        memcpy(last, r.position, 3 * stride * sizeof *last);
        fap_face_pose_points(r.face, (const float(*)[3])noisy, (const uint8_t(*)[3])wanted, r.position, NULL);
        for (size_t i = 0; i < 3 * stride && t; i++)
            sum += pow(r.position[i] - last[i], 2);
    }
    close_rig(&r);
    return sqrt(sum / ((double)count * FRAMES));
}

double bench_temporal_jitter_mm(void)
{
    return jitter_mm(0);
}

double bench_temporal_jitter_held_mm(void)
{
    return jitter_mm(100);
}

/* --- principal components --- */

static double contribution(int components)
{
    static const int visemes[] = { 1, 2, 10, 11, 13, 14 };
    const fap_allocator alloc = fap_mem_allocator(NULL);
    fap_bank *bank = bench_bank();
    int key[6], count = 0;
    fap_pca pca;

    if (!bank)
        return -1;
    for (int i = 0; i < 6; i++)
        if (fap_bank_key_number(bank, FAP_KEY_VISEME, visemes[i]) >= 0)
            key[count++] = fap_bank_key_number(bank, FAP_KEY_VISEME, visemes[i]);
    const double ccr =
        fap_pca_open(&pca, bank, key, count, 0, &alloc) ? -1 : fap_pca_contribution(&pca, components);
    fap_pca_close(&pca, &alloc);
    fap_bank_close(&bank);
    return ccr;
}

double bench_pca_ccr_1(void)
{
    return contribution(1);
}

double bench_pca_ccr_2(void)
{
    return contribution(2);
}

double bench_pca_ccr_3(void)
{
    return contribution(3);
}

/* --- the exact solver by itself --- */

typedef struct problem {
    double a[QP_ROWS][QP_TARGETS], gram[QP_TARGETS][QP_TARGETS], b[QP_ROWS];
} problem;

static double signed_unit(uint32_t *seed)
{
    return (double)(next(seed) % 20001) / 10000 - 1;
}

static void make_problem(problem *p)
{
    uint32_t seed = 77;

    for (int r = 0; r < QP_ROWS; r++)
        for (int k = 0; k < QP_TARGETS; k++)
            p->a[r][k] = signed_unit(&seed);
    for (int i = 0; i < QP_TARGETS; i++)
        for (int j = 0; j < QP_TARGETS; j++)
            for (int r = 0; r < QP_ROWS; r++)
                p->gram[i][j] += p->a[r][i] * p->a[r][j];
}

/* A target that no weights between 0 and 1 reach, so that bounds matter. */
static void aim_problem(problem *p, uint32_t seed)
{
    double x[QP_TARGETS];

    for (int k = 0; k < QP_TARGETS; k++)
        x[k] = 0.3 + 0.9 * signed_unit(&seed);
    for (int r = 0; r < QP_ROWS; r++) {
        p->b[r] = 0.3 * signed_unit(&seed);
        for (int k = 0; k < QP_TARGETS; k++)
            p->b[r] += p->a[r][k] * x[k];
    }
}

static void solve_problem(const problem *p, fap_qp *qp)
{
    fap_qp_clear(qp, QP_TARGETS);
    for (int r = 0; r < QP_ROWS; r++)
        for (int k = 0; k < QP_TARGETS; k++)
            qp->linear[k] += p->a[r][k] * p->b[r];
    for (int k = 0; k < QP_TARGETS; k++)
        qp->hi[k] = 1;
    for (int i = 0; i < QP_TARGETS; i++)
        memcpy(qp->gram + i * qp->capacity, p->gram[i], sizeof p->gram[i]);
    fap_qp_solve(qp);
}

/* How far the slope at the answer is from what the minimum asks for; 0 at the minimum. */
static double off_optimum(const problem *p, const fap_qp *qp)
{
    double worst = 0;

    for (int i = 0; i < QP_TARGETS; i++) {
        double slope = -qp->linear[i];
        for (int j = 0; j < QP_TARGETS; j++)
            slope += p->gram[i][j] * qp->x[j];
        const double inside = qp->x[i] > 0 && qp->x[i] < 1 ? fabs(slope) : 0;
        worst = fmax(worst, qp->x[i] <= 0 ? -slope : qp->x[i] >= 1 ? slope : inside);
    }
    return worst;
}

double bench_qp_us_50x60(void)
{
    const fap_allocator alloc = fap_mem_allocator(NULL);
    problem *p = calloc(1, sizeof *p);
    fap_qp qp;
    double best = INFINITY, off = 0;

    if (!p || fap_qp_open(&qp, QP_TARGETS, &alloc))
        return -1;
    make_problem(p);
    for (uint32_t b = 1; b <= 20; b++) {
        aim_problem(p, b);
        const double start = bench_now_s();
        for (int i = 0; i < 20; i++)
            solve_problem(p, &qp);
        best = fmin(best, (bench_now_s() - start) / 20);
        off = fmax(off, off_optimum(p, &qp));
    }
    fap_qp_close(&qp, &alloc);
    free(p);
    return off < 1e-6 ? 1e6 * best : -1;
}
