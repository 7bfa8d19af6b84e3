/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include "bank/planar_bone.h"

static const float triangle[3][3] = { { 0, 0, 1 }, { 4, 0, 0 }, { 1, 3, 0 } };

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static void any_place(uint32_t *seed, float at[3])
{
    for (int i = 0; i < 3; i++)
        at[i] = (float)(next(seed) % 1201) / 100 - 5;
}

static void make(fap_planar_bone *bone, const float corner[3][3])
{
    assert_int_equal(fap_planar_bone_set(bone, corner), 1);
}

static float distance(const float a[3], const float b[3])
{
    float sum = 0;

    for (int i = 0; i < 3; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrtf(sum);
}

TEST(planar_bone, all_regions_are_met_and_a_bone_at_rest_moves_nothing)
{
    fap_planar_bone bone;
    int met[7] = { 0 };
    uint32_t seed = 1;

    make(&bone, triangle);
    for (int n = 0; n < 2000; n++) {
        fap_bone_place place;
        float at[3], to[3];
        any_place(&seed, at);
        fap_planar_bone_locate(&bone, at, &place);
        met[place.region]++;
        fap_planar_bone_carry(&bone, &place, to);
        assert_true(distance(at, to) < 1e-3f);
    }
    for (int r = 0; r < 7; r++)
        assert_true(met[r] > 10);
}

/* A quarter turn about z and a step. */
static void turn(const float a[3], float out[3])
{
    out[0] = 2 - a[1];
    out[1] = a[0] - 1;
    out[2] = a[2] + 5;
}

TEST(planar_bone, a_rigid_bone_carries_rigidly)
{
    fap_planar_bone rest, moved;
    float corner[3][3];
    uint32_t seed = 2;

    for (int i = 0; i < 3; i++)
        turn(triangle[i], corner[i]);
    make(&rest, triangle);
    make(&moved, (const float(*)[3])corner);
    for (int n = 0; n < 500; n++) {
        fap_bone_place place;
        float at[3], to[3], expected[3];
        any_place(&seed, at);
        turn(at, expected);
        fap_planar_bone_locate(&rest, at, &place);
        fap_planar_bone_carry(&moved, &place, to);
        assert_true(distance(to, expected) < 1e-3f);
    }
}

/* Along a walk in small steps across all regions, what a bent and stretched bone makes of it has no step either. */
TEST(planar_bone, regions_join_without_a_step)
{
    static const float bent[3][3] = { { -1, 0.5f, 1 }, { 6, 1, 2 }, { 1, 4, -2 } };
    fap_planar_bone rest, moved;
    float last[3] = { 0 };

    make(&rest, triangle);
    make(&moved, bent);
    for (int n = 0; n <= 4000; n++) {
        const float turn_rad = 2 * 3.14159265f * (float)n / 4000;
        const float at[3] = { 1.6f + 4.5f * cosf(turn_rad), 1 + 4.5f * sinf(turn_rad), 0.5f };
        fap_bone_place place;
        float to[3];
        fap_planar_bone_locate(&rest, at, &place);
        fap_planar_bone_carry(&moved, &place, to);
        assert_true(n == 0 || distance(to, last) < 0.1f);
        memcpy(last, to, sizeof last);
    }
}

TEST(planar_bone, distance_is_that_of_the_triangle)
{
    fap_planar_bone bone;
    fap_bone_place place;
    static const float flat[3][3] = { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } };
    const float above[3] = { 1, 1, -2 }, beside[3] = { 2, -3, 4 }, beyond[3] = { 7, -4, 0 };

    make(&bone, flat);
    assert_float_equal(fap_planar_bone_locate(&bone, above, &place), 2, 1e-5);
    assert_int_equal(place.region, 0);
    assert_float_equal(fap_planar_bone_locate(&bone, beside, &place), 5, 1e-5);
    assert_int_equal(place.region, 1);
    assert_float_equal(fap_planar_bone_locate(&bone, beyond, &place), 5, 1e-5);
    assert_int_equal(place.region, 5);
}

TEST(planar_bone, three_corners_on_a_line_are_no_bone)
{
    static const float line[3][3] = { { 0, 0, 0 }, { 1, 1, 1 }, { 3, 3, 3 } }, point[3][3] = { { 0 } };
    fap_planar_bone bone;

    assert_int_equal(fap_planar_bone_set(&bone, line), 0);
    assert_int_equal(fap_planar_bone_set(&bone, point), 0);
}

TEST(planar_bone, weights_fall_from_one_to_nothing)
{
    assert_float_equal(fap_planar_bone_weight(0, 5), 1, 1e-6);
    assert_float_equal(fap_planar_bone_weight(2.5f, 5), 0.5, 1e-6);
    assert_true(fap_planar_bone_weight(5, 5) == 0 && fap_planar_bone_weight(9, 5) == 0);
}
