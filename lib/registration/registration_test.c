/* SPDX-License-Identifier: BSD-2-Clause */
/* A face is laid onto a person whose every vertex is known: the built-in face, bent. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/registration.h>

#include "base/mem.h"
#include "registration/elastic.h"
#include "registration/warp.h"
#include "surface/nearest.h"

enum { PINS = 40 };

static char where[FAP_ERROR_TEXT_SIZE];

/* --- bent space --- */

static const double four[5][3] = { { 0, 0, 0 }, { 10, 0, 1 }, { 0, 10, 2 }, { 3, 4, 10 }, { 8, 8, 8 } };

TEST(warp, every_kernel_meets_its_centres)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const double move[5][3] = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 3 }, { -1, -1, 0 }, { 0.5, 0, 0 } };

    for (int kernel = WARP_HARDY; kernel <= WARP_BIHARMONIC; kernel++) {
        warp w;
        assert_int_equal(warp_open(&w, (warp_kernel)kernel, four, move, NULL, 5, 0, &heap), FAP_OK);
        for (int i = 0; i < 5; i++) {
            double got[3];
            warp_move(&w, four[i], got);
            for (int a = 0; a < 3; a++)
                assert_float_equal(got[a], move[i][a], 1e-8);
        }
        warp_close(&w, &heap);
    }
}

TEST(warp, an_affine_move_stays_one_between_and_beyond_the_centres)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    double move[5][3], got[3];
    const double at[3] = { 20, -7, 5 };
    warp w;

    for (int i = 0; i < 5; i++) {
        move[i][0] = 1 + 0.1 * four[i][1];
        move[i][1] = -0.2 * four[i][0];
        move[i][2] = 2;
    }
    assert_int_equal(warp_open(&w, WARP_HARDY, four, (const double(*)[3])move, NULL, 5, 0, &heap), FAP_OK);
    warp_move(&w, at, got);
    assert_float_equal(got[0], 1 + 0.1 * -7, 1e-8);
    assert_float_equal(got[1], -0.2 * 20, 1e-8);
    assert_float_equal(got[2], 2, 1e-8);
    warp_close(&w, &heap);
}

TEST(warp, centres_in_one_place_are_refused)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const double twice[5][3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    warp w;

    assert_int_equal(warp_open(&w, WARP_BIHARMONIC, twice, four, NULL, 5, 0, &heap), FAP_E_DATA);
}

/* --- a face laid onto a bent one --- */

typedef struct model {
    fap_bank *bank;
    float (*position)[3], (*truth)[3];
    fap_generic generic;
    fap_surface *scan;
    fap_pin pin[PINS];
} model;

/* Another head: wider below, a longer nose, all of it smooth. */
static void bend(const float p[3], float out[3])
{
    out[0] = p[0] * (1.05F - 0.001F * p[1]);
    out[1] = p[1] * 0.96F;
    out[2] = p[2] + 5 * expf(-(p[0] * p[0] + (p[1] + 5) * (p[1] + 5)) / 900);
}

/* Metres, z down, x forward: as a scanner may have it. */
static void to_scanner(const float mm[3], float out[3])
{
    out[0] = mm[2] / 1000 + 1;
    out[1] = mm[0] / 1000 - 2;
    out[2] = mm[1] / 1000;
}

static void open_model(model *m)
{
    assert_int_equal(fap_bank_builtin(&m->bank, NULL), FAP_OK);
    const fap_mesh *mesh = fap_bank_mesh(m->bank);
    m->position = malloc(mesh->vertex_count * sizeof *m->position);
    m->truth = malloc(mesh->vertex_count * sizeof *m->truth);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        for (int a = 0; a < 3; a++)
            m->position[i][a] = mesh->position[(uint32_t)a * mesh->stride + i];
        bend(m->position[i], m->truth[i]);
    }
    m->generic = (fap_generic){ .vertex_count = mesh->vertex_count,
                                .triangle_count = mesh->triangle_count,
                                .position = (const float(*)[3])m->position,
                                .triangle = (const uint32_t(*)[3])mesh->triangle,
                                .part = mesh->part,
                                .mask = fap_bank_masks(m->bank) };
    assert_int_equal(fap_surface_create(&m->scan, mesh->vertex_count, mesh->triangle_count, NULL), FAP_OK);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        to_scanner(m->truth[i], m->scan->position[i]);
    memcpy(m->scan->triangle, mesh->triangle, mesh->triangle_count * sizeof *m->scan->triangle);
}

static uint32_t click(model *m)
{
    uint32_t count = 0;

    for (int p = 0; p < FAP_POINT_COUNT && count < PINS; p++) {
        const fap_bank_point *point = fap_bank_point_get(m->bank, p);
        if (!point->present || !point->vertex_count || m->generic.part[point->vertex[0]] != FAP_PART_SKIN)
            continue;
        const uint32_t v = point->vertex[0];
        m->pin[count] = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        to_scanner(m->truth[v], m->pin[count++].at);
    }
    return count;
}

static void close_model(model *m)
{
    fap_surface_close(&m->scan);
    free(m->position);
    free(m->truth);
    fap_bank_close(&m->bank);
}

/* Lays it or skips the test. */
static fap_registration *lay(model *m, uint32_t pins, const fap_registration_config *cfg)
{
    fap_registration *r;
    const fap_err err = fap_register(&r, &m->generic, m->scan, m->pin, pins, cfg, where);

    if (err == FAP_E_UNSUPPORTED) {
        close_model(m);
        skip();
    }
    assert_int_equal(err, FAP_OK);
    return r;
}

static double rms_off(const model *m, const fap_registration *r)
{
    double sum = 0;
    uint32_t count = 0;

    for (uint32_t i = 0; i < m->generic.vertex_count; i++) {
        float scan[3], there[3];
        if (m->generic.part[i] != FAP_PART_SKIN)
            continue;
        to_scanner(m->truth[i], scan);
        fap_registration_to_head(r, scan, there);
        for (int a = 0; a < 3; a++)
            sum += pow((double)fap_registration_positions(r)[i][a] - (double)there[a], 2);
        count++;
    }
    return sqrt(sum / count);
}

TEST(registration, a_bent_face_in_other_axes_and_units_is_found)
{
    model m;

    open_model(&m);
    const uint32_t pins = click(&m);
    fap_registration *r = lay(&m, pins, NULL);
    const fap_registration_report *rep = fap_registration_report_get(r);
    assert_float_equal(rep->mm_per_unit, 1000, 0);
    assert_true(rep->turned_deg > 100 && rep->turned_deg < 140); /* axes changed round: 120 */
    assert_true(rep->surface_rms_mm < 0.6);
    assert_true(rms_off(&m, r) < 2.5);
    assert_int_equal(rep->pins_out, 0);
    fap_registration_close(&r);
    close_model(&m);
}

/* The works' own methods meet landmarks and sample what is seen: farther off between, but a face. */
TEST(registration, every_method_finds_it)
{
    for (int method = 0; method < FAP_REGISTER_COUNT; method++) {
        model m;
        fap_registration_config cfg;

        open_model(&m);
        fap_registration_config_init(&cfg);
        cfg.method = (fap_registration_method)method;
        fap_registration *r = lay(&m, click(&m), &cfg);
        const fap_registration_report *rep = fap_registration_report_get(r);
        assert_float_equal(rep->mm_per_unit, 1000, 0);
        assert_true(rep->surface_rms_mm < 2 && rep->pin_rms_mm < 2.5);
        assert_true(rms_off(&m, r) < 4);
        fap_registration_close(&r);
        close_model(&m);
    }
}

/* A third of the scan's triangles are gone: what is sampled is filled, and nobody falls into a hole. */
TEST(registration, every_method_puts_up_with_holes)
{
    for (int method = 0; method < FAP_REGISTER_COUNT; method++) {
        model m;
        fap_registration_config cfg;
        uint32_t kept = 0;

        open_model(&m);
        for (uint32_t t = 0; t < m.scan->triangle_count; t++)
            if (t % 3)
                memcpy(m.scan->triangle[kept++], m.scan->triangle[t], sizeof *m.scan->triangle);
        m.scan->triangle_count = kept;
        fap_registration_config_init(&cfg);
        cfg.method = (fap_registration_method)method;
        cfg.mm_per_unit = 1000;
        fap_registration *r = lay(&m, click(&m), &cfg);
        assert_true(rms_off(&m, r) < 5);
        fap_registration_close(&r);
        close_model(&m);
    }
}

TEST(registration, the_front_is_the_same_for_everybody_and_has_no_ears)
{
    model m;

    open_model(&m);
    fap_registration *r = lay(&m, click(&m), NULL);
    const uint8_t *front = fap_registration_front(r);
    static const char *const in[] = { "9.3", "8.1", "2.1", "4.1", "5.3" }, *const out[] = { "10.5", "10.6" };
    for (int i = 0; i < 5; i++)
        assert_true(front[fap_bank_point_get(m.bank, fap_point_by_name(in[i]))->vertex[0]]);
    for (int i = 0; i < 2; i++)
        assert_false(front[fap_bank_point_get(m.bank, fap_point_by_name(out[i]))->vertex[0]]);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, the_scan_itself_is_followed_where_no_landmark_is)
{
    model m;
    fap_registration_config cfg;

    open_model(&m);
    /* A bump on the left cheek that no landmark knows of. */
    for (uint32_t i = 0; i < m.generic.vertex_count; i++) {
        const double d2 = pow((double)m.position[i][0] - 40, 2) + pow((double)m.position[i][1] + 20, 2);
        m.truth[i][2] += (float)(4 * exp(-d2 / 300));
        to_scanner(m.truth[i], m.scan->position[i]);
    }
    fap_registration_config_init(&cfg);
    cfg.mm_per_unit = 1000;
    fap_registration *r = lay(&m, click(&m), &cfg);
    assert_true(fap_registration_report_get(r)->surface_rms_mm < 0.7);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, a_landmark_that_the_others_contradict_is_left_out)
{
    model m;

    open_model(&m);
    const uint32_t pins = click(&m);
    m.pin[5].at[1] += 0.08F; /* eight centimetres */
    fap_registration *r = lay(&m, pins, NULL);
    assert_int_equal(fap_registration_report_get(r)->pins_out, 1);
    assert_true(rms_off(&m, r) < 2.5);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, pins_that_make_no_triangle_are_refused_with_a_reason)
{
    model m;
    fap_registration *r;

    open_model(&m);
    click(&m);
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, 2, NULL, where), FAP_E_ARG);
    assert_non_null(strstr(where, "three landmarks"));
    for (int i = 1; i < 4; i++)
        memcpy(m.pin[i].at, m.pin[0].at, sizeof m.pin[0].at);
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, 4, NULL, where), FAP_E_DATA);
    m.pin[0].vertex[1] = m.generic.vertex_count;
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, 4, NULL, where), FAP_E_ARG);
    assert_null(r);
    close_model(&m);
}

static int stop_at_half(void *user, double done)
{
    (void)user;
    return done > 0.5;
}

TEST(registration, whoever_waits_may_end_it)
{
    model m;
    fap_registration *r;
    fap_registration_config cfg;
    surface_index *index;

    if (surface_index_open(&index, NULL, 0, NULL, 0) == FAP_E_UNSUPPORTED)
        skip();
    surface_index_close(&index);
    fap_registration_config_init(&cfg);
    cfg.progress = stop_at_half;
    open_model(&m);
    const uint32_t pins = click(&m);
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, pins, &cfg, where), FAP_E_END);
    assert_null(r);
    close_model(&m);
}

TEST(registration, methods_have_names)
{
    assert_string_equal(fap_registration_name(FAP_REGISTER_AUTO), "auto");
    assert_string_equal(fap_registration_name(FAP_REGISTER_ZHU), "zhu");
    assert_string_equal(fap_registration_name(FAP_REGISTER_LORENZO), "lorenzo");
    assert_string_equal(fap_optimizer_name(FAP_OPTIMIZER_SIMPLEX), "simplex");
    assert_null(fap_optimizer_name(FAP_OPTIMIZER_COUNT));
    assert_null(fap_registration_name(FAP_REGISTER_COUNT));
    assert_null(fap_registration_name(-1));
}

TEST(registration, zhu_meets_the_landmarks_and_then_the_scan)
{
    model m;
    fap_registration_config cfg;

    open_model(&m);
    const uint32_t pins = click(&m);
    fap_registration_config_init(&cfg);
    cfg.method = FAP_REGISTER_ZHU;
    fap_registration *r = lay(&m, pins, &cfg);
    assert_true(fap_registration_report_get(r)->pin_rms_mm < 0.5);
    assert_true(rms_off(&m, r) < 3);
    fap_registration_close(&r);

    cfg.limit_mm = 0.001; /* nothing is projected: the landmarks alone */
    r = lay(&m, pins, &cfg);
    assert_true(fap_registration_report_get(r)->pin_rms_mm < 0.01);
    const double alone = rms_off(&m, r);
    assert_true(alone > 0.1 && alone < 4);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, zhu_makes_a_finer_face)
{
    model m;
    fap_registration_config cfg;

    open_model(&m);
    const uint32_t pins = click(&m);
    fap_registration_config_init(&cfg);
    cfg.method = FAP_REGISTER_ZHU;
    cfg.subdivisions = 2;
    fap_registration *r = lay(&m, pins, &cfg);
    const fap_surface *s = fap_registration_surface(r);
    assert_int_equal(s->triangle_count, 16 * m.generic.triangle_count);
    assert_true(s->vertex_count > 8 * m.generic.vertex_count);
    assert_true(fap_registration_report_get(r)->surface_rms_mm < 2);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, lorenzo_lays_the_face_by_either_optimizer)
{
    for (int o = 0; o < FAP_OPTIMIZER_COUNT; o++) {
        model m;
        fap_registration_config cfg;

        open_model(&m);
        const uint32_t pins = click(&m);
        fap_registration_config_init(&cfg);
        cfg.method = FAP_REGISTER_LORENZO;
        cfg.optimizer = (fap_optimizer)o;
        cfg.control_points = 100;
        fap_registration *r = lay(&m, pins, &cfg);
        const fap_registration_report *rep = fap_registration_report_get(r);
        assert_true(rep->surface_rms_mm < 0.6);
        assert_true(rms_off(&m, r) < 2.5);
        fap_registration_close(&r);
        close_model(&m);
    }
}

/* Every third triangle is not there, and a patch of the cheek. */
TEST(registration, lorenzo_spans_holes)
{
    model m;
    fap_registration_config cfg;
    uint32_t kept = 0;

    open_model(&m);
    const uint32_t pins = click(&m);
    for (uint32_t t = 0; t < m.scan->triangle_count; t++) {
        const float *at = m.truth[m.scan->triangle[t][0]];
        const int cheek = fabsf(at[0] - 40) < 15 && fabsf(at[1] + 20) < 15;
        if (t % 3 && !cheek)
            memmove(m.scan->triangle[kept++], m.scan->triangle[t], sizeof *m.scan->triangle);
    }
    m.scan->triangle_count = kept;
    fap_registration_config_init(&cfg);
    cfg.method = FAP_REGISTER_LORENZO;
    fap_registration *r = lay(&m, pins, &cfg);
    assert_true(rms_off(&m, r) < 3);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(registration, lorenzo_refuses_what_it_cannot_take_and_may_be_ended)
{
    model m;
    fap_registration *r;
    fap_registration_config cfg;
    surface_index *index;

    if (surface_index_open(&index, NULL, 0, NULL, 0) == FAP_E_UNSUPPORTED)
        skip();
    surface_index_close(&index);
    open_model(&m);
    const uint32_t pins = click(&m);
    fap_registration_config_init(&cfg);
    cfg.method = FAP_REGISTER_LORENZO;
    cfg.control_points = FAP_CONTROL_POINTS_MAX + 1;
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, pins, &cfg, where), FAP_E_ARG);
    cfg.control_points = 100;
    cfg.progress = stop_at_half;
    assert_int_equal(fap_register(&r, &m.generic, m.scan, m.pin, pins, &cfg, where), FAP_E_END);
    assert_null(r);
    close_model(&m);
}
