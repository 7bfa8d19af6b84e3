/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Tournaments, crossovers and the adjustment of a child's length. The random numbers start anew for every
 * run: a pose depends on its frame alone, and neighbouring frames see the same draws. Source: Zhu 2006
 * sections 3.2 (figure 3.3, eq. 3.2 to 3.6) and 3.4.3.
 */
#include <math.h>
#include <string.h>

#include "base/lanes.h"
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

/* --- vectors in blocks of lanes --- */

enum { LANES = FAP_LANES };

static void scale(float *v, float by, int n)
{
    for (int i = 0; i < n; i += LANES)
        for (int k = 0; k < LANES; k++)
            v[i + k] *= by;
}

static void mix(float *restrict out, const float *restrict a, const float *restrict b, float t, int n)
{
    const float rest = 1 - t;

    for (int i = 0; i < n; i += LANES)
        for (int k = 0; k < LANES; k++)
            out[i + k] = t * a[i + k] + rest * b[i + k];
}

static float largest(const float *v, int n)
{
    float most[LANES] = { 0 }, all = 0;

    for (int i = 0; i < n; i += LANES)
        for (int k = 0; k < LANES; k++)
            most[k] = v[i + k] > most[k] ? v[i + k] : most[k];
    for (int k = 0; k < LANES; k++)
        all = fmaxf(all, most[k]);
    return all;
}

static int any_negative(const float *v, int n)
{
    float least[LANES] = { 0 };
    int any = 0;

    for (int i = 0; i < n; i += LANES)
        for (int k = 0; k < LANES; k++)
            least[k] = v[i + k] < least[k] ? v[i + k] : least[k];
    for (int k = 0; k < LANES; k++)
        any |= least[k] < 0;
    return any;
}

/* --- individuals --- */

int fap_ga_open(fap_ga *ga, int capacity, int size_max, int gene_count, const fap_allocator *alloc)
{
    const size_t rows = (size_t)capacity + 2, size = (size_t)fap_lanes_padded(size_max),
                 genes = (size_t)fap_lanes_padded(gene_count), each = size + genes + 1;

    memset(ga, 0, sizeof *ga);
    ga->block = fap_mem_calloc(alloc, rows * each, sizeof(float));
    if (!ga->block)
        return 1;
    ga->capacity = capacity;
    ga->size_max = (int)size;
    ga->gene_count = (int)genes;
    ga->vector = ga->block;
    ga->gene = ga->vector + rows * size;
    ga->score = ga->gene + rows * genes;
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

/* --- fitness --- */

/* The three coordinates of a block of points. */
static void lengths(const float *x, int plane, float *restrict out)
{
    const float *y = x + plane, *z = y + plane;

    for (int k = 0; k < LANES; k++)
        out[k] = sqrtf((x[k] * x[k] + y[k] * y[k]) + z[k] * z[k]);
}

static void measure_target(fap_ga_aim *aim, const float *target, int plane)
{
    float length[LANES];

    aim->plane = plane;
    aim->moving = 0;
    aim->length = 0;
    for (int p = 0; p < plane; p += LANES) {
        lengths(target + p, plane, length);
        for (int k = 0; k < LANES; k++) {
            const int moves = length[k] > tiny;
            aim->counts[p + k] = (float)moves;
            aim->per_length[p + k] = moves ? 1 / length[k] : 0;
            aim->length += moves ? length[k] : 0;
            aim->moving += moves;
        }
    }
}

/* Mean cosine. A point that stays where it should move has no angle: it earns nothing. */
static float cosine(const fap_ga_aim *aim, const float *target, const float *candidate)
{
    const int plane = aim->plane;
    float sum[LANES] = { 0 }, got[LANES];

    for (int p = 0; p < plane; p += LANES) {
        const float *a = target + p, *b = candidate + p, *per = aim->per_length + p;
        lengths(b, plane, got);
        for (int k = 0; k < LANES; k++) {
            const float dot =
                (a[k] * b[k] + a[plane + k] * b[plane + k]) + a[2 * plane + k] * b[2 * plane + k];
            const float share = dot * per[k] / (got[k] > tiny ? got[k] : 1);
            sum[k] += got[k] > tiny ? share : 0;
        }
    }
    return aim->moving ? fap_lanes_sum(sum) / (float)aim->moving : 1;
}

float fap_ga_cosine(const float *target, const float *candidate, int plane)
{
    fap_ga_aim aim;

    measure_target(&aim, target, plane);
    return cosine(&aim, target, candidate);
}

static float squared_error(const fap_ga_task *task, const float *candidate)
{
    float sum[LANES] = { 0 };

    for (int i = 0; i < task->size; i += LANES)
        for (int k = 0; k < LANES; k++) {
            const float e = candidate[i + k] - task->target[i + k];
            sum[k] += task->row_weight[i + k] * (e * e);
        }
    return fap_lanes_sum(sum);
}

static float rate(const fap_ga *ga, const fap_ga_task *task, const float *candidate)
{
    return task->cosine ? cosine(&ga->aim, task->target, candidate) : -squared_error(task, candidate);
}

static float summed_length(const fap_ga_aim *aim, const float *vector)
{
    float sum[LANES] = { 0 }, length[LANES];

    for (int p = 0; p < aim->plane; p += LANES) {
        lengths(vector + p, aim->plane, length);
        for (int k = 0; k < LANES; k++)
            sum[k] += aim->counts[p + k] * length[k];
    }
    return fap_lanes_sum(sum);
}

/* Section 3.2: the ratio of the summed lengths of target and candidate. */
static float length_ratio(const fap_ga *ga, const float *vector)
{
    const float own = summed_length(&ga->aim, vector);
    return own > tiny ? ga->aim.length / own : 1;
}

/* The scale with the least error that keeps every gene in its range. */
static float best_scale(const fap_ga *ga, const fap_ga_task *task, int i)
{
    const float *v = vector_of(ga, i);
    float wanted[LANES] = { 0 }, own[LANES] = { 0 };

    for (int r = 0; r < task->size; r += LANES)
        for (int k = 0; k < LANES; k++) {
            const float weighted = task->row_weight[r + k] * v[r + k];
            wanted[k] += weighted * task->target[r + k];
            own[k] += weighted * v[r + k];
        }
    const float square = fap_lanes_sum(own), most = largest(gene_of(ga, i), ga->gene_count);
    const float by = square > tiny ? fmaxf(fap_lanes_sum(wanted), 0) / square : 1;
    return most > tiny ? fminf(by, task->gene_max / most) : by;
}

static void scale_individual(const fap_ga *ga, const fap_ga_task *task, int i)
{
    const float by = task->cosine ? length_ratio(ga, vector_of(ga, i)) : best_scale(ga, task, i);

    scale(vector_of(ga, i), by, task->size);
    scale(gene_of(ga, i), by, ga->gene_count);
}

/* --- generations --- */

/* Share of the first parent; the second has the rest. Eq. 3.6 written out is a line of 1 + 2 alpha the
 * length. */
static float share(rng *r, fap_crossover crossover)
{
    if (crossover == FAP_CROSSOVER_MIDPOINT)
        return 0.5f;
    const float t = draw_unit(r);
    return crossover == FAP_CROSSOVER_LINE ? t : t * (1 + 2 * blx_alpha) - blx_alpha;
}

/* BLX leaves the range that genes may have; such a child is not worth a second look. */
static int allowed(const fap_ga *ga, const fap_ga_task *task, int i)
{
    const float *gene = gene_of(ga, i);

    return task->cosine ||
           (!any_negative(gene, ga->gene_count) && largest(gene, ga->gene_count) <= task->gene_max);
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
    if (task->cosine)
        measure_target(&ga->aim, task->target, task->size / 3);
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
