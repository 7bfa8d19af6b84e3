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

static void close_stage(stage *s)
{
    renderer_destroy(&s->renderer);
    assert_null(s->renderer);
    free(s->normal);
    free(s->position);
    fap_face_close(&s->face);
    fap_bank_close(&s->bank);
}

/* 0: there is no such OpenGL here, and nothing is open. */
static int try_stage(stage *s, const char *gl)
{
    char where[FAP_ERROR_TEXT_SIZE];

    memset(s, 0, sizeof *s);
    assert_int_equal(fap_bank_builtin(&s->bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&s->face, s->bank, NULL), FAP_OK);
    s->position = aligned_alloc(32, 3 * sizeof(float) * fap_face_stride(s->face));
    s->normal = aligned_alloc(32, 3 * sizeof(float) * fap_face_stride(s->face));
    const fap_err err = renderer_create(&s->renderer, gl, s->bank, SIZE, SIZE, where);
    if (err == FAP_E_UNSUPPORTED) {
        close_stage(s);
        return 0;
    }
    assert_int_equal(err, FAP_OK);
    return 1;
}

static void open_stage(stage *s)
{
    if (!try_stage(s, NULL))
        skip();
}

static render_scene scene_of(stage *s, int jaw)
{
    fap_frame frame = { 0 };

    frame.state[3] = FAP_CODED;
    frame.value[3] = jaw;
    fap_face_pose(s->face, &frame, s->position, s->normal);
    return (render_scene){ s->position, s->normal, .view = render_view_of(CAMERA_FRONT) };
}

static image draw(stage *s, const render_scene *scene, int size)
{
    image im;

    assert_int_equal(image_create(&im, size, size), FAP_OK);
    assert_int_equal(renderer_draw(s->renderer, scene, &im), FAP_OK);
    return im;
}

static image picture(stage *s, int jaw, render_camera camera)
{
    render_scene scene = scene_of(s, jaw);

    scene.view = render_view_of(camera);
    return draw(s, &scene, SIZE);
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

static size_t pixels_that_differ(const image *a, const image *b)
{
    image_difference d;

    assert_int_equal(image_compare(a, b, 2, &d, NULL), FAP_OK);
    return d.far_count;
}

/* GLFW is one of them where there is a display: see tests/cli/window.sh. */
TEST(renderer, every_context_draws_the_same_picture)
{
    image first = { 0 };

    for (int i = 0; renderer_gl_name(i); i++) {
        stage s;
        if (!try_stage(&s, renderer_gl_name(i)))
            continue;
        image im = picture(&s, 300, CAMERA_THREE_QUARTER);
        close_stage(&s);
        if (!first.rgba) {
            first = im;
            continue;
        }
        assert_memory_equal(first.rgba, im.rgba, SIZE * SIZE * 4);
        image_free(&im);
    }
    image_free(&first);
}

TEST(renderer, a_context_that_is_not_built_in_is_named)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_bank *bank;
    renderer *r;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(renderer_create(&r, "vulkan", bank, SIZE, SIZE, where), FAP_E_UNSUPPORTED);
    assert_null(r);
    assert_true(!renderer_gl_name(0) || strstr(where, "vulkan"));
    fap_bank_close(&bank);
}

TEST(renderer, two_at_a_time_do_not_disturb_each_other)
{
    stage a, b;

    open_stage(&a);
    open_stage(&b);
    image first = picture(&a, 200, CAMERA_FRONT), other = picture(&b, 200, CAMERA_FRONT);
    close_stage(&b);
    image again = picture(&a, 200, CAMERA_FRONT);
    assert_memory_equal(first.rgba, other.rgba, SIZE * SIZE * 4);
    assert_memory_equal(first.rgba, again.rgba, SIZE * SIZE * 4);
    image_free(&first);
    image_free(&other);
    image_free(&again);
    close_stage(&a);
}

TEST(renderer, one_picture_is_begun_and_finished_at_a_time)
{
    stage s;

    open_stage(&s);
    const render_scene scene = scene_of(&s, 400);
    image whole = draw(&s, &scene, SIZE), halves = draw(&s, &scene, SIZE);
    assert_int_equal(renderer_finish(s.renderer, &halves), FAP_E_ARG);
    assert_int_equal(renderer_begin(s.renderer, &scene), FAP_OK);
    assert_int_equal(renderer_begin(s.renderer, &scene), FAP_E_ARG);
    memset(s.position, 0, 3 * sizeof(float) * fap_face_stride(s.face)); /* the arrays are free again */
    memset(halves.rgba, 0, SIZE * SIZE * 4);
    assert_int_equal(renderer_finish(s.renderer, &halves), FAP_OK);
    assert_memory_equal(whole.rgba, halves.rgba, SIZE * SIZE * 4);
    image_free(&whole);
    image_free(&halves);
    close_stage(&s);
}

TEST(renderer, another_size_and_back_is_the_same_picture)
{
    stage s;

    open_stage(&s);
    const render_scene scene = scene_of(&s, 0);
    image before = draw(&s, &scene, SIZE);
    assert_int_equal(renderer_resize(s.renderer, 2 * SIZE, 2 * SIZE), FAP_OK);
    assert_int_equal(renderer_draw(s.renderer, &scene, &before), FAP_E_ARG);
    image large = draw(&s, &scene, 2 * SIZE);
    assert_int_equal(renderer_resize(s.renderer, 0, SIZE), FAP_E_ARG);
    assert_int_equal(renderer_resize(s.renderer, SIZE, SIZE), FAP_OK);
    image after = draw(&s, &scene, SIZE);
    assert_memory_equal(before.rgba, after.rgba, SIZE * SIZE * 4);
    image_free(&before);
    image_free(&large);
    image_free(&after);
    close_stage(&s);
}

TEST(renderer, wireframe_and_marks_are_seen_and_leave_nothing_behind)
{
    stage s;

    open_stage(&s);
    render_scene scene = scene_of(&s, 0);
    image plain = draw(&s, &scene, SIZE);
    scene.wireframe = 1;
    image wire = draw(&s, &scene, SIZE);
    const fap_bank_point *tip = fap_bank_point_get(s.bank, fap_point_by_name("9.3"));
    const render_mark mark = { { tip->position_mm[0], tip->position_mm[1], tip->position_mm[2] },
                               { 0, 255, 0 } };
    scene.wireframe = 0;
    scene.mark = &mark;
    scene.mark_count = 1;
    image marked = draw(&s, &scene, SIZE);
    scene.mark_count = 0;
    image again = draw(&s, &scene, SIZE);
    assert_true(pixels_that_differ(&plain, &wire) > SIZE);
    assert_in_range(pixels_that_differ(&plain, &marked), 4, 64);
    assert_memory_equal(plain.rgba, again.rgba, SIZE * SIZE * 4);
    image_free(&plain);
    image_free(&wire);
    image_free(&marked);
    image_free(&again);
    close_stage(&s);
}

TEST(renderer, a_mark_is_drawn_where_its_place_is_projected_to)
{
    stage s;
    float at[3];

    open_stage(&s);
    render_scene scene = scene_of(&s, 0);
    const fap_bank_point *tip = fap_bank_point_get(s.bank, fap_point_by_name("9.3"));
    const render_mark mark = { { tip->position_mm[0], tip->position_mm[1], tip->position_mm[2] },
                               { 0, 255, 0 } };
    scene.view = (render_view){ .yaw_degrees = 25, .pitch_degrees = 20, .distance = 0.5f, .right = 0.1f };
    scene.mark = &mark;
    scene.mark_count = 1;
    image im = draw(&s, &scene, SIZE);
    assert_true(renderer_project(s.renderer, &scene.view, mark.place_mm, at));
    const uint8_t *p = im.rgba + 4 * ((int)at[1] * SIZE + (int)at[0]);
    assert_true(p[1] > 200 && p[0] < 60 && p[2] < 60);
    image_free(&im);
    close_stage(&s);
}

static int skin_pixels(const image *im)
{
    int count = 0;

    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++)
            count += is_skin(im, x, y);
    return count;
}

TEST(renderer, a_closer_view_shows_more_skin_and_a_shifted_one_less)
{
    stage s;

    open_stage(&s);
    render_scene scene = scene_of(&s, 0);
    image whole = draw(&s, &scene, SIZE);
    scene.view.distance = 0.5f;
    image close = draw(&s, &scene, SIZE);
    scene.view = render_view_of(CAMERA_FRONT);
    scene.view.right = 1;
    image beside = draw(&s, &scene, SIZE);
    assert_true(skin_pixels(&close) > 2 * skin_pixels(&whole));
    assert_true(skin_pixels(&beside) < skin_pixels(&whole));
    image_free(&whole);
    image_free(&close);
    image_free(&beside);
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
    assert_int_not_equal(renderer_create(&r, NULL, bank, 0, 100, where), FAP_OK);
    assert_null(r);
    assert_int_not_equal(renderer_create(&r, NULL, bank, 100, RENDER_MAX_SIZE + 1, where), FAP_OK);
    assert_null(r);
    fap_bank_close(&bank);
}

#ifdef HAVE_GL
#include "player/render/context.h"
#include "player/render/gl_objects.h"

/* A caller with a context of its own, as a window has one. */
TEST(renderer, shows_into_a_framebuffer_of_the_caller_what_it_would_have_read_back)
{
    char where[FAP_ERROR_TEXT_SIZE];
    gl_context context;
    gl_functions gl;
    gl_target window;
    stage s;

    open_stage(&s);
    const render_scene scene = scene_of(&s, 100);
    image expected = draw(&s, &scene, SIZE), shown;
    assert_int_equal(gl_context_open(&context, NULL, where), FAP_OK);
    assert_null(gl_load(&gl, context.driver->get_function));
    assert_true(gl_target_make(&gl, &window, SIZE, SIZE, 0));
    renderer_destroy(&s.renderer);
    context.driver->make_current(context.state);
    const gl_context_source source = { .get_function = context.driver->get_function };
    assert_int_equal(renderer_create_on(&s.renderer, &source, s.bank, SIZE, SIZE, where), FAP_OK);
    assert_int_equal(renderer_show(s.renderer, &scene, (render_target){ window.frame, 0, 0 }), FAP_OK);
    assert_int_equal(image_create(&shown, SIZE, SIZE), FAP_OK);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, window.frame);
    for (int y = 0; y < SIZE; y++)
        gl.ReadPixels(0, SIZE - 1 - y, SIZE, 1, GL_RGBA, GL_UNSIGNED_BYTE, shown.rgba + 4 * y * SIZE);
    assert_memory_equal(shown.rgba, expected.rgba, SIZE * SIZE * 4);
    gl_target_delete(&gl, &window);
    close_stage(&s);
    gl_context_close(&context);
    image_free(&expected);
    image_free(&shown);
}
#endif

/* --- other looks --- */

static const uint8_t *pixel(const image *im, int x, int y)
{
    return im->rgba + 4 * (y * im->width + x);
}

static image dressed(stage *s, const render_look *look)
{
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(renderer_dress(s->renderer, look, where), FAP_OK);
    return picture(s, 0, CAMERA_FRONT);
}

TEST(renderer, a_colour_takes_the_place_of_the_studio)
{
    const render_look blue = { .backdrop = BACKDROP_COLOUR, .rgb = { 32, 64, 96 } };
    const uint8_t opaque_blue[4] = { 32, 64, 96, 255 };
    stage s;

    open_stage(&s);
    image im = dressed(&s, &blue);
    assert_memory_equal(pixel(&im, 0, 0), opaque_blue, 4);
    assert_memory_equal(pixel(&im, SIZE - 1, SIZE - 1), opaque_blue, 4);
    assert_true(is_skin(&im, SIZE / 2, SIZE / 2));
    image_free(&im);
    close_stage(&s);
}

TEST(renderer, before_nothing_the_face_alone_is_opaque)
{
    const render_look nothing = { .backdrop = BACKDROP_NOTHING };
    stage s;

    open_stage(&s);
    image studio = picture(&s, 0, CAMERA_FRONT), im = dressed(&s, &nothing);
    assert_int_equal(pixel(&im, 0, 0)[3], 0);
    assert_int_equal(pixel(&studio, 0, 0)[3], 255);
    assert_memory_equal(pixel(&im, SIZE / 2, SIZE / 2), pixel(&studio, SIZE / 2, SIZE / 2), 4);
    image_free(&studio);
    image_free(&im);
    close_stage(&s);
}

/* Twice as high as wide: of four rows the two in the middle are seen. */
TEST(renderer, a_picture_fills_the_frame_from_its_middle)
{
    static const uint8_t rows[4][3] = { { 255, 0, 0 }, { 0, 255, 0 }, { 0, 0, 255 }, { 255, 0, 0 } };
    stage s;
    image wall;

    open_stage(&s);
    assert_int_equal(image_create(&wall, 128, 256), FAP_OK);
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 128; x++)
            memcpy(wall.rgba + 4 * (y * 128 + x), rows[y / 64], 3);
    image im = dressed(&s, &(render_look){ .backdrop = BACKDROP_PICTURE, .picture = &wall });
    assert_memory_equal(pixel(&im, 2, 10), rows[1], 3);
    assert_memory_equal(pixel(&im, 2, SIZE - 10), rows[2], 3);
    image_free(&im);
    image_free(&wall);
    close_stage(&s);
}

TEST(renderer, the_look_can_be_taken_off_again)
{
    const render_look colour = { .backdrop = BACKDROP_COLOUR }, plain = { 0 };
    stage s;

    open_stage(&s);
    image before = picture(&s, 0, CAMERA_FRONT), black = dressed(&s, &colour), after = dressed(&s, &plain);
    assert_memory_not_equal(before.rgba, black.rgba, SIZE * SIZE * 4);
    assert_memory_equal(before.rgba, after.rgba, SIZE * SIZE * 4);
    image_free(&before);
    image_free(&black);
    image_free(&after);
    close_stage(&s);
}

/* The built-in face has none. */
TEST(renderer, a_skin_needs_texture_coordinates)
{
    char where[FAP_ERROR_TEXT_SIZE];
    stage s;
    image skin;

    open_stage(&s);
    assert_int_equal(image_create(&skin, 2, 2), FAP_OK);
    assert_int_equal(renderer_dress(s.renderer, &(render_look){ .skin = &skin }, where), FAP_E_DATA);
    assert_non_null(strstr(where, "texture coordinates"));
    image im = picture(&s, 0, CAMERA_FRONT); /* the look before stays */
    assert_true(is_skin(&im, SIZE / 2, SIZE / 2));
    image_free(&im);
    image_free(&skin);
    close_stage(&s);
}
