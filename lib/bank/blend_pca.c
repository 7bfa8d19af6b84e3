/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The thesis's population as principal components: coefficients by least squares over commanded rows, within
 * three standard deviations, leaning towards the neutral face (or the viseme and expression that are shown).
 * Source: Yano et al., section 5.2, eq. 2.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "bank/pca.h"
#include "bank/qp.h"
#include "base/mem.h"

static const double enough = 0.995; /* of the variance; what is left is more noise than face */
static const double most = 3;       /* standard deviations, eq. 2 */
static const double lean_mm2 = 0.3; /* price of a standard deviation that nobody asked for */

typedef struct state {
    fap_pca pca;
    fap_qp qp;
    int count;    /* components used */
    float *rows;  /* [FAP_ROWS][count]: millimetres per standard deviation */
    float *mean;  /* [FAP_ROWS]: the mean model */
    double *lean; /* [count]: where this frame's coefficients lean to */
} state;

/* As many as the bank has stored: whoever stored them chose their number. */
static int load_components(state *s, const fap_face *face, const fap_basis *basis)
{
    const int failed = fap_pca_load(&s->pca, basis, &face->alloc);

    s->count = s->pca.component_count;
    return failed;
}

static int open_components(state *s, const fap_face *face)
{
    const fap_basis *basis = fap_bank_basis(face->bank);
    int key[FAP_PCA_MODELS];

    if (basis)
        return load_components(s, face, basis);
    const int count = fap_pca_population(face->bank, key);
    const int failed = fap_pca_open(&s->pca, face->bank, key, count, 1, &face->alloc);
    while (!failed && s->count < s->pca.component_count && fap_pca_contribution(&s->pca, s->count) < enough)
        s->count++;
    return failed;
}

static void fill_row(state *s, const fap_face *face, int row)
{
    const fap_pca *pca = &s->pca;
    const float *motion = face->motion + (size_t)row * (size_t)face->key_count;

    for (int j = pca->neutral; j < pca->model_count; j++) {
        const float m = motion[pca->key[j]];
        s->mean[row] += m / (float)pca->model_count;
        for (int c = 0; c < s->count && m != 0; c++)
            s->rows[(size_t)row * (size_t)s->count + (size_t)c] +=
                m * (float)pca->mix[(size_t)c * (size_t)pca->model_count + (size_t)j];
    }
}

static int open_pca(void *user, const fap_face *face)
{
    state *s = user;

    if (open_components(s, face))
        return 1;
    s->rows = fap_mem_calloc(&face->alloc, FAP_ROWS * (size_t)(s->count + 1), sizeof *s->rows);
    s->mean = fap_mem_calloc(&face->alloc, FAP_ROWS, sizeof *s->mean);
    s->lean = fap_mem_calloc(&face->alloc, (size_t)s->count + 1, sizeof *s->lean);
    if (!s->rows || !s->mean || !s->lean || fap_qp_open(&s->qp, s->count + 1, &face->alloc))
        return 1;
    for (int row = 0; row < FAP_ROWS; row++)
        fill_row(s, face, row);
    return 0;
}

static void close_pca(void *user, const fap_face *face)
{
    state *s = user;

    fap_pca_close(&s->pca, &face->alloc);
    fap_qp_close(&s->qp, &face->alloc);
    fap_mem_free(&face->alloc, s->rows);
    fap_mem_free(&face->alloc, s->mean);
    fap_mem_free(&face->alloc, s->lean);
}

static int model_of(const fap_pca *pca, int key)
{
    for (int j = pca->neutral; j < pca->model_count; j++)
        if (pca->key[j] == key)
            return j;
    return -1;
}

/* A model's coordinates are the same as its part in each component, but for the scale. */
static void set_lean(state *s, const fap_face *face)
{
    const double models = s->pca.model_count;

    memcpy(s->lean, s->pca.rest, sizeof *s->lean * (size_t)s->count);
    for (int i = 0; i < face->base_count; i++) {
        const int j = model_of(&s->pca, face->base_key[i]);
        for (int c = 0; c < s->count && j >= 0; c++) {
            const double *mix = s->pca.mix + (size_t)c * (size_t)s->pca.model_count;
            s->lean[c] += face->base_weight[i] * models * (mix[j] - mix[0]);
        }
    }
}

/* Neutral face and base are always within reach. */
static void set_problem(state *s, const fap_face *face)
{
    fap_qp *qp = &s->qp;

    set_lean(s, face);
    fap_qp_clear(qp, s->count);
    for (int c = 0; c < s->count; c++) {
        qp->lo[c] = fmin(-most, s->lean[c]);
        qp->hi[c] = fmax(most, s->lean[c]);
        qp->gram[(size_t)c * (size_t)qp->capacity + (size_t)c] = lean_mm2;
        qp->linear[c] = lean_mm2 * s->lean[c];
    }
}

static void add_row(state *s, const fap_face *face, int row)
{
    const float *r = s->rows + (size_t)row * (size_t)s->count;
    const double weight = fap_blend_importance(row), target = fap_blend_row_target(face, row) - s->mean[row];

    for (int i = 0; i < s->count; i++) {
        const double a = weight * r[i];
        double *g = s->qp.gram + (size_t)i * (size_t)s->qp.capacity;
        s->qp.linear[i] += a * target;
        for (int j = 0; j < s->count; j++)
            g[j] += a * r[j];
    }
}

static void solve_pca(void *user, fap_face *face)
{
    state *s = user;
    const fap_pca *pca = &s->pca;

    set_problem(s, face);
    for (int r = 0; r < face->row_count; r++)
        add_row(s, face, face->row[r]);
    fap_qp_solve(&s->qp);
    for (int j = pca->neutral; j < pca->model_count; j++) {
        double sum = 1.0 / pca->model_count;
        for (int c = 0; c < s->count; c++)
            sum += s->qp.x[c] * pca->mix[(size_t)c * (size_t)pca->model_count + (size_t)j];
        face->weight[pca->key[j]] = (float)sum;
    }
}

const fap_blend_method fap_blend_pca = {
    .name = "pca",
    .summary = "principal components of the key models, within 3 standard deviations",
    .state_size = sizeof(state),
    .open = open_pca,
    .close = close_pca,
    .solve = solve_pca,
};
