/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * With X' the models less their mean, the eigenvectors of X'X'^T (three rows a vertex) are X' times those of the
 * M x M matrix X'^T X'; its entries are sparse inner products of motions. The paper's eigenvalues are sums over
 * models; ours are divided by their number, so that their roots are standard deviations. Source: Yano et al.,
 * section 5.2.
 */
#include <math.h>
#include <string.h>

#include "bank/pca.h"
#include "base/jacobi.h"
#include "base/mem.h"

static const double least_share = 1e-9; /* of the largest variance: below it a component is rounding */

static double block_product(const int16_t *a, const int16_t *b)
{
    int64_t sum = 0;

    for (int i = 0; i < 3 * FAP_BLOCK; i++)
        sum += (int64_t)a[i] * b[i];
    return (double)sum;
}

/* Blocks ascend in both keys. */
static double inner_product(const fap_key *a, const fap_key *b)
{
    double sum = 0;

    for (uint32_t i = 0, j = 0; i < a->block_count && j < b->block_count;) {
        if (a->block[i] == b->block[j])
            sum += block_product(a->delta + (size_t)i * 3 * FAP_BLOCK, b->delta + (size_t)j * 3 * FAP_BLOCK);
        const int behind = a->block[i] <= b->block[j];
        j += b->block[j] <= a->block[i];
        i += (uint32_t)behind;
    }
    return sum * a->scale_mm * b->scale_mm;
}

static void fill_products(const fap_pca *pca, const fap_bank *bank, double *g)
{
    const size_t n = (size_t)pca->model_count;

    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            const int a = pca->key[i], b = pca->key[j];
            g[i * n + j] =
                a < 0 || b < 0 ? 0 : inner_product(fap_bank_key_get(bank, a), fap_bank_key_get(bank, b));
            g[j * n + i] = g[i * n + j];
        }
}

/* From products of motions to products of differences from the mean. */
static void centre(double *g, size_t n, double *mean)
{
    double all = 0;

    for (size_t i = 0; i < n; i++) {
        mean[i] = 0;
        for (size_t j = 0; j < n; j++)
            mean[i] += g[i * n + j] / (double)n;
        all += mean[i] / (double)n;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            g[i * n + j] += all - mean[i] - mean[j];
}

/* The largest eigenvalue that has not been taken; -1: none is worth it. */
static int next_largest(const double *g, size_t n, double below)
{
    int best = -1;

    for (size_t i = 0; i < n; i++)
        if (g[i * n + i] > below && (best < 0 || g[i * n + i] > g[(size_t)best * n + (size_t)best]))
            best = (int)i;
    return best;
}

static void take_components(fap_pca *pca, double *g, const double *v)
{
    const size_t n = (size_t)pca->model_count;
    const int first = next_largest(g, n, 0);
    const double least = first < 0 ? 0 : least_share * g[(size_t)first * n + (size_t)first];

    for (int i; (i = next_largest(g, n, least)) >= 0; g[(size_t)i * n + (size_t)i] = -1) {
        const size_t c = (size_t)pca->component_count++;
        const double *e = v + (size_t)i * n;
        pca->variance[c] = g[(size_t)i * n + (size_t)i] / (double)n;
        for (size_t j = 0; j < n; j++)
            pca->mix[c * n + j] = e[j] / sqrt((double)n);
        pca->rest[c] = pca->neutral ? e[0] * sqrt((double)n) : 0;
    }
}

static int solve(fap_pca *pca, const fap_bank *bank, const fap_allocator *alloc)
{
    const size_t n = (size_t)pca->model_count;
    double *work = fap_mem_calloc(alloc, 2 * n * n + n, sizeof *work);

    if (!work)
        return 1;
    fill_products(pca, bank, work);
    centre(work, n, work + 2 * n * n);
    fap_jacobi(work, work + n * n, n);
    take_components(pca, work, work + n * n);
    fap_mem_free(alloc, work);
    return 0;
}

int fap_pca_population(const fap_bank *bank, int key[FAP_PCA_MODELS])
{
    const int keys = fap_bank_key_count(bank);
    int population = 0, n = 0;

    for (int k = 0; k < keys; k++)
        population += fap_bank_key_get(bank, k)->kind != FAP_KEY_UNIT;
    for (int k = 0; k < keys && n < FAP_PCA_MODELS; k++)
        if (!population || fap_bank_key_get(bank, k)->kind != FAP_KEY_UNIT)
            key[n++] = k;
    return n;
}

static int take_room(fap_pca *pca, const fap_allocator *alloc)
{
    const size_t n = (size_t)pca->model_count;

    pca->key = fap_mem_calloc(alloc, n, sizeof *pca->key);
    pca->variance = fap_mem_calloc(alloc, n, sizeof *pca->variance);
    pca->mix = fap_mem_calloc(alloc, n * n, sizeof *pca->mix);
    pca->rest = fap_mem_calloc(alloc, n, sizeof *pca->rest);
    return !pca->key || !pca->variance || !pca->mix || !pca->rest;
}

int fap_pca_load(fap_pca *pca, const fap_basis *basis, const fap_allocator *alloc)
{
    const int n = basis->model_count;

    *pca = (fap_pca){ .model_count = n, .neutral = 1 };
    if (take_room(pca, alloc))
        return 1;
    pca->component_count = basis->component_count < n ? basis->component_count : n;
    for (int j = 0; j < n; j++)
        pca->key[j] = j < pca->neutral ? -1 : (int)basis->model[j];
    for (int c = 0; c < pca->component_count; c++) {
        const fap_component *from = &basis->component[c];
        pca->variance[c] = (double)from->sigma_mm * from->sigma_mm;
        pca->rest[c] = from->rest;
        for (int j = 0; j < n; j++)
            pca->mix[(size_t)c * (size_t)n + (size_t)j] = from->mix[j];
    }
    return 0;
}

int fap_pca_open(fap_pca *pca, const fap_bank *bank, const int *key, int count, int with_neutral,
                 const fap_allocator *alloc)
{
    const size_t n = (size_t)count + (with_neutral != 0);

    memset(pca, 0, sizeof *pca);
    pca->neutral = with_neutral != 0;
    pca->model_count = (int)n;
    if (take_room(pca, alloc))
        return 1;
    for (int i = 0; i < pca->model_count; i++)
        pca->key[i] = i < pca->neutral ? -1 : key[i - pca->neutral];
    return solve(pca, bank, alloc);
}

void fap_pca_close(fap_pca *pca, const fap_allocator *alloc)
{
    fap_mem_free(alloc, pca->key);
    fap_mem_free(alloc, pca->variance);
    fap_mem_free(alloc, pca->mix);
    fap_mem_free(alloc, pca->rest);
    memset(pca, 0, sizeof *pca);
}

double fap_pca_contribution(const fap_pca *pca, int components)
{
    double some = 0, all = 0;

    for (int i = 0; i < pca->component_count; i++) {
        all += pca->variance[i];
        some += i < components ? pca->variance[i] : 0;
    }
    return all > 0 ? some / all : 1;
}
