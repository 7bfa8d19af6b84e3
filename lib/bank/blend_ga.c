/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The default: the thesis's algorithm seeded with the exact answer and counting millimetres. What it finds is
 * taken only where nothing is lost against that answer. Source: DESIGN.md section 5.
 */
#include <math.h>
#include <string.h>

#include "bank/blend_zhu.h"
#include "base/mem.h"

static const float beside_weight = 1;        /* a millimetre at a point nobody speaks of */
static const float worth_it_mm = 0.1f;       /* RMS the GA must gain before it is believed ... */
static const float fully_worth_it_mm = 0.5f; /* ... and before it is believed fully */

enum { SHARE_STEPS = 14 };

typedef struct state {
    fap_least_squares ls;
    fap_zhu zhu;   /* its algorithm, and its answer to compare with */
    float *trial;  /* [FAP_REGION_MAX][key_count] */
    float *before; /* [FAP_REGION_MAX][key_count]: the answer of the pose before */
} state;

/* What the GA compares in a region: rows, where they should go, what a square millimetre counts. */
typedef struct aim {
    int commanded, count; /* commanded rows first */
    uint16_t row[FAP_ROWS];
    float target[3 * FAP_GA_POINTS], weight[3 * FAP_GA_POINTS]; /* 0 behind count */
} aim;

static int open_ga(void *user, const fap_face *face)
{
    state *s = user;
    const size_t n = FAP_REGION_MAX * (size_t)face->key_count;

    s->trial = fap_mem_calloc(&face->alloc, n, sizeof *s->trial);
    s->before = fap_mem_calloc(&face->alloc, n, sizeof *s->before);
    return !s->trial || !s->before || fap_least_squares_open(&s->ls, face) || fap_zhu_open(&s->zhu, face);
}

static void close_ga(void *user, const fap_face *face)
{
    state *s = user;

    fap_least_squares_close(&s->ls, face);
    fap_zhu_close(&s->zhu, face);
    fap_mem_free(&face->alloc, s->trial);
    fap_mem_free(&face->alloc, s->before);
}

static void aim_at(aim *a, int row, float target, float weight)
{
    a->row[a->count] = (uint16_t)row;
    a->target[a->count] = target;
    a->weight[a->count++] = weight;
}

static float share_of(const fap_face *face, int region, int row)
{
    return face->regions.point[region][row / 3];
}

/*
 * Commanded rows at their targets; points nobody speaks of where the exact answer leaves them. Without the
 * latter a raised brow was reached by "surprise", open mouth and all.
 */
static void take_aim(const fap_face *face, int region, const float *weight, aim *a)
{
    memset(a, 0, sizeof *a);
    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        if (share_of(face, region, row) > 0)
            aim_at(a, row, fap_blend_row_target(face, row),
                   share_of(face, region, row) * fap_blend_importance(row));
    }
    a->commanded = a->count;
    for (int row = 0; row < FAP_ROWS; row++) {
        const uint8_t *w = face->wanted[row / 3];
        if (face->solvable[row / 3] && !w[0] && !w[1] && !w[2] && share_of(face, region, row) > 0)
            aim_at(a, row, fap_face_row_motion(face, row, weight),
                   share_of(face, region, row) * beside_weight);
    }
}

static float weighted_rms(const fap_face *face, const aim *a, const float *weight)
{
    float sum = 0;

    for (int r = 0; r < a->commanded; r++) {
        const float e = fap_face_row_motion(face, a->row[r], weight) - a->target[r];
        sum += a->weight[r] * e * e;
    }
    return a->commanded ? sqrtf(sum / (float)a->commanded) : 0;
}

static void add_weights(fap_ga *ga, const fap_face *face, const aim *a, const float *weight)
{
    float *vector, *gene;

    if (!fap_ga_add(ga, &vector, &gene))
        return;
    memcpy(gene, weight, sizeof *gene * (size_t)face->key_count);
    for (int r = 0; r < a->count; r++)
        vector[r] = fap_face_row_motion(face, a->row[r], weight);
}

static void add_key(fap_ga *ga, const fap_face *face, const aim *a, int key)
{
    float *vector, *gene;

    if (!fap_ga_add(ga, &vector, &gene))
        return;
    gene[key] = 1;
    for (int r = 0; r < a->count; r++)
        vector[r] = face->motion[(size_t)a->row[r] * (size_t)face->key_count + (size_t)key];
}

/* @before: the last pose's weights, where they count; or NULL */
static void seed_population(fap_ga *ga, const fap_face *face, const aim *a, const float *weight,
                            const float *before)
{
    fap_ga_clear(ga);
    add_weights(ga, face, a, weight);
    if (before)
        add_weights(ga, face, a, before);
    for (int k = 0; k < face->key_count; k++)
        if (face->population[k])
            add_key(ga, face, a, k);
}

static void mix(const fap_face *face, const float *from, const float *to, float share, float *out)
{
    for (int k = 0; k < face->key_count; k++)
        out[k] = from[k] + share * (to[k] - from[k]);
}

/* Over all regions: neither millimetres nor fitness may be lost. */
static int no_worse(const fap_face *face, const float *a, const float *than)
{
    return fap_blend_squared_error(face, a) <= fap_blend_squared_error(face, than) &&
           fap_blend_fitness(face, a) >= fap_blend_fitness(face, than);
}

/*
 * The exact answer can only be beaten by keys that the units do not span. How far the GA's answer is believed
 * grows smoothly with what it gains, so that a gain that comes and goes does not make the face twitch; the
 * error is convex, so part of the way is never worse than the start.
 */
static float belief(float gain_mm)
{
    const float t = fminf(1, fmaxf(0, (gain_mm - worth_it_mm) / (fully_worth_it_mm - worth_it_mm)));
    return t * t * (3 - 2 * t);
}

static void improve(state *s, fap_face *face, int region)
{
    aim a;
    float score, *own = fap_blend_region(face, face->weight, region);

    take_aim(face, region, own, &a);
    const float before_mm = weighted_rms(face, &a, own);
    if (before_mm < worth_it_mm)
        return;
    seed_population(&s->zhu.ga, face, &a, own,
                    face->follows_on ? fap_blend_region(face, s->before, region) : NULL);
    const fap_ga_task task = { .target = a.target,
                               .row_weight = a.weight,
                               .size = fap_lanes_padded(a.count),
                               .crossover = face->cfg.crossover,
                               .generations = face->cfg.generations,
                               .seed = face->cfg.seed,
                               .gene_max = fap_most_of_a_unit };
    const float *gene = fap_ga_run(&s->zhu.ga, &task, &score);
    memcpy(s->trial, face->weight, sizeof *s->trial * FAP_REGION_MAX * (size_t)face->key_count);
    mix(face, own, gene, belief(before_mm - sqrtf(-score / (float)a.commanded)),
        fap_blend_region(face, s->trial, region));
    if (no_worse(face, s->trial, face->weight))
        memcpy(face->weight, s->trial, sizeof *s->trial * FAP_REGION_MAX * (size_t)face->key_count);
}

/* How much of the way from the first weights to the second loses the fewest millimetres, 0 to 1. */
static float best_share(const fap_face *face, const float *from, const float *to)
{
    double down = 0, square = 0;

    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        const float start = fap_blend_row_motion(face, row, from);
        const double way = fap_blend_row_motion(face, row, to) - start;
        down += way * fap_blend_shortfall(face, row, from);
        square += way * way;
    }
    return square > 0 ? (float)fmin(1, fmax(0, down / square)) : 0;
}

/* Each region may leave the whole face's answer, as far as the whole gains by it. */
static void refine(state *s, fap_face *face)
{
    memset(s->trial, 0, sizeof *s->trial * FAP_REGION_MAX * (size_t)face->key_count);
    for (int r = 0; r < face->regions.count; r++)
        fap_least_squares_refine(&s->ls, face, r, fap_blend_region(face, s->trial, r));
    const float share = best_share(face, face->weight, s->trial);
    for (int r = 0; r < face->regions.count; r++) {
        float *own = fap_blend_region(face, face->weight, r);
        mix(face, own, fap_blend_region(face, s->trial, r), share, own);
    }
}

/* The least share of the fields with which fitness is no worse than @p rival; 1 where none is enough. */
static float least_share(fap_face *face, float rival)
{
    float lo = 0, hi = 1;

    for (int i = 0; i < SHARE_STEPS; i++) {
        face->field_share = (lo + hi) / 2;
        *(fap_blend_fitness(face, face->weight) >= rival ? &hi : &lo) = face->field_share;
    }
    return hi;
}

/* The share from which on fields cost millimetres again: where one pulls at a neighbour that has none. */
static float most_share(fap_face *face)
{
    double down = 0, square = 0;

    face->field_share = 0;
    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        const double way = face->field_motion[row];
        down += way * fap_blend_shortfall(face, row, face->weight);
        square += way * way;
    }
    return square > 0 ? (float)fmin(1, fmax(0, 2 * down / square)) : 0;
}

/*
 * The thesis counts angles, we count millimetres, and no blend need exist that is best in both: a point asked to
 * move by a hair counts as much as a jaw there, and next to nothing here. Where its answer has the better angles,
 * the fields of the residual go the least part of the way that makes up for it. That costs no millimetres, and
 * with the residual on the face is the same in the end.
 */
static void keep_up(state *s, fap_face *face)
{
    const float own = fap_blend_fitness(face, face->weight);

    if (own >= 1)
        return;
    memset(s->trial, 0, sizeof *s->trial * FAP_REGION_MAX * (size_t)face->key_count);
    fap_zhu_solve(&s->zhu, face, s->trial);
    const float rival = fap_blend_fitness(face, s->trial);
    if (own >= rival)
        return;
    fap_face_plan_fields(face);
    const float most = most_share(face);
    face->field_share = fminf(most, least_share(face, rival));
}

static void solve_ga(void *user, fap_face *face)
{
    state *s = user;

    fap_least_squares_solve(&s->ls, face, face->weight);
    fap_blend_copy_to_regions(face, face->weight);
    if (face->regions.count > 1)
        refine(s, face);
    for (int r = 0; r < face->regions.count; r++)
        improve(s, face, r);
    keep_up(s, face);
    memcpy(s->before, face->weight, sizeof *s->before * FAP_REGION_MAX * (size_t)face->key_count);
}

const fap_blend_method fap_blend_ga = {
    .name = "ga",
    .summary = "the genetic algorithm started from qp's answer",
    .regions = 1,
    .state_size = sizeof(state),
    .open = open_ga,
    .close = close_ga,
    .solve = solve_ga,
};
