/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Face animation tables as a blend method: what the smallest clients will show, to be looked at beside the others. Baked
 * at open. Visemes and expressions are the bank's keys here, too, and give way as in fap_fat_pose().
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "bank/fat.h"
#include "base/mem.h"

typedef struct state {
    fap_fat *fat;
    float (*moved)[3]; /* [vertex_count] */
} state;

static int open_fat(void *user, const fap_face *face)
{
    state *s = user;

    s->moved = fap_mem_calloc(&face->alloc, face->mesh->vertex_count, sizeof *s->moved);
    return !s->moved || fap_fat_bake(&s->fat, face->bank, &face->alloc) != FAP_OK;
}

static void close_fat(void *user, const fap_face *face)
{
    state *s = user;

    fap_fat_close(&s->fat);
    fap_mem_free(&face->alloc, s->moved);
}

/* Targets back into values: emphasis and stopped lids are in them. */
static void as_frame(const fap_face *face, fap_frame *f)
{
    *f = (fap_frame){ 0 };
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const int axis = info->motion - FAP_MOTION_X;
        if (info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z || info->point < 0 ||
            !face->wanted[info->point][axis])
            continue;
        const float mm = fap_blend_row_target(face, 3 * info->point + axis);
        f->state[fap] = FAP_CODED;
        f->value[fap] =
            (int32_t)lrintf(info->sign * mm / fap_fapu_step(fap_bank_fapu(face->bank), (fap_unit)info->unit));
    }
}

static int yields(const fap_face *face, const fap_frame *f, int key)
{
    return face->key[key]->kind == FAP_KEY_VISEME ? fat_gives_mouth(f) : fat_gives_expression(f);
}

static void solve_fat(void *user, fap_face *face)
{
    fap_frame f;

    (void)user;
    as_frame(face, &f);
    for (int i = 0; i < face->base_count; i++)
        if (!yields(face, &f, face->base_key[i]))
            face->weight[face->base_key[i]] = face->base_weight[i];
}

static void shape_fat(void *user, fap_face *face, float *position)
{
    const state *s = user;
    const size_t stride = face->mesh->stride;
    fap_frame f;

    as_frame(face, &f);
    memset(s->moved, 0, face->mesh->vertex_count * sizeof *s->moved);
    fat_add_low_level(s->fat, &f, s->moved);
    for (uint32_t v = 0; v < face->mesh->vertex_count; v++)
        for (size_t axis = 0; axis < 3; axis++)
            position[axis * stride + v] += s->moved[v][axis];
}

const fap_blend_method fap_blend_fat = {
    .name = "fat",
    .summary = "face animation tables: straight lines, for the smallest clients",
    .state_size = sizeof(state),
    .open = open_fat,
    .close = close_fat,
    .solve = solve_fat,
    .shape = shape_fat,
};
