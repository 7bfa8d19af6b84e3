/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Commanded rows to weights of units by bounded least squares, per axis: a free axis pulls on nothing. The
 * minimum is unique and continuous in the targets. Source: DESIGN.md section 5.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "base/lanes.h"
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

/* The whole face's, and one of each region where there are any. */
static int open_problems(fap_least_squares *ls, const fap_face *face)
{
    const size_t size = (size_t)ls->qp.capacity;
    const int count = 1 + (face->regions.count > 1 ? face->regions.count : 0);

    ls->problem = fap_mem_calloc(&face->alloc, (size_t)count, sizeof *ls->problem);
    if (!ls->problem)
        return 1;
    ls->problem_count = count;
    for (int i = 0; i < count; i++) {
        fap_problem *p = &ls->problem[i];
        p->base_count = -1;
        p->gram = fap_mem_calloc(&face->alloc, size * size, sizeof *p->gram);
        p->variable = fap_mem_calloc(&face->alloc, size, sizeof *p->variable);
        p->last = fap_mem_calloc(&face->alloc, size, sizeof *p->last);
        if (!p->gram || !p->variable || !p->last)
            return 1;
    }
    return 0;
}

static void close_problems(fap_least_squares *ls, const fap_face *face)
{
    for (int i = 0; i < ls->problem_count; i++) {
        fap_mem_free(&face->alloc, ls->problem[i].gram);
        fap_mem_free(&face->alloc, ls->problem[i].variable);
        fap_mem_free(&face->alloc, ls->problem[i].last);
    }
    fap_mem_free(&face->alloc, ls->problem);
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
    ls->pull = fap_mem_calloc(alloc, n + 1, sizeof *ls->pull);
    ls->whole = fap_mem_calloc(alloc, n + 1, sizeof *ls->whole);
    if (!ls->basis || !ls->free_key || !ls->beside || !ls->mover || !ls->reach || !ls->pull || !ls->whole ||
        fap_qp_open(&ls->qp, face->key_count + 1, alloc) || open_problems(ls, face))
        return 1;
    make_basis(ls, face);
    find_free_keys(ls, face);
    find_rivals(ls, face);
    return 0;
}

void fap_least_squares_close(fap_least_squares *ls, const fap_face *face)
{
    void *const blocks[] = { ls->basis, ls->free_key, ls->beside, ls->mover, ls->reach, ls->pull, ls->whole };

    close_problems(ls, face);
    fap_qp_close(&ls->qp, &face->alloc);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(&face->alloc, blocks[i]);
}

/* --- the problem: what it is made of --- */

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

static int has_base_jaw(const fap_face *face)
{
    return face->known.mouth_close >= 0 && base_jaw(face) > 0;
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

static void add_variable(fap_problem *p, size_t stride, int column, double ridge)
{
    const size_t i = (size_t)p->n++;

    p->variable[i] = column;
    p->gram[i * stride + i] = ridge;
}

/* Keys that are free, then those that are shown, then lips that close over the shown ones' jaw. */
static void list_variables(const fap_least_squares *ls, const fap_face *face, fap_problem *p)
{
    const size_t stride = (size_t)ls->qp.capacity;

    p->n = 0;
    for (int k = 0; k < face->key_count; k++)
        if (ls->free_key[k] && !has_base(face, k))
            add_variable(p, stride, k, price_of(ls, face, k));
    for (int i = 0; i < face->base_count; i++)
        add_variable(p, stride, face->base_key[i], base_hold_mm2);
    if (p->has_base_jaw)
        add_variable(p, stride, face->key_count, ridge_mm2);
}

static int variable_of(const fap_problem *p, int key)
{
    for (int i = 0; i < p->n; i++)
        if (p->variable[i] == key)
            return i;
    return -1;
}

/*
 * Opposites shown together (mouth left and right) cancel out but for their by-products, which the solver
 * would make use of: stiffness * (w1 + w2)^2 makes that dear and keeps the problem convex.
 */
static void add_rivals(const fap_least_squares *ls, fap_problem *p)
{
    const size_t stride = (size_t)ls->qp.capacity;

    for (int r = 0; r < ls->rival_count; r++) {
        const fap_rivals *rivals = &ls->rivals[r];
        const int pair[2] = { variable_of(p, rivals->key[0]), variable_of(p, rivals->key[1]) };
        for (int i = 0; i < 4 && pair[0] >= 0 && pair[1] >= 0; i++)
            p->gram[(size_t)pair[i / 2] * stride + (size_t)pair[i % 2]] += rivals->stiffness_mm2;
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
static int list_movers(fap_least_squares *ls, const fap_face *face, const fap_problem *p, int row)
{
    int n = 0;

    for (int i = 0; i < p->n; i++) {
        const float reach = reach_of(ls, face, row, p->variable[i]);
        if (reach == 0)
            continue;
        ls->mover[n] = i;
        ls->reach[n++] = reach;
    }
    return n;
}

/* What a square millimetre of a row counts in a region, -1 the whole face. */
static float weight_of(const fap_face *face, int region, int row)
{
    const float share = region < 0 ? 1 : face->regions.point[region][row / 3];
    return share * fap_blend_importance(row);
}

static void add_row(fap_least_squares *ls, const fap_face *face, fap_problem *p, int row, double weight)
{
    const int n = list_movers(ls, face, p, row);

    for (int i = 0; i < n; i++) {
        const double a = weight * ls->reach[i];
        double *g = p->gram + (size_t)ls->mover[i] * (size_t)ls->qp.capacity;
        for (int j = 0; j < n; j++)
            g[ls->mover[j]] += a * ls->reach[j];
    }
}

static int is_made_for(const fap_problem *p, const fap_face *face)
{
    return p->base_count == face->base_count && p->follows_on == face->follows_on &&
           p->has_base_jaw == has_base_jaw(face) &&
           !memcmp(p->base_key, face->base_key, sizeof *p->base_key * (size_t)p->base_count) &&
           !memcmp(p->wanted, face->wanted, sizeof p->wanted);
}

static void make_problem(fap_least_squares *ls, const fap_face *face, int region, fap_problem *p)
{
    const size_t size = (size_t)ls->qp.capacity;

    memcpy(p->wanted, face->wanted, sizeof p->wanted);
    memcpy(p->base_key, face->base_key, sizeof p->base_key);
    p->base_count = face->base_count;
    p->has_base_jaw = has_base_jaw(face);
    p->follows_on = face->follows_on;
    memset(p->gram, 0, size * size * sizeof *p->gram);
    fap_blend_beside(face, -1, ls->basis, (size_t)face->key_count + 1, ls->beside);
    list_variables(ls, face, p);
    add_rivals(ls, p);
    for (int r = 0; r < face->row_count; r++)
        if (weight_of(face, region, face->row[r]) > 0)
            add_row(ls, face, p, face->row[r], weight_of(face, region, face->row[r]));
    const double held = (region >= 0 ? tie_mm2 : 0) + (p->follows_on ? face->cfg.temporal_mm2 : 0);
    for (size_t i = 0; i < (size_t)p->n; i++)
        p->gram[i * size + i] += held;
}

/* --- this frame's targets --- */

/* What the targets ask of each column: the transposed basis times weighted targets. */
static void gather_pull(fap_least_squares *ls, const fap_face *face, int region)
{
    const int columns = face->key_count + 1, puff = face->known.cheek_puff;

    memset(ls->pull, 0, (size_t)columns * sizeof *ls->pull);
    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        const float *basis = ls->basis + (size_t)row * (size_t)columns;
        const float asked = weight_of(face, region, row) * fap_blend_row_target(face, row);
        fap_lanes_add(ls->pull, basis, asked, columns);
        if (puff >= 0)
            ls->pull[puff] += asked * (reach_of(ls, face, row, puff) - basis[puff]);
    }
}

static double bound_of(const fap_face *face, int column)
{
    for (int i = 0; i < face->base_count; i++)
        if (face->base_key[i] == column)
            return face->base_weight[i];
    if (column == face->key_count)
        return fmin(1, base_jaw(face));
    return column == face->known.mouth_close ? 1 : fap_most_of_a_unit;
}

static void set_targets(fap_least_squares *ls, const fap_face *face, int region, const fap_problem *p)
{
    fap_qp *qp = &ls->qp;

    gather_pull(ls, face, region);
    for (int i = 0; i < p->n; i++) {
        const int column = p->variable[i];
        qp->lo[i] = 0;
        qp->hi[i] = bound_of(face, column);
        qp->linear[i] = ls->pull[column];
        if (has_base(face, column))
            qp->linear[i] += base_hold_mm2 * qp->hi[i];
        if (region >= 0)
            qp->linear[i] += tie_mm2 * ls->whole[i];
        if (p->follows_on)
            qp->linear[i] += face->cfg.temporal_mm2 * p->last[column];
    }
}

/* Back from "jaw opens behind closed lips" to the bank's own keys. */
static void read_answer(const fap_least_squares *ls, const fap_face *face, const fap_problem *p,
                        float *weight)
{
    const fap_face_keys *k = &face->known;

    memset(weight, 0, sizeof *weight * (size_t)face->key_count);
    for (int i = 0; i < p->n; i++) {
        const float x = (float)ls->qp.x[i];
        const int column = p->variable[i];
        weight[column < face->key_count ? column : k->mouth_close] += x;
        if (column == k->mouth_close && k->jaw_open >= 0)
            weight[k->jaw_open] += x;
    }
    if (k->jaw_open >= 0)
        weight[k->jaw_open] = fminf(fap_most_of_a_unit, weight[k->jaw_open]);
}

static void solve(fap_least_squares *ls, const fap_face *face, int region, float *weight)
{
    fap_problem *p = &ls->problem[1 + region];

    if (!is_made_for(p, face))
        make_problem(ls, face, region, p);
    ls->qp.gram = p->gram;
    ls->qp.n = p->n;
    set_targets(ls, face, region, p);
    fap_qp_solve(&ls->qp);
    memset(p->last, 0, ((size_t)face->key_count + 1) * sizeof *p->last);
    for (int i = 0; i < p->n; i++)
        p->last[p->variable[i]] = (float)ls->qp.x[i];
    read_answer(ls, face, p, weight);
}

void fap_least_squares_solve(fap_least_squares *ls, const fap_face *face, float *weight)
{
    solve(ls, face, -1, weight);
    memcpy(ls->whole, ls->qp.x, sizeof *ls->whole * (size_t)ls->qp.n);
}

void fap_least_squares_refine(fap_least_squares *ls, const fap_face *face, int region, float *weight)
{
    solve(ls, face, region, weight);
}
