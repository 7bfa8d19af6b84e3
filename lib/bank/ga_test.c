/* SPDX-License-Identifier: BSD-2-Clause */
/* The thesis's algorithm on small populations made here. */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include "bank/ga.h"
#include "base/mem.h"

enum { KEYS = 12, POINTS = FAP_LANES, SIZE = 3 * POINTS };

typedef struct bed {
    fap_allocator alloc;
    fap_ga ga;
    float key[KEYS][SIZE], target[SIZE], row_weight[SIZE];
} bed;

static float noise(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / (1 << 23) - 1;
}

static void open_bed(bed *b, uint32_t seed)
{
    memset(b, 0, sizeof *b);
    b->alloc = fap_mem_allocator(NULL);
    assert_int_equal(fap_ga_open(&b->ga, KEYS, SIZE, KEYS, &b->alloc), 0);
    for (int k = 0; k < KEYS; k++)
        for (int i = 0; i < SIZE; i++)
            b->key[k][i] = 5 * noise(&seed);
    for (int i = 0; i < SIZE; i++) {
        b->row_weight[i] = 1;
        b->target[i] = 0.5f * b->key[2][i] + 0.3f * b->key[7][i];
    }
}

static void populate(bed *b)
{
    float *vector, *gene;

    fap_ga_clear(&b->ga);
    for (int k = 0; k < KEYS; k++) {
        assert_int_equal(fap_ga_add(&b->ga, &vector, &gene), 1);
        memcpy(vector, b->key[k], sizeof b->key[k]);
        gene[k] = 1;
    }
    assert_int_equal(fap_ga_add(&b->ga, &vector, &gene), 0);
}

static fap_ga_task task_of(const bed *b, fap_crossover crossover, uint64_t seed)
{
    return (fap_ga_task){ .target = b->target,
                          .row_weight = b->row_weight,
                          .size = SIZE,
                          .cosine = 1,
                          .crossover = crossover,
                          .generations = 70,
                          .seed = seed,
                          .gene_max = 1.25f };
}

static void vector_of(const bed *b, const float *gene, float *out)
{
    for (int i = 0; i < SIZE; i++) {
        out[i] = 0;
        for (int k = 0; k < KEYS; k++)
            out[i] += gene[k] * b->key[k][i];
    }
}

static float summed_length(const float *v)
{
    float sum = 0;
    for (int i = 0; i < POINTS; i++)
        sum += sqrtf(v[i] * v[i] + v[POINTS + i] * v[POINTS + i] + v[2 * POINTS + i] * v[2 * POINTS + i]);
    return sum;
}

TEST(ga, cosine_is_that_of_the_angles_averaged_over_points_that_move)
{
    /* x of 8 points, then y, then z: the first moves along x, the second along y, the third not at all */
    const float target[SIZE] = { [0] = 1, [POINTS + 1] = 2 };
    const float got[SIZE] = { [0] = 3, [1] = 1, [POINTS + 1] = 1, [2] = 7, [POINTS + 2] = 7 };

    assert_float_equal(fap_ga_cosine(target, got, POINTS), (1 + sqrt(0.5)) / 2, 1e-6);
    assert_true(fap_ga_cosine(target, got, 0) == 1);
}

TEST(ga, genes_make_the_vector_whose_score_is_reported)
{
    for (int crossover = FAP_CROSSOVER_MIDPOINT; crossover <= FAP_CROSSOVER_BLX; crossover++) {
        bed b;
        float score, vector[SIZE];
        open_bed(&b, 1);
        populate(&b);
        const fap_ga_task task = task_of(&b, (fap_crossover)crossover, 5);
        vector_of(&b, fap_ga_run(&b.ga, &task, &score), vector);
        assert_float_equal(fap_ga_cosine(b.target, vector, POINTS), score, 1e-4);
        assert_float_equal(summed_length(vector), summed_length(b.target), 1e-2);
        fap_ga_close(&b.ga, &b.alloc);
    }
}

static float best_key(const bed *b)
{
    float best = -1;
    for (int k = 0; k < KEYS; k++)
        best = fmaxf(best, fap_ga_cosine(b->target, b->key[k], POINTS));
    return best;
}

TEST(ga, never_ends_below_the_best_key_and_mostly_above)
{
    int better = 0;

    for (uint32_t seed = 1; seed <= 40; seed++) {
        bed b;
        float score;
        open_bed(&b, seed);
        populate(&b);
        const fap_ga_task task = task_of(&b, FAP_CROSSOVER_LINE, seed);
        fap_ga_run(&b.ga, &task, &score);
        assert_true(score >= best_key(&b) - 1e-6f);
        better += score > best_key(&b) + 1e-3f;
        fap_ga_close(&b.ga, &b.alloc);
    }
    assert_true(better > 20);
}

TEST(ga, equal_seeds_give_equal_bits)
{
    bed b;
    float score[2], gene[2][KEYS];

    open_bed(&b, 3);
    const fap_ga_task task = task_of(&b, FAP_CROSSOVER_BLX, 42);
    for (int run = 0; run < 2; run++) {
        populate(&b);
        memcpy(gene[run], fap_ga_run(&b.ga, &task, &score[run]), sizeof gene[run]);
    }
    assert_memory_equal(gene[0], gene[1], sizeof gene[0]);
    assert_true(score[0] == score[1]);
    fap_ga_close(&b.ga, &b.alloc);
}

TEST(ga, counting_millimetres_keeps_weights_in_range)
{
    bed b;
    float score;

    open_bed(&b, 6);
    populate(&b);
    fap_ga_task task = task_of(&b, FAP_CROSSOVER_BLX, 1);
    task.cosine = 0;
    task.generations = 500;
    const float *gene = fap_ga_run(&b.ga, &task, &score);
    for (int k = 0; k < KEYS; k++)
        assert_true(gene[k] >= 0 && gene[k] <= 1.2501f);
    fap_ga_close(&b.ga, &b.alloc);
}

TEST(ga, small_populations_are_no_special_case)
{
    for (int count = 0; count <= 2; count++) {
        bed b;
        float score, *vector, *gene;
        open_bed(&b, 8);
        fap_ga_clear(&b.ga);
        for (int k = 0; k < count; k++) {
            fap_ga_add(&b.ga, &vector, &gene);
            memcpy(vector, b.key[k], sizeof b.key[k]);
            gene[k] = 1;
        }
        const fap_ga_task task = task_of(&b, FAP_CROSSOVER_LINE, 1);
        const float *best = fap_ga_run(&b.ga, &task, &score);
        assert_int_equal(best != NULL, count > 0);
        fap_ga_close(&b.ga, &b.alloc);
    }
}
