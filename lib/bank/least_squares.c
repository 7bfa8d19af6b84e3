/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Commanded rows to weights of units by bounded least squares, per axis: a free axis pulls on nothing. The
 * minimum is unique and continuous in the targets. Source: DESIGN.md section 5.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "base/mem.h"

/* Prices in square millimetres: what a weight of one costs against a squared error. */
const float fap_most_of_a_unit = 1.25f;
static const float ridge_mm2 = 0.1f;     /* decides between equal answers: the smaller weights */
static const float shut_jaw_factor = 20; /* see price_of() */
static const double tie_mm2 = 10;        /* how dearly a region's weight leaves that of the whole face */
static const double base_hold_mm2 = 1;   /* how dearly a viseme or expression yields to low-level FAPs */

/* --- made at open --- */

static int unit(const fap_face *face, const char *name)
{
    return fap_bank_key_find(face->bank, FAP_KEY_UNIT, name);
}

static void find_rivals(fap_least_squares *ls, const fap_face *face)
{
    static const struct pair {
        const char *a, *b;
        float stiffness_mm2;
    } pairs[FAP_RIVALS] = {
        { "mouthLeft", "mouthRight", 5 },          { "jawLeft", "jawRight", 5 },
        { "eyeBlinkLeft", "eyeWideLeft", 1 },      { "eyeBlinkRight", "eyeWideRight", 1 },
        { "mouthSmileLeft", "mouthFrownLeft", 1 }, { "mouthSmileRight", "mouthFrownRight", 1 },
    };

    for (int i = 0; i < FAP_RIVALS; i++) {
        const int a = unit(face, pairs[i].a), b = unit(face, pairs[i].b);
        if (a >= 0 && b >= 0)
            ls->rivals[ls->rival_count++] = (fap_rivals){ { a, b }, pairs[i].stiffness_mm2 };
    }
}

static int is_look(const fap_face *face, int key)
{
    const fap_face_keys *k = &face->known;

    for (int right = 0; right < 2; right++)
        if (key == k->look_up[right] || key == k->look_down[right] || key == k->look_in[right] ||
            key == k->look_out[right])
            return 1;
    return 0;
}

/* The gaze's own units apart; a bank without units offers all its keys. */
static void find_free_keys(fap_least_squares *ls, const fap_face *face)
{
    int count = 0;

    for (int k = 0; k < face->key_count; k++) {
        ls->free_key[k] = face->key[k]->kind == FAP_KEY_UNIT && !is_look(face, k);
        count += ls->free_key[k];
    }
    for (int k = 0; k < face->key_count && !count; k++)
        ls->free_key[k] = 1;
}

/*
 * Lips can only be closed over an open jaw: w(mouthClose) <= w(jawOpen). With jawOpen = s + mouthClose that
 * is s >= 0, a plain bound, and mouthClose's column becomes "jaw opens behind closed lips". Over the jaw of a
 * viseme lips close by a variable of its own, mouthClose as it is: the extra column at the end.
 */
static void close_over_jaw(const fap_face *face, float *basis)
{
    const fap_face_keys *k = &face->known;

    if (k->mouth_close < 0)
        return;
    basis[face->key_count] = basis[k->mouth_close];
    if (k->jaw_open >= 0)
        basis[k->mouth_close] += basis[k->jaw_open];
}

/*
 * FAPs 39 and 40 state a puffed cheek by its sideways way alone, yet cheeks puff forward: the whole way
 * counts, and the residual adds what is missing sideways. Without this a wide mouth was found to explain them
 * better.
 */
static void puff_outward(fap_least_squares *ls, const fap_face *face)
{
    static const char *const cheeks[2] = { "5.1", "5.2" };
    const int key = face->known.cheek_puff;

    for (int right = 0; right < 2; right++) {
        const int point = fap_point_by_name(cheeks[right]);
        ls->cheek_row[right] = 3 * point;
        if (key < 0)
            continue;
        const float *m = face->key[key]->point_mm[point];
        const float way = sqrtf(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        ls->basis[3 * (size_t)point * ((size_t)face->key_count + 1) + (size_t)key] = right ? -way : way;
    }
}

static void make_basis(fap_least_squares *ls, const fap_face *face)
{
    const size_t n = (size_t)face->key_count;

    for (size_t row = 0; row < FAP_ROWS; row++) {
        memcpy(ls->basis + row * (n + 1), face->motion + row * n, n * sizeof *ls->basis);
        close_over_jaw(face, ls->basis + row * (n + 1));
    }
    puff_outward(ls, face);
}

int fap_least_squares_open(fap_least_squares *ls, const fap_face *face)
{
    const fap_allocator *alloc = &face->alloc;
    const size_t n = (size_t)face->key_count;

    ls->basis = fap_mem_calloc(alloc, (n + 1) * FAP_ROWS, sizeof *ls->basis);
    ls->free_key = fap_mem_calloc(alloc, n, sizeof *ls->free_key);
    ls->beside = fap_mem_calloc(alloc, 2 * n, sizeof *ls->beside);
    ls->mover = fap_mem_calloc(alloc, n + 1, sizeof *ls->mover);
    ls->reach = fap_mem_calloc(alloc, n + 1, sizeof *ls->reach);
    ls->variable = fap_mem_calloc(alloc, n + 1, sizeof *ls->variable);
    ls->whole = fap_mem_calloc(alloc, n + 1, sizeof *ls->whole);
    if (!ls->basis || !ls->free_key || !ls->beside || !ls->mover || !ls->reach || !ls->variable ||
        !ls->whole || fap_qp_open(&ls->qp, face->key_count + 1, alloc))
        return 1;
    make_basis(ls, face);
    find_free_keys(ls, face);
    find_rivals(ls, face);
    return 0;
}

void fap_least_squares_close(fap_least_squares *ls, const fap_face *face)
{
    void *const blocks[] = { ls->basis, ls->free_key, ls->beside, ls->mover,
                             ls->reach, ls->variable, ls->whole };

    fap_qp_close(&ls->qp, &face->alloc);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(&face->alloc, blocks[i]);
}

/* --- this frame's problem --- */

static int has_base(const fap_face *face, int key)
{
    for (int i = 0; i < face->base_count; i++)
        if (face->base_key[i] == key)
            return 1;
    return 0;
}

/* How far a viseme's or expression's jaw is open, in units of jawOpen. */
static double base_jaw(const fap_face *face)
{
    const int jaw = face->known.jaw_open;
    const float *motion = face->motion + (size_t)face->chin_row * (size_t)face->key_count;
    double sum = 0;

    for (int i = 0; i < face->base_count && jaw >= 0 && motion[jaw] < 0; i++)
        sum += face->base_weight[i] * fmax(0, motion[face->base_key[i]] / motion[jaw]);
    return sum;
}

static int drives_lips(const fap_face *face)
{
    return face->wanted[face->slit[0][0]][1] || face->wanted[face->slit[0][1]][1];
}

static float plain_price(const fap_least_squares *ls, int key)
{
    return ridge_mm2 * (1 + ls->beside[key]);
}

/* Jaw down with lips shut is open_jaw to the letter; where lips have no say, an open mouth is expected. */
static float price_of(const fap_least_squares *ls, const fap_face *face, int key)
{
    const fap_face_keys *k = &face->known;

    if (key != k->mouth_close || k->jaw_open < 0 || drives_lips(face))
        return plain_price(ls, key);
    return fmaxf(plain_price(ls, key), shut_jaw_factor * plain_price(ls, k->jaw_open));
}

static void add_variable(fap_least_squares *ls, int column, double hi, double ridge, double prior)
{
    fap_qp *qp = &ls->qp;
    const size_t i = (size_t)qp->n;

    ls->variable[qp->n++] = column;
    qp->hi[i] = hi;
    qp->gram[i * (size_t)qp->capacity + i] = ridge;
    qp->linear[i] = ridge * prior;
}

static void set_variables(fap_least_squares *ls, const fap_face *face)
{
    const int close = face->known.mouth_close;

    fap_qp_clear(&ls->qp, ls->qp.capacity);
    ls->qp.n = 0;
    for (int k = 0; k < face->key_count; k++)
        if (ls->free_key[k] && !has_base(face, k))
            add_variable(ls, k, k == close ? 1 : fap_most_of_a_unit, price_of(ls, face, k), 0);
    for (int i = 0; i < face->base_count; i++)
        add_variable(ls, face->base_key[i], face->base_weight[i], base_hold_mm2, face->base_weight[i]);
    if (close >= 0 && base_jaw(face) > 0)
        add_variable(ls, face->key_count, fmin(1, base_jaw(face)), ridge_mm2, 0);
}

static int variable_of(const fap_least_squares *ls, int key)
{
    for (int i = 0; i < ls->qp.n; i++)
        if (ls->variable[i] == key)
            return i;
    return -1;
}

/*
 * Opposites shown together (mouth left and right) cancel out but for their by-products, which the solver
 * would make use of: stiffness * (w1 + w2)^2 makes that dear and keeps the problem convex.
 */
static void add_rivals(fap_least_squares *ls)
{
    fap_qp *qp = &ls->qp;

    for (int r = 0; r < ls->rival_count; r++) {
        const fap_rivals *rivals = &ls->rivals[r];
        const int pair[2] = { variable_of(ls, rivals->key[0]), variable_of(ls, rivals->key[1]) };
        for (int i = 0; i < 4 && pair[0] >= 0 && pair[1] >= 0; i++)
            qp->gram[(size_t)pair[i / 2] * (size_t)qp->capacity + (size_t)pair[i % 2]] +=
                rivals->stiffness_mm2;
    }
}

/* A cheek that is given forward, too, needs no guess at how far it puffs. */
static float reach_of(const fap_least_squares *ls, const fap_face *face, int row, int column)
{
    const int guessed =
        column == face->known.cheek_puff && (row == ls->cheek_row[0] || row == ls->cheek_row[1]);

    if (guessed && face->wanted[row / 3][2])
        return face->motion[(size_t)row * (size_t)face->key_count + (size_t)column];
    return ls->basis[(size_t)row * ((size_t)face->key_count + 1) + (size_t)column];
}

/* The variables that move this row, and how far. */
static int list_movers(fap_least_squares *ls, const fap_face *face, int row)
{
    int n = 0;

    for (int i = 0; i < ls->qp.n; i++) {
        const float reach = reach_of(ls, face, row, ls->variable[i]);
        if (reach == 0)
            continue;
        ls->mover[n] = i;
        ls->reach[n++] = reach;
    }
    return n;
}

static void add_row(fap_least_squares *ls, const fap_face *face, int row, float share)
{
    fap_qp *qp = &ls->qp;
    const int n = list_movers(ls, face, row);
    const double weight = share * fap_blend_importance(row), target = fap_blend_row_target(face, row);

    for (int i = 0; i < n; i++) {
        const double a = weight * ls->reach[i];
        double *g = qp->gram + (size_t)ls->mover[i] * (size_t)qp->capacity;
        qp->linear[ls->mover[i]] += a * target;
        for (int j = 0; j < n; j++)
            g[ls->mover[j]] += a * ls->reach[j];
    }
}

/* Back from "jaw opens behind closed lips" to the bank's own keys. */
static void read_answer(const fap_least_squares *ls, const fap_face *face, float *weight)
{
    const fap_face_keys *k = &face->known;

    memset(weight, 0, sizeof *weight * (size_t)face->key_count);
    for (int i = 0; i < ls->qp.n; i++) {
        const float x = (float)ls->qp.x[i];
        const int column = ls->variable[i];
        weight[column < face->key_count ? column : k->mouth_close] += x;
        if (column == k->mouth_close && k->jaw_open >= 0)
            weight[k->jaw_open] += x;
    }
    if (k->jaw_open >= 0)
        weight[k->jaw_open] = fminf(fap_most_of_a_unit, weight[k->jaw_open]);
}

void fap_least_squares_solve(fap_least_squares *ls, const fap_face *face, float *weight)
{
    fap_blend_beside(face, -1, ls->basis, (size_t)face->key_count + 1, ls->beside);
    set_variables(ls, face);
    add_rivals(ls);
    for (int r = 0; r < face->row_count; r++)
        add_row(ls, face, face->row[r], 1);
    fap_qp_solve(&ls->qp);
    memcpy(ls->whole, ls->qp.x, sizeof *ls->whole * (size_t)ls->qp.n);
    read_answer(ls, face, weight);
}

/* Every weight is tied to the whole face's answer. */
static void tie(fap_least_squares *ls)
{
    fap_qp *qp = &ls->qp;

    for (size_t i = 0; i < (size_t)qp->n; i++) {
        qp->gram[i * (size_t)qp->capacity + i] += tie_mm2;
        qp->linear[i] += tie_mm2 * ls->whole[i];
    }
}

void fap_least_squares_refine(fap_least_squares *ls, const fap_face *face, int region, float *weight)
{
    set_variables(ls, face);
    add_rivals(ls);
    tie(ls);
    for (int r = 0; r < face->row_count; r++) {
        const float share = face->regions.point[region][face->row[r] / 3];
        if (share > 0)
            add_row(ls, face, face->row[r], share);
    }
    fap_qp_solve(&ls->qp);
    read_answer(ls, face, weight);
}
