/* SPDX-License-Identifier: BSD-2-Clause */
/* Joints, corrections and key frames of the glTF export. Whole files are read back by tests/cli/glb_check.py. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "player/sinks/glb_content.h"

enum { FRAMES = 4 };

typedef struct export
{
    fap_bank *bank;
    fap_face *face;
    float *position;
    fap_frame frame;
    glb_rig rig;
    glb_shape shape;
    glb_motion motion[JOINT_COUNT];
    glb_affine affine[JOINT_COUNT];
}
export;

static void open_export(export *e)
{
    memset(e, 0, sizeof *e);
    assert_int_equal(fap_bank_builtin(&e->bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&e->face, e->bank, NULL), FAP_OK);
    e->position = aligned_alloc(32, 3 * fap_face_stride(e->face) * sizeof *e->position);
    assert_true(glb_rig_open(&e->rig, e->bank) && glb_shape_open(&e->shape, e->bank, &e->rig));
}

static void close_export(export *e)
{
    glb_shape_close(&e->shape);
    glb_rig_close(&e->rig);
    free(e->position);
    fap_face_close(&e->face);
    fap_bank_close(&e->bank);
}

static void say(export *e, int fap, int32_t value)
{
    e->frame.state[fap] = FAP_CODED;
    e->frame.value[fap] = value;
}

static void pose(export *e)
{
    fap_face_pose(e->face, &e->frame, e->position, NULL);
    glb_rig_move(&e->rig, &e->frame, e->position, e->motion);
    glb_rig_affines(&e->rig, (const glb_motion *)e->motion, e->affine);
}

static void talk(export *e, int frame)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        say(e, fap, (int32_t)(150 * sin(frame + fap)));
    say(e, 49, 30000 * (frame % 3 - 1));
    say(e, 23, 20000 * (frame % 2));
    pose(e);
}

static void learn(export *e)
{
    glb_shape_learn(&e->shape, e->position, fap_face_weights(e->face), e->affine);
}

static double fit(export *e, float *weight)
{
    double worst, square;
    glb_shape_fit(&e->shape, e->position, fap_face_weights(e->face), e->affine, weight, &worst, &square);
    assert_true(sqrt(square) <= worst);
    return worst;
}

TEST(glb, joints_can_be_undone)
{
    export e;

    open_export(&e);
    talk(&e, 2);
    for (uint32_t v = 0; v < e.rig.mesh->vertex_count; v += 7) {
        const glb_affine a = glb_rig_affine(&e.rig, e.affine, v);
        const float p[3] = { 10, 20, -30 };
        float to[3], back[3];
        glb_affine_apply(&a, p, to);
        glb_affine_undo(&a, to, back);
        for (int i = 0; i < 3; i++)
            assert_true(fabsf(back[i] - p[i]) < 1e-3f);
    }
    close_export(&e);
}

TEST(glb, eyes_and_head_need_joints_alone)
{
    export e;
    float weight[512];

    open_export(&e);
    say(&e, 23, 25000);
    say(&e, 24, 25000);
    say(&e, 48, 12000);
    say(&e, 49, -30000);
    say(&e, 50, 9000);
    pose(&e);
    const float *w = fap_face_weights(e.face);
    learn(&e);
    glb_shape_settle(&e.shape);
    const double worst = fit(&e, weight);
    assert_true(worst < 0.1);
    for (int k = 0; k < e.shape.key_count; k++)
        assert_true(weight[k] == fminf(1, w[k]));
    /* an eyeball that no joint turned would be off by millimetres, everywhere */
    assert_true(e.motion[JOINT_EYE_LEFT].turn[0][0] < 0.98f && e.motion[JOINT_HEAD].turn[0][0] < 0.96f);
    close_export(&e);
}

TEST(glb, the_neck_is_no_thinner_than_the_players)
{
    export e;
    float weight[512];

    open_export(&e);
    say(&e, 49, 52000);
    pose(&e);
    glb_shape_settle(&e.shape); /* learnt nothing: joints must do it */
    assert_int_equal(e.shape.correction_count, 0);
    assert_true(fit(&e, weight) < 1);
    close_export(&e);
}

TEST(glb, the_jaw_goes_where_the_lower_teeth_go)
{
    export e;

    open_export(&e);
    say(&e, 3, 600);
    pose(&e);
    assert_true(e.rig.present[JOINT_JAW]);
    double before = 0, after = 0;
    for (uint32_t i = 0; i < e.rig.tooth_count; i++) {
        const uint32_t v = e.rig.tooth[i], stride = e.rig.mesh->stride;
        for (uint32_t axis = 0; axis < 3; axis++) {
            const float rest[3] = { e.rig.mesh->position[v], e.rig.mesh->position[stride + v],
                                    e.rig.mesh->position[2 * stride + v] };
            float to[3];
            glb_affine_apply(&e.affine[JOINT_JAW], rest, to);
            before += pow((double)e.position[axis * stride + v] - rest[axis], 2);
            after += pow((double)e.position[axis * stride + v] - to[axis], 2);
        }
    }
    assert_true(before > 100 && after < 0.05 * before);
    close_export(&e);
}

TEST(glb, few_frames_are_learnt_exactly)
{
    export e;
    float weight[512];

    open_export(&e);
    for (int i = 0; i < FRAMES; i++) {
        talk(&e, i);
        learn(&e);
    }
    glb_shape_settle(&e.shape);
    assert_true(e.shape.correction_count > 0 && e.shape.correction_count <= FRAMES);
    for (int i = 0; i < FRAMES; i++) {
        talk(&e, i);
        assert_true(fit(&e, weight) < 0.03);
        for (int c = 0; c < e.shape.correction_count; c++)
            assert_true(fabsf(weight[e.shape.key_count + c]) < 1.001f);
    }
    talk(&e, FRAMES + 3);
    assert_true(fit(&e, weight) > 0.1); /* what was not learnt is not there */
    close_export(&e);
}

TEST(glb, more_frames_than_room_are_still_near)
{
    export e;
    float weight[512];

    open_export(&e);
    for (int i = 0; i < 130; i++) {
        talk(&e, i);
        learn(&e);
    }
    glb_shape_settle(&e.shape);
    assert_true(e.shape.correction_count <= 48);
    talk(&e, 5);
    assert_true(fit(&e, weight) < 5);
    close_export(&e);
}

static void add_target(export *e, int target, float weight, float *shape)
{
    float *motion = calloc(e->shape.length, sizeof *motion);

    glb_shape_target(&e->shape, target, motion);
    for (size_t i = 0; i < e->shape.length; i++)
        shape[i] += weight * motion[i];
    free(motion);
}

TEST(glb, weights_are_within_0_and_1_and_say_the_same)
{
    export e;
    float *weight, *before, *after, worst = 0;

    open_export(&e);
    for (int i = 0; i < FRAMES; i++) {
        talk(&e, i);
        learn(&e);
    }
    glb_shape_settle(&e.shape);
    const int targets = glb_shape_target_count(&e.shape), last = (FRAMES - 1) * targets;
    weight = calloc((size_t)(FRAMES * targets), sizeof *weight);
    before = calloc(e.shape.length, sizeof *before);
    after = calloc(e.shape.length, sizeof *after);
    for (int i = 0; i < FRAMES; i++) {
        talk(&e, i);
        fit(&e, weight + i * targets);
    }
    for (int t = 0; t < targets - 1; t++)
        add_target(&e, t, weight[last + t], before);
    glb_shape_fold(&e.shape, weight, FRAMES, targets);
    for (int t = 0; t < targets; t++)
        add_target(&e, t, weight[last + t], after);
    for (int i = 0; i < FRAMES * targets; i++)
        assert_true(weight[i] >= 0 && weight[i] <= 1);
    for (size_t i = 0; i < e.shape.length; i++)
        worst = fmaxf(worst, fabsf(before[i] - after[i]));
    assert_true(worst < 1e-3f);
    free(weight);
    free(before);
    free(after);
    close_export(&e);
}

TEST(glb, key_frames_take_the_short_way_round)
{
    glb_track t;
    glb_motion motion[JOINT_COUNT];

    memset(motion, 0, sizeof motion);
    assert_true(glb_track_open(&t, 100, 1));
    for (uint32_t i = 0; i < 100; i++) {
        for (int j = 0; j < JOINT_COUNT; j++)
            fap_head_rotation((int32_t)(i * 3000), (int32_t)(i * 17000), (int32_t)(i * -9000),
                              motion[j].turn);
        glb_track_set(&t, i, i * 0.04, motion);
    }
    for (uint32_t i = 0; i < 100; i++) {
        const float *q = t.turn[JOINT_HEAD][i];
        assert_true(fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6f);
        const float *p = i ? q - 4 : q;
        assert_true(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] > 0.9f);
    }
    glb_track_close(&t);
}

TEST(glb, files_are_no_larger_than_was_announced)
{
    export e;
    glb_track track;
    char *data = NULL;
    size_t size = 0;

    open_export(&e);
    for (int i = 0; i < FRAMES; i++) {
        talk(&e, i);
        learn(&e);
    }
    glb_shape_settle(&e.shape);
    assert_true(glb_track_open(&track, FRAMES, glb_shape_target_count(&e.shape)));
    for (uint32_t i = 0; i < FRAMES; i++)
        glb_track_set(&track, i, i * 0.04, e.motion);
    FILE *out = open_memstream(&data, &size);
    assert_true(glb_write_face(&e.rig, &e.shape, &track, &(glb_about){ .generator = "test" }, out));
    fclose(out);
    assert_memory_equal(data, "glTF\2\0\0\0", 8);
    assert_true((double)size <= glb_estimate(e.bank, FRAMES));
    free(data);
    glb_track_close(&track);
    close_export(&e);
}
