/* SPDX-License-Identifier: BSD-2-Clause */
/* Principal components of the built-in face's keys: what they must be, whatever the face. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/pca.h"
#include "base/mem.h"

typedef struct bed {
    fap_allocator alloc;
    fap_bank *bank;
    int key[32], count;
    fap_pca pca;
} bed;

static void open_bed(bed *b, fap_key_kind kind, int with_neutral)
{
    memset(b, 0, sizeof *b);
    b->alloc = fap_mem_allocator(NULL);
    assert_int_equal(fap_bank_builtin(&b->bank, NULL), FAP_OK);
    for (int k = 0; k < fap_bank_key_count(b->bank) && b->count < 32; k++)
        if (fap_bank_key_get(b->bank, k)->kind == kind)
            b->key[b->count++] = k;
    assert_int_equal(fap_pca_open(&b->pca, b->bank, b->key, b->count, with_neutral, &b->alloc), 0);
}

static void close_bed(bed *b)
{
    fap_pca_close(&b->pca, &b->alloc);
    fap_bank_close(&b->bank);
}

/* The motion of a whole model, or of a component, as one long vector. */
static void add_motion(const bed *b, int key, double weight, double *out)
{
    const fap_key *k = fap_bank_key_get(b->bank, key);

    for (uint32_t i = 0; i < k->block_count; i++)
        for (int j = 0; j < 3 * FAP_BLOCK; j++)
            out[3u * FAP_BLOCK * k->block[i] + (uint32_t)j] +=
                weight * k->scale_mm * k->delta[(size_t)i * 3 * FAP_BLOCK + (size_t)j];
}

static double *component(const bed *b, int c)
{
    double *out = calloc(3u * fap_bank_mesh(b->bank)->stride, sizeof *out);

    for (int j = b->pca.neutral; j < b->pca.model_count; j++)
        add_motion(b, b->pca.key[j], b->pca.mix[c * b->pca.model_count + j], out);
    return out;
}

static double dot(const bed *b, const double *x, const double *y)
{
    double sum = 0;

    for (size_t i = 0; i < 3u * fap_bank_mesh(b->bank)->stride; i++)
        sum += x[i] * y[i];
    return sum;
}

TEST(pca, components_are_orthogonal_and_as_long_as_their_standard_deviation)
{
    bed b;

    open_bed(&b, FAP_KEY_EXPRESSION, 0);
    assert_int_equal(b.pca.component_count, b.count - 1); /* the mean takes one */
    for (int i = 0; i < b.pca.component_count; i++)
        for (int j = 0; j <= i; j++) {
            double *x = component(&b, i), *y = component(&b, j);
            const double want = i == j ? b.pca.variance[i] : 0;
            assert_float_equal(dot(&b, x, y), want, 1e-6 * b.pca.variance[0]);
            free(x);
            free(y);
        }
    close_bed(&b);
}

TEST(pca, variances_fall_and_contributions_rise_to_one)
{
    bed b;

    open_bed(&b, FAP_KEY_VISEME, 1);
    for (int i = 1; i < b.pca.component_count; i++) {
        assert_true(b.pca.variance[i] <= b.pca.variance[i - 1]);
        assert_true(fap_pca_contribution(&b.pca, i) <= fap_pca_contribution(&b.pca, i + 1));
    }
    assert_float_equal(fap_pca_contribution(&b.pca, b.pca.component_count), 1, 1e-9);
    close_bed(&b);
}

/* mean + sum of coordinates times components is the model again; the neutral face is model 0. */
TEST(pca, all_components_together_give_the_neutral_face_back)
{
    bed b;

    open_bed(&b, FAP_KEY_EXPRESSION, 1);
    for (int j = 1; j < b.pca.model_count; j++) {
        double weight = 1.0 / b.pca.model_count;
        for (int c = 0; c < b.pca.component_count; c++)
            weight += b.pca.rest[c] * b.pca.mix[c * b.pca.model_count + j];
        assert_float_equal(weight, 0, 1e-6);
    }
    close_bed(&b);
}

TEST(pca, one_model_has_no_variance)
{
    bed b;
    fap_pca one;

    open_bed(&b, FAP_KEY_EXPRESSION, 0);
    assert_int_equal(fap_pca_open(&one, b.bank, b.key, 1, 0, &b.alloc), 0);
    assert_int_equal(one.component_count, 0);
    assert_true(fap_pca_contribution(&one, 3) == 1);
    fap_pca_close(&one, &b.alloc);
    close_bed(&b);
}
