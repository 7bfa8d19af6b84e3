/* SPDX-License-Identifier: BSD-2-Clause */
/* fap_motion_carry(): motions of what no scan shows, from those of the skin. */
#include <math.h>
#include <string.h>

#include <fap/studio/expression.h>

#include "base/mem.h"
#include "capture/rigid.h"
#include "surface/nearest.h"

/* Chin and jaw line: where they go together as a body, the jaw has moved. */
static const char *const jaw_points[] = { "2.1", "2.10", "2.11", "2.12", "2.13", "2.14" };
enum { JAW_POINTS = sizeof jaw_points / sizeof *jaw_points };
/* Less is chewing gum in the skin; and a body leaves no more than this share of the motion. */
static const double jaw_moves_mm = 2, jaw_bends = 0.4;
/* A lash is this long at most; its root is in the lid. */
static const float lash_mm = 20;

typedef struct carrying {
    const fap_bank *bank;
    const fap_mesh *mesh;
    const float (*rest)[3];
    float (*motion)[3];
} carrying;

static double length2(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/* --- the jaw --- */

typedef struct jaw {
    double from[JAW_POINTS][3], to[JAW_POINTS][3], weight[JAW_POINTS];
    uint32_t count;
    double moved; /* rms */
} jaw;

static void measure_jaw(const carrying *c, jaw *j)
{
    double sum = 0;

    *j = (jaw){ 0 };
    for (int i = 0; i < JAW_POINTS; i++) {
        const fap_bank_point *p = fap_bank_point_get(c->bank, fap_point_by_name(jaw_points[i]));
        if (!p->present || !p->vertex_count)
            continue;
        for (int a = 0; a < 3; a++) {
            j->from[j->count][a] = (double)c->rest[p->vertex[0]][a];
            j->to[j->count][a] = j->from[j->count][a] + (double)c->motion[p->vertex[0]][a];
            sum += pow((double)c->motion[p->vertex[0]][a], 2);
        }
        j->weight[j->count++] = 1;
    }
    j->moved = j->count ? sqrt(sum / j->count) : 0;
}

/* How the jaw has moved; 0: it has not. */
static int find_jaw(const carrying *c, rigid_pose *pose)
{
    double left = 0;
    jaw j;

    measure_jaw(c, &j);
    if (j.moved < jaw_moves_mm ||
        !rigid_fit((const double(*)[3])j.from, (const double(*)[3])j.to, j.weight, j.count, pose))
        return 0;
    for (uint32_t i = 0; i < j.count; i++) {
        double there[3];
        rigid_apply(pose, j.from[i], there);
        for (int a = 0; a < 3; a++)
            there[a] -= j.to[i][a];
        left += length2(there);
    }
    return sqrt(left / j.count) < jaw_bends * j.moved;
}

static void carry_by_jaw(const carrying *c)
{
    rigid_pose pose;
    const int moved = find_jaw(c, &pose);

    for (uint32_t i = 0; i < c->mesh->vertex_count; i++) {
        const uint8_t part = c->mesh->part[i];
        double at[3], there[3];
        if (part == FAP_PART_SKIN || part == FAP_PART_LASHES)
            continue;
        memset(c->motion[i], 0, sizeof c->motion[i]);
        if (!moved || (part != FAP_PART_TEETH_LOWER && part != FAP_PART_TONGUE))
            continue;
        for (int a = 0; a < 3; a++)
            at[a] = (double)c->rest[i][a];
        rigid_apply(&pose, at, there);
        for (int a = 0; a < 3; a++)
            c->motion[i][a] = (float)(there[a] - at[a]);
    }
}

/* --- lashes --- */

static int is_skin(const void *user, uint32_t t)
{
    const fap_mesh *mesh = user;
    return mesh->part[mesh->triangle[3 * (size_t)t]] == FAP_PART_SKIN;
}

static int has_lashes(const fap_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->part[i] == FAP_PART_LASHES)
            return 1;
    return 0;
}

static void carry_lash(const carrying *c, const surface_index *skin, uint32_t i)
{
    surface_hit h;

    memset(c->motion[i], 0, sizeof c->motion[i]);
    if (!surface_index_nearest(skin, c->rest[i], lash_mm, is_skin, c->mesh, &h))
        return;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            c->motion[i][a] +=
                h.share[k] * c->motion[c->mesh->triangle[3 * (size_t)h.triangle + (size_t)k]][a];
}

static fap_err carry_lashes(const carrying *c)
{
    surface_index *skin;

    if (!has_lashes(c->mesh))
        return FAP_OK;
    const fap_err err = surface_index_open(&skin, c->rest, c->mesh->vertex_count,
                                           (const uint32_t(*)[3])c->mesh->triangle, c->mesh->triangle_count);
    for (uint32_t i = 0; err == FAP_OK && i < c->mesh->vertex_count; i++)
        if (c->mesh->part[i] == FAP_PART_LASHES)
            carry_lash(c, skin, i);
    surface_index_close(&skin);
    return err;
}

fap_err fap_motion_carry(const fap_bank *bank, const float (*rest)[3], float (*motion)[3])
{
    const carrying c = { bank, fap_bank_mesh(bank), rest, motion };

    carry_by_jaw(&c);
    return carry_lashes(&c);
}
