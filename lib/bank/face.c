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
#include "bank/ga.h"
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
        .regions = 1,
        .overlap_percent = 20,
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
    const int regions = cfg->regions == 1 || cfg->regions == 2 || cfg->regions == 4;
    return fap_blend_name((int)cfg->blend) && cfg->crossover <= FAP_CROSSOVER_BLX && cfg->generations >= 0 &&
           cfg->generations <= MOST_GENERATIONS && cfg->emphasis >= 0 && cfg->emphasis <= 10 && regions &&
           cfg->overlap_percent >= 0 && cfg->overlap_percent <= 50 && cfg->temporal_mm2 >= 0 &&
           cfg->temporal_mm2 <= 1e6f;
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

static void read_keys(fap_face *face)
{
    for (int k = 0; k < face->key_count; k++) {
        face->key[k] = fap_bank_key_get(face->bank, k);
        face->population[k] = face->key[k]->kind != FAP_KEY_UNIT;
        for (int row = 0; row < FAP_ROWS; row++)
            face->motion[(size_t)row * (size_t)face->key_count + (size_t)k] =
                face->key[k]->point_mm[row / 3][row % 3];
    }
    find_known_keys(face);
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
    face->population = fap_mem_calloc(&face->alloc, n, sizeof *face->population);
    face->fixed = fap_mem_calloc(&face->alloc, n, sizeof *face->fixed);
    face->weight = fap_mem_calloc(&face->alloc, n * FAP_REGION_MAX, sizeof *face->weight);
    face->shown = fap_mem_calloc(&face->alloc, n, sizeof *face->shown);
    if (!face->key || !face->motion || !face->population || !face->fixed || !face->weight || !face->shown)
        return FAP_E_NOMEM;
    read_keys(face);
    return FAP_OK;
}

static fap_err open_method(fap_face *face)
{
    const fap_blend_method *m = fap_blend_methods[face->cfg.blend];
    const int regions = m->regions ? face->cfg.regions : 1;

    face->method = m;
    face->state = m->state_size ? fap_mem_calloc(&face->alloc, 1, m->state_size) : NULL;
    if ((m->state_size && !face->state) ||
        fap_regions_open(&face->regions, face->bank, regions, face->cfg.overlap_percent / 100,
                         &face->alloc) ||
        (m->open && m->open(face->state, face)))
        return FAP_E_NOMEM;
    return FAP_OK;
}

static void close_method(fap_face *face)
{
    if (face->state && face->method->close)
        face->method->close(face->state, face);
    fap_mem_free(&face->alloc, face->state);
    fap_regions_close(&face->regions, &face->alloc);
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
    fap_err err = open_keys(face);
    if (!err)
        err = open_surface(face);
    return err ? err : open_method(face);
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
    close_method(f);
    fap_face_close_parts(f);
    fap_normals_close(&f->normals, &alloc);
    fap_residual_close(&f->residual, &alloc);
    void *const blocks[] = { f->key, f->motion, f->population, f->fixed, f->weight, f->shown, f };
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(&alloc, blocks[i]);
    *face = NULL;
}

size_t fap_face_stride(const fap_face *face)
{
    return face->mesh->stride;
}

/* --- pose --- */

static float weight_in(const fap_face *face, const float *weight, int region, int k)
{
    return weight[(size_t)region * (size_t)face->key_count + (size_t)k];
}

static int same_in_all_regions(const fap_face *face, const float *weight, int k)
{
    for (int r = 1; r < face->regions.count; r++)
        if (weight_in(face, weight, r, k) != weight[k])
            return 0;
    return 1;
}

static void add_key_by_region(const fap_face *face, const float *weight, int k, float *position)
{
    const fap_key *key = face->key[k];
    float w[FAP_REGION_MAX] = { 0 };

    for (int r = 0; r < face->regions.count; r++)
        w[r] = weight_in(face, weight, r, k) * key->scale_mm;
    face->dsp.add_key_regions(position, face->mesh->stride, key->block, key->delta, key->block_count,
                              face->regions.map, w);
}

/*
 * Eq. 3.1, in each region with its own weights (eq. 3.7). Weights of no effect are skipped, so a frame costs
 * what it moves.
 */
static void blend(const fap_face *face, const float *weight, float *position)
{
    const size_t stride = face->mesh->stride;

    memcpy(position, face->mesh->position, 3 * stride * sizeof *position);
    for (int k = 0; k < face->key_count; k++) {
        const fap_key *key = face->key[k];
        if (!same_in_all_regions(face, weight, k))
            add_key_by_region(face, weight, k, position);
        else if (weight[k] != 0)
            face->dsp.add_key(position, stride, key->block, key->delta, key->block_count,
                              weight[k] * key->scale_mm);
    }
}

/* For callers: one weight a key. */
static void show_weights(fap_face *face)
{
    for (int k = 0; k < face->key_count; k++) {
        float sum = 0;
        for (int r = 0; r < face->regions.count; r++)
            sum += weight_in(face, face->weight, r, k);
        face->shown[k] = face->regions.count > 1 ? sum / (float)face->regions.count : sum;
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

/* The same as the method's own fitness, for a shape that is not made of weights alone. */
static float measured_fitness(const fap_face *face)
{
    float target[3][FAP_GA_POINTS] = { 0 }, got[3][FAP_GA_POINTS] = { 0 };

    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r], p = row / 3, axis = row % 3;
        target[axis][p] = fap_blend_row_target(face, row);
        got[axis][p] = face->point[p][axis] - face->neutral[p][axis] - face->fixed_motion[row];
    }
    return fap_ga_cosine(target[0], got[0], FAP_GA_POINTS);
}

static void move_in_head(fap_face *face, const fap_frame *frame, float *position)
{
    blend(face, face->weight, position);
    if (face->method->shape && face->row_count)
        face->method->shape(face->state, face, position);
    fap_face_turn_eyes(face, frame, position);
    fap_face_clamp_teeth(face, position);
    if (face->field_share > 0)
        fap_face_apply_fields(face, position);
    fap_face_measure(face, position, face->point);
    face->stats.target_error_mm = error_mm(face);
    if (face->method->shape)
        face->stats.fitness = measured_fitness(face);
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
    show_weights(face);
    if (normal)
        fap_normals_compute(&face->normals, &face->dsp, face->mesh->stride, position, normal);
}

/* Whether the pose before is near enough in time to hold on to. */
static void keep_time(fap_face *face, int64_t pts_us)
{
    const int64_t longest_us = 100000;

    face->follows_on = face->cfg.temporal_mm2 > 0 && face->has_posed && pts_us > face->last_pts_us &&
                       pts_us - face->last_pts_us <= longest_us;
    face->has_posed = 1;
    face->last_pts_us = pts_us;
}

void fap_face_pose(fap_face *face, const fap_frame *frame, float *position, float *normal)
{
    assert(((uintptr_t)position & 31) == 0 && ((uintptr_t)normal & 31) == 0);
    keep_time(face, frame->pts_us);
    fap_face_lay_base(face, frame);
    fap_face_read_targets(face, frame);
    fap_face_solve(face);
    move_in_head(face, frame, position);
    fap_face_turn_head(face, frame, position);
    finish(face, position, normal);
}

void fap_face_pose_points(fap_face *face, const float target_mm[FAP_POINT_COUNT][3],
                          const uint8_t wanted[FAP_POINT_COUNT][3], float *position, float *normal)
{
    const fap_frame still = { 0 };

    assert(((uintptr_t)position & 31) == 0 && ((uintptr_t)normal & 31) == 0);
    keep_time(face, face->last_pts_us + 1); /* points have no time: each call follows the one before */
    fap_face_lay_base(face, &still);
    fap_face_take_targets(face, target_mm, wanted);
    fap_face_solve(face);
    move_in_head(face, &still, position);
    finish(face, position, normal);
}

void fap_face_pose_keys(fap_face *face, const float *weight, float *position, float *normal)
{
    assert(((uintptr_t)position & 31) == 0 && ((uintptr_t)normal & 31) == 0);
    memcpy(face->weight, weight, sizeof *weight * (size_t)face->key_count);
    fap_blend_copy_to_regions(face, face->weight);
    face->stats = (fap_face_stats){ .fitness = 1 };
    face->row_count = 0;
    blend(face, face->weight, position);
    fap_face_measure(face, position, face->point);
    finish(face, position, normal);
}

void fap_face_points(const fap_face *face, float points[FAP_POINT_COUNT][3])
{
    memcpy(points, face->point, sizeof face->point);
}

const float *fap_face_weights(const fap_face *face)
{
    return face->shown;
}

void fap_face_last_stats(const fap_face *face, fap_face_stats *out)
{
    *out = face->stats;
}
