/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From commanded rows (one axis of one feature point each) to blend weights, three ways: bounded least
 * squares on the units, the thesis's genetic algorithm, and that algorithm started from the least-squares
 * answer. Source: DESIGN.md section 5; Zhu 2006 chapter 3.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"

/* Lengths in millimetres, prices in square millimetres: what a weight of one costs against a squared error.
 */
static const float weight_max = 1.25f;   /* units may go a little beyond what was modelled */
static const float most_of_a_key = 2;    /* the thesis sets no bound; absurd targets need one */
static const float farthest_mm = 150;    /* beyond it a target is noise; keeps sums of squares finite */
static const float ridge_mm2 = 0.1f;     /* decides between equal answers: the smaller weights */
static const float shut_jaw_factor = 20; /* see price_of() */
static const double base_hold_mm2 = 1;   /* how dearly a viseme or expression yields to low-level FAPs */
static const float most_beside = 300;    /* caps of "how much beside the point" a key is ... */
static const float left_out_beside =
    10;                               /* ... and from where, above the best, the thesis's way leaves it out */
static const float beside_weight = 1; /* the GA: a millimetre at a point nobody speaks of */
static const float worth_it_mm = 0.1f;       /* RMS the GA must gain before it is believed ... */
static const float fully_worth_it_mm = 0.5f; /* ... and before it is believed fully */

static float clampf(float x, float lo, float hi)
{
    return fminf(hi, fmaxf(lo, x));
}

/*
 * An upper lid stops on the lower one. Asked for more (markers sit above the lid and travel further), the
 * solver would shut the eye too tight to get there. What was asked is still what the error is measured
 * against.
 */
static void stop_lid(fap_face *face, int upper, int lower)
{
    const float gap = face->neutral[upper][1] - face->neutral[lower][1];
    const float lower_lid = face->wanted[lower][1] ? face->target[lower][1] : 0;

    if (face->wanted[upper][1] && gap > 0)
        face->target[upper][1] = fmaxf(face->target[upper][1], fminf(lower_lid - gap, 0));
}

void fap_face_read_targets(fap_face *face, const fap_frame *frame)
{
    fap_face_targets(fap_bank_fapu(face->bank), frame, face->target, face->wanted);
    face->row_count = 0;
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int axis = 0; axis < 3; axis++) {
            float *t = &face->target[p][axis];
            *t = clampf(*t * face->cfg.emphasis, -farthest_mm, farthest_mm);
            face->wanted[p][axis] &= face->solvable[p];
            if (face->wanted[p][axis])
                face->row[face->row_count++] = (uint16_t)(3 * p + axis);
        }
    memcpy(face->asked, face->target, sizeof face->asked);
    for (int i = FAP_LIP_SLITS; i < FAP_SLITS; i++)
        stop_lid(face, face->slit[i][0], face->slit[i][1]);
}

/* A mouth that does not quite close, or lids that leave a slit, are seen at once; a cheek half a millimetre
 * off is not. */
static float importance(int row)
{
    const fap_point_info *info = fap_point_get(row / 3);

    switch (info->group) {
    case 2: return info->index == 1 ? 1 : info->index == 10 ? 0.5f : row % 3 == 1 ? 4 : 2;
    case 3: return 4;
    case 8: return 2;
    case 5:
    case 9: return 0.5f;
    case 10: return 0.25f;
    default: return 1;
    }
}

float fap_face_row_motion(const fap_face *face, int row, const float *weight)
{
    const float *motion = face->motion + (size_t)row * (size_t)face->key_count;
    float sum = 0;

    for (int k = 0; k < face->key_count; k++)
        sum += motion[k] * weight[k];
    return sum;
}

/* What is left of a row's target once gaze and blink have moved it. */
static float row_target(const fap_face *face, int row)
{
    return face->target[row / 3][row % 3] - face->fixed_motion[row];
}

/* --- least squares --- */

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
static void puff_outward(fap_face *face)
{
    static const char *const cheeks[2] = { "5.1", "5.2" };
    const int key = face->known.cheek_puff;

    for (int right = 0; right < 2 && key >= 0; right++) {
        const int point = fap_point_by_name(cheeks[right]);
        const float *m = face->key[key]->point_mm[point];
        const float way = sqrtf(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        face->basis[3 * (size_t)point * ((size_t)face->key_count + 1) + (size_t)key] = right ? -way : way;
    }
}

void fap_face_make_basis(fap_face *face)
{
    const size_t n = (size_t)face->key_count;

    for (size_t row = 0; row < FAP_ROWS; row++) {
        memcpy(face->basis + row * (n + 1), face->motion + row * n, n * sizeof *face->basis);
        close_over_jaw(face, face->basis + row * (n + 1));
    }
    puff_outward(face);
}

static const float *basis_row(const fap_face *face, int row)
{
    return face->basis + (size_t)row * ((size_t)face->key_count + 1);
}

static void add_squares(const fap_face *face, int row, float *sum)
{
    const float *a = basis_row(face, row);

    for (int k = 0; k < face->key_count; k++)
        sum[k] += a[k] * a[k];
}

static int drives_lips(const fap_face *face)
{
    return face->wanted[face->slit[0][0]][1] || face->wanted[face->slit[0][1]][1];
}

/*
 * For each key, how much it moves points nobody speaks of against how much it moves commanded ones. Brows
 * move the lids a little, too, but a command to the lids alone should close the eyes and leave the brows in
 * peace.
 */
static void measure_beside(fap_face *face)
{
    float *beside = face->beside, *asked = face->beside + face->key_count;

    memset(face->beside, 0, 2 * sizeof *face->beside * (size_t)face->key_count);
    for (int row = 0; row < FAP_ROWS; row++) {
        const uint8_t *w = face->wanted[row / 3];
        if (w[row % 3])
            add_squares(face, row, asked);
        else if (!w[0] && !w[1] && !w[2])
            add_squares(face, row, beside);
    }
    for (int k = 0; k < face->key_count; k++)
        face->beside[k] = fminf(beside[k] / (asked[k] + 1e-3f), most_beside);
}

static float plain_price(const fap_face *face, int key)
{
    return ridge_mm2 * (1 + face->beside[key]);
}

/* Jaw down with lips shut is open_jaw to the letter; where lips have no say, an open mouth is expected. */
static float price_of(const fap_face *face, int key)
{
    const fap_face_keys *k = &face->known;

    if (key != k->mouth_close || k->jaw_open < 0 || drives_lips(face))
        return plain_price(face, key);
    return fmaxf(plain_price(face, key), shut_jaw_factor * plain_price(face, k->jaw_open));
}

static void add_variable(fap_face *face, int column, double hi, double ridge, double prior)
{
    fap_qp *qp = &face->qp;
    const size_t i = (size_t)qp->n;

    face->variable[qp->n++] = column;
    qp->hi[i] = hi;
    qp->gram[i * (size_t)qp->capacity + i] = ridge;
    qp->linear[i] = ridge * prior;
}

static void set_variables(fap_face *face)
{
    const int close = face->known.mouth_close;

    measure_beside(face);
    fap_qp_clear(&face->qp, face->qp.capacity);
    face->qp.n = 0;
    for (int k = 0; k < face->key_count; k++)
        if (face->free_key[k] && !has_base(face, k))
            add_variable(face, k, k == close ? 1 : weight_max, price_of(face, k), 0);
    for (int i = 0; i < face->base_count; i++)
        add_variable(face, face->base_key[i], face->base_weight[i], base_hold_mm2, face->base_weight[i]);
    if (close >= 0 && base_jaw(face) > 0)
        add_variable(face, face->key_count, fmin(1, base_jaw(face)), ridge_mm2, 0);
}

static int variable_of(const fap_face *face, int key)
{
    for (int i = 0; i < face->qp.n; i++)
        if (face->variable[i] == key)
            return i;
    return -1;
}

/*
 * Opposites shown together (mouth left and right) cancel out but for their by-products, which the solver
 * would make use of: stiffness * (w1 + w2)^2 makes that dear and keeps the problem convex.
 */
static void add_rivals(fap_face *face)
{
    fap_qp *qp = &face->qp;

    for (int r = 0; r < face->rival_count; r++) {
        const fap_face_rivals *rivals = &face->rivals[r];
        const int pair[2] = { variable_of(face, rivals->key[0]), variable_of(face, rivals->key[1]) };
        for (int i = 0; i < 4 && pair[0] >= 0 && pair[1] >= 0; i++)
            qp->gram[(size_t)pair[i / 2] * (size_t)qp->capacity + (size_t)pair[i % 2]] +=
                rivals->stiffness_mm2;
    }
}

/* The variables that move this row, and how far. */
static int list_movers(fap_face *face, int row)
{
    const float *a = basis_row(face, row);
    int n = 0;

    for (int i = 0; i < face->qp.n; i++)
        if (a[face->variable[i]] != 0) {
            face->mover[n] = i;
            face->reach[n++] = a[face->variable[i]];
        }
    return n;
}

static void add_row(fap_face *face, int row)
{
    fap_qp *qp = &face->qp;
    const int n = list_movers(face, row);
    const double weight = importance(row), target = row_target(face, row);

    for (int i = 0; i < n; i++) {
        const double a = weight * face->reach[i];
        double *g = qp->gram + (size_t)face->mover[i] * (size_t)qp->capacity;
        qp->linear[face->mover[i]] += a * target;
        for (int j = 0; j < n; j++)
            g[face->mover[j]] += a * face->reach[j];
    }
}

static void solve_least_squares(fap_face *face)
{
    const fap_face_keys *k = &face->known;

    set_variables(face);
    add_rivals(face);
    for (int r = 0; r < face->row_count; r++)
        add_row(face, face->row[r]);
    fap_qp_solve(&face->qp);
    memset(face->weight, 0, sizeof *face->weight * (size_t)face->key_count);
    for (int i = 0; i < face->qp.n; i++) {
        const float x = (float)face->qp.x[i];
        const int column = face->variable[i];
        face->weight[column < face->key_count ? column : k->mouth_close] += x;
        if (column == k->mouth_close && k->jaw_open >= 0)
            face->weight[k->jaw_open] += x;
    }
    if (k->jaw_open >= 0)
        face->weight[k->jaw_open] = fminf(weight_max, face->weight[k->jaw_open]);
}

/* --- the thesis's way --- */

/* 3D targets: what viseme and expression ask of a point, overridden where a FAP speaks; unknown axes are 0.
 */
static int wanted_vectors(const fap_face *face, int *point, float *vector)
{
    int n = 0;

    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        float *v = vector + 3 * (size_t)n;
        for (int axis = 0; axis < 3; axis++) {
            const int row = 3 * p + axis;
            v[axis] = face->wanted[p][axis] ? row_target(face, row) : 0;
            for (int i = 0; i < face->base_count && !face->wanted[p][axis]; i++)
                v[axis] += face->cfg.emphasis * face->base_weight[i] *
                           face->motion[(size_t)row * (size_t)face->key_count + (size_t)face->base_key[i]];
        }
        if (face->solvable[p] && (v[0] != 0 || v[1] != 0 || v[2] != 0))
            point[n++] = p;
    }
    return n;
}

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

/* The thesis's feature points are those its bank moves; the tongue, say, is left out of the fitness here as
 * there. */
static int drop_unmoved(const fap_face *face, int *point, float *vector, int n)
{
    int kept = 0;

    for (int i = 0; i < n; i++) {
        if (!population_moves(face, point[i]))
            continue;
        memmove(vector + 3 * (size_t)kept, vector + 3 * (size_t)i, 3 * sizeof *vector);
        point[kept++] = point[i];
    }
    return kept;
}

static float least_beside(const fap_face *face)
{
    float least = most_beside;

    for (int k = 0; k < face->key_count; k++)
        if (face->population[k])
            least = fminf(least, face->beside[k]);
    return least;
}

/*
 * A key that hardly moves what is asked for (a blink, when only the mouth is commanded) would be scaled to a
 * monster by the ratio of lengths; the thesis's keys all move most of the face. With every point commanded
 * all keys take part.
 */
static void add_population(fap_face *face, const int *point, int n)
{
    float *vector, *gene;
    const float least = least_beside(face);

    for (int k = 0; k < face->key_count; k++) {
        if (!face->population[k] || face->beside[k] > least + left_out_beside ||
            !fap_ga_add(&face->ga, &vector, &gene))
            continue;
        gene[k] = 1;
        for (int i = 0; i < 3 * n; i++)
            vector[i] =
                face->motion[(size_t)(3 * point[i / 3] + i % 3) * (size_t)face->key_count + (size_t)k];
    }
}

static void solve_zhu(fap_face *face)
{
    int point[FAP_POINT_COUNT];
    float vector[FAP_ROWS + 3], score;
    const int n = drop_unmoved(face, point, vector, wanted_vectors(face, point, vector));

    memset(face->weight, 0, sizeof *face->weight * (size_t)face->key_count);
    if (!n)
        return;
    measure_beside(face);
    fap_ga_clear(&face->ga);
    add_population(face, point, n);
    const fap_ga_task task = { .target = vector,
                               .size = 3 * n,
                               .cosine = 1,
                               .crossover = face->cfg.crossover,
                               .generations = face->cfg.generations,
                               .seed = face->cfg.seed };
    const float *gene = fap_ga_run(&face->ga, &task, &score);
    for (int k = 0; k < face->key_count && gene; k++)
        face->weight[k] = clampf(gene[k], -most_of_a_key, most_of_a_key);
}

/* --- the default: the same algorithm, seeded with the exact answer, counting millimetres --- */

/* What the GA compares: rows, where they should go, what a millimetre counts. */
typedef struct aim {
    int commanded, count; /* commanded rows first */
    uint16_t row[FAP_ROWS];
    float target[FAP_ROWS], weight[FAP_ROWS];
} aim;

static void aim_at(aim *a, int row, float target, float weight)
{
    a->row[a->count] = (uint16_t)row;
    a->target[a->count] = target;
    a->weight[a->count++] = weight;
}

/*
 * Commanded rows at their targets; points nobody speaks of where the exact answer leaves them. Without the
 * latter a raised brow was reached by "surprise", open mouth and all.
 */
static void take_aim(const fap_face *face, aim *a)
{
    a->count = 0;
    for (int r = 0; r < face->row_count; r++)
        aim_at(a, face->row[r], row_target(face, face->row[r]), importance(face->row[r]));
    a->commanded = a->count;
    for (int row = 0; row < FAP_ROWS; row++) {
        const uint8_t *w = face->wanted[row / 3];
        if (face->solvable[row / 3] && !w[0] && !w[1] && !w[2])
            aim_at(a, row, fap_face_row_motion(face, row, face->weight), beside_weight);
    }
}

static float squared_error(const fap_face *face, const aim *a, const float *weight, int weighted)
{
    float sum = 0;

    for (int r = 0; r < a->commanded; r++) {
        const float e = fap_face_row_motion(face, a->row[r], weight) - a->target[r];
        sum += (weighted ? a->weight[r] : 1) * e * e;
    }
    return sum;
}

static void add_weights(fap_face *face, const aim *a, const float *weight)
{
    float *vector, *gene;

    if (!fap_ga_add(&face->ga, &vector, &gene))
        return;
    memcpy(gene, weight, sizeof *gene * (size_t)face->key_count);
    for (int r = 0; r < a->count; r++)
        vector[r] = fap_face_row_motion(face, a->row[r], weight);
}

static void add_key(fap_face *face, const aim *a, int key)
{
    float *vector, *gene;

    if (!fap_ga_add(&face->ga, &vector, &gene))
        return;
    gene[key] = 1;
    for (int r = 0; r < a->count; r++)
        vector[r] = face->motion[(size_t)a->row[r] * (size_t)face->key_count + (size_t)key];
}

/*
 * The exact answer can only be beaten by keys that the units do not span. How far the GA's answer is believed
 * grows smoothly with what it gains, so that a gain that comes and goes does not make the face twitch; the
 * error is convex, so part of the way is never worse than the start.
 */
static void accept(fap_face *face, const float *gene, float gain_mm, float *mixed)
{
    const float t = clampf((gain_mm - worth_it_mm) / (fully_worth_it_mm - worth_it_mm), 0, 1);
    const float share = t * t * (3 - 2 * t);

    for (int k = 0; k < face->key_count; k++)
        mixed[k] = face->weight[k] + share * (gene[k] - face->weight[k]);
}

static float rms(float squared, int count)
{
    return sqrtf(squared / (float)count);
}

static void seed_population(fap_face *face, const aim *a)
{
    fap_ga_clear(&face->ga);
    add_weights(face, a, face->weight);
    for (int k = 0; k < face->key_count; k++)
        if (face->population[k])
            add_key(face, a, k);
}

/* Mean cosine along the commanded axes alone: what nobody asked for is neither right nor wrong. */
static float fitness_of(const fap_face *face, const float *weight)
{
    float target[FAP_ROWS] = { 0 }, got[FAP_ROWS] = { 0 };

    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        target[row] = row_target(face, row);
        got[row] = fap_face_row_motion(face, row, weight);
    }
    return fap_ga_cosine(target, got, FAP_ROWS);
}

static void take_if_better(fap_face *face, const aim *a, const float *weight)
{
    if (squared_error(face, a, weight, 0) <= squared_error(face, a, face->weight, 0) &&
        fitness_of(face, weight) >= fitness_of(face, face->weight))
        memcpy(face->weight, weight, sizeof *weight * (size_t)face->key_count);
}

static void improve(fap_face *face)
{
    aim a;
    float score;

    take_aim(face, &a);
    const float before_mm = rms(squared_error(face, &a, face->weight, 1), a.commanded);
    if (before_mm < worth_it_mm)
        return;
    seed_population(face, &a);
    const fap_ga_task task = { .target = a.target,
                               .row_weight = a.weight,
                               .size = a.count,
                               .crossover = face->cfg.crossover,
                               .generations = face->cfg.generations,
                               .seed = face->cfg.seed,
                               .gene_max = weight_max };
    const float *gene = fap_ga_run(&face->ga, &task, &score);
    float *mixed = face->ga.gene; /* the first individual's place: the run is over */
    accept(face, gene, before_mm - rms(-score, a.commanded), mixed);
    take_if_better(face, &a, mixed);
}

/* ------------------------------------------------------------------------------------------------------------------
 */

static void show_base(fap_face *face)
{
    memset(face->weight, 0, sizeof *face->weight * (size_t)face->key_count);
    for (int i = 0; i < face->base_count; i++)
        face->weight[face->base_key[i]] = face->base_weight[i];
}

void fap_face_solve(fap_face *face)
{
    if (!face->row_count)
        show_base(face);
    else if (face->cfg.blend == FAP_BLEND_ZHU)
        solve_zhu(face);
    else
        solve_least_squares(face);
    if (face->row_count && face->cfg.blend == FAP_BLEND_GA)
        improve(face);
    face->stats.fitness = fitness_of(face, face->weight);
    for (int k = 0; k < face->key_count; k++)
        face->weight[k] += face->fixed[k];
}
