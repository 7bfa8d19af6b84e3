/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fap_expression_lay(): the scan's head is brought over the face at rest, the face is laid onto it as onto any scan, and the
 * difference, masked and smoothed, is the motion. Sources: see expression.h. Yano & Harada align the two laid models, which for
 * vertices that correspond is no search; here the face at rest is aligned with the scan itself, before anything is laid, so
 * that a mouth that opens does not turn the head.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/expression.h>
#include <fap/studio/landmarks.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "registration/icp.h"
#include "registration/stencil.h"
#include "surface/edges.h"
#include "surface/normals.h"

enum { ICP_ROUNDS = 40, PAIRS = 6 };
/* What does least on a face: the corners of the eyes, and the nose. */
static const char *const pair_points[PAIRS] = { "3.7", "3.8", "3.11", "3.12", "9.12", "9.3" };
static const double icp_reach_mm = 10;

typedef struct work {
    const fap_person *who;
    const fap_bank *bank;
    const fap_mesh *mesh;
    const fap_expression_config *cfg;
    fap_expression_report *report;
    fap_allocator alloc;
    char *where;
    fap_generic person;
    fap_surface *scan; /* millimetres; the head's axes as soon as the pose is known */
    fap_pin pin[FAP_POINT_COUNT];
    double anchor[FAP_POINT_COUNT][3]; /* where each pin is on the face at rest */
    uint8_t is_pair[FAP_POINT_COUNT];
    uint32_t pin_count;
    uint8_t *still; /* [vertices] under the stencil */
} work;

void fap_expression_config_init(fap_expression_config *cfg)
{
    *cfg = (fap_expression_config){
        .struct_size = sizeof *cfg, .keep = 0.7, .mask_mm = 20, .smooth_share = 0.1, .smooth_steps = -1
    };
    fap_registration_config_init(&cfg->fit);
    cfg->fit.pin_error_mm = 0.3; /* what is seen twice is seen with the same error */
}

static fap_err fail(const work *w, fap_err err, const char *text)
{
    snprintf(w->where, FAP_ERROR_TEXT_SIZE, "%s", text);
    return err;
}

/* --- landmarks --- */

/* A landmark this far off the face at rest was not on it. */
static const float astray_mm = 12;

typedef struct same_side {
    const fap_mesh *mesh;
    const uint8_t *mask;
    uint8_t own;
} same_side;

/* A lip's landmark is not on the other one, however near that is. */
static int is_same_side(const void *user, uint32_t t)
{
    const same_side *s = user;
    const uint32_t *v = s->mesh->triangle + 3 * (size_t)t;
    uint8_t there = 0;

    for (int c = 0; s->mask && c < 3; c++)
        there |= s->mask[v[c]];
    return s->mesh->part[v[0]] == FAP_PART_SKIN && !(fap_mask_across(s->own) & there);
}

static int is_pair(const work *w, const fap_pin *pin)
{
    for (int i = 0; i < PAIRS; i++) {
        const fap_bank_point *p = fap_bank_point_get(w->bank, fap_point_by_name(pair_points[i]));
        if (p->present && p->vertex_count && p->vertex[0] == pin->vertex[0])
            return 1;
    }
    return 0;
}

/* The first bit of a mask. */
static uint8_t side_of(const work *w, uint32_t vertex)
{
    const uint8_t mask = w->person.mask ? w->person.mask[vertex] : 0;
    return mask & (uint8_t)-mask;
}

static const fap_pin *find_pin(const fap_pin *pin, uint32_t count, uint32_t vertex)
{
    for (uint32_t i = 0; i < count; i++)
        if (pin[i].vertex[0] == vertex)
            return &pin[i];
    return NULL;
}

static void anchor(work *w, const surface_index *face, fap_pin *pin, const fap_pin *before)
{
    const same_side side = { w->mesh, w->person.mask, side_of(w, pin->vertex[0]) };
    float at[3];
    surface_hit h;

    if (!before)
        return;
    fap_registration_to_head(w->who->rest, before->at, at);
    if (!surface_index_nearest(face, at, astray_mm, is_same_side, &side, &h))
        return;
    for (int k = 0; k < 3; k++) {
        pin->vertex[k] = w->mesh->triangle[3 * (size_t)h.triangle + (size_t)k];
        pin->share[k] = h.share[k];
    }
    w->report->anchored++;
}

static void find_anchors(work *w)
{
    for (uint32_t i = 0; i < w->pin_count; i++)
        for (int a = 0; a < 3; a++) {
            w->anchor[i][a] = 0;
            for (int k = 0; k < 3; k++)
                w->anchor[i][a] += (double)(w->pin[i].share[k] * w->person.position[w->pin[i].vertex[k]][a]);
        }
}

/* Where the face at rest has what the landmarks mean: there, where they were on the scan at rest. */
static fap_err take_landmarks(work *w, const fap_take *landmarks)
{
    fap_pin *before = fap_mem_calloc(&w->alloc, FAP_POINT_COUNT, sizeof *before);
    surface_index *face = NULL;
    uint32_t count = 0;

    fap_err err =
        before ? fap_landmarks_pin(landmarks, w->bank, w->pin, &w->pin_count, w->where) : FAP_E_NOMEM;
    for (uint32_t i = 0; err == FAP_OK && i < w->pin_count; i++)
        w->is_pair[i] = (uint8_t)is_pair(w, &w->pin[i]);
    if (err == FAP_OK)
        err = fap_landmarks_pin(w->who->landmarks, w->bank, before, &count, w->where);
    if (err == FAP_OK)
        err = surface_index_open(&face, w->person.position, w->person.vertex_count, w->person.triangle,
                                 w->person.triangle_count);
    for (uint32_t i = 0; err == FAP_OK && i < w->pin_count; i++)
        anchor(w, face, &w->pin[i], find_pin(before, count, w->pin[i].vertex[0]));
    if (err == FAP_OK)
        find_anchors(w);
    surface_index_close(&face);
    fap_mem_free(&w->alloc, before);
    return err == FAP_E_UNSUPPORTED
               ? fail(w, err, "built without Embree (libembree-dev), which finds where a scan is near")
               : err;
}

/* --- the scan, copied and moved --- */

static fap_err copy_scan(work *w, const fap_surface *scan)
{
    const float mm = (float)fap_registration_report_get(w->who->rest)->mm_per_unit;

    const fap_err err = fap_surface_create(&w->scan, scan->vertex_count, scan->triangle_count, &w->alloc);
    if (err != FAP_OK)
        return err;
    for (uint32_t i = 0; i < scan->vertex_count; i++)
        for (int a = 0; a < 3; a++)
            w->scan->position[i][a] = mm * scan->position[i][a];
    memcpy(w->scan->triangle, scan->triangle, scan->triangle_count * sizeof *scan->triangle);
    for (uint32_t i = 0; i < w->pin_count; i++)
        for (int a = 0; a < 3; a++)
            w->pin[i].at[a] *= mm;
    return FAP_OK;
}

static void undo(const rigid_pose *pose, float at[3])
{
    const double seen[3] = { (double)at[0], (double)at[1], (double)at[2] };
    double model[3];

    rigid_undo(pose, seen, model);
    for (int a = 0; a < 3; a++)
        at[a] = (float)model[a];
}

static void report_head(work *w, const rigid_pose *pose)
{
    const double mm = fap_registration_report_get(w->who->rest)->mm_per_unit;

    for (int a = 0; a < 3; a++) {
        w->report->head[a][3] = 0;
        for (int b = 0; b < 3; b++) {
            w->report->head[a][b] = mm * pose->r[b][a];
            w->report->head[a][3] -= pose->r[b][a] * pose->t[b];
        }
    }
}

static void turn_scan(work *w, const rigid_pose *pose)
{
    report_head(w, pose);
    for (uint32_t i = 0; i < w->scan->vertex_count; i++)
        undo(pose, w->scan->position[i]);
    for (uint32_t i = 0; i < w->pin_count; i++)
        undo(pose, w->pin[i].at);
}

/* --- where the head is --- */

/* Scan from face, by the six pairs; by all landmarks where fewer than three of these are known. */
static int find_start(const work *w, rigid_pose *pose)
{
    double from[FAP_POINT_COUNT][3], to[FAP_POINT_COUNT][3], weight[FAP_POINT_COUNT];
    uint32_t pairs = 0;

    for (uint32_t i = 0; i < w->pin_count; i++)
        pairs += w->is_pair[i];
    w->report->pairs = pairs < 3 ? 0 : pairs;
    for (uint32_t i = 0; i < w->pin_count; i++) {
        weight[i] = pairs < 3 || w->is_pair[i];
        for (int a = 0; a < 3; a++) {
            from[i][a] = w->anchor[i][a];
            to[i][a] = (double)w->pin[i].at[a];
        }
    }
    return rigid_fit((const double(*)[3])from, (const double(*)[3])to, weight, w->pin_count, pose);
}

static fap_err run_icp(const work *w, const surface_index *index, rigid_pose *pose)
{
    const uint32_t vertices = w->mesh->vertex_count;
    float(*normal)[3] = fap_mem_calloc(&w->alloc, vertices, sizeof *normal),
    (*scan_normal)[3] = fap_mem_calloc(&w->alloc, w->scan->vertex_count, sizeof *scan_normal);
    icp_outcome out;

    fap_err err = normal && scan_normal ? FAP_OK : FAP_E_NOMEM;
    if (err == FAP_OK) {
        surface_normals(w->person.position, vertices, w->person.triangle, w->person.triangle_count, normal);
        surface_normals((const float(*)[3])w->scan->position, w->scan->vertex_count,
                        (const uint32_t(*)[3])w->scan->triangle, w->scan->triangle_count, scan_normal);
        const icp_task task = { .model = w->person.position,
                                .normal = (const float(*)[3])normal,
                                .use = w->still,
                                .count = vertices,
                                .surface = index,
                                .surface_normal = (const float(*)[3])scan_normal,
                                .surface_triangle = (const uint32_t(*)[3])w->scan->triangle,
                                .keep = w->cfg->keep,
                                .reach_mm = icp_reach_mm,
                                .rounds = ICP_ROUNDS };
        err = icp_align(&task, pose, &out, &w->alloc);
    }
    if (err == FAP_OK) {
        w->report->icp_rounds = (uint32_t)out.rounds;
        w->report->icp_before_mm = out.before_mm;
        w->report->icp_after_mm = out.after_mm;
    }
    fap_mem_free(&w->alloc, normal);
    fap_mem_free(&w->alloc, scan_normal);
    return err == FAP_E_DATA ? fail(w, err, "the scan has no upper face where the landmarks say that it is")
                             : err;
}

static fap_err bring_head(work *w)
{
    surface_index *index;
    rigid_pose pose;

    if (!find_start(w, &pose))
        return fail(w, FAP_E_DATA, "the landmarks are on one line; three that are not are the least");
    if (w->cfg->alignment == FAP_ALIGN_ICP) {
        fap_err err = surface_index_open(&index, (const float(*)[3])w->scan->position, w->scan->vertex_count,
                                         (const uint32_t(*)[3])w->scan->triangle, w->scan->triangle_count);
        if (err == FAP_OK)
            err = run_icp(w, index, &pose);
        surface_index_close(&index);
        if (err != FAP_OK)
            return err == FAP_E_UNSUPPORTED
                       ? fail(w, err,
                              "built without Embree (libembree-dev), which finds where a scan is near")
                       : err;
    }
    turn_scan(w, &pose);
    return FAP_OK;
}

/* --- the motion --- */

/* Of a skin that was drawn to the scan bending as little as it must: it is smooth already. */
static const int smooth_steps = 3;
/* Of a range image's samples, as the paper has it. */
static const int yano_steps = 30;

/* Each step goes that share of the way to the mean of the neighbours (Yano & Harada 2009, eq. in 4.1). */
static fap_err smooth(const work *w, float (*motion)[3])
{
    const int steps = w->cfg->smooth_steps >= 0                 ? w->cfg->smooth_steps
                      : w->cfg->fit.method == FAP_REGISTER_YANO ? yano_steps
                                                                : smooth_steps;
    const uint32_t n = w->mesh->vertex_count;
    surface_edges e;
    float(*sum)[3] = fap_mem_calloc(&w->alloc, n, sizeof *sum);
    uint32_t *count = fap_mem_calloc(&w->alloc, n, sizeof *count);
    const fap_err err =
        sum && count ? surface_edges_find(&e, w->person.triangle, w->person.triangle_count, n, &w->alloc)
                     : FAP_E_NOMEM;

    for (int step = 0; err == FAP_OK && step < steps; step++) {
        memset(sum, 0, n * sizeof *sum);
        memset(count, 0, n * sizeof *count);
        for (uint32_t i = 0; i < e.count; i++) {
            const uint32_t end[2] = { e.edge[i].low, e.edge[i].high };
            for (int k = 0; k < 2; k++) {
                count[end[k]]++;
                for (int a = 0; a < 3; a++)
                    sum[end[k]][a] += motion[end[1 - k]][a];
            }
        }
        for (uint32_t i = 0; i < n; i++)
            for (int a = 0; count[i] && a < 3; a++)
                motion[i][a] += (float)w->cfg->smooth_share * (sum[i][a] / (float)count[i] - motion[i][a]);
    }
    if (err == FAP_OK)
        surface_edges_free(&e, &w->alloc);
    fap_mem_free(&w->alloc, sum);
    fap_mem_free(&w->alloc, count);
    return err;
}

static fap_err take_motion(const work *w, const fap_registration *r, float (*motion)[3])
{
    const uint32_t n = w->mesh->vertex_count;
    fap_err err = FAP_OK;

    memcpy(motion, fap_registration_positions(r), n * sizeof *motion);
    if (w->cfg->alignment == FAP_ALIGN_ORIENTATION)
        err = fap_face_orient(motion, w->bank, w->person.position);
    if (err != FAP_OK)
        return fail(w, err,
                    "this face has not the points of eyes and nose that the orientation is taken from");
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            motion[i][a] = w->cfg->masked && w->still[i] ? 0 : motion[i][a] - w->person.position[i][a];
    err = smooth(w, motion);
    return err == FAP_OK ? fap_motion_carry(w->bank, w->person.position, motion) : err;
}

static fap_err lay(const work *w, float (*motion)[3])
{
    fap_registration_config fit = w->cfg->fit;
    fap_registration *r;

    fit.in_place = 1;
    fit.subdivisions = 0;
    fap_err err = fap_register(&r, &w->person, w->scan, w->pin, w->pin_count, &fit, w->where);
    if (err != FAP_OK)
        return err;
    w->report->fit = *fap_registration_report_get(r);
    err = take_motion(w, r, motion);
    fap_registration_close(&r);
    return err;
}

static void measure(const work *w, const float (*motion)[3])
{
    double most = 0;

    for (uint32_t i = 0; i < w->mesh->vertex_count; i++) {
        w->report->masked += w->cfg->masked && w->still[i];
        most = fmax(most, pow((double)motion[i][0], 2) + pow((double)motion[i][1], 2) +
                              pow((double)motion[i][2], 2));
    }
    w->report->moves_mm = sqrt(most);
}

static fap_err run(work *w, const fap_surface *scan, const fap_take *landmarks, float (*motion)[3])
{
    fap_err err = take_landmarks(w, landmarks);

    if (err == FAP_OK)
        err = copy_scan(w, scan);
    if (err == FAP_OK && !(w->still = fap_mem_calloc(&w->alloc, w->mesh->vertex_count, 1)))
        err = FAP_E_NOMEM;
    if (err == FAP_OK) {
        err = stencil_find(w->bank, w->person.position, w->cfg->mask_mm, w->still, &w->alloc);
        if (err == FAP_E_DATA)
            return fail(w, err, "this face has no points of brows, eyes and ears that the mask runs along");
    }
    if (err == FAP_OK)
        err = bring_head(w);
    if (err == FAP_OK)
        err = lay(w, motion);
    if (err == FAP_OK)
        measure(w, (const float(*)[3])motion);
    return err;
}

fap_err fap_expression_lay(float (*motion)[3], const fap_person *person, const fap_surface *scan,
                           const fap_take *landmarks, const fap_expression_config *cfg,
                           fap_expression_report *report, char *where)
{
    char own[FAP_ERROR_TEXT_SIZE];
    fap_expression_config defaults;
    fap_expression_report ignored;

    fap_expression_config_init(&defaults);
    cfg = cfg ? cfg : &defaults;
    const fap_allocator alloc = fap_mem_allocator(&cfg->fit.alloc);
    work *w = fap_mem_calloc(&alloc, 1, sizeof *w);
    if (!w)
        return FAP_E_NOMEM;
    const fap_mesh *mesh = fap_bank_mesh(person->bank);
    *w = (work){ .who = person,
                 .bank = person->bank,
                 .mesh = mesh,
                 .cfg = cfg,
                 .report = report ? report : &ignored,
                 .alloc = alloc,
                 .where = where ? where : own,
                 .person = { .vertex_count = mesh->vertex_count,
                             .triangle_count = mesh->triangle_count,
                             .position = fap_registration_positions(person->rest),
                             .triangle = (const uint32_t(*)[3])mesh->triangle,
                             .part = mesh->part,
                             .mask = fap_bank_masks(person->bank) } };
    *w->where = '\0';
    *w->report = (fap_expression_report){ 0 };
    const fap_err err = run(w, scan, landmarks, motion);
    fap_surface_close(&w->scan);
    fap_mem_free(&alloc, w->still);
    fap_mem_free(&alloc, w);
    return err;
}
