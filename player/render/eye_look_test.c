/* SPDX-License-Identifier: BSD-2-Clause */
/* What is found out about eyes: on the built-in face, whose eyes are known. */
#include "tests/test.h"

#include <stdlib.h>

#include "player/render/eye_look.h"

typedef struct fixture {
    fap_bank *bank;
    const fap_mesh *mesh;
    int16_t (*on_eye)[2];
    eye_look eye[2];
} fixture;

static void open_fixture(fixture *f)
{
    assert_int_equal(fap_bank_builtin(&f->bank, NULL), FAP_OK);
    f->mesh = fap_bank_mesh(f->bank);
    f->on_eye = calloc(f->mesh->vertex_count, sizeof *f->on_eye);
    assert_non_null(f->on_eye);
    for (int right = 0; right < 2; right++)
        eye_look_measure(&f->eye[right], f->bank, right, f->on_eye);
}

static void close_fixture(fixture *f)
{
    free(f->on_eye);
    fap_bank_close(&f->bank);
}

TEST(eye_look, finds_a_green_iris_in_a_white_eye)
{
    fixture f;

    open_fixture(&f);
    for (int right = 0; right < 2; right++) {
        const eye_look *e = &f.eye[right];
        assert_true(e->radius_mm > 8 && e->radius_mm < 20);
        assert_true(e->limbus > 0.3f && e->limbus < 0.6f);
        assert_true(e->iris[1] > e->iris[0] && e->iris[1] > e->iris[2]);
        assert_true(e->white[0] > 0.6f && e->white[1] > 0.6f && e->white[2] > 0.6f);
        assert_non_null(e->lid);
    }
    close_fixture(&f);
}

TEST(eye_look, both_eyes_are_alike)
{
    fixture f;

    open_fixture(&f);
    assert_float_equal(f.eye[0].limbus, f.eye[1].limbus, 1e-3f);
    assert_float_equal(f.eye[0].iris[1], f.eye[1].iris[1], 1e-3f);
    assert_int_not_equal(f.eye[0].front, f.eye[1].front);
    close_fixture(&f);
}

TEST(eye_look, places_on_the_eye_are_right_and_up_of_the_pupil)
{
    fixture f;

    open_fixture(&f);
    for (uint32_t i = 0; i < f.mesh->vertex_count; i++) {
        const int part = f.mesh->part[i];
        if (part != FAP_PART_EYE_LEFT && part != FAP_PART_EYE_RIGHT) {
            assert_int_equal(f.on_eye[i][0], 0);
            continue;
        }
        float centre[3], radius;
        assert_true(fap_bank_eye(f.bank, part == FAP_PART_EYE_RIGHT, centre, &radius));
        const float x = f.mesh->position[i] - centre[0], y = f.mesh->position[f.mesh->stride + i] - centre[1];
        if (fabsf(x) > 1)
            assert_true((f.on_eye[i][0] > 0) == (x > 0));
        if (fabsf(y) > 1)
            assert_true((f.on_eye[i][1] > 0) == (y > 0));
    }
    close_fixture(&f);
}

TEST(eye_look, a_resting_eye_looks_ahead_from_under_its_lid)
{
    fixture f;
    vec3 gaze, lid;

    open_fixture(&f);
    /* At rest normals of an eyeball point away from its middle; positions will do. */
    eye_look_pose(&f.eye[0], f.mesh, f.mesh->position, f.mesh->position, gaze, lid);
    const float *rest = f.mesh->position;
    assert_true(gaze[2] > 0);
    assert_true(lid[1] > rest[f.mesh->stride + f.eye[0].front]);
    assert_true(fabsf(lid[0] - rest[f.eye[0].front]) < 5);
    close_fixture(&f);
}
