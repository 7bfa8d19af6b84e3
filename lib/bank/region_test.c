/* SPDX-License-Identifier: BSD-2-Clause */
/* Shares of regions: they sum to one, change slowly along the surface, and bodies have one each. */
#include "tests/test.h"

#include <math.h>

#include "bank/region.h"
#include "base/mem.h"

static float share(const fap_regions *r, int region, uint32_t v)
{
    return r->map[((size_t)(v / FAP_BLOCK) * FAP_REGION_MAX + (size_t)region) * FAP_BLOCK + v % FAP_BLOCK];
}

static void open_regions(fap_regions *r, fap_bank **bank, int count, float overlap)
{
    const fap_allocator alloc = fap_mem_allocator(NULL);

    assert_int_equal(fap_bank_builtin(bank, NULL), FAP_OK);
    assert_int_equal(fap_regions_open(r, *bank, count, overlap, &alloc), 0);
}

static void close_regions(fap_regions *r, fap_bank **bank)
{
    const fap_allocator alloc = fap_mem_allocator(NULL);

    fap_regions_close(r, &alloc);
    fap_bank_close(bank);
}

TEST(region, shares_sum_to_one)
{
    for (int count = 1; count <= 4; count *= 2) {
        fap_regions r;
        fap_bank *bank;
        open_regions(&r, &bank, count, 0.2f);
        for (int p = 0; p < FAP_POINT_COUNT; p++)
            assert_float_equal(r.point[0][p] + r.point[1][p] + r.point[2][p] + r.point[3][p], 1, 1e-5);
        for (uint32_t v = 0; v < fap_bank_mesh(bank)->vertex_count && r.map; v++)
            assert_float_equal(share(&r, 0, v) + share(&r, 1, v) + share(&r, 2, v) + share(&r, 3, v), 1,
                               1e-5);
        assert_int_equal(r.map != NULL, count > 1);
        close_regions(&r, &bank);
    }
}

/* 20 % of the width on either side: the ramp is 0.4 of the face wide, so an edge of e mm changes by e over that. */
TEST(region, neighbours_have_nearly_the_same_shares)
{
    fap_regions r;
    fap_bank *bank;

    open_regions(&r, &bank, 4, 0.2f);
    const fap_mesh *mesh = fap_bank_mesh(bank);
    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const uint32_t a = mesh->triangle[i], b = mesh->triangle[i % 3 == 2 ? i - 2 : i + 1];
        float length = 0;
        for (size_t axis = 0; axis < 3; axis++)
            length +=
                powf(mesh->position[axis * mesh->stride + a] - mesh->position[axis * mesh->stride + b], 2);
        for (int k = 0; k < 4; k++)
            assert_true(fabsf(share(&r, k, a) - share(&r, k, b)) <= sqrtf(length) / 20);
    }
    close_regions(&r, &bank);
}

TEST(region, left_is_left_and_upper_is_upper)
{
    fap_regions r;
    fap_bank *bank;

    open_regions(&r, &bank, 4, 0.1f);
    assert_true(r.point[0][fap_point_by_name("4.5")] > 0.99f);
    assert_true(r.point[1][fap_point_by_name("4.6")] > 0.99f);
    assert_true(r.point[2][fap_point_by_name("2.11")] > 0.6f);
    assert_true(r.point[3][fap_point_by_name("2.12")] > 0.6f);
    assert_float_equal(r.point[2][fap_point_by_name("2.1")], 0.5, 0.05);
    close_regions(&r, &bank);
}

TEST(region, without_overlap_borders_are_sharp)
{
    fap_regions r;
    fap_bank *bank;

    open_regions(&r, &bank, 2, 0);
    for (uint32_t v = 0; v < fap_bank_mesh(bank)->vertex_count; v++)
        assert_true(share(&r, 0, v) == 0 || share(&r, 0, v) == 1);
    close_regions(&r, &bank);
}

TEST(region, teeth_and_eyes_are_shaped_as_one_body)
{
    fap_regions r;
    fap_bank *bank;
    float first[FAP_PART_COUNT];

    open_regions(&r, &bank, 4, 0.2f);
    const fap_mesh *mesh = fap_bank_mesh(bank);
    for (int p = 0; p < FAP_PART_COUNT; p++)
        first[p] = -1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *f = &first[mesh->part[v]];
        if (mesh->part[v] == FAP_PART_SKIN || mesh->part[v] == FAP_PART_LASHES)
            continue;
        *f = *f < 0 ? share(&r, 2, v) : *f;
        assert_true(share(&r, 2, v) == *f);
    }
    close_regions(&r, &bank);
}
