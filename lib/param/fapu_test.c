/* SPDX-License-Identifier: BSD-2-Clause */
/* FAPU measurement and head angles. */
#include "tests/test.h"

#include <string.h>

#include <fap/derive.h>
#include <fap/fapu.h>

static void place(float points[FAP_POINT_COUNT][3], const char *name, float x, float y)
{
    const int i = fap_point_by_name(name);
    points[i][0] = x;
    points[i][1] = y;
}

static void neutral(float points[FAP_POINT_COUNT][3])
{
    memset(points, 0, FAP_POINT_COUNT * sizeof *points);
    place(points, "3.1", 31, 5);
    place(points, "3.3", 31, -5);
    place(points, "3.2", -31, 5);
    place(points, "3.4", -31, -5);
    place(points, "3.5", 31, 0);
    place(points, "3.6", -31, 0);
    place(points, "9.15", 0, -48);
    place(points, "2.2", 0, -68);
    place(points, "8.3", 25, -70);
    place(points, "8.4", -25, -70);
}

TEST(fapu, distances_are_those_of_the_definition)
{
    float points[FAP_POINT_COUNT][3];
    fap_fapu fapu;

    neutral(points);
    assert_int_equal(fap_fapu_measure((const float(*)[3])points, &fapu), FAP_OK);
    assert_float_equal(fapu.irisd_mm, 10, 1e-6);
    assert_float_equal(fapu.es_mm, 62, 1e-6);
    assert_float_equal(fapu.ens_mm, 48, 1e-6);
    assert_float_equal(fapu.mns_mm, 20, 1e-6);
    assert_float_equal(fapu.mw_mm, 50, 1e-6);
    assert_float_equal(fap_fapu_step(&fapu, FAP_UNIT_MNS), 20.0f / 1024, 1e-9);
}

TEST(fapu, refuses_what_is_not_a_face)
{
    float points[FAP_POINT_COUNT][3];
    fap_fapu fapu;

    neutral(points);
    place(points, "2.2", 0, 0);
    assert_int_equal(fap_fapu_measure((const float(*)[3])points, &fapu), FAP_E_DATA);
}

TEST(fapu, positive_head_angles_turn_the_way_the_table_says)
{
    float r[3][3];

    fap_head_rotation(20000, 0, 0, r); /* pitch: the nose, +z, goes down */
    assert_true(r[1][2] < -0.1f);
    fap_head_rotation(0, 20000, 0, r); /* yaw: the nose goes to the face's left, +x */
    assert_true(r[0][2] > 0.1f);
    fap_head_rotation(0, 0, 20000, r); /* roll: the crown, +y, goes to the face's right, -x */
    assert_true(r[0][1] < -0.1f);
}

TEST(fapu, head_angles_survive_a_round_trip)
{
    for (int32_t pitch = -60000; pitch <= 60000; pitch += 20000)
        for (int32_t yaw = -90000; yaw <= 90000; yaw += 30000)
            for (int32_t roll = -50000; roll <= 50000; roll += 25000) {
                float r[3][3];
                int32_t p, y, o;
                fap_head_rotation(pitch, yaw, roll, r);
                fap_head_angles((const float(*)[3])r, &p, &y, &o);
                assert_in_range(p - pitch + 5, 0, 10);
                assert_in_range(y - yaw + 5, 0, 10);
                assert_in_range(o - roll + 5, 0, 10);
            }
}

TEST(derive, fills_the_other_contour_and_the_other_side)
{
    fap_frame f = { 0 };

    f.state[4] = FAP_CODED, f.value[4] = 100;
    f.state[6] = FAP_CODED, f.value[6] = -50;
    f.state[19] = FAP_HELD, f.value[19] = 7;
    fap_derive(&f);
    assert_int_equal(f.state[51], FAP_DERIVED);
    assert_int_equal(f.value[51], 100);
    assert_int_equal(f.value[53], -50);
    assert_int_equal(f.value[7], -50);
    assert_int_equal(f.value[54], -50);
    assert_int_equal(f.value[20], 7);
    assert_int_equal(f.state[4], FAP_CODED);
    assert_int_equal(f.state[3], FAP_ABSENT);
}
