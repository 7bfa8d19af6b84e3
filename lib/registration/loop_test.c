/* SPDX-License-Identifier: BSD-2-Clause */
/* Loop's scheme: counts, limits of a plane, borders, and what is passed on. */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/loop.h"
#include "surface/edges.h"

static const float octahedron[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                        { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };
static const uint32_t faces[8][3] = { { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 },
                                      { 2, 0, 5 }, { 1, 2, 5 }, { 3, 1, 5 }, { 0, 3, 5 } };

TEST(loop, four_triangles_for_one_and_the_old_vertices_first)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    loop_mesh once, twice;
    surface_edges e;

    assert_int_equal(loop_subdivide(&once, octahedron, 6, faces, 8, NULL, NULL, &heap), FAP_OK);
    assert_int_equal(once.triangle_count, 32);
    assert_int_equal(once.vertex_count, 6 + 12);
    /* Four neighbours: 5/8 of itself, and 3/32 of each, which cancel. */
    assert_float_equal(once.position[0][0], 0.625, 1e-6);
    assert_float_equal(once.position[0][1], 0, 1e-6);
    assert_int_equal(loop_subdivide(&twice, (const float(*)[3])once.position, once.vertex_count,
                                    (const uint32_t(*)[3])once.triangle, once.triangle_count, NULL, NULL,
                                    &heap),
                     FAP_OK);
    assert_int_equal(twice.triangle_count, 128);
    assert_int_equal(surface_edges_find(&e, (const uint32_t(*)[3])twice.triangle, twice.triangle_count,
                                        twice.vertex_count, &heap),
                     FAP_OK);
    for (uint32_t i = 0; i < e.count; i++) { /* shut and facing one way, as before */
        assert_int_equal(e.edge[i].triangles, 2);
        assert_int_equal(e.edge[i].turned, 0);
    }
    surface_edges_free(&e, &heap);
    loop_free(&once, &heap);
    loop_free(&twice, &heap);
}

TEST(loop, a_border_stays_a_curve_of_its_own_and_masks_are_passed_on)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    static const float square[4][3] = { { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } };
    static const uint32_t halves[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    static const uint8_t part[4] = { 1, 1, 1, 1 }, mask[4] = { 3, 1, 2, 0 };
    loop_mesh m;

    assert_int_equal(loop_subdivide(&m, square, 4, halves, 2, part, mask, &heap), FAP_OK);
    assert_int_equal(m.vertex_count, 9);
    assert_float_equal(m.position[0][0], 0.5, 1e-6); /* 3/4 and an eighth of each border neighbour */
    assert_float_equal(m.position[0][1], 0.5, 1e-6);
    for (uint32_t i = 0; i < 9; i++) {
        assert_float_equal(m.position[i][2], 0, 0);
        assert_int_equal(m.part[i], 1);
    }
    assert_int_equal(m.mask[4], 1); /* of the edge 0 1: what both have */
    loop_free(&m, &heap);
}
