/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Tournaments, crossovers and the adjustment of a child's length. The random numbers start anew for every
 * run: a pose depends on its frame alone, and neighbouring frames see the same draws. Source: Zhu 2006
 * sections 3.2 (figure 3.3, eq. 3.2 to 3.6) and 3.4.3.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "bank/ga.h"

static const float blx_alpha = 0.2f; /* section 3.3: the best of those tried there */
static const float tiny = 1e-6f;     /* millimetres; shorter vectors have no direction */

/* PCG32 (O'Neill 2014), one stream. */
typedef struct rng {
    uint64_t state;
} rng;

static uint32_t draw(rng *r)
{
    const uint64_t old = r->state;
    r->state = old * 6364136223846793005u + 1442695040888963407u;
    const uint32_t mixed = (uint32_t)(((old >> 18) ^ old) >> 27), turn = (uint32_t)(old >> 59);
    return (mixed >> turn) | (mixed << ((32 - turn) & 31));
}

static int draw_below(rng *r, int n)
{
    return (int)(((uint64_t)draw(r) * (uint64_t)n) >> 32);
}

static float draw_unit(rng *r)
{
    return (float)(draw(r) >> 8) * (1.0f / 16777216);
}

static void seed_rng(rng *r, uint64_t seed)
{
    r->state = seed + 1442695040888963407u;
    draw(r);
    r->state += seed;
    draw(r);
}

int fap_ga_open(fap_ga *ga, int capacity, int size_max, int gene_count, const fap_allocator *alloc)
{
    const size_t rows = (size_t)capacity + 2, each = (size_t)size_max + (size_t)gene_count + 1;

    memset(ga, 0, sizeof *ga);
    ga->block = fap_mem_calloc(alloc, rows * each, sizeof(float));
    if (!ga->block)
        return 1;
    ga->capacity = capacity;
    ga->size_max = size_max;
    ga->gene_count = gene_count;
    ga->vector = ga->block;
    ga->gene = ga->vector + rows * (size_t)size_max;
    ga->score = ga->gene + rows * (size_t)gene_count;
    return 0;
}

void fap_ga_close(fap_ga *ga, const fap_allocator *alloc)
{
    fap_mem_free(alloc, ga->block);
    memset(ga, 0, sizeof *ga);
}

void fap_ga_clear(fap_ga *ga)
{
    ga->count = 0;
}

static float *vector_of(const fap_ga *ga, int i)
{
    return ga->vector + (size_t)i * (size_t)ga->size_max;
}

static float *gene_of(const fap_ga *ga, int i)
{
    return ga->gene + (size_t)i * (size_t)ga->gene_count;
}

int fap_ga_add(fap_ga *ga, float **vector, float **gene)
{
    if (ga->count >= ga->capacity)
        return 0;
    *vector = vector_of(ga, ga->count);
    *gene = gene_of(ga, ga->count++);
    memset(*vector, 0, sizeof **vector * (size_t)ga->size_max);
    memset(*gene, 0, sizeof **gene * (size_t)ga->gene_count);
    return 1;
}

static float dot3(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Mean cosine, the lengths of the target's vectors known. */
static float cosine(const float *target, const float *length, const float *candidate, int size)
{
    float sum = 0;
    int moving = 0;

    for (int i = 0; i + 2 < size; i += 3) {
        const float wanted = length[i / 3];
        if (wanted <= tiny)
            continue;
        const float got = sqrtf(dot3(candidate + i, candidate + i));
        moving++;
        if (got > tiny) /* a point that stays where it should move has no angle: it earns nothing */
            sum += dot3(target + i, candidate + i) / (wanted * got);
    }
    return moving ? sum / (float)moving : 1;
}

static void measure_lengths(const float *target, int size, float *length)
{
    for (int i = 0; i + 2 < size; i += 3)
        length[i / 3] = sqrtf(dot3(target + i, target + i));
}

float fap_ga_cosine(const float *target, const float *candidate, int size)
{
    float length[FAP_POINT_COUNT];

    measure_lengths(target, size, length);
    return cosine(target, length, candidate, size);
}

static float squared_error(const fap_ga_task *task, const float *candidate)
{
    float sum = 0;

    for (int i = 0; i < task->size; i++) {
        const float e = candidate[i] - task->target[i];
        sum += task->row_weight[i] * (e * e);
    }
    return sum;
}

static float rate(const fap_ga *ga, const fap_ga_task *task, const float *candidate)
{
    return task->cosine ? cosine(task->target, ga->length, candidate, task->size)
                        : -squared_error(task, candidate);
}

static float summed_length(const fap_ga *ga, const fap_ga_task *task, const float *vector)
{
    float sum = 0;

    for (int i = 0; i + 2 < task->size; i += 3)
        if (ga->length[i / 3] > tiny)
            sum += sqrtf(dot3(vector + i, vector + i));
    return sum;
}

/* Section 3.2: the ratio of the summed lengths of target and candidate. */
static float length_ratio(const fap_ga *ga, const fap_ga_task *task, const float *vector)
{
    const float own = summed_length(ga, task, vector);
    return own > tiny ? ga->target_length / own : 1;
}

/* The scale with the least error that keeps every gene in its range. */
static float best_scale(const fap_ga *ga, const fap_ga_task *task, int i)
{
    const float *v = vector_of(ga, i), *gene = gene_of(ga, i);
    float wanted = 0, own = 0, largest = 0;

    for (int k = 0; k < task->size; k++) {
        wanted += task->row_weight[k] * (v[k] * task->target[k]);
        own += task->row_weight[k] * (v[k] * v[k]);
    }
    for (int k = 0; k < ga->gene_count; k++)
        largest = fmaxf(largest, gene[k]);
    const float scale = own > tiny ? fmaxf(wanted, 0) / own : 1;
    return largest > tiny ? fminf(scale, task->gene_max / largest) : scale;
}

static void scale_individual(const fap_ga *ga, const fap_ga_task *task, int i)
{
    float *v = vector_of(ga, i), *gene = gene_of(ga, i);
    const float scale = task->cosine ? length_ratio(ga, task, v) : best_scale(ga, task, i);

    for (int k = 0; k < task->size; k++)
        v[k] *= scale;
    for (int k = 0; k < ga->gene_count; k++)
        gene[k] *= scale;
}

/* Share of the first parent; the second has the rest. Eq. 3.6 written out is a line of 1 + 2 alpha the
 * length. */
static float share(rng *r, fap_crossover crossover)
{
    if (crossover == FAP_CROSSOVER_MIDPOINT)
        return 0.5f;
    const float t = draw_unit(r);
    return crossover == FAP_CROSSOVER_LINE ? t : t * (1 + 2 * blx_alpha) - blx_alpha;
}

static void mix(float *out, const float *a, const float *b, float t, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = t * a[i] + (1 - t) * b[i];
}

/* BLX leaves the range that genes may have; such a child is not worth a second look. */
static int allowed(const fap_ga *ga, const fap_ga_task *task, int i)
{
    const float *gene = gene_of(ga, i);

    for (int k = 0; k < ga->gene_count && !task->cosine; k++)
        if (gene[k] < 0 || gene[k] > task->gene_max)
            return 0;
    return 1;
}

static void copy_individual(fap_ga *ga, int to, int from)
{
    memcpy(vector_of(ga, to), vector_of(ga, from), sizeof(float) * (size_t)ga->size_max);
    memcpy(gene_of(ga, to), gene_of(ga, from), sizeof(float) * (size_t)ga->gene_count);
    ga->score[to] = ga->score[from];
}

static void keep_if_best(fap_ga *ga, int i)
{
    const int best = ga->capacity;
    if (ga->score[i] > ga->score[best])
        copy_individual(ga, best, i);
}

/* Three different individuals, the one with the worst score last. */
static void tournament(const fap_ga *ga, rng *r, int pick[3])
{
    pick[0] = draw_below(r, ga->count);
    pick[1] = (pick[0] + 1 + draw_below(r, ga->count - 1)) % ga->count;
    do
        pick[2] = draw_below(r, ga->count);
    while (pick[2] == pick[0] || pick[2] == pick[1]);

    for (int i = 0; i < 2; i++)
        if (ga->score[pick[i]] < ga->score[pick[2]]) {
            const int swap = pick[i];
            pick[i] = pick[2];
            pick[2] = swap;
        }
}

static void generation(fap_ga *ga, const fap_ga_task *task, rng *r)
{
    const int child = ga->capacity + 1;
    int pick[3];

    tournament(ga, r, pick);
    const float t = share(r, task->crossover);
    mix(vector_of(ga, child), vector_of(ga, pick[0]), vector_of(ga, pick[1]), t, task->size);
    mix(gene_of(ga, child), gene_of(ga, pick[0]), gene_of(ga, pick[1]), t, ga->gene_count);
    if (!allowed(ga, task, child))
        return;
    scale_individual(ga, task, child);
    ga->score[child] = rate(ga, task, vector_of(ga, child));
    copy_individual(ga, pick[2], child);
    keep_if_best(ga, child);
}

const float *fap_ga_run(fap_ga *ga, const fap_ga_task *task, float *score)
{
    const int best = ga->capacity;
    rng r;

    if (!ga->count)
        return NULL;
    seed_rng(&r, task->seed);
    if (task->cosine) {
        measure_lengths(task->target, task->size, ga->length);
        ga->target_length = summed_length(ga, task, task->target);
    }
    ga->score[best] = -INFINITY;
    for (int i = 0; i < ga->count; i++) {
        ga->score[i] = rate(ga, task, vector_of(ga, i));
        keep_if_best(ga, i);
    }
    for (int g = 0; g < task->generations && ga->count >= 3; g++)
        generation(ga, task, &r);
    if (task->cosine) /* a key that was never a child still has its own length */
        scale_individual(ga, task, best);
    *score = ga->score[best];
    return gene_of(ga, best);
}
