/* SPDX-License-Identifier: BSD-2-Clause */
/* The renderer on the built-in face: repeatable, framed, and honest about what it cannot do. */
#include "tests/test.h"

#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "player/render/renderer.h"

enum { SIZE = 96 };

typedef struct stage {
    fap_bank *bank;
    fap_face *face;
    renderer *renderer;
    float *position, *normal;
} stage;

static void open_stage(stage *s)
{
    char where[FAP_ERROR_TEXT_SIZE];

    memset(s, 0, sizeof *s);
    assert_int_equal(fap_bank_builtin(&s->bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&s->face, s->bank, NULL), FAP_OK);
    s->position = aligned_alloc(32, 3 * sizeof(float) * fap_face_stride(s->face));
    s->normal = aligned_alloc(32, 3 * sizeof(float) * fap_face_stride(s->face));
    const fap_err err = renderer_create(&s->renderer, s->bank, SIZE, SIZE, where);
    if (err == FAP_E_UNSUPPORTED)
        skip();
    assert_int_equal(err, FAP_OK);
}

static void close_stage(stage *s)
{
    renderer_destroy(&s->renderer);
    assert_null(s->renderer);
    free(s->normal);
    free(s->position);
    fap_face_close(&s->face);
    fap_bank_close(&s->bank);
}

static image picture(stage *s, int jaw, render_camera camera)
{
    fap_frame frame = { 0 };
    image im;

    frame.state[3] = FAP_CODED;
    frame.value[3] = jaw;
    fap_face_pose(s->face, &frame, s->position, s->normal);
    assert_int_equal(image_create(&im, SIZE, SIZE), FAP_OK);
    assert_int_equal(renderer_draw(s->renderer, s->position, s->normal, camera, &im), FAP_OK);
    return im;
}

TEST(renderer, same_pose_gives_same_bits_and_another_pose_another_picture)
{
    stage s;
    image_difference d;

    open_stage(&s);
    image a = picture(&s, 0, CAMERA_FRONT), b = picture(&s, 600, CAMERA_FRONT),
          c = picture(&s, 0, CAMERA_FRONT);
    assert_memory_equal(a.rgba, c.rgba, SIZE * SIZE * 4);
    assert_int_equal(image_compare(&a, &b, 2, &d, NULL), FAP_OK);
    assert_false(image_same(&d));
    image_free(&a);
    image_free(&b);
    image_free(&c);
    close_stage(&s);
}

/* Skin is redder than it is blue; the studio behind it is not. */
static int is_skin(const image *im, int x, int y)
{
    const uint8_t *p = im->rgba + 4 * (y * im->width + x);
    return p[0] > p[2] + 20;
}

TEST(renderer, every_camera_frames_the_head)
{
    stage s;

    open_stage(&s);
    for (int camera = 0; camera < CAMERA_COUNT; camera++) {
        image im = picture(&s, 0, camera);
        assert_true(is_skin(&im, SIZE / 2, SIZE / 2));
        for (int i = 0; i < SIZE; i++) {
            assert_false(is_skin(&im, i, 0));
            assert_false(is_skin(&im, 0, i / 2));
            assert_false(is_skin(&im, SIZE - 1, i / 2));
        }
        image_free(&im);
    }
    close_stage(&s);
}

TEST(renderer, cameras_have_names)
{
    for (int camera = 0; camera < CAMERA_COUNT; camera++)
        assert_int_equal(render_camera_by_name(render_camera_name(camera)), camera);
    assert_int_equal(render_camera_by_name("above"), -1);
}

TEST(renderer, refuses_impossible_sizes)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_bank *bank;
    renderer *r;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_not_equal(renderer_create(&r, bank, 0, 100, where), FAP_OK);
    assert_null(r);
    assert_int_not_equal(renderer_create(&r, bank, 100, RENDER_MAX_SIZE + 1, where), FAP_OK);
    fap_bank_close(&bank);
}
