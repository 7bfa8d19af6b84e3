/* SPDX-License-Identifier: BSD-2-Clause */
/* A person whose motions are known is scanned: the built-in face, at rest and with a key model, somewhere else each time. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/expression.h>
#include <fap/studio/landmarks.h>

#include "base/mem.h"
#include "registration/icp.h"
#include "registration/stencil.h"
#include "surface/normals.h"

static char where[FAP_ERROR_TEXT_SIZE];

typedef struct model {
    fap_bank *bank;
    const fap_mesh *mesh;
    fap_generic generic;
    fap_surface *scan[2]; /* at rest, and of the expression */
    fap_take *landmarks[2];
    fap_registration *rest;
    float (*truth)[3]; /* motion */
    float (*found)[3];
} model;

/* Turned and moved, in centimetres. */
static void to_scanner(int which, const float mm[3], float out[3])
{
    const float c = which ? 0.98F : 1, s = which ? 0.19899749F : 0;

    out[0] = (c * mm[0] + s * mm[2]) / 10 + 2 * (float)which;
    out[1] = mm[1] / 10 - 3;
    out[2] = (-s * mm[0] + c * mm[2]) / 10 + 1;
}

static void read_truth(model *m, const char *name, fap_key_kind kind)
{
    const fap_key *key = fap_bank_key_get(m->bank, fap_bank_key_find(m->bank, kind, name));

    assert_non_null(key);
    for (uint32_t b = 0; b < key->block_count; b++)
        for (uint32_t lane = 0; lane < FAP_BLOCK; lane++)
            for (uint32_t a = 0; a < 3; a++) {
                const uint32_t v = (uint32_t)key->block[b] * FAP_BLOCK + lane;
                if (v < m->mesh->vertex_count)
                    m->truth[v][a] = key->scale_mm * (float)key->delta[(b * 3 + a) * FAP_BLOCK + lane];
            }
}

static void scan(model *m, int which)
{
    const uint32_t n = m->mesh->vertex_count;

    assert_int_equal(fap_surface_create(&m->scan[which], n, m->mesh->triangle_count, NULL), FAP_OK);
    for (uint32_t v = 0; v < n; v++) {
        float at[3];
        for (int a = 0; a < 3; a++)
            at[a] = m->generic.position[v][a] + (which ? m->truth[v][a] : 0);
        to_scanner(which, at, m->scan[which]->position[v]);
    }
    memcpy(m->scan[which]->triangle, m->mesh->triangle, m->mesh->triangle_count * sizeof(uint32_t[3]));
}

static void click(model *m, int which)
{
    uint32_t count = 0;

    assert_int_equal(fap_take_create(&m->landmarks[which], FAP_POINT_COUNT, 1, NULL), FAP_OK);
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(m->bank, p);
        if (!point->present || !point->vertex_count)
            continue;
        strcpy(m->landmarks[which]->name[count], fap_point_get(p)->name);
        fap_take_set(m->landmarks[which], 0, count++, m->scan[which]->position[point->vertex[0]]);
    }
    m->landmarks[which]->point_count = count;
}

static fap_err open_model(model *m, const char *key, fap_key_kind kind)
{
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t pins;

    assert_int_equal(fap_bank_builtin(&m->bank, NULL), FAP_OK);
    m->mesh = fap_bank_mesh(m->bank);
    m->truth = calloc(m->mesh->vertex_count, sizeof *m->truth);
    m->found = calloc(m->mesh->vertex_count, sizeof *m->found);
    assert_int_equal(fap_generic_of_bank(&m->generic, m->bank, NULL), FAP_OK);
    read_truth(m, key, kind);
    for (int which = 0; which < 2; which++) {
        scan(m, which);
        click(m, which);
    }
    assert_int_equal(fap_landmarks_pin(m->landmarks[0], m->bank, pin, &pins, where), FAP_OK);
    return fap_register(&m->rest, &m->generic, m->scan[0], pin, pins, NULL, where);
}

static void close_model(model *m)
{
    for (int which = 0; which < 2; which++) {
        fap_surface_close(&m->scan[which]);
        fap_take_close(&m->landmarks[which]);
    }
    fap_registration_close(&m->rest);
    fap_generic_free(&m->generic, NULL);
    fap_bank_close(&m->bank);
    free(m->truth);
    free(m->found);
}

static fap_err lay(model *m, const fap_expression_config *cfg, fap_expression_report *report)
{
    const fap_person person = { m->bank, m->rest, m->landmarks[0] };
    return fap_expression_lay(m->found, &person, m->scan[1], m->landmarks[1], cfg, report, where);
}

/* Of the skin that moves: how far the found motion is off, and how far there was to go. */
static void compare(const model *m, double *off, double *went)
{
    double sum = 0, all = 0;
    uint32_t count = 0;

    for (uint32_t v = 0; v < m->mesh->vertex_count; v++) {
        double moved = 0, error = 0;
        for (int a = 0; a < 3; a++) {
            moved += pow((double)m->truth[v][a], 2);
            error += pow((double)m->truth[v][a] - (double)m->found[v][a], 2);
        }
        if (m->mesh->part[v] != FAP_PART_SKIN || moved < 1)
            continue;
        sum += error;
        all += moved;
        count++;
    }
    assert_true(count > 10);
    *off = sqrt(sum / count);
    *went = sqrt(all / count);
}

TEST(expression, a_motion_that_was_scanned_is_found)
{
    model m = { 0 };
    fap_expression_report report;
    double off, went;

    if (open_model(&m, "joy", FAP_KEY_EXPRESSION) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    assert_int_equal(lay(&m, NULL, &report), FAP_OK);
    compare(&m, &off, &went);
    assert_true(off < 0.35 * went);
    assert_int_equal(report.pairs, 6);
    assert_true(report.anchored > 30 && report.icp_after_mm <= report.icp_before_mm + 1e-9);
    close_model(&m);
}

TEST(expression, a_jaw_that_opens_takes_lower_teeth_along_and_leaves_the_upper_ones)
{
    model m = { 0 };

    if (open_model(&m, "aa", FAP_KEY_VISEME) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    assert_int_equal(lay(&m, NULL, NULL), FAP_OK);
    float lower = 0;
    for (uint32_t v = 0; v < m.mesh->vertex_count; v++) {
        if (m.mesh->part[v] == FAP_PART_TEETH_UPPER || m.mesh->part[v] == FAP_PART_EYE_LEFT)
            assert_true(m.found[v][1] == 0);
        if (m.mesh->part[v] == FAP_PART_TEETH_LOWER)
            lower = fminf(lower, m.found[v][1]);
    }
    assert_true(lower < -2);
    close_model(&m);
}

TEST(expression, a_word_moves_nothing_under_the_stencil_mask)
{
    model m = { 0 };
    fap_expression_config cfg;
    fap_expression_report report;

    fap_expression_config_init(&cfg);
    cfg.masked = 1;
    cfg.smooth_steps = 0;
    if (open_model(&m, "aa", FAP_KEY_VISEME) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    assert_int_equal(lay(&m, &cfg, &report), FAP_OK);
    assert_true(report.masked > 20);
    const uint32_t brow = fap_bank_point_get(m.bank, fap_point_by_name("4.3"))->vertex[0];
    const uint32_t lip = fap_bank_point_get(m.bank, fap_point_by_name("8.2"))->vertex[0];
    assert_true(m.found[brow][0] == 0 && m.found[brow][1] == 0 && m.found[brow][2] == 0);
    assert_true(m.found[lip][1] < -2);
    close_model(&m);
}

TEST(expression, the_thesis_way_to_turn_heads_does_as_well)
{
    model m = { 0 };
    fap_expression_config cfg;
    double off, went;

    fap_expression_config_init(&cfg);
    cfg.alignment = FAP_ALIGN_ORIENTATION;
    if (open_model(&m, "joy", FAP_KEY_EXPRESSION) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    assert_int_equal(lay(&m, &cfg, NULL), FAP_OK);
    compare(&m, &off, &went);
    assert_true(off < 0.35 * went);
    close_model(&m);
}

TEST(expression, a_scan_that_is_not_where_its_landmarks_are_is_refused)
{
    model m = { 0 };

    if (open_model(&m, "joy", FAP_KEY_EXPRESSION) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    for (uint32_t v = 0; v < m.scan[1]->vertex_count; v++)
        m.scan[1]->position[v][2] += 50;
    assert_int_equal(lay(&m, NULL, NULL), FAP_E_DATA);
    assert_non_null(strstr(where, "landmarks"));
    close_model(&m);
}

/* --- the parts --- */

TEST(orient, a_face_that_looks_elsewhere_is_turned_back)
{
    fap_bank *bank;
    fap_generic g;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_generic_of_bank(&g, bank, NULL), FAP_OK);
    float(*turned)[3] = malloc(g.vertex_count * sizeof *turned);
    for (uint32_t v = 0; v < g.vertex_count; v++) {
        to_scanner(1, g.position[v], turned[v]);
        for (int a = 0; a < 3; a++)
            turned[v][a] *= 10;
    }
    assert_int_equal(fap_face_orient(turned, bank, g.position), FAP_OK);
    for (uint32_t v = 0; v < g.vertex_count; v++)
        for (int a = 0; a < 3; a++)
            assert_float_equal(turned[v][a], g.position[v][a], 0.02);
    free(turned);
    fap_generic_free(&g, NULL);
    fap_bank_close(&bank);
}

TEST(stencil, covers_brows_and_eyes_and_no_lip)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    fap_bank *bank;
    fap_generic g;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_generic_of_bank(&g, bank, NULL), FAP_OK);
    uint8_t *still = malloc(g.vertex_count);
    assert_int_equal(stencil_find(bank, g.position, 20, still, &heap), FAP_OK);
    static const char *const inside[] = { "4.1", "4.2", "4.5", "3.7", "3.12", "11.2" }, *const outside[] = {
        "8.1", "8.2", "8.3", "8.4", "2.1", "5.1", "9.15"
    };
    for (size_t i = 0; i < sizeof inside / sizeof *inside; i++)
        assert_true(still[fap_bank_point_get(bank, fap_point_by_name(inside[i]))->vertex[0]]);
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++)
        assert_false(still[fap_bank_point_get(bank, fap_point_by_name(outside[i]))->vertex[0]]);
    free(still);
    fap_generic_free(&g, NULL);
    fap_bank_close(&bank);
}

TEST(icp, finds_a_small_turn_though_a_part_has_moved_on_its_own)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    fap_bank *bank;
    fap_generic g;
    surface_index *index;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_generic_of_bank(&g, bank, NULL), FAP_OK);
    const uint32_t n = g.vertex_count;
    float(*at)[3] = malloc(n * sizeof *at), (*normal)[3] = malloc(n * sizeof *normal),
    (*there)[3] = malloc(n * sizeof *there);
    uint8_t *use = malloc(n);
    surface_normals(g.position, n, g.triangle, g.triangle_count, normal);
    for (uint32_t v = 0; v < n; v++) {
        const double angle = 0.05, c = cos(angle), s = sin(angle);
        const float *p = g.position[v];
        at[v][0] = (float)(c * (double)p[0] + s * (double)p[2] + 1);
        at[v][1] = p[1] - 2 - (p[1] < -60 ? 8 : 0); /* the chin has dropped */
        at[v][2] = (float)(-s * (double)p[0] + c * (double)p[2] + 0.5);
        use[v] = (uint8_t)(g.part[v] == FAP_PART_SKIN);
    }
    surface_normals((const float(*)[3])at, n, g.triangle, g.triangle_count, there);
    if (surface_index_open(&index, (const float(*)[3])at, n, g.triangle, g.triangle_count) == FAP_OK) {
        rigid_pose pose = { .r = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
        icp_outcome out;
        const icp_task task = { g.position, (const float(*)[3])normal,
                                use,        n,
                                index,      (const float(*)[3])there,
                                g.triangle, 0.6,
                                20,         200 };
        assert_int_equal(icp_align(&task, &pose, &out, &heap), FAP_OK);
        assert_true(out.after_mm < 0.3 && out.after_mm < 0.3 * out.before_mm);
        assert_float_equal(pose.r[0][2], sin(0.05), 0.01);
        assert_float_equal(pose.t[1], -2, 0.3);
    }
    surface_index_close(&index);
    free(at);
    free(normal);
    free(there);
    free(use);
    fap_generic_free(&g, NULL);
    fap_bank_close(&bank);
}
