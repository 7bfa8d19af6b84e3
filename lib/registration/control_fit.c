/* SPDX-License-Identifier: BSD-2-Clause */
/* See control_fit.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/control_fit.h"

static const double most_step_mm = 4, enough = 1e-4;
static const double simplex_enough_mm = 0.02;
enum { SIMPLEX_VALUES = 60 };

static const float (*carried(const control_fit *f))[3]
{
    return (const float(*)[3])f->at;
}

fap_err control_fit_open(control_fit *f, bone_skin *skin, mesh_energy *energy, const float (*first)[3],
                         fap_optimizer optimizer, const fap_allocator *alloc)
{
    const control_face *face = energy->face;
    const uint32_t n = face->vertex_count;
    const int one_by_one = optimizer == FAP_OPTIMIZER_SIMPLEX;

    *f = (control_fit){ .skin = skin,
                        .energy = energy,
                        .alloc = *alloc,
                        .control = fap_mem_calloc(alloc, skin->mesh->count, sizeof *f->control),
                        .first = fap_mem_calloc(alloc, skin->mesh->count, sizeof *f->first),
                        .at = fap_mem_calloc(alloc, n, sizeof *f->at),
                        .pull = fap_mem_calloc(alloc, n, sizeof *f->pull),
                        .vertex = fap_mem_calloc(alloc, n, sizeof *f->vertex),
                        .vertex_stamp = fap_mem_calloc(alloc, n, sizeof *f->vertex_stamp),
                        .edge = fap_mem_calloc(alloc, energy->edge_count, sizeof *f->edge),
                        .edge_stamp = fap_mem_calloc(alloc, energy->edge_count, sizeof *f->edge_stamp) };
    if (!f->control || !f->first || !f->at || !f->pull || !f->vertex || !f->vertex_stamp || !f->edge ||
        !f->edge_stamp)
        return FAP_E_NOMEM;
    memcpy(f->at, face->position, n * sizeof *f->at);
    for (uint32_t i = 0; i < skin->mesh->count; i++)
        for (int a = 0; a < 3; a++) {
            f->first[i][a] = (double)first[skin->mesh->vertex[i]][a];
            f->control[i][a] = (double)face->position[skin->mesh->vertex[i]][a];
        }
    return one_by_one ? FAP_OK : lbfgs_open(&f->lower, 3 * (size_t)skin->mesh->count, alloc);
}

void control_fit_close(control_fit *f)
{
    const fap_allocator *a = &f->alloc;

    if (!f->skin)
        return;
    lbfgs_close(&f->lower);
    fap_mem_free(a, f->control);
    fap_mem_free(a, f->first);
    fap_mem_free(a, f->at);
    fap_mem_free(a, f->pull);
    fap_mem_free(a, f->vertex);
    fap_mem_free(a, f->vertex_stamp);
    fap_mem_free(a, f->edge);
    fap_mem_free(a, f->edge_stamp);
}

/* --- the net --- */

/* How a control point has moved, less the mean of its neighbours. */
static void unevenness(const control_fit *f, const double (*control)[3], uint32_t point, double out[3])
{
    const bone_skin *s = f->skin;
    const uint32_t first = s->start[point], end = s->start[point + 1];
    const double share = end > first ? 1.0 / (2 * (end - first)) : 0;

    for (int a = 0; a < 3; a++) {
        const double own = control[point][a] - f->first[point][a];
        out[a] = end > first ? own : 0;
        for (uint32_t k = first; k < end; k++)
            for (int c = 0; c < 3; c++) {
                const uint32_t other = s->mesh->bone[s->around[k]][c];
                if (other != point)
                    out[a] -= share * (control[other][a] - f->first[other][a]);
            }
    }
}

static void pull_even(const control_fit *f, uint32_t point, const double off[3], double by,
                      double (*gradient)[3])
{
    const bone_skin *s = f->skin;
    const uint32_t first = s->start[point], end = s->start[point + 1];

    for (int a = 0; a < 3; a++) {
        gradient[point][a] += 2 * by * off[a];
        for (uint32_t k = first; k < end; k++)
            for (int c = 0; c < 3; c++) {
                const uint32_t other = s->mesh->bone[s->around[k]][c];
                if (other != point)
                    gradient[other][a] -= 2 * by * off[a] / (2 * (end - first));
            }
    }
}

static double net_value(const control_fit *f, const double (*control)[3], double (*gradient)[3])
{
    const double by = f->even / f->skin->mesh->count;
    double sum = 0;

    for (uint32_t i = 0; f->even > 0 && i < f->skin->mesh->count; i++) {
        double off[3];
        unevenness(f, control, i, off);
        sum += by * (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]);
        if (gradient)
            pull_even(f, i, off, by, gradient);
    }
    return sum;
}

/* --- all at once --- */

static int carry_all(control_fit *f, const double (*control)[3])
{
    if (!bone_skin_set(f->skin, control, UINT32_MAX))
        return 0;
    for (uint32_t v = 0; v < f->skin->vertex_count; v++)
        bone_skin_carry(f->skin, v, f->at[v]);
    return 1;
}

int control_fit_carry(control_fit *f)
{
    return carry_all(f, (const double(*)[3])f->control);
}

double control_fit_value(void *user, const double *x, double *gradient)
{
    control_fit *f = user;

    if (!carry_all(f, (const double(*)[3])x))
        return INFINITY;
    const double value = mesh_energy_all(f->energy, carried(f), gradient ? f->pull : NULL);
    if (gradient)
        bone_skin_pull(f->skin, (const double(*)[3])f->pull, (double(*)[3])gradient);
    return value + net_value(f, (const double(*)[3])x, (double(*)[3])gradient);
}

double control_fit_lbfgs(control_fit *f, int iterations)
{
    const lbfgs_task task = { .value = control_fit_value,
                              .user = f,
                              .iterations = iterations,
                              .most_step = most_step_mm,
                              .enough = enough };
    const double value = lbfgs_run(f->lower, &task, &f->control[0][0]);

    control_fit_carry(f); /* the last place asked for need not be the best one */
    return value;
}

/* --- one by one --- */

static int is_carried_by(const control_fit *f, uint32_t v, uint32_t point)
{
    for (int i = 0; i < f->skin->says[v]; i++) {
        const uint32_t *corner = f->skin->mesh->bone[f->skin->say[v][i].bone];
        if (corner[0] == point || corner[1] == point || corner[2] == point)
            return 1;
    }
    return 0;
}

static void list_edges_of(control_fit *f, uint32_t v)
{
    for (uint32_t k = f->energy->start[v]; k < f->energy->start[v + 1]; k++) {
        const uint32_t e = f->energy->around[k];
        if (f->edge_stamp[e] == f->stamp)
            continue;
        f->edge_stamp[e] = f->stamp;
        f->edge[f->edge_count++] = e;
    }
}

/* Vertices that the point's bones carry, and edges that those change. */
static void choose(control_fit *f, uint32_t point)
{
    f->point = point;
    f->stamp++;
    f->vertex_count = f->edge_count = 0;
    for (uint32_t v = 0; v < f->skin->vertex_count; v++)
        if (is_carried_by(f, v, point)) {
            f->vertex[f->vertex_count++] = v;
            list_edges_of(f, v);
        }
}

static int move_point(control_fit *f, const double *x)
{
    memcpy(f->control[f->point], x, 3 * sizeof *x);
    if (!bone_skin_set(f->skin, (const double(*)[3])f->control, f->point))
        return 0;
    for (uint32_t i = 0; i < f->vertex_count; i++)
        bone_skin_carry(f->skin, f->vertex[i], f->at[f->vertex[i]]);
    return 1;
}

static double value_around(void *user, const double *x, double *gradient)
{
    control_fit *f = user;

    (void)gradient;
    if (!move_point(f, x))
        return INFINITY;
    double sum =
        net_value(f, (const double(*)[3])f->control, NULL) + mesh_energy_pins(f->energy, carried(f), NULL);
    for (uint32_t i = 0; i < f->vertex_count; i++)
        sum += mesh_energy_vertex(f->energy, carried(f), f->vertex[i], NULL);
    for (uint32_t i = 0; i < f->edge_count; i++)
        sum += mesh_energy_edge(f->energy, carried(f), f->edge[i], NULL);
    return sum;
}

double control_fit_simplex(control_fit *f, double edge_mm)
{
    const simplex_task task = { .value = value_around,
                                .user = f,
                                .size = 3,
                                .edge = edge_mm,
                                .enough = simplex_enough_mm,
                                .values = SIMPLEX_VALUES };

    control_fit_carry(f);
    for (uint32_t p = 0; p < f->skin->mesh->count; p++) {
        double x[3];
        choose(f, p);
        memcpy(x, f->control[p], sizeof x);
        simplex_run(&task, x);
        move_point(f, x);
    }
    return mesh_energy_all(f->energy, carried(f), NULL);
}
