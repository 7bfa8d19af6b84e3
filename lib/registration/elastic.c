/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See elastic.h. Energy over displacements d = x - rest:
 *   sum of pulls + sum of pins + stiffness * sum |(L d)_i|^2 + stretch * sum over edges w |d_i - d_j|^2
 * L has rows that sum to nothing, with cotangent weights so that an even stretch of the plane costs nothing. Bending is
 * counted per vertex: where an artist put many, the skin may change within a shorter way. Sources: Sorkine et al. 2004,
 * Laplacian surface editing; Hestenes, Stiefel 1952 for the solver.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/elastic.h"

typedef double vec3[3];

struct elastic {
    fap_allocator alloc;
    uint32_t count;
    const float (*rest)[3];
    uint32_t *row, *column; /* L, without its diagonal of 1 */
    double *weight;         /* of -1/sum each, so that (L d)_i = d_i + sum weight d_j */
    double *square;         /* diagonal of L^T L */
    uint8_t *use;
    vec3 *x, *r, *z, *p, *ap, *bend;
    double (*block)[6];   /* each vertex's own 3x3 block and ... */
    double (*inverse)[6]; /* ... the preconditioner: xx xy xz yy yz zz */
};

/* --- the Laplacian --- */

/* A triangle too thin to tell its angles must not make weights of thousands. */
static const double least_weight = 0.05, most_weight = 5;

static double cotangent(const float *at, const float *a, const float *b)
{
    double u[3], v[3], n[3], dot = 0;

    for (int i = 0; i < 3; i++) {
        u[i] = (double)a[i] - (double)at[i];
        v[i] = (double)b[i] - (double)at[i];
        dot += u[i] * v[i];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    return dot / fmax(1e-12, sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
}

static uint32_t third(const uint32_t v[3], uint32_t a, uint32_t b)
{
    for (int i = 0; i < 3; i++)
        if (v[i] != a && v[i] != b)
            return v[i];
    return a;
}

static double edge_weight(const float (*rest)[3], const uint32_t (*triangle)[3], const surface_edge *edge)
{
    double sum = 0;

    for (int k = 0; k < 2 && edge->triangle[k] != UINT32_MAX; k++)
        sum += cotangent(rest[third(triangle[edge->triangle[k]], edge->low, edge->high)], rest[edge->low],
                         rest[edge->high]) /
               2;
    return fmax(least_weight, fmin(most_weight, sum));
}

static int takes_part(const elastic *e, const surface_edge *edge)
{
    return e->use[edge->low] && e->use[edge->high];
}

static void count_row(elastic *e, const surface_edges *edges)
{
    for (uint32_t i = 0; i < edges->count; i++)
        if (takes_part(e, &edges->edge[i])) {
            e->row[edges->edge[i].low + 1]++;
            e->row[edges->edge[i].high + 1]++;
        }
    for (uint32_t v = 0; v < e->count; v++)
        e->row[v + 1] += e->row[v];
}

static void put_neighbour(elastic *e, uint32_t *next, uint32_t v, uint32_t other, double weight)
{
    e->column[next[v]] = other;
    e->weight[next[v]++] = weight;
}

static void fill_rows(elastic *e, uint32_t *next, const uint32_t (*triangle)[3], const surface_edges *edges)
{
    memcpy(next, e->row, e->count * sizeof *next);
    for (uint32_t i = 0; i < edges->count; i++) {
        const surface_edge *edge = &edges->edge[i];
        if (!takes_part(e, edge))
            continue;
        const double weight = edge_weight(e->rest, triangle, edge);
        put_neighbour(e, next, edge->low, edge->high, weight);
        put_neighbour(e, next, edge->high, edge->low, weight);
    }
    for (uint32_t v = 0; v < e->count; v++) {
        double sum = 0;
        for (uint32_t k = e->row[v]; k < e->row[v + 1]; k++)
            sum += e->weight[k];
        for (uint32_t k = e->row[v]; k < e->row[v + 1]; k++)
            e->weight[k] /= -sum;
    }
    for (uint32_t v = 0; v < e->count; v++) {
        e->square[v] += e->row[v] < e->row[v + 1];
        for (uint32_t k = e->row[v]; k < e->row[v + 1]; k++)
            e->square[e->column[k]] += e->weight[k] * e->weight[k];
    }
}

/* --- memory --- */

static int allocate(elastic *e, size_t halves)
{
    const fap_allocator *a = &e->alloc;

    e->row = fap_mem_calloc(a, (size_t)e->count + 1, sizeof *e->row);
    e->column = fap_mem_calloc(a, halves, sizeof *e->column);
    e->weight = fap_mem_calloc(a, halves, sizeof *e->weight);
    e->square = fap_mem_calloc(a, e->count, sizeof *e->square);
    e->use = fap_mem_calloc(a, e->count, 1);
    e->x = fap_mem_calloc(a, 6 * (size_t)e->count, sizeof *e->x);
    e->block = fap_mem_calloc(a, 2 * (size_t)e->count, sizeof *e->block);
    if (!e->row || !e->column || !e->weight || !e->square || !e->use || !e->x || !e->block)
        return 0;
    e->r = e->x + e->count;
    e->z = e->r + e->count;
    e->p = e->z + e->count;
    e->ap = e->p + e->count;
    e->bend = e->ap + e->count;
    e->inverse = e->block + e->count;
    return 1;
}

fap_err elastic_open(elastic **out, const float (*rest)[3], uint32_t count, const uint32_t (*triangle)[3],
                     uint32_t triangle_count, const surface_edges *edges, const uint8_t *use,
                     const fap_allocator *alloc)
{
    elastic *e = fap_mem_calloc(alloc, 1, sizeof *e);
    uint32_t *next = fap_mem_calloc(alloc, count, sizeof *next);

    *out = e;
    (void)triangle_count;
    if (e)
        *e = (elastic){ .alloc = *alloc, .count = count, .rest = rest };
    const int ok = e && next && allocate(e, 2 * (size_t)edges->count);
    if (ok) {
        memcpy(e->use, use, count);
        count_row(e, edges);
        fill_rows(e, next, triangle, edges);
    } else
        elastic_close(out);
    fap_mem_free(alloc, next);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

void elastic_close(elastic **out)
{
    elastic *e = *out;

    if (!e)
        return;
    const fap_allocator a = e->alloc;
    fap_mem_free(&a, e->row);
    fap_mem_free(&a, e->column);
    fap_mem_free(&a, e->weight);
    fap_mem_free(&a, e->square);
    fap_mem_free(&a, e->use);
    fap_mem_free(&a, e->x);
    fap_mem_free(&a, e->block);
    fap_mem_free(&a, e);
    *out = NULL;
}

/* --- the matrix --- */

static void times_block(const double b[6], const vec3 v, vec3 out)
{
    out[0] = b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
    out[1] = b[1] * v[0] + b[3] * v[1] + b[4] * v[2];
    out[2] = b[2] * v[0] + b[4] * v[1] + b[5] * v[2];
}

static void laplacian_row(const elastic *e, const vec3 *v, uint32_t i, vec3 out)
{
    memcpy(out, v[i], sizeof(vec3));
    for (uint32_t k = e->row[i]; k < e->row[i + 1]; k++)
        for (int a = 0; a < 3; a++)
            out[a] += e->weight[k] * v[e->column[k]][a];
}

/* out += stiffness * L^T L v. The rows of L are not symmetric: L^T is dealt out. */
static void add_bending(elastic *e, double stiffness, const vec3 *v, vec3 *out)
{
    for (uint32_t i = 0; i < e->count; i++)
        if (e->row[i] < e->row[i + 1])
            laplacian_row(e, v, i, e->bend[i]);
    for (uint32_t i = 0; i < e->count; i++) {
        if (e->row[i] == e->row[i + 1])
            continue;
        for (int a = 0; a < 3; a++)
            out[i][a] += stiffness * e->bend[i][a];
        for (uint32_t k = e->row[i]; k < e->row[i + 1]; k++)
            for (int a = 0; a < 3; a++)
                out[e->column[k]][a] += stiffness * e->weight[k] * e->bend[i][a];
    }
}

/* out += stretch * sum over neighbours (v_i - v_j), each edge from both ends. */
static void add_stretching(const elastic *e, double stretch, const vec3 *v, vec3 *out)
{
    for (uint32_t i = 0; stretch > 0 && i < e->count; i++)
        for (uint32_t k = e->row[i]; k < e->row[i + 1]; k++)
            for (int a = 0; a < 3; a++) {
                const double pull = -stretch * e->weight[k] * (v[i][a] - v[e->column[k]][a]) / 2;
                out[i][a] += pull;
                out[e->column[k]][a] -= pull;
            }
}

static void add_pin(const elastic_pin *pin, const vec3 *v, vec3 *out)
{
    for (int a = 0; a < 3; a++) {
        double at = 0;
        for (int k = 0; k < 3; k++)
            at += pin->share[k] * v[pin->vertex[k]][a];
        for (int k = 0; k < 3; k++)
            out[pin->vertex[k]][a] += pin->weight * pin->share[k] * at;
    }
}

static void multiply(elastic *e, const elastic_task *t, const vec3 *v, vec3 *out)
{
    for (uint32_t i = 0; i < e->count; i++)
        times_block(e->block[i], v[i], out[i]);
    add_bending(e, t->stiffness, v, out);
    add_stretching(e, t->stretch, v, out);
    for (uint32_t p = 0; p < t->pin_count; p++)
        add_pin(&t->pin[p], v, out);
}

/* --- right side, blocks, preconditioner --- */

/* A whiff of itself holds a vertex that nothing draws. */
static const double own_weight = 1e-6;

static void make_block(const elastic_task *t, uint32_t i, double b[6])
{
    const elastic_pull *p = &t->pull[i];
    const double *n = p->normal, across = p->weight * t->slide, along = p->weight * (1 - t->slide);

    b[0] = along * n[0] * n[0] + across + own_weight;
    b[1] = along * n[0] * n[1];
    b[2] = along * n[0] * n[2];
    b[3] = along * n[1] * n[1] + across + own_weight;
    b[4] = along * n[1] * n[2];
    b[5] = along * n[2] * n[2] + across + own_weight;
}

static void invert(const double b[6], double extra, double out[6])
{
    const double xx = b[0] + extra, yy = b[3] + extra, zz = b[5] + extra;
    const double c0 = yy * zz - b[4] * b[4], c1 = b[2] * b[4] - b[1] * zz, c2 = b[1] * b[4] - b[2] * yy;
    const double det = xx * c0 + b[1] * c1 + b[2] * c2;

    out[0] = c0 / det;
    out[1] = c1 / det;
    out[2] = c2 / det;
    out[3] = (xx * zz - b[2] * b[2]) / det;
    out[4] = (b[1] * b[2] - xx * b[4]) / det;
    out[5] = (xx * yy - b[1] * b[1]) / det;
}

static void prepare(elastic *e, const elastic_task *t)
{
    for (uint32_t i = 0; i < e->count; i++)
        make_block(t, i, e->block[i]);
    for (uint32_t i = 0; i < e->count; i++)
        invert(e->block[i], t->stiffness * e->square[i] + t->stretch * (e->row[i] < e->row[i + 1]),
               e->inverse[i]);
}

/* Everything in displacements from rest: r = right side - matrix * x. */
static void begin(elastic *e, const elastic_task *t, const float (*at)[3])
{
    for (uint32_t i = 0; i < e->count; i++)
        for (int a = 0; a < 3; a++)
            e->x[i][a] = (double)at[i][a] - (double)e->rest[i][a];
    multiply(e, t, (const vec3 *)e->x, e->ap);
    for (uint32_t i = 0; i < e->count; i++) {
        vec3 to, right;
        for (int a = 0; a < 3; a++)
            to[a] = t->pull[i].weight > 0 ? t->pull[i].to[a] - (double)e->rest[i][a] : e->x[i][a];
        times_block(e->block[i], to, right);
        for (int a = 0; a < 3; a++)
            e->r[i][a] = right[a] - e->ap[i][a];
    }
    for (uint32_t p = 0; p < t->pin_count; p++) {
        const elastic_pin *pin = &t->pin[p];
        for (int a = 0; a < 3; a++) {
            double to = pin->to[a];
            for (int k = 0; k < 3; k++)
                to -= pin->share[k] * (double)e->rest[pin->vertex[k]][a];
            for (int k = 0; k < 3; k++)
                e->r[pin->vertex[k]][a] += pin->weight * pin->share[k] * to;
        }
    }
}

static double inner(const vec3 *a, const vec3 *b, uint32_t n)
{
    double sum = 0;

    for (uint32_t i = 0; i < n; i++)
        sum += a[i][0] * b[i][0] + a[i][1] * b[i][1] + a[i][2] * b[i][2];
    return sum;
}

static void add(vec3 *to, double factor, const vec3 *v, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            to[i][a] += factor * v[i][a];
}

int elastic_solve(elastic *e, const elastic_task *t, float (*at)[3])
{
    const uint32_t n = e->count;
    int round = 0;

    prepare(e, t);
    begin(e, t, (const float(*)[3])at);
    for (uint32_t i = 0; i < n; i++)
        times_block(e->inverse[i], e->r[i], e->z[i]);
    memcpy(e->p, e->z, n * sizeof *e->p);
    double rz = inner((const vec3 *)e->r, (const vec3 *)e->z, n);
    const double end = rz * t->enough * t->enough;
    for (; round < t->rounds && rz > end; round++) {
        multiply(e, t, (const vec3 *)e->p, e->ap);
        const double step = rz / inner((const vec3 *)e->p, (const vec3 *)e->ap, n), before = rz;
        add(e->x, step, (const vec3 *)e->p, n);
        add(e->r, -step, (const vec3 *)e->ap, n);
        for (uint32_t i = 0; i < n; i++)
            times_block(e->inverse[i], e->r[i], e->z[i]);
        rz = inner((const vec3 *)e->r, (const vec3 *)e->z, n);
        for (uint32_t i = 0; i < n; i++)
            for (int a = 0; a < 3; a++)
                e->p[i][a] = e->z[i][a] + rz / before * e->p[i][a];
    }
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            at[i][a] = (float)((double)e->rest[i][a] + e->x[i][a]);
    return round;
}
