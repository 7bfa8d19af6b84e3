/* SPDX-License-Identifier: BSD-2-Clause */
/* Rigid fits. */
#include "tests/test.h"

#include <math.h>

#include <fap/fapu.h>

#include "capture/rigid.h"

static const double shape[5][3] = {
    { 0, 0, 0 }, { 80, 5, 0 }, { -10, 60, 7 }, { 20, -30, 40 }, { 11, 12, -50 }
};
static const double equal[5] = { 1, 1, 1, 1, 1 };

static void move(const rigid_pose *pose, double out[5][3])
{
    for (int i = 0; i < 5; i++)
        rigid_apply(pose, shape[i], out[i]);
}

static rigid_pose turned(int32_t pitch, int32_t yaw, int32_t roll)
{
    rigid_pose pose = { .t = { 300, -20, 1500 } };
    float r[3][3];

    fap_head_rotation(pitch, yaw, roll, r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            pose.r[i][j] = (double)r[i][j];
    return pose;
}

static void assert_same_pose(const rigid_pose *a, const rigid_pose *b, double tolerance)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            assert_float_equal(a->r[i][j], b->r[i][j], tolerance);
        assert_float_equal(a->t[i], b->t[i], 100 * tolerance);
    }
}

TEST(rigid, any_turn_is_found_half_turns_too)
{
    static const int32_t turns[][3] = {
        { 0, 0, 0 }, { 30000, -50000, 20000 }, { 0, 314159, 0 }, { 157000, 100000, -314159 }
    };

    for (int i = 0; i < 4; i++) {
        const rigid_pose want = turned(turns[i][0], turns[i][1], turns[i][2]);
        double seen[5][3];
        rigid_pose got;
        move(&want, seen);
        assert_true(rigid_fit(shape, (const double(*)[3])seen, equal, 5, &got));
        assert_same_pose(&got, &want, 1e-5);
    }
}

TEST(rigid, a_mirror_image_never_gives_a_reflection)
{
    double seen[5][3];
    rigid_pose got;

    for (int i = 0; i < 5; i++)
        for (int axis = 0; axis < 3; axis++)
            seen[i][axis] = axis ? shape[i][axis] : -shape[i][axis];
    assert_true(rigid_fit(shape, (const double(*)[3])seen, equal, 5, &got));
    const double(*r)[3] = got.r;
    const double determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                               r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                               r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    assert_float_equal(determinant, 1, 1e-9);
}

TEST(rigid, undo_is_the_inverse_of_apply)
{
    const rigid_pose pose = turned(10000, 20000, -30000);
    double seen[3], back[3];

    rigid_apply(&pose, shape[3], seen);
    rigid_undo(&pose, seen, back);
    for (int axis = 0; axis < 3; axis++)
        assert_float_equal(back[axis], shape[3][axis], 1e-4);
}

TEST(rigid, lines_and_pairs_have_no_pose)
{
    static const double line[4][3] = { { 0, 0, 0 }, { 10, 10, 10 }, { 20, 20, 20 }, { 70, 70, 70 } };
    rigid_pose pose;

    assert_false(rigid_fit(line, line, equal, 4, &pose));
    assert_false(rigid_fit(shape, shape, equal, 2, &pose));
    assert_true(rigid_fit(shape, shape, equal, 3, &pose));
}

TEST(rigid, a_marker_of_small_weight_does_not_pull)
{
    static const double weight[5] = { 1, 1, 1, 1, 1e-9 };
    const rigid_pose want = turned(20000, 0, 0);
    double seen[5][3];
    rigid_pose got;

    move(&want, seen);
    seen[4][1] += 30;
    assert_true(rigid_fit(shape, (const double(*)[3])seen, weight, 5, &got));
    assert_same_pose(&got, &want, 1e-5);
}
