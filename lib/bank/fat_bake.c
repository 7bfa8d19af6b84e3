/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From a bank to face animation tables. The key models say how the surface goes with the FAPs (fat_operator.h), small
 * fields round the feature points make every commanded one arrive exactly, lids slide over the eyeballs and the lower
 * teeth stay below the upper. Posing each FAP alone by the solver was tried first: what it does along axes that no FAP
 * names adds up to lips 6 mm in front of the face. Visemes and expressions are the bank's key models as they are.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "bank/fat.h"
#include "bank/fat_operator.h"
#include "base/mem.h"

enum { STRENGTH_MAX = 63, JAW = 3, STEPS = 32767, LEADERS_OF_ONE = 4 };

static const float still_mm = 0.02f; /* what moves less is left out ... */
static const float ripple_mm = 0.1f; /* ... and an interval whose bend is less is joined to the next */
static const float radians_per_au = 1e-5f;
static const double least_alike = 0.2; /* correlation below which no FAP follows another */

typedef struct baker {
    const fap_bank *bank;
    const fap_mesh *mesh;
    fap_face *face;
    fap_fat *fat;
    fat_operator op;
    float *weight;                 /* [key_count] */
    float *rest, *posed, *field;   /* x[stride] y[stride] z[stride]; field: of one millimetre of a FAP */
    float *moved[FAT_BORDERS_MAX]; /* [3 * stride] at each border */
} baker;

/* --- posing --- */

static int is_turn(const fap_info *info)
{
    return info->motion == FAP_MOTION_YAW || info->motion == FAP_MOTION_PITCH ||
           info->motion == FAP_MOTION_ROLL;
}

/* All other FAPs are told to stay. */
static void pose_alone(baker *b, int fap, int32_t value, float *out)
{
    fap_frame f = { 0 };

    for (int i = 3; i <= FAP_COUNT; i++)
        f.state[i] = FAP_CODED;
    f.value[fap] = value;
    fap_face_pose(b->face, &f, out, NULL);
}

/* Where vertices went; eyeballs that turn do so in a table of their own. */
static void measure(baker *b, int fap, int32_t value, float *moved)
{
    const size_t stride = b->mesh->stride;

    pose_alone(b, fap, value, b->posed);
    for (size_t i = 0; i < 3 * stride; i++)
        moved[i] = b->posed[i] - b->rest[i];
    for (uint32_t v = 0; v < stride && is_turn(fap_info_get(fap)); v++)
        if (b->mesh->part[v] == FAP_PART_EYE_LEFT || b->mesh->part[v] == FAP_PART_EYE_RIGHT)
            moved[v] = moved[stride + v] = moved[2 * stride + v] = 0;
}

/* --- one table --- */

static int vertex_moves(const baker *b, const fat_table *t, uint32_t v)
{
    for (int k = 0; k < t->border_count; k++)
        for (size_t axis = 0; axis < 3; axis++)
            if (fabsf(b->moved[k][axis * b->mesh->stride + v]) > still_mm)
                return 1;
    return 0;
}

/* Millimetres for one unit within interval @p k. */
static float slope_of(const baker *b, const fat_table *t, int k, size_t i)
{
    return (b->moved[k + 1][i] - b->moved[k][i]) / (float)(t->border[k + 1] - t->border[k]);
}

static void choose_scale(const baker *b, fat_table *t)
{
    float most = 0;

    for (int k = 0; k + 1 < t->border_count; k++)
        for (size_t i = 0; i < 3 * (size_t)b->mesh->stride; i++)
            most = fmaxf(most, fabsf(slope_of(b, t, k, i)));
    t->scale_mm = most / STEPS;
}

static void fill_table(const baker *b, fat_table *t)
{
    uint32_t n = 0;

    for (uint32_t v = 0; v < b->mesh->vertex_count; v++) {
        if (!vertex_moves(b, t, v))
            continue;
        t->vertex[n] = v;
        for (int k = 0; k + 1 < t->border_count; k++)
            for (size_t axis = 0; axis < 3; axis++)
                t->slope[(size_t)k * t->vertex_count + n][axis] =
                    (int16_t)lrintf(slope_of(b, t, k, axis * b->mesh->stride + v) / t->scale_mm);
        n++;
    }
}

/* Takes border @p k out where the path is straight enough without it. */
static int is_straight(const baker *b, const fat_table *t, int k)
{
    const float part =
        (float)(t->border[k] - t->border[k - 1]) / (float)(t->border[k + 1] - t->border[k - 1]);

    for (size_t i = 0; i < 3 * (size_t)b->mesh->stride; i++) {
        const float line = b->moved[k - 1][i] + part * (b->moved[k + 1][i] - b->moved[k - 1][i]);
        if (fabsf(line - b->moved[k][i]) > ripple_mm)
            return 0;
    }
    return 1;
}

static void drop_border(baker *b, fat_table *t, int k)
{
    float *freed = b->moved[k];

    t->border_count--;
    for (int i = k; i < t->border_count; i++) {
        t->border[i] = t->border[i + 1];
        b->moved[i] = b->moved[i + 1];
    }
    b->moved[t->border_count] = freed;
}

/* A table from what is measured at its borders; one that moves nothing is not kept. */
static int keep_table(baker *b, fat_table t)
{
    for (int k = t.border_count - 2; k > 0; k--)
        if (t.border[k] != 0 && is_straight(b, &t, k))
            drop_border(b, &t, k);
    if (t.border_count == 3 && is_straight(b, &t, 1)) /* then one slope does for both directions */
        drop_border(b, &t, 0);
    for (uint32_t v = 0; v < b->mesh->vertex_count; v++)
        t.vertex_count += (uint32_t)vertex_moves(b, &t, v);
    choose_scale(b, &t);
    if (!t.vertex_count || !(t.scale_mm > 0) || b->fat->table_count == FAT_TABLES_MAX)
        return 1;
    fat_table *kept = &b->fat->table[b->fat->table_count++];
    *kept = t;
    if (!fat_table_open(b->fat, kept))
        return 0;
    fill_table(b, kept);
    return 1;
}

/* --- FAPs that move a point --- */

/* Eyeballs are rigid: what keys did to them is undone. */
static void hold_eyeballs(const baker *b, float *field)
{
    for (uint32_t v = 0; v < b->mesh->vertex_count; v++)
        for (size_t axis = 0; axis < 3; axis++)
            if (b->mesh->part[v] == FAP_PART_EYE_LEFT || b->mesh->part[v] == FAP_PART_EYE_RIGHT)
                field[axis * b->mesh->stride + v] = 0;
}

static void add_keys(const baker *b, float *field)
{
    const fap_face *face = b->face;

    for (int k = 0; k < face->key_count; k++)
        face->dsp.add_key(field, b->mesh->stride, face->key[k]->block, face->key[k]->delta,
                          face->key[k]->block_count, b->weight[k] * face->key[k]->scale_mm);
}

/* What the keys leave over: the FAP's own point gets there, and no other FAP's moves along that FAP's axis. */
static void add_residual(baker *b, int row, float *field)
{
    float point[FAP_POINT_COUNT][3], strength[3][FAP_POINT_COUNT];

    fap_face_measure(b->face, field, point);
    for (int axis = 0; axis < 3; axis++) {
        uint8_t on[FAP_POINT_COUNT] = { 0 };
        float error[FAP_POINT_COUNT] = { 0 };
        for (int i = 0; i < b->op.row_count; i++) {
            const int p = b->op.point[i];
            if (b->op.axis[i] != axis)
                continue;
            on[p] = 1;
            error[p] = (i == row ? b->op.sign[i] : 0) - point[p][axis];
        }
        fap_residual_solve(&b->face->residual, on, error, strength[axis]);
    }
    fap_residual_apply(&b->face->residual, &b->face->dsp, (const float(*)[FAP_POINT_COUNT])strength, field,
                       b->mesh->stride);
}

/* How far a lid goes until it meets the other one; 0: it is no lid. */
static float lid_gap(const baker *b, int fap)
{
    const int *slit = b->face->slit[FAP_LIP_SLITS + (fap == 20 || fap == 22)];
    const float gap = b->face->neutral[slit[0]][1] - b->face->neutral[slit[1]][1];

    return fap >= 19 && fap <= 22 ? fmaxf(0, gap) : 0;
}

/* Lids bend round the eyeball, which quarters of the way follow well enough; all else is straight on either side. */
static void choose_borders(const baker *b, int row, fat_table *t)
{
    const int32_t most = fap_info_get(t->fap)->i_max;
    const int32_t shut = (int32_t)lrintf(lid_gap(b, t->fap) / b->op.step_mm[row]);
    int n = 0;

    t->border[n++] = -most;
    t->border[n++] = 0;
    for (int quarter = 1; quarter <= 4 && shut >= 4; quarter++)
        t->border[n++] = shut * quarter / 4;
    if (most > shut)
        t->border[n++] = most;
    t->border_count = (uint8_t)n;
}

/*
 * What pushes one way only is done by the FAPs that are there for it. In every table it would add up: millimetres of
 * teeth that brows and cheeks had opened, lids that stand off the eye.
 */
static void measure_row(baker *b, int row, int32_t value, float *moved)
{
    const fap_frame still = { 0 };
    const float gap = lid_gap(b, b->op.fap[row]);
    float mm = (float)value * b->op.step_mm[row];

    if (gap > 0 && b->op.fap[row] <= 20)
        mm = fminf(mm, gap);
    for (size_t i = 0; i < 3 * (size_t)b->mesh->stride; i++)
        b->posed[i] = b->rest[i] + mm * b->field[i];
    if (b->op.fap[row] == JAW)
        fap_face_clamp_teeth(b->face, b->posed);
    if (gap > 0)
        fap_face_slide_lids(b->face, &still, b->posed);
    for (size_t i = 0; i < 3 * (size_t)b->mesh->stride; i++)
        moved[i] = b->posed[i] - b->rest[i];
}

static int bake_row(baker *b, int row)
{
    fat_table t = { .fap = b->op.fap[row] };

    memset(b->field, 0, 3 * (size_t)b->mesh->stride * sizeof *b->field);
    fat_operator_weights(&b->op, b->face, row, b->weight);
    add_keys(b, b->field);
    hold_eyeballs(b, b->field);
    add_residual(b, row, b->field);
    choose_borders(b, row, &t);
    for (int k = 0; k < t.border_count; k++)
        measure_row(b, row, t.border[k], b->moved[k]);
    return keep_table(b, t);
}

/* --- FAPs that move a body: gaze, pupils, the tongue's curl --- */

static int bake_body(baker *b, int fap)
{
    const fap_info *info = fap_info_get(fap);
    const int32_t most = info->i_max * (is_turn(info) ? info->quant_step : 1);
    fat_table t = { .fap = (uint8_t)fap,
                    .border_count = 5,
                    .border = { -most, -most / 2, 0, most / 2, most } };

    for (int k = 0; k < t.border_count; k++)
        measure(b, fap, t.border[k], b->moved[k]);
    return keep_table(b, t);
}

static int bake_fap(baker *b, int fap)
{
    const int row = fat_operator_row(&b->op, fap);

    return row < 0 ? bake_body(b, fap) : bake_row(b, row);
}

/* --- visemes and expressions --- */

/* Key models are straight: two borders will do. */
static int bake_key(baker *b, const fap_key *key)
{
    fat_table t = { .fap = key->kind == FAP_KEY_VISEME ? 1 : 2, .select = key->number, .border_count = 2 };
    const size_t stride = b->mesh->stride;

    t.border[1] = STRENGTH_MAX;
    memset(b->moved[0], 0, 3 * stride * sizeof(float));
    memset(b->moved[1], 0, 3 * stride * sizeof(float));
    for (uint32_t i = 0; i < key->block_count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            for (size_t lane = 0; lane < FAP_BLOCK; lane++)
                b->moved[1][axis * stride + (size_t)key->block[i] * FAP_BLOCK + lane] =
                    key->scale_mm * key->delta[(i * 3 + axis) * FAP_BLOCK + lane];
    return keep_table(b, t);
}

/* --- what turns --- */

static uint32_t count_share(const baker *b, int part)
{
    uint32_t n = 0;

    for (uint32_t v = 0; v < b->mesh->vertex_count; v++)
        n += part >= 0 ? b->mesh->part[v] == part : b->mesh->head_weight[v] > 0;
    return n;
}

static int by_share(const baker *b, int part, fat_turn *t)
{
    uint32_t n = 0;

    for (int share = 255; share > 0; share--)
        for (uint32_t v = 0; v < b->mesh->vertex_count; v++) {
            const int own = part < 0 ? b->mesh->head_weight[v] : b->mesh->part[v] == part ? 255 : 0;
            if (own != share)
                continue;
            t->vertex[n] = v;
            t->share[n++] = (uint8_t)share;
        }
    return n == t->vertex_count;
}

/* @p part: of an eyeball; -1: the head. */
static int bake_turn(baker *b, int fap, int part, const float pivot[3])
{
    static const uint8_t axes[] = { [FAP_MOTION_YAW] = 1, [FAP_MOTION_PITCH] = 0, [FAP_MOTION_ROLL] = 2 };
    fat_turn *t = &b->fat->turn[b->fat->turn_count++];

    *t = (fat_turn){ .fap = (uint8_t)fap, .axis = axes[fap_info_get(fap)->motion] };
    memcpy(t->pivot, pivot, sizeof t->pivot);
    t->radians = radians_per_au;
    t->vertex_count = count_share(b, part);
    return fat_turn_open(b->fat, t) && by_share(b, part, t);
}

/* Pitch before yaw, as fap_head_rotation() has it. */
static int bake_turns(baker *b)
{
    const fap_bank_point *spine = fap_bank_point_get(b->bank, fap_point_by_name("7.1"));
    float centre[3], radius;

    for (int right = 0; right < 2; right++)
        if (fap_bank_eye(b->bank, right, centre, &radius) &&
            !(bake_turn(b, 25 + right, FAP_PART_EYE_LEFT + right, centre) &&
              bake_turn(b, 23 + right, FAP_PART_EYE_LEFT + right, centre)))
            return 0;
    return bake_turn(b, 50, -1, spine->position_mm) && bake_turn(b, 48, -1, spine->position_mm) &&
           bake_turn(b, 49, -1, spine->position_mm);
}

/* --- what follows what, where FAPs are few --- */

/* What clients send by itself: jaw, lips' middles and corners, lids, brows. */
static const uint8_t leaders[] = { 3,  51, 52, 4,  5,  59, 60, 53, 54, 12, 13, 6,  7, 14,
                                   15, 16, 17, 19, 20, 31, 32, 33, 34, 35, 36, 41, 42 };

typedef struct bond {
    int leader;
    double share, alike;
} bond;

/* Bonds of one row, the closest first. */
static int list_bonds(const baker *b, int row, bond *list)
{
    int n = 0;

    for (size_t i = 0; i < sizeof leaders; i++) {
        const int leader = fat_operator_row(&b->op, leaders[i]);
        bond own = { .leader = leader };
        if (leader < 0 || leader == row)
            continue;
        own.share = fat_operator_share(&b->op, row, leader, &own.alike);
        own.share *= (double)(b->op.step_mm[leader] / b->op.step_mm[row]);
        own.alike = fabs(own.alike);
        if (!(own.alike >= least_alike))
            continue;
        int at = n++;
        for (; at > 0 && list[at - 1].alike < own.alike; at--)
            list[at] = list[at - 1];
        list[at] = own;
    }
    return n < LEADERS_OF_ONE ? n : LEADERS_OF_ONE;
}

static void bake_follows(baker *b)
{
    for (int row = 0; row < b->op.row_count; row++) {
        bond list[sizeof leaders];
        const int n = list_bonds(b, row, list);
        for (int i = 0; i < n && b->fat->follow_count < FAT_FOLLOW_MAX; i++) {
            const long share = lrint(fmin(30000, fmax(-30000, 1024 * list[i].share)));
            b->fat->follow[b->fat->follow_count++] =
                (fat_follow){ b->op.fap[row], b->op.fap[list[i].leader], (int16_t)share };
        }
    }
}

/* --- all of it --- */

static int bake_mesh(baker *b)
{
    fap_fat *fat = b->fat;

    fat->vertex_count = b->mesh->vertex_count;
    fat->triangle_count = b->mesh->triangle_count;
    fat->neutral = fap_mem_calloc(&fat->alloc, fat->vertex_count, sizeof *fat->neutral);
    fat->triangle = fap_mem_calloc(&fat->alloc, fat->triangle_count, 3 * sizeof *fat->triangle);
    if (!fat->neutral || !fat->triangle)
        return 0;
    for (uint32_t v = 0; v < fat->vertex_count; v++)
        for (size_t axis = 0; axis < 3; axis++)
            fat->neutral[v][axis] = b->rest[axis * b->mesh->stride + v];
    memcpy(fat->triangle, b->mesh->triangle, 3 * (size_t)fat->triangle_count * sizeof *fat->triangle);
    return 1;
}

static int bake_all(baker *b)
{
    pose_alone(b, 0, 0, b->rest);
    if (!bake_mesh(b))
        return 0;
    for (int k = 0; k < fap_bank_key_count(b->bank); k++) {
        const fap_key *key = fap_bank_key_get(b->bank, k);
        if ((key->kind == FAP_KEY_VISEME || key->kind == FAP_KEY_EXPRESSION) && !bake_key(b, key))
            return 0;
    }
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if ((fap < 48 || fap > 50) && !bake_fap(b, fap))
            return 0;
    bake_follows(b);
    return bake_turns(b);
}

static int open_work(baker *b, const fap_allocator *alloc)
{
    const size_t size = 3 * (size_t)b->mesh->stride;
    int good = 1;

    b->rest = fap_mem_calloc_aligned(alloc, size, sizeof(float));
    b->posed = fap_mem_calloc_aligned(alloc, size, sizeof(float));
    b->field = fap_mem_calloc_aligned(alloc, size, sizeof(float));
    b->weight = fap_mem_calloc(alloc, (size_t)b->face->key_count, sizeof(float));
    for (int k = 0; k < FAT_BORDERS_MAX; k++) {
        b->moved[k] = fap_mem_calloc_aligned(alloc, size, sizeof(float));
        good = good && b->moved[k];
    }
    return good && b->rest && b->posed && b->field && b->weight && !fat_operator_open(&b->op, b->face);
}

static void close_work(baker *b, const fap_allocator *alloc)
{
    fap_mem_free_aligned(alloc, b->rest);
    fap_mem_free_aligned(alloc, b->posed);
    fap_mem_free_aligned(alloc, b->field);
    fap_mem_free(alloc, b->weight);
    fat_operator_close(&b->op, b->face);
    for (int k = 0; k < FAT_BORDERS_MAX; k++)
        fap_mem_free_aligned(alloc, b->moved[k]);
    fap_face_close(&b->face);
}

fap_err fap_fat_bake(fap_fat **fat, const fap_bank *bank, const fap_allocator *alloc)
{
    const fap_allocator own = fap_mem_allocator(alloc);
    baker b = { .bank = bank };
    fap_face_config cfg;

    if (!fat)
        return FAP_E_ARG;
    *fat = NULL;
    if (!bank)
        return FAP_E_ARG;
    b.mesh = fap_bank_mesh(bank);
    fap_face_config_init(&cfg);
    cfg.blend = FAP_BLEND_QP;
    cfg.alloc = own;
    fap_err err = fap_face_open(&b.face, bank, &cfg);
    if (err != FAP_OK)
        return err;
    b.fat = fat_new(&own);
    if (!b.fat || !open_work(&b, &own) || !bake_all(&b)) {
        fap_fat_close(&b.fat);
        err = FAP_E_NOMEM;
    }
    *fat = b.fat;
    close_work(&b, &own);
    return err;
}
