/* SPDX-License-Identifier: BSD-2-Clause */
/* The parts of the lorenzo method, on functions and sheets whose answer is known. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "registration/control_fit.h"

/* --- both ways down --- */

/* Rosenbrock's valley: its floor is bent, and lowest, 0, at 1, 1. */
static double valley(void *user, const double *x, double *gradient)
{
    const double a = 1 - x[0], b = x[1] - x[0] * x[0];

    if (user)
        ++*(int *)user;
    if (gradient) {
        gradient[0] = -2 * a - 400 * x[0] * b;
        gradient[1] = 200 * b;
    }
    return a * a + 100 * b * b;
}

/* A bowl, 4 lower in each unknown's direction, and nobody may be left of 0 in the first. */
static double bowl(void *user, const double *x, double *gradient)
{
    double sum = 0;

    (void)user;
    for (int i = 0; i < 6; i++) {
        sum += (i + 1) * (x[i] - i) * (x[i] - i);
        if (gradient)
            gradient[i] = 2 * (i + 1) * (x[i] - i);
    }
    return x[0] < -0.5 ? INFINITY : sum;
}

TEST(simplex, goes_along_a_bent_valley)
{
    int asked = 0;
    const simplex_task task = { valley, &asked, 2, 0.5, 1e-6, 400 };
    double x[2] = { -1.2, 1 };

    assert_true(simplex_run(&task, x) < 1e-9);
    assert_float_equal(x[0], 1, 1e-4);
    assert_float_equal(x[1], 1, 1e-4);
    assert_true(asked < 300);
}

TEST(simplex, stops_when_it_has_asked_enough)
{
    int asked = 0;
    const simplex_task task = { valley, &asked, 2, 0.5, 1e-12, 20 };
    double x[2] = { -1.2, 1 };
    const double before = valley(NULL, x, NULL);

    assert_true(simplex_run(&task, x) < before);
    assert_true(asked < 25);
}

TEST(simplex, finds_the_ground_of_six_unknowns_beside_a_wall)
{
    const simplex_task task = { bowl, NULL, 6, 1, 1e-6, 4000 };
    double x[6] = { 3, 3, 3, 3, 3, 3 };

    assert_true(simplex_run(&task, x) < 1e-6);
    for (int i = 0; i < 6; i++)
        assert_float_equal(x[i], i, 1e-3);
}

TEST(lbfgs, goes_along_a_bent_valley)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    double x[2] = { -1.2, 1 };
    lbfgs *l;

    assert_int_equal(lbfgs_open(&l, 2, &heap), FAP_OK);
    const lbfgs_task task = { valley, NULL, 100, 1, 1e-12 };
    assert_true(lbfgs_run(l, &task, x) < 1e-9);
    assert_float_equal(x[0], 1, 1e-4);
    assert_float_equal(x[1], 1, 1e-4);
    lbfgs_close(&l);
    assert_null(l);
}

TEST(lbfgs, takes_no_longer_step_than_allowed_and_never_rises)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    double x[6] = { 9, 9, 9, 9, 9, 9 };
    lbfgs *l;

    assert_int_equal(lbfgs_open(&l, 6, &heap), FAP_OK);
    const lbfgs_task task = { bowl, NULL, 1, 0.5, 0 };
    double value = bowl(NULL, x, NULL);
    for (int i = 0; i < 60; i++) {
        double before[6];
        memcpy(before, x, sizeof x);
        const double next = lbfgs_run(l, &task, x);
        assert_true(next <= value);
        value = next;
        for (int k = 0; k < 6; k++)
            assert_true(fabs(x[k] - before[k]) <= 0.5 + 1e-12);
    }
    assert_true(value < 1e-6);
    lbfgs_close(&l);
}

TEST(lbfgs, stays_where_nobody_may_be)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    double x[6] = { -1, 0, 0, 0, 0, 0 };
    lbfgs *l;

    assert_int_equal(lbfgs_open(&l, 6, &heap), FAP_OK);
    const lbfgs_task task = { bowl, NULL, 10, 1, 0 };
    assert_true(isinf(lbfgs_run(l, &task, x)));
    assert_float_equal(x[0], -1, 0);
    lbfgs_close(&l);
}

/* --- a bumpy sheet with a slit --- */

enum { SIDE = 25, SHEET = SIDE * SIDE, HALF = SIDE / 2, QUADS = (SIDE - 1) * (SIDE - 1) };

typedef struct sheet {
    float at[SHEET][3];
    uint32_t triangle[2 * QUADS][3], triangles;
    uint8_t use[SHEET], mask[SHEET];
    surface_edges edges;
    control_face face;
    control_mesh mesh;
    bone_skin skin;
    mesh_energy energy;
    control_fit fit;
    elastic_pin pin;
    fap_allocator heap;
} sheet;

/* Between two rows there are no triangles in the middle columns: a mouth, its lips half a millimetre apart. */
static int is_slit(int row, int column)
{
    return row == HALF && column > 5 && column < SIDE - 7;
}

static void add_quad(sheet *s, uint32_t v)
{
    memcpy(s->triangle[s->triangles++], (uint32_t[3]){ v, v + 1, v + SIDE }, 3 * sizeof(uint32_t));
    memcpy(s->triangle[s->triangles++], (uint32_t[3]){ v + 1, v + SIDE + 1, v + SIDE }, 3 * sizeof(uint32_t));
}

static void open_sheet(sheet *s, uint32_t points, fap_optimizer optimizer)
{
    *s = (sheet){ .heap = fap_mem_allocator(NULL) };
    for (int v = 0; v < SHEET; v++) {
        const float x = (float)(v % SIDE), y = (float)(v / SIDE);
        s->at[v][0] = 3 * x;
        s->at[v][1] = 3 * y - (y > HALF ? 2.5F : 0);
        s->at[v][2] = 4 * sinf(0.3F * x) * cosf(0.25F * y);
        s->use[v] = 1;
        s->mask[v] = y > HALF && y < HALF + 4    ? FAP_MASK_LIP_UPPER
                     : y <= HALF && y > HALF - 3 ? FAP_MASK_LIP_LOWER
                                                 : 0;
    }
    for (int row = 0; row + 1 < SIDE; row++)
        for (int column = 0; column + 1 < SIDE; column++)
            if (!is_slit(row, column))
                add_quad(s, (uint32_t)(row * SIDE + column));
    assert_int_equal(
        surface_edges_find(&s->edges, (const uint32_t(*)[3])s->triangle, s->triangles, SHEET, &s->heap),
        FAP_OK);
    s->face = (control_face){ (const float(*)[3])s->at,
                              SHEET,
                              (const uint32_t(*)[3])s->triangle,
                              s->triangles,
                              &s->edges,
                              s->use,
                              s->mask };
    const uint32_t seed[2] = { 0, SHEET - 1 };
    assert_int_equal(control_mesh_make(&s->mesh, &s->face, seed, 2, points, &s->heap), FAP_OK);
    assert_int_equal(bone_skin_open(&s->skin, &s->face, &s->mesh, &s->heap), FAP_OK);
    assert_int_equal(mesh_energy_open(&s->energy, &s->face, &s->heap), FAP_OK);
    assert_int_equal(
        control_fit_open(&s->fit, &s->skin, &s->energy, (const float(*)[3])s->at, optimizer, &s->heap),
        FAP_OK);
    s->energy.weights = (energy_weights){ .dist = 1, .strain = 0.5, .bend = 3, .slide = 0.1 };
    s->fit.even = 0.5;
    s->pin =
        (elastic_pin){ .vertex = { 3, 30, 31 }, .share = { 0.5, 0.3, 0.2 }, .to = { 9, 1, 2 }, .weight = 1 };
    s->energy.pin = &s->pin;
}

static void close_sheet(sheet *s)
{
    control_fit_close(&s->fit);
    mesh_energy_close(&s->energy, &s->heap);
    bone_skin_close(&s->skin, &s->heap);
    control_mesh_free(&s->mesh, &s->heap);
    surface_edges_free(&s->edges, &s->heap);
}

/* Where a smooth motion takes a place. */
static void move(const double from[3], double to[3])
{
    to[0] = 1.04 * from[0] + 0.5 * sin(0.1 * from[1]);
    to[1] = from[1] + 0.03 * from[0];
    to[2] = from[2] + 2 * sin(0.06 * from[0] + 0.05 * from[1]);
}

/* Every vertex is drawn to where moved control points would have it, along the sheet too. */
static void plant(sheet *s)
{
    for (uint32_t i = 0; i < s->mesh.count; i++) {
        double from[3];
        memcpy(from, s->fit.control[i], sizeof from);
        move(from, s->fit.control[i]);
    }
    assert_true(control_fit_carry(&s->fit));
    for (uint32_t v = 0; v < SHEET; v++) {
        elastic_pull *p = &s->energy.pull[v];
        *p = (elastic_pull){ .normal = { 0, 0.28, 0.96 }, .weight = 1 };
        for (int a = 0; a < 3; a++)
            p->to[a] = (double)s->fit.at[v][a];
    }
}

static void back_to_rest(sheet *s)
{
    for (uint32_t i = 0; i < s->mesh.count; i++)
        for (int a = 0; a < 3; a++)
            s->fit.control[i][a] = (double)s->at[s->mesh.vertex[i]][a];
    assert_true(control_fit_carry(&s->fit));
}

static double planted_off(const sheet *s)
{
    double sum = 0;

    for (uint32_t i = 0; i < s->mesh.count; i++) {
        double from[3], to[3];
        for (int a = 0; a < 3; a++)
            from[a] = (double)s->at[s->mesh.vertex[i]][a];
        move(from, to);
        for (int a = 0; a < 3; a++)
            sum += pow(s->fit.control[i][a] - to[a], 2);
    }
    return sqrt(sum / s->mesh.count);
}

static int is_upper(const sheet *s, uint32_t point)
{
    return s->mesh.vertex[point] / SIDE > HALF;
}

TEST(control_mesh, no_triangle_spans_the_slit)
{
    sheet s;

    open_sheet(&s, 80, FAP_OPTIMIZER_LBFGS);
    assert_int_equal(s.mesh.count, 80);
    assert_int_equal(s.mesh.vertex[0], 0);
    assert_int_equal(s.mesh.vertex[1], SHEET - 1);
    assert_true(s.mesh.bone_count > 80);
    for (uint32_t b = 0; b < s.mesh.bone_count; b++) {
        const uint32_t *c = s.mesh.bone[b];
        float middle = 0;
        for (int k = 0; k < 3; k++)
            middle += s.at[s.mesh.vertex[c[k]]][0] / 3;
        const int uppers = is_upper(&s, c[0]) + is_upper(&s, c[1]) + is_upper(&s, c[2]);
        assert_true(uppers == 0 || uppers == 3 || middle < 3 * 8 || middle > 3 * (SIDE - 9));
    }
    close_sheet(&s);
}

TEST(control_mesh, faces_as_the_face_does)
{
    sheet s;

    open_sheet(&s, 60, FAP_OPTIMIZER_LBFGS);
    for (uint32_t b = 0; b < s.mesh.bone_count; b++)
        assert_true(s.skin.bone[b].normal[2] > 0);
    close_sheet(&s);
}

TEST(bone_skin, at_rest_everything_is_where_it_was)
{
    sheet s;

    open_sheet(&s, 60, FAP_OPTIMIZER_LBFGS);
    assert_true(control_fit_carry(&s.fit));
    for (uint32_t v = 0; v < SHEET; v++) {
        float sum = 0;
        assert_true(s.skin.says[v] > 0);
        for (int i = 0; i < s.skin.says[v]; i++)
            sum += s.skin.say[v][i].weight;
        assert_float_equal(sum, 1, 1e-5);
        for (int a = 0; a < 3; a++)
            assert_float_equal(s.fit.at[v][a], s.at[v][a], 1e-3);
    }
    close_sheet(&s);
}

TEST(bone_skin, one_lip_leaves_the_other_alone)
{
    sheet s;

    open_sheet(&s, 80, FAP_OPTIMIZER_LBFGS);
    for (uint32_t i = 0; i < s.mesh.count; i++)
        if (s.mask[s.mesh.vertex[i]] == FAP_MASK_LIP_LOWER)
            s.fit.control[i][1] -= 5;
    assert_true(control_fit_carry(&s.fit));
    for (uint32_t v = 0; v < SHEET; v++)
        if (v % SIDE > 9 && v % SIDE < 14 &&
            v / SIDE == HALF + 1) /* the edge of the upper lip, off its corners */
            assert_float_equal(s.fit.at[v][1], s.at[v][1], 0.05);
    close_sheet(&s);
}

TEST(control_fit, the_gradient_is_what_differences_say)
{
    sheet s;

    open_sheet(&s, 40, FAP_OPTIMIZER_LBFGS);
    plant(&s);
    back_to_rest(&s);
    s.energy.pin_count = 1;
    s.energy.weights.pin = 0.1;
    double *x = &s.fit.control[0][0], gradient[3 * 40], most = 0;
    for (int i = 0; i < 3 * 40; i++)
        x[i] += 0.7 * sin(5.0 * i); /* no bone is flat, and every term pulls */
    control_fit_value(&s.fit, x, gradient);
    for (int i = 0; i < 3 * 40; i++)
        most = fmax(most, fabs(gradient[i]));
    for (int i = 0; i < 3 * 40; i++) {
        const double kept = x[i], step = 0.02;
        x[i] = kept + step;
        const double above = control_fit_value(&s.fit, x, NULL);
        x[i] = kept - step;
        const double below = control_fit_value(&s.fit, x, NULL);
        x[i] = kept;
        assert_float_equal((above - below) / (2 * step), gradient[i], 0.01 * most);
    }
    close_sheet(&s);
}

TEST(control_fit, what_rests_costs_nothing)
{
    sheet s;

    open_sheet(&s, 40, FAP_OPTIMIZER_LBFGS);
    assert_true(control_fit_value(&s.fit, &s.fit.control[0][0], NULL) < 1e-8);
    close_sheet(&s);
}

TEST(control_fit, lbfgs_finds_planted_control_points_and_never_rises)
{
    sheet s;

    open_sheet(&s, 40, FAP_OPTIMIZER_LBFGS);
    plant(&s);
    back_to_rest(&s);
    s.energy.weights.strain = s.energy.weights.bend = s.fit.even = 1e-4;
    const double far = planted_off(&s);
    double value = INFINITY;
    for (int i = 0; i < 12; i++) {
        const double next = control_fit_lbfgs(&s.fit, 10);
        assert_true(next <= value * (1 + 1e-9));
        value = next;
    }
    assert_true(far > 1.5);
    assert_true(planted_off(&s) < 0.1);
    close_sheet(&s);
}

TEST(control_fit, the_simplex_finds_them_too)
{
    sheet s;

    open_sheet(&s, 40, FAP_OPTIMIZER_SIMPLEX);
    plant(&s);
    back_to_rest(&s);
    s.energy.weights.strain = s.energy.weights.bend = s.fit.even = 1e-4;
    double value = INFINITY;
    for (int i = 0; i < 10; i++) {
        const double next = control_fit_simplex(&s.fit, 1);
        assert_true(next <= value + 1e-9);
        value = next;
    }
    assert_true(planted_off(&s) < 0.3);
    close_sheet(&s);
}
