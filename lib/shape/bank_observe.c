/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Columns are key models, rows the point axes that are seen: the matrix every blend method has to work with. Its
 * singular values come from one-sided Jacobi rotations, which find small ones as exactly as large ones.
 */
#include <fap/studio/bank_observe.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_KEYS = 512, MAX_SWEEPS = 60, ROW_ROOM = FAP_POINT_COUNT * 3 };

static const double unseen_mm = 0.05;    /* at full strength */
static const double alike_cosine = 0.98; /* 11 degrees */
static const double rank_limit = 1e-3;   /* of the strongest: motions are stored to a few micrometres */
static const double jacobi_done = 1e-12;

typedef struct columns {
    int count, rows;
    int *key;    /* [count]: bank index */
    double *at;  /* [count][rows] */
    double *own; /* [count]: squared length */
} columns;

static double *column(const columns *c, int i)
{
    return c->at + (size_t)i * (size_t)c->rows;
}

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* --- the matrix --- */

static int sees(const fap_bank *bank, const uint8_t seen[FAP_POINT_COUNT][3], int point, int axis)
{
    return fap_bank_point_get(bank, point)->present && (!seen || seen[point][axis]);
}

static int pick_keys(const fap_bank *bank, unsigned kinds, int *key)
{
    int count = 0;

    for (int k = 0; k < fap_bank_key_count(bank); k++)
        if (kinds >> fap_bank_key_get(bank, k)->kind & 1) {
            if (count == MAX_KEYS)
                return -1;
            key[count++] = k;
        }
    return count;
}

/* What each key does to one axis of one point. 0: none of them anything. */
static int fill_row(const columns *c, const fap_bank *bank, int point, int axis, double *row)
{
    double most = 0;

    for (int i = 0; i < c->count; i++) {
        row[(size_t)i * ROW_ROOM] = (double)fap_bank_key_get(bank, c->key[i])->point_mm[point][axis];
        most = fmax(most, fabs(row[(size_t)i * ROW_ROOM]));
    }
    return most > unseen_mm;
}

/* Columns are laid out for all rows there could be, and moved together once the number is known. */
static void fill(columns *c, const fap_bank *bank, const uint8_t seen[FAP_POINT_COUNT][3])
{
    for (int point = 0; point < FAP_POINT_COUNT; point++)
        for (int axis = 0; axis < 3; axis++)
            if (sees(bank, seen, point, axis))
                c->rows += fill_row(c, bank, point, axis, c->at + c->rows);
    for (int i = 0; i < c->count; i++) {
        memmove(column(c, i), c->at + (size_t)i * ROW_ROOM, (size_t)c->rows * sizeof *c->at);
        c->own[i] = dot(column(c, i), column(c, i), c->rows);
    }
}

/* --- what it says --- */

static double largest(const double *v, int n)
{
    double most = 0;

    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(v[i]));
    return most;
}

static void find_unseen(const columns *c, fap_observation *o)
{
    for (int i = 0; i < c->count; i++)
        if (largest(column(c, i), c->rows) <= unseen_mm)
            o->unseen[o->unseen_count++] = c->key[i];
}

static int by_likeness(const void *a, const void *b)
{
    const float x = fabsf(((const fap_alike *)a)->cosine), y = fabsf(((const fap_alike *)b)->cosine);
    return (x < y) - (x > y);
}

static void find_alike(const columns *c, fap_observation *o)
{
    for (int i = 0; i < c->count; i++)
        for (int k = i + 1; k < c->count; k++) {
            const double *a = column(c, i), *b = column(c, k);
            if (largest(a, c->rows) <= unseen_mm || largest(b, c->rows) <= unseen_mm)
                continue;
            const double cosine = dot(a, b, c->rows) / sqrt(c->own[i] * c->own[k]);
            if (fabs(cosine) >= alike_cosine)
                o->alike[o->alike_count++] = (fap_alike){ { c->key[i], c->key[k] }, (float)cosine };
        }
    if (o->alike_count)
        qsort(o->alike, (size_t)o->alike_count, sizeof *o->alike, by_likeness);
}

/* Turns two columns against each other until they are orthogonal. 0: they were. */
static int rotate_pair(columns *c, int i, int k)
{
    double *a = column(c, i), *b = column(c, k);
    const double both = dot(a, b, c->rows);

    if (fabs(both) <= jacobi_done * sqrt(c->own[i] * c->own[k]))
        return 0;
    const double zeta = (c->own[k] - c->own[i]) / (2 * both);
    const double t = (zeta < 0 ? -1 : 1) / (fabs(zeta) + sqrt(1 + zeta * zeta));
    const double cosine = 1 / sqrt(1 + t * t), sine = t * cosine;
    for (int r = 0; r < c->rows; r++) {
        const double x = a[r];
        a[r] = cosine * x - sine * b[r];
        b[r] = sine * x + cosine * b[r];
    }
    c->own[i] = dot(a, a, c->rows);
    c->own[k] = dot(b, b, c->rows);
    return 1;
}

/* Afterwards the columns' lengths are the singular values. */
static void orthogonalise(columns *c)
{
    for (int sweep = 0, turned = 1; turned && sweep < MAX_SWEEPS; sweep++) {
        turned = 0;
        for (int i = 0; i < c->count; i++)
            for (int k = i + 1; k < c->count; k++)
                turned += rotate_pair(c, i, k);
    }
}

static void find_rank(columns *c, fap_observation *o)
{
    orthogonalise(c);
    const double most = sqrt(largest(c->own, c->count));
    double least = most;
    for (int i = 0; i < c->count; i++) {
        const double strength = sqrt(c->own[i]);
        if (strength <= most * rank_limit)
            continue;
        o->rank++;
        least = fmin(least, strength);
    }
    o->condition = o->rank ? most / least : 0;
}

/* --- life --- */

/* One block for everything, so that one free() does. */
static fap_observation *make(int keys)
{
    const size_t pairs = (size_t)keys * (size_t)(keys - 1) / 2;
    fap_observation *o = calloc(1, sizeof *o + pairs * sizeof *o->alike + (size_t)keys * sizeof *o->unseen);

    if (!o)
        return NULL;
    o->key_count = keys;
    o->alike = (fap_alike *)(o + 1);
    o->unseen = (int *)(o->alike + pairs);
    return o;
}

static int columns_open(columns *c)
{
    c->at = calloc((size_t)c->count * ROW_ROOM + 1, sizeof *c->at);
    c->own = calloc((size_t)c->count + 1, sizeof *c->own);
    return c->at && c->own;
}

fap_err fap_bank_observe(fap_observation **out, const fap_bank *bank, unsigned kinds,
                         const uint8_t seen[FAP_POINT_COUNT][3])
{
    int key[MAX_KEYS];
    columns c = { .key = key };

    if (!out)
        return FAP_E_ARG;
    *out = NULL;
    if (!bank || !kinds)
        return FAP_E_ARG;
    c.count = pick_keys(bank, kinds, key);
    if (c.count < 0)
        return FAP_E_LIMIT;
    fap_observation *o = columns_open(&c) ? make(c.count) : NULL;
    if (o) {
        fill(&c, bank, seen);
        o->row_count = c.rows;
        find_unseen(&c, o);
        find_alike(&c, o);
        find_rank(&c, o);
    }
    free(c.at);
    free(c.own);
    *out = o;
    return o ? FAP_OK : FAP_E_NOMEM;
}

void fap_bank_observe_free(fap_observation **o)
{
    if (!o)
        return;
    free(*o);
    *o = NULL;
}
