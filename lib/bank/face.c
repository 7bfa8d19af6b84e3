/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The life of a face and the order of work in a pose: base, targets, weights, one weighted sum of motion
 * vectors, eyes, teeth, residual, tongue, lids, head, normals. All memory is taken in open. Source: Zhu 2006
 * section 3.1, eq. 3.1; DESIGN.md section 5.
 */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "base/mem.h"

enum { MOST_GENERATIONS = 100000 };

void fap_face_config_init(fap_face_config *cfg)
{
    *cfg = (fap_face_config){
        .struct_size = sizeof *cfg,
        .blend = FAP_BLEND_GA,
        .crossover = FAP_CROSSOVER_LINE,
        .generations = 70,
        .emphasis = 1,
        .seed = 1,
        .residual = 1,
    };
}

/* Members that the caller's header does not know yet keep their defaults. */
static int read_config(fap_face_config *cfg, const fap_face_config *from)
{
    fap_face_config_init(cfg);
    if (!from)
        return 1;
    if (from->struct_size < offsetof(fap_face_config, generations) || from->struct_size > sizeof *cfg)
        return 0;
    memcpy(cfg, from, from->struct_size);
    return cfg->blend <= FAP_BLEND_GA && cfg->crossover <= FAP_CROSSOVER_BLX && cfg->generations >= 0 &&
           cfg->generations <= MOST_GENERATIONS && cfg->emphasis >= 0 && cfg->emphasis <= 10;
}

/* --- open and close --- */

static int unit(const fap_face *face, const char *name)
{
    return fap_bank_key_find(face->bank, FAP_KEY_UNIT, name);
}

static void find_known_keys(fap_face *face)
{
    static const char *const names[2][5] = {
        { "eyeBlinkLeft", "eyeLookUpLeft", "eyeLookDownLeft", "eyeLookInLeft", "eyeLookOutLeft" },
        { "eyeBlinkRight", "eyeLookUpRight", "eyeLookDownRight", "eyeLookInRight", "eyeLookOutRight" },
    };
    fap_face_keys *k = &face->known;

    k->jaw_open = unit(face, "jawOpen");
    k->mouth_close = unit(face, "mouthClose");
    k->cheek_puff = unit(face, "cheekPuff");
    k->blink_both = fap_bank_key_find(face->bank, FAP_KEY_EXTRA, "blink");
    for (int right = 0; right < 2; right++) {
        k->blink[right] = unit(face, names[right][0]);
        k->look_up[right] = unit(face, names[right][1]);
        k->look_down[right] = unit(face, names[right][2]);
        k->look_in[right] = unit(face, names[right][3]);
        k->look_out[right] = unit(face, names[right][4]);
    }
}

static void find_rivals(fap_face *face)
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
            face->rivals[face->rival_count++] = (fap_face_rivals){ { a, b }, pairs[i].stiffness_mm2 };
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

/* Units are the basis of least squares, the gaze's own apart; a bank without units offers all its keys. */
static void sort_keys(fap_face *face)
{
    int unit_count = 0;

    for (int k = 0; k < face->key_count; k++) {
        const int is_unit = face->key[k]->kind == FAP_KEY_UNIT;
        face->population[k] = !is_unit;
        face->free_key[k] = is_unit && !is_look(face, k);
        unit_count += face->free_key[k];
    }
    for (int k = 0; k < face->key_count && !unit_count; k++)
        face->free_key[k] = 1;
}

static void read_keys(fap_face *face)
{
    for (int k = 0; k < face->key_count; k++) {
        face->key[k] = fap_bank_key_get(face->bank, k);
        for (int row = 0; row < FAP_ROWS; row++)
            face->motion[(size_t)row * (size_t)face->key_count + (size_t)k] =
                face->key[k]->point_mm[row / 3][row % 3];
    }
    find_known_keys(face);
    find_rivals(face);
    fap_face_make_basis(face);
    sort_keys(face);
}

/* Eyeballs are bodies: FAPs 27 and 28 move them as such. */
static void sort_points(fap_face *face)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(face->bank, p);
        const int eyeball = p == fap_point_index(3, 5) || p == fap_point_index(3, 6);
        face->solvable[p] = point->present && point->vertex_count && !eyeball;
    }
}

static fap_err open_keys(fap_face *face)
{
    const size_t n = (size_t)face->key_count;

    face->key = fap_mem_calloc(&face->alloc, n, sizeof *face->key);
    face->motion = fap_mem_calloc(&face->alloc, n * FAP_ROWS, sizeof *face->motion);
    face->basis = fap_mem_calloc(&face->alloc, (n + 1) * FAP_ROWS, sizeof *face->basis);
    face->free_key = fap_mem_calloc(&face->alloc, n, sizeof *face->free_key);
    face->population = fap_mem_calloc(&face->alloc, n, sizeof *face->population);
    face->fixed = fap_mem_calloc(&face->alloc, n, sizeof *face->fixed);
    face->weight = fap_mem_calloc(&face->alloc, n, sizeof *face->weight);
    face->variable = fap_mem_calloc(&face->alloc, n + 1, sizeof *face->variable);
    face->beside = fap_mem_calloc(&face->alloc, 2 * n, sizeof *face->beside);
    face->mover = fap_mem_calloc(&face->alloc, n + 1, sizeof *face->mover);
    face->reach = fap_mem_calloc(&face->alloc, n + 1, sizeof *face->reach);
    if (!face->key || !face->motion || !face->basis || !face->free_key || !face->beside || !face->mover ||
        !face->reach || !face->population || !face->fixed || !face->weight || !face->variable)
        return FAP_E_NOMEM;
    read_keys(face);
    if (fap_qp_open(&face->qp, face->key_count + 1, &face->alloc) ||
        fap_ga_open(&face->ga, face->key_count + 1, FAP_ROWS, face->key_count, &face->alloc))
        return FAP_E_NOMEM;
    return FAP_OK;
}

static fap_err open_surface(fap_face *face)
{
    fap_graph graph;
    const fap_err err = fap_face_open_parts(face);

    if (err)
        return err;
    int failed = fap_graph_open(&graph, face->bank, &face->alloc);
    failed = failed || fap_normals_open(&face->normals, &graph, face->mesh, &face->alloc) ||
             fap_residual_open(&face->residual, face->bank, &graph, face->follows, &face->alloc);
    fap_graph_close(&graph, &face->alloc);
    return failed ? FAP_E_NOMEM : FAP_OK;
}

static fap_err open_face(fap_face *face)
{
    const fap_bank_point *spine = fap_bank_point_get(face->bank, fap_point_index(7, 1));

    if (!spine->present || !face->mesh->vertex_count || !face->key_count)
        return FAP_E_DATA;
    memcpy(face->spine, spine->position_mm, sizeof face->spine);
    fap_dsp_init(&face->dsp, fap_cpu_detect());
    fap_face_measure(face, face->mesh->position, face->neutral);
    memcpy(face->point, face->neutral, sizeof face->point);
    sort_points(face);
    fap_face_find_slits(face);
    face->chin_row = 3 * fap_point_by_name("2.1") + 1;
    const fap_err err = open_keys(face);
    return err ? err : open_surface(face);
}

fap_err fap_face_open(fap_face **face, const fap_bank *bank, const fap_face_config *cfg)
{
    fap_face_config own;

    *face = NULL;
    if (!bank || !read_config(&own, cfg))
        return FAP_E_ARG;
    const fap_allocator alloc = fap_mem_allocator(&own.alloc);
    fap_face *f = fap_mem_calloc(&alloc, 1, sizeof *f);
    if (!f)
        return FAP_E_NOMEM;
    f->alloc = alloc;
    f->cfg = own;
    f->bank = bank;
    f->mesh = fap_bank_mesh(bank);
    f->key_count = fap_bank_key_count(bank);
    const fap_err err = open_face(f);
    if (err)
        fap_face_close(&f);
    *face = f;
    return err;
}

void fap_face_close(fap_face **face)
{
    fap_face *f = face ? *face : NULL;
    if (!f)
        return;
    const fap_allocator alloc = f->alloc;
    fap_face_close_parts(f);
    fap_normals_close(&f->normals, &alloc);
    fap_residual_close(&f->residual, &alloc);
    fap_qp_close(&f->qp, &alloc);
    fap_ga_close(&f->ga, &alloc);
    void *const blocks[] = { f->key,    f->motion, f->basis, f->free_key, f->population, f->fixed,
                             f->weight, f->beside, f->mover, f->reach,    f->variable,   f };
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(&alloc, blocks[i]);
    *face = NULL;
}

size_t fap_face_stride(const fap_face *face)
{
    return face->mesh->stride;
}

/* --- pose --- */

/* Eq. 3.1. Weights of no effect are skipped, so a frame costs what it moves. */
static void blend(const fap_face *face, const float *weight, float *position)
{
    const size_t stride = face->mesh->stride;

    memcpy(position, face->mesh->position, 3 * stride * sizeof *position);
    for (int k = 0; k < face->key_count; k++) {
        const fap_key *key = face->key[k];
        if (weight[k] != 0)
            face->dsp.add_key(position, stride, key->block, key->delta, key->block_count,
                              weight[k] * key->scale_mm);
    }
}

void fap_face_measure(const fap_face *face, const float *position, float point[FAP_POINT_COUNT][3])
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *b = fap_bank_point_get(face->bank, p);
        for (size_t axis = 0; axis < 3; axis++) {
            const float *row = position + axis * face->mesh->stride;
            double sum = 0;
            for (uint32_t i = 0; i < b->vertex_count; i++)
                sum += row[b->vertex[i]];
            point[p][axis] = b->vertex_count ? (float)(sum / b->vertex_count) : b->position_mm[axis];
        }
    }
}

/* RMS distance of the commanded axes from their targets. */
static float error_mm(const fap_face *face)
{
    double sum = 0;

    for (int r = 0; r < face->row_count; r++) {
        const int p = face->row[r] / 3, axis = face->row[r] % 3;
        const double e = face->point[p][axis] - face->neutral[p][axis] - face->asked[p][axis];
        sum += e * e;
    }
    return face->row_count ? (float)sqrt(sum / face->row_count) : 0;
}

static void move_in_head(fap_face *face, const fap_frame *frame, float *position)
{
    blend(face, face->weight, position);
    fap_face_turn_eyes(face, frame, position);
    fap_face_clamp_teeth(face, position);
    fap_face_measure(face, position, face->point);
    face->stats.target_error_mm = error_mm(face);
    if (face->cfg.residual)
        fap_face_correct(face, position);
    fap_face_curl_tongue(face, frame, position);
    fap_face_slide_lids(face, frame, position);
    fap_face_measure(face, position, face->point);
    face->stats.residual_error_mm = error_mm(face);
    face->stats.target_count = face->row_count;
}

static void finish(fap_face *face, const float *position, float *normal)
{
    if (normal)
        fap_normals_compute(&face->normals, &face->dsp, face->mesh, position, normal);
}

void fap_face_pose(fap_face *face, const fap_frame *frame, float *position, float *normal)
{
    assert(((uintptr_t)position & 31) == 0 && ((uintptr_t)normal & 31) == 0);
    fap_face_lay_base(face, frame);
    fap_face_read_targets(face, frame);
    fap_face_solve(face);
    move_in_head(face, frame, position);
    fap_face_turn_head(face, frame, position);
    finish(face, position, normal);
}

void fap_face_pose_keys(fap_face *face, const float *weight, float *position, float *normal)
{
    assert(((uintptr_t)position & 31) == 0 && ((uintptr_t)normal & 31) == 0);
    memcpy(face->weight, weight, sizeof *weight * (size_t)face->key_count);
    face->stats = (fap_face_stats){ .fitness = 1 };
    face->row_count = 0;
    blend(face, weight, position);
    fap_face_measure(face, position, face->point);
    finish(face, position, normal);
}

void fap_face_points(const fap_face *face, float points[FAP_POINT_COUNT][3])
{
    memcpy(points, face->point, sizeof face->point);
}

const float *fap_face_weights(const fap_face *face)
{
    return face->weight;
}

void fap_face_last_stats(const fap_face *face, fap_face_stats *out)
{
    *out = face->stats;
}
