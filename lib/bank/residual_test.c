/* SPDX-License-Identifier: BSD-2-Clause */
/* Distances along the surface, and fields that stay on their side of a slit. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/residual.h"
#include "base/mem.h"

typedef struct bed {
    fap_allocator alloc;
    fap_bank *bank;
    const fap_mesh *mesh;
    fap_graph graph;
    fap_residual residual;
    uint32_t *follows;
} bed;

static void open_bed(bed *b)
{
    memset(b, 0, sizeof *b);
    b->alloc = fap_mem_allocator(NULL);
    assert_int_equal(fap_bank_builtin(&b->bank, NULL), FAP_OK);
    b->mesh = fap_bank_mesh(b->bank);
    b->follows = calloc(b->mesh->vertex_count, sizeof *b->follows);
    for (uint32_t v = 0; v < b->mesh->vertex_count; v++)
        b->follows[v] = v;
    assert_int_equal(fap_graph_open(&b->graph, b->bank, &b->alloc), 0);
    assert_int_equal(fap_residual_open(&b->residual, b->bank, &b->graph, b->follows, &b->alloc), 0);
}

static void close_bed(bed *b)
{
    fap_residual_close(&b->residual, &b->alloc);
    fap_graph_close(&b->graph, &b->alloc);
    fap_bank_close(&b->bank);
    free(b->follows);
}

static const fap_bank_point *point(const bed *b, const char *name)
{
    return fap_bank_point_get(b->bank, fap_point_by_name(name));
}

static float distance_to(const bed *b, const char *name)
{
    return b->graph.distance[b->graph.weld[point(b, name)->vertex[0]]];
}

TEST(residual, distances_along_the_surface_are_no_shorter_than_straight_ones)
{
    bed b;

    open_bed(&b);
    const fap_bank_point *nose = point(&b, "9.3");
    fap_graph_flood(&b.graph, nose->vertex, nose->vertex_count, 80);
    assert_true(b.graph.reached_count > 20);
    for (uint32_t i = 0; i < b.graph.reached_count; i++) {
        const uint32_t v = b.graph.reached[i];
        float least = INFINITY;
        for (uint32_t k = 0; k < nose->vertex_count; k++) {
            float sum = 0;
            for (size_t axis = 0; axis < 3; axis++) {
                const float *row = b.mesh->position + axis * b.mesh->stride;
                sum += (row[v] - row[nose->vertex[k]]) * (row[v] - row[nose->vertex[k]]);
            }
            least = fminf(least, sqrtf(sum));
        }
        assert_true(b.graph.distance[v] >= least - 1e-3f && b.graph.distance[v] <= 80);
    }
    close_bed(&b);
}

TEST(residual, the_way_between_the_lips_goes_round_the_corner)
{
    bed b;

    open_bed(&b);
    fap_graph_flood(&b.graph, point(&b, "2.2")->vertex, point(&b, "2.2")->vertex_count, 200);
    assert_true(distance_to(&b, "2.3") > 1.2f * distance_to(&b, "2.4"));
    close_bed(&b);
}

TEST(residual, lips_and_lids_do_not_drag_each_other)
{
    static const char *const pairs[][2] = { { "2.2", "2.3" }, { "3.1", "3.3" }, { "3.2", "3.4" } };
    bed b;

    open_bed(&b);
    for (size_t i = 0; i < 3; i++) {
        const int up = fap_point_by_name(pairs[i][0]), low = fap_point_by_name(pairs[i][1]);
        assert_float_equal(b.residual.pull[up][up], 1, 1e-6);
        assert_true(b.residual.pull[up][low] == 0 && b.residual.pull[low][up] == 0);
    }
    close_bed(&b);
}

TEST(residual, strengths_move_every_point_as_asked)
{
    bed b;
    uint8_t on[FAP_POINT_COUNT] = { 0 };
    float error[FAP_POINT_COUNT] = { 0 }, strength[FAP_POINT_COUNT];

    open_bed(&b);
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        on[p] = fap_point_get(p)->moved && b.residual.field[p].block_count;
        error[p] = (float)(p % 7) - 3;
    }
    fap_residual_solve(&b.residual, on, error, strength);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        if (on[p])
            assert_float_equal(fap_residual_pull(&b.residual, p, strength), error[p], 1e-4);
    close_bed(&b);
}

TEST(residual, contradictions_and_infinities_end_in_finite_strengths)
{
    bed b;
    uint8_t on[FAP_POINT_COUNT];
    float error[FAP_POINT_COUNT], strength[FAP_POINT_COUNT];

    open_bed(&b);
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        on[p] = 1;
        error[p] = p % 2 ? 1e30f : -1e30f;
        for (int q = 0; q < FAP_POINT_COUNT; q++)
            b.residual.pull[p][q] = 1; /* all points are one */
    }
    fap_residual_solve(&b.residual, on, error, strength);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        assert_true(isfinite(strength[p]) && fabsf(strength[p]) <= 40);
    close_bed(&b);
}
