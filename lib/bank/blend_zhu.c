/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The thesis's genetic algorithm, to the letter, in each region by itself: population = visemes, expressions
 * and extra keys, fitness = mean cosine, length afterwards. Ours are two things that absurd or sparse targets
 * need: keys beside the point stay out, and weights end. Source: Zhu 2006 sections 3.2 to 3.4.
 */
#include <math.h>
#include <string.h>

#include "bank/blend_zhu.h"
#include "base/mem.h"

static const float most_of_a_key = 2;    /* the thesis sets no bound; absurd targets need one */
static const float asked_mm = 1;         /* who is asked to go less far is partly asked to stay */
static const float left_out_beside = 10; /* this much more "beside" than the best, and a key is left out */

/* The region's sub-goal: points it has a say in, and where they should go. */
typedef struct goal {
    int count, plane, point[FAP_POINT_COUNT];
    float vector[3 * FAP_GA_POINTS]; /* x[plane] y[plane] z[plane] */
} goal;

int fap_zhu_open(fap_zhu *zhu, const fap_face *face)
{
    const int n = face->key_count;

    zhu->beside = fap_mem_calloc(&face->alloc, 2 * (size_t)n, sizeof *zhu->beside);
    return !zhu->beside || fap_ga_open(&zhu->ga, n + 1, 3 * FAP_GA_POINTS, n, &face->alloc);
}

void fap_zhu_close(fap_zhu *zhu, const fap_face *face)
{
    fap_mem_free(&face->alloc, zhu->beside);
    fap_ga_close(&zhu->ga, &face->alloc);
}

/* What viseme and expression ask of a point, overridden where a FAP speaks; unknown axes are 0. */
static float wanted_axis(const fap_face *face, int p, int axis)
{
    const int row = 3 * p + axis;
    float sum = 0;

    if (face->wanted[p][axis])
        return fap_blend_row_target(face, row);
    for (int i = 0; i < face->base_count; i++)
        sum += face->cfg.emphasis * face->base_weight[i] *
               face->motion[(size_t)row * (size_t)face->key_count + (size_t)face->base_key[i]];
    return sum;
}

/* The thesis's feature points are those its bank moves; the tongue, say, is left out of the fitness here as
 * there. */
static int population_moves(const fap_face *face, int p)
{
    for (int axis = 0; axis < 3; axis++) {
        const float *motion = face->motion + (size_t)(3 * p + axis) * (size_t)face->key_count;
        for (int k = 0; k < face->key_count; k++)
            if (face->population[k] && motion[k] != 0)
                return 1;
    }
    return 0;
}

/* Points of the strip that regions share belong to both. */
static void set_goal(const fap_face *face, int region, goal *g)
{
    float v[FAP_POINT_COUNT][3];

    g->count = 0;
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        if (!face->solvable[p] || face->regions.point[region][p] <= 0)
            continue;
        for (int axis = 0; axis < 3; axis++)
            v[g->count][axis] = wanted_axis(face, p, axis);
        if ((v[g->count][0] != 0 || v[g->count][1] != 0 || v[g->count][2] != 0) && population_moves(face, p))
            g->point[g->count++] = p;
    }
    g->plane = fap_lanes_padded(g->count);
    memset(g->vector, 0, sizeof g->vector);
    for (int i = 0; i < 3 * g->count; i++)
        g->vector[i % 3 * g->plane + i / 3] = v[i / 3][i % 3];
}

/* How far a point is asked to go at all; one that is told to stay has no direction for the cosine to count. */
static float asked_share(const fap_face *face, int p)
{
    float square = 0;

    for (int axis = 0; axis < 3; axis++)
        square += wanted_axis(face, p, axis) * wanted_axis(face, p, axis);
    return fminf(1, sqrtf(square) / asked_mm);
}

/* The thesis's own case: every point it moves is known in all three axes. There all keys take part. */
static int all_told(const fap_face *face)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const uint8_t *w = face->wanted[p];
        if (face->solvable[p] && !(w[0] && w[1] && w[2]) && population_moves(face, p))
            return 0;
    }
    return 1;
}

/* As fap_blend_beside(), but what must stay where it is counts as beside. */
static void find_beside(fap_zhu *zhu, const fap_face *face, int region)
{
    float *beside = zhu->beside, *asked = beside + face->key_count;

    memset(beside, 0, 2 * sizeof *beside * (size_t)face->key_count);
    if (all_told(face))
        return;
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const uint8_t *w = face->wanted[p];
        const float share = face->regions.point[region][p], ask = asked_share(face, p);
        for (int axis = 0; axis < 3; axis++) {
            if (!w[axis] && (w[0] || w[1] || w[2]))
                continue;
            const float *motion = face->motion + (size_t)(3 * p + axis) * (size_t)face->key_count;
            for (int k = 0; k < face->key_count; k++) {
                asked[k] += share * ask * motion[k] * motion[k];
                beside[k] += share * (1 - ask) * motion[k] * motion[k];
            }
        }
    }
    for (int k = 0; k < face->key_count; k++)
        beside[k] = fminf(beside[k] / (asked[k] + 1e-3f), fap_blend_most_beside);
}

static float least_beside(const fap_zhu *zhu, const fap_face *face)
{
    float least = fap_blend_most_beside;

    for (int k = 0; k < face->key_count; k++)
        if (face->population[k])
            least = fminf(least, zhu->beside[k]);
    return least;
}

/*
 * A key that hardly moves what is asked for (a blink, when only the mouth is commanded) would be scaled to a
 * monster by the ratio of lengths; the thesis's keys all move most of the face, and with every point commanded
 * all of them take part.
 */
static void add_population(fap_zhu *zhu, const fap_face *face, const goal *g)
{
    float *vector, *gene;
    const float least = least_beside(zhu, face);

    for (int k = 0; k < face->key_count; k++) {
        if (!face->population[k] || zhu->beside[k] > least + left_out_beside ||
            !fap_ga_add(&zhu->ga, &vector, &gene))
            continue;
        gene[k] = 1;
        for (int i = 0; i < 3 * g->count; i++)
            vector[i % 3 * g->plane + i / 3] =
                face->motion[(size_t)(3 * g->point[i / 3] + i % 3) * (size_t)face->key_count + (size_t)k];
    }
}

static void solve_region(fap_zhu *zhu, const fap_face *face, int region, float *weight)
{
    goal g;
    float score;

    set_goal(face, region, &g);
    if (!g.count)
        return;
    find_beside(zhu, face, region);
    fap_ga_clear(&zhu->ga);
    add_population(zhu, face, &g);
    const fap_ga_task task = { .target = g.vector,
                               .size = 3 * g.plane,
                               .cosine = 1,
                               .crossover = face->cfg.crossover,
                               .generations = face->cfg.generations,
                               .seed = face->cfg.seed };
    const float *gene = fap_ga_run(&zhu->ga, &task, &score);
    for (int k = 0; k < face->key_count && gene; k++)
        weight[k] = fminf(most_of_a_key, fmaxf(-most_of_a_key, gene[k]));
}

void fap_zhu_solve(fap_zhu *zhu, const fap_face *face, float *weight)
{
    for (int r = 0; r < face->regions.count; r++)
        solve_region(zhu, face, r, fap_blend_region(face, weight, r));
}

static int open_zhu(void *state, const fap_face *face)
{
    return fap_zhu_open(state, face);
}

static void close_zhu(void *state, const fap_face *face)
{
    fap_zhu_close(state, face);
}

static void solve_zhu(void *state, fap_face *face)
{
    fap_zhu_solve(state, face, face->weight);
}

const fap_blend_method fap_blend_zhu = {
    .name = "zhu",
    .summary = "the genetic algorithm of Zhu 2006, to the letter",
    .regions = 1,
    .state_size = sizeof(fap_zhu),
    .open = open_zhu,
    .close = close_zhu,
    .solve = solve_zhu,
};
