/* SPDX-License-Identifier: BSD-2-Clause */
/* See icp.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "registration/icp.h"

/* Pairs that face more than 60 degrees apart are of two sides of something. */
static const double least_facing = 0.5;
/* It has arrived when a round gains less than this share. */
static const double enough = 1e-4;

typedef struct pairing {
    const icp_task *task;
    const rigid_pose *pose;
    double (*from)[3], (*to)[3], *off, *sorted, *weight;
    uint32_t count;
} pairing;

typedef struct facing {
    const icp_task *task;
    double normal[3];
} facing;

static int faces_alike(const void *user, uint32_t t)
{
    const facing *f = user;
    double dot = 0, length = 0;

    for (int a = 0; a < 3; a++) {
        double n = 0;
        for (int c = 0; c < 3; c++)
            n += (double)f->task->surface_normal[f->task->surface_triangle[t][c]][a];
        dot += n * f->normal[a];
        length += n * n;
    }
    return dot > least_facing * sqrt(length);
}

static void add_pair(pairing *p, uint32_t i)
{
    const icp_task *task = p->task;
    double model[3], there[3];
    float at[3];
    surface_hit h;
    facing f = { .task = task };

    for (int a = 0; a < 3; a++) {
        model[a] = (double)task->model[i][a];
        for (int k = 0; k < 3; k++)
            f.normal[a] += p->pose->r[a][k] * (double)task->normal[i][k];
    }
    rigid_apply(p->pose, model, there);
    for (int a = 0; a < 3; a++)
        at[a] = (float)there[a];
    if (!surface_index_nearest(task->surface, at, (float)task->reach_mm, faces_alike, &f, &h))
        return;
    memcpy(p->from[p->count], model, sizeof model);
    for (int a = 0; a < 3; a++)
        p->to[p->count][a] = (double)h.at[a];
    p->sorted[p->count] = p->off[p->count] = (double)h.distance;
    p->count++;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The farthest count for nothing. @return rms of the others. */
static double trim(pairing *p)
{
    const uint32_t kept = (uint32_t)fmax(3, p->task->keep * p->count);
    double sum = 0;
    uint32_t count = 0;

    qsort(p->sorted, p->count, sizeof *p->sorted, by_value);
    const double limit = p->sorted[kept < p->count ? kept : p->count - 1];
    for (uint32_t i = 0; i < p->count; i++) {
        p->weight[i] = p->off[i] <= limit;
        if (p->weight[i] > 0) {
            sum += p->off[i] * p->off[i];
            count++;
        }
    }
    return sqrt(sum / count);
}

static double pair_up(pairing *p)
{
    p->count = 0;
    for (uint32_t i = 0; i < p->task->count; i++)
        if (p->task->use[i])
            add_pair(p, i);
    return p->count < 3 ? -1 : trim(p);
}

static fap_err run(pairing *p, rigid_pose *pose, icp_outcome *out)
{
    double rms = out->before_mm = pair_up(p);

    for (out->rounds = 0; rms >= 0 && out->rounds < p->task->rounds;) {
        const double before = rms;
        rigid_pose better;
        if (!rigid_fit((const double(*)[3])p->from, (const double(*)[3])p->to, p->weight, p->count, &better))
            return FAP_E_DATA;
        *pose = better;
        out->rounds++;
        rms = pair_up(p);
        if (rms > before * (1 - enough))
            break;
    }
    out->after_mm = rms;
    return rms >= 0 ? FAP_OK : FAP_E_DATA;
}

fap_err icp_align(const icp_task *task, rigid_pose *pose, icp_outcome *out, const fap_allocator *alloc)
{
    pairing p = { .task = task, .pose = pose };

    p.from = fap_mem_calloc(alloc, task->count, sizeof *p.from);
    p.to = fap_mem_calloc(alloc, task->count, sizeof *p.to);
    p.off = fap_mem_calloc(alloc, 3 * (size_t)task->count, sizeof *p.off);
    p.sorted = p.off ? p.off + task->count : NULL;
    p.weight = p.off ? p.off + 2 * (size_t)task->count : NULL;
    const fap_err err = p.from && p.to && p.off ? run(&p, pose, out) : FAP_E_NOMEM;
    fap_mem_free(alloc, p.from);
    fap_mem_free(alloc, p.to);
    fap_mem_free(alloc, p.off);
    return err;
}
