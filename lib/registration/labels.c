/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fap/studio/labels.h. The thesis does not list its points; of its 172 it says that they are more than MPEG-4's, as hair, neck, top
 * and back of the head need some too. "By affine transformations" is read as: each minor point by an affine map of its own, in which
 * the major points near it count most.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/gauss.h"
#include "base/mem.h"
#include "capture/rigid.h"
#include "registration/labels.h"
#include "surface/normals.h"

static const char *const majors[FAP_LABELS_MAJOR] = { "3.7",  "3.11", "3.8", "3.12", "3.1",  "3.3",  "3.2",
                                                      "3.4",  "4.1",  "4.3", "4.5",  "4.2",  "4.4",  "4.6",
                                                      "9.12", "9.3",  "9.1", "9.2",  "9.15", "8.1",  "8.2",
                                                      "8.3",  "8.4",  "2.1", "2.13", "2.14", "10.5", "10.6" };
/* Where a ray along the normal comes back to the face this soon, it began inside of something. */
static const float cavity_mm = 60, step_off_mm = 0.5F;
/* How far off the affine map may put a point, and how strongly the maps hold to the one of the whole head. */
static const double ray_mm = 30, hold = 0.02;
/* Major points within this count alike. */
static const double near_mm = 15;

/* --- which they are --- */

typedef struct choosing {
    fap_labels *out;
    const fap_mesh *mesh;
    float (*position)[3], (*normal)[3];
    double *far2; /* [vertices] to the nearest chosen one; -1: is not to be chosen */
} choosing;

static void choose(choosing *c, uint32_t vertex, int point)
{
    fap_labels *l = c->out;

    l->vertex[l->count] = vertex;
    l->point[l->count++] = (int16_t)point;
    for (uint32_t v = 0; v < c->mesh->vertex_count; v++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)c->position[v][a] - (double)c->position[vertex][a], 2);
        if (c->far2[v] > d)
            c->far2[v] = d;
    }
}

static int has(const fap_labels *l, int point)
{
    for (uint32_t i = 0; i < l->count; i++)
        if (l->point[i] == point)
            return 1;
    return 0;
}

static void choose_point(choosing *c, const fap_bank *bank, int point)
{
    const fap_bank_point *p = fap_bank_point_get(bank, point);

    if (p && p->present && p->vertex_count && c->mesh->part[p->vertex[0]] == FAP_PART_SKIN &&
        !has(c->out, point))
        choose(c, p->vertex[0], point);
}

/* Gums and the inside of lids and nostrils are no place for a label. */
static void leave_out_cavities(choosing *c, const surface_index *face)
{
    for (uint32_t v = 0; v < c->mesh->vertex_count; v++) {
        float from[3];
        surface_hit h;
        for (int a = 0; a < 3; a++)
            from[a] = c->position[v][a] + step_off_mm * c->normal[v][a];
        if (c->mesh->part[v] != FAP_PART_SKIN || surface_index_ray(face, from, c->normal[v], cavity_mm, &h))
            c->far2[v] = -1;
        else
            c->far2[v] = INFINITY;
    }
}

static int choose_farthest(choosing *c)
{
    uint32_t best = 0;

    for (uint32_t v = 1; v < c->mesh->vertex_count; v++)
        if (c->far2[v] > c->far2[best])
            best = v;
    if (!(c->far2[best] > 0))
        return 0;
    choose(c, best, -1);
    return 1;
}

static fap_err choose_all(choosing *c, const fap_bank *bank)
{
    surface_index *face;
    const fap_err err = surface_index_open(&face, (const float(*)[3])c->position, c->mesh->vertex_count,
                                           (const uint32_t(*)[3])c->mesh->triangle, c->mesh->triangle_count);

    if (err != FAP_OK)
        return err;
    leave_out_cavities(c, face);
    surface_index_close(&face);
    for (int i = 0; i < FAP_LABELS_MAJOR; i++)
        choose_point(c, bank, fap_point_by_name(majors[i]));
    if (c->out->count < FAP_LABELS_MAJOR)
        return FAP_E_DATA;
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        choose_point(c, bank, p);
    while (c->out->count < FAP_LABELS && choose_farthest(c))
        continue;
    return FAP_OK;
}

fap_err fap_labels_of_bank(fap_labels *out, const fap_bank *bank)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    choosing c = { .out = out,
                   .mesh = mesh,
                   .position = malloc(mesh->vertex_count * sizeof *c.position),
                   .normal = malloc(mesh->vertex_count * sizeof *c.normal),
                   .far2 = malloc(mesh->vertex_count * sizeof *c.far2) };
    fap_err err = c.position && c.normal && c.far2 ? FAP_OK : FAP_E_NOMEM;

    out->count = 0;
    for (uint32_t i = 0; err == FAP_OK && i < 3 * mesh->vertex_count; i++)
        c.position[i / 3][i % 3] = mesh->position[i % 3 * mesh->stride + i / 3];
    if (err == FAP_OK) {
        surface_normals((const float(*)[3])c.position, mesh->vertex_count,
                        (const uint32_t(*)[3])mesh->triangle, mesh->triangle_count, c.normal);
        err = choose_all(&c, bank);
    }
    free(c.position);
    free(c.normal);
    free(c.far2);
    return err;
}

/* --- where they are --- */

typedef struct following {
    const fap_labels *labels;
    const surface_index *index;
    fap_label_place *place;
    double rest[FAP_LABELS][3]; /* on the generic face */
    double seen[FAP_LABELS][3]; /* placed ones: on the scan, in the generic face's axes and size */
    float facing[FAP_LABELS][3];
    rigid_pose pose; /* generic = pose of (scan * scale) */
    double scale;
} following;

static int is_placed(const following *f, uint32_t i)
{
    return f->place[i].state == FAP_LABEL_PLACED;
}

/* Root of the sum of squared distances from the middle of the placed ones. */
static double spread(const following *f, const double (*p)[3])
{
    double middle[3] = { 0, 0, 0 }, sum = 0;
    uint32_t count = 0;

    for (uint32_t i = 0; i < f->labels->count; i++) {
        count += (uint32_t)is_placed(f, i);
        for (int a = 0; a < 3 && is_placed(f, i); a++)
            middle[a] += p[i][a];
    }
    for (uint32_t i = 0; i < f->labels->count; i++)
        for (int a = 0; a < 3 && is_placed(f, i); a++)
            sum += pow(p[i][a] - middle[a] / count, 2);
    return sqrt(sum);
}

/* The head as a whole. */
static int find_pose(following *f)
{
    double weight[FAP_LABELS];
    uint32_t count = 0;

    for (uint32_t i = 0; i < f->labels->count; i++) {
        weight[i] = is_placed(f, i);
        count += (uint32_t)is_placed(f, i);
        for (int a = 0; a < 3; a++)
            f->seen[i][a] = is_placed(f, i) ? (double)f->place[i].at[a] : 0;
    }
    const double from = spread(f, (const double(*)[3])f->seen);
    if (count < 4 || !(from > 0))
        return 0;
    f->scale = spread(f, (const double(*)[3])f->rest) / from;
    for (uint32_t i = 0; i < f->labels->count; i++)
        for (int a = 0; a < 3; a++)
            f->seen[i][a] *= f->scale;
    if (!rigid_fit((const double(*)[3])f->seen, (const double(*)[3])f->rest, weight, f->labels->count,
                   &f->pose))
        return 0;
    for (uint32_t i = 0; i < f->labels->count; i++) {
        double there[3];
        rigid_apply(&f->pose, f->seen[i], there);
        memcpy(f->seen[i], there, sizeof there);
    }
    return 1;
}

/* The affine map around one label, by weighted least squares on how the placed ones differ from the generic face's. */
static void map_one(const following *f, uint32_t label, double out[3])
{
    double sum[4][4] = { { 0 } }, right[3][4] = { { 0 } }, total = 0;

    for (uint32_t i = 0; i < f->labels->count; i++) {
        double d2 = 0, x[4] = { 0, 0, 0, 1 };
        if (!is_placed(f, i))
            continue;
        for (int a = 0; a < 3; a++) {
            x[a] = (f->rest[i][a] - f->rest[label][a]) / near_mm;
            d2 += x[a] * x[a];
        }
        const double w = 1 / pow(1 + d2, 2);
        total += w;
        for (int r = 0; r < 4; r++) {
            for (int c = 0; c < 4; c++)
                sum[r][c] += w * x[r] * x[c];
            for (int a = 0; a < 3; a++)
                right[a][r] += w * x[r] * (f->seen[i][a] - f->rest[i][a]);
        }
    }
    for (int r = 0; r < 3; r++)
        sum[r][r] += hold * total * (1 + sum[r][r] / total);
    for (int a = 0; a < 3; a++) {
        double m[4][5], x[4];
        for (int r = 0; r < 4; r++) {
            memcpy(m[r], sum[r], sizeof sum[r]);
            m[r][4] = right[a][r];
        }
        fap_gauss_solve(m[0], 5, 4, 1e-12, x);
        out[a] = f->rest[label][a] + x[3];
    }
}

static void to_scan(const following *f, const double at[3], float out[3])
{
    double there[3];

    rigid_undo(&f->pose, at, there);
    for (int a = 0; a < 3; a++)
        out[a] = (float)(there[a] / f->scale);
}

/* Front, side, top or back, whichever sees it best: that picture's depth is what is looked for. */
static void view_of(const following *f, uint32_t label, double out[3])
{
    const float *n = f->facing[label];
    int best = 0;

    for (int a = 1; a < 3; a++)
        if (fabsf(n[a]) > fabsf(n[best]))
            best = a;
    out[0] = out[1] = out[2] = 0;
    out[best] = n[best] < 0 ? -1 : 1;
}

/* From outside inwards; the surface met first is the one that is seen. */
static int cast(const following *f, uint32_t label, const double at[3], float out[3])
{
    double way[3], start[3], end[3], length = 0;
    float from[3], to[3], direction[3];
    surface_hit h;

    view_of(f, label, way);
    for (int a = 0; a < 3; a++) {
        start[a] = at[a] + ray_mm * way[a];
        end[a] = at[a] - ray_mm * way[a];
    }
    to_scan(f, start, from);
    to_scan(f, end, to);
    for (int a = 0; a < 3; a++)
        length += pow((double)to[a] - (double)from[a], 2);
    length = sqrt(length);
    for (int a = 0; a < 3; a++)
        direction[a] = (float)(((double)to[a] - (double)from[a]) / length);
    if (!surface_index_ray(f->index, from, direction, (float)length, &h))
        return 0;
    memcpy(out, h.at, sizeof h.at);
    return 1;
}

static void follow_one(const following *f, uint32_t label)
{
    fap_label_place *p = &f->place[label];
    double at[3];

    map_one(f, label, at);
    p->state = FAP_LABEL_MET;
    if (f->index && cast(f, label, at, p->at))
        return;
    to_scan(f, at, p->at);
    p->state = FAP_LABEL_GUESSED;
}

static fap_err find_facing(following *f, const fap_mesh *mesh)
{
    float(*position)[3] = malloc(mesh->vertex_count * sizeof *position),
    (*normal)[3] = malloc(mesh->vertex_count * sizeof *normal);

    for (uint32_t i = 0; position && i < 3 * mesh->vertex_count; i++)
        position[i / 3][i % 3] = mesh->position[i % 3 * mesh->stride + i / 3];
    if (position && normal)
        surface_normals((const float(*)[3])position, mesh->vertex_count, (const uint32_t(*)[3])mesh->triangle,
                        mesh->triangle_count, normal);
    for (uint32_t i = 0; position && normal && i < f->labels->count; i++)
        for (int a = 0; a < 3; a++) {
            f->rest[i][a] = (double)position[f->labels->vertex[i]][a];
            f->facing[i][a] = normal[f->labels->vertex[i]][a];
        }
    const fap_err err = position && normal ? FAP_OK : FAP_E_NOMEM;
    free(position);
    free(normal);
    return err;
}

fap_err labels_follow(const fap_labels *labels, const fap_bank *bank, const surface_index *index,
                      fap_label_place *place)
{
    following *f = calloc(1, sizeof *f);

    if (!f)
        return FAP_E_NOMEM;
    *f = (following){ .labels = labels, .index = index, .place = place };
    fap_err err = find_facing(f, fap_bank_mesh(bank));
    if (err == FAP_OK && !find_pose(f))
        err = FAP_E_NOT_FOUND;
    for (uint32_t i = 0; err == FAP_OK && i < labels->count; i++)
        if (!is_placed(f, i))
            follow_one(f, i);
    free(f);
    return err;
}

fap_err fap_labels_follow(const fap_labels *labels, const fap_bank *bank, const fap_surface *scan,
                          fap_label_place *place)
{
    surface_index *index;
    fap_err err = surface_index_open(&index, (const float(*)[3])scan->position, scan->vertex_count,
                                     (const uint32_t(*)[3])scan->triangle, scan->triangle_count);

    if (err == FAP_OK)
        err = labels_follow(labels, bank, index, place);
    surface_index_close(&index);
    return err;
}
