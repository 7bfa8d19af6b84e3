/* SPDX-License-Identifier: BSD-2-Clause */
/* Posing: every FAP moves its point as Table C-1 says, whatever the face, the method and the values. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bank/faces_test.h"

typedef struct rig {
    fap_bank *bank;
    fap_face *face;
    size_t stride;
    float *position, *normal;
    float neutral[FAP_POINT_COUNT][3], point[FAP_POINT_COUNT][3];
} rig;

static fap_face_config config(fap_blend blend)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    return cfg;
}

static void pose(rig *r, const fap_frame *frame)
{
    fap_face_pose(r->face, frame, r->position, r->normal);
    fap_face_points(r->face, r->point);
}

static void open_rig(rig *r, int which, const fap_face_config *cfg)
{
    const fap_frame still = { 0 };

    memset(r, 0, sizeof *r);
    r->bank = test_bank(which);
    assert_int_equal(fap_face_open(&r->face, r->bank, cfg), FAP_OK);
    r->stride = fap_face_stride(r->face);
    r->position = aligned_alloc(32, 3 * r->stride * sizeof(float));
    r->normal = aligned_alloc(32, 3 * r->stride * sizeof(float));
    pose(r, &still);
    memcpy(r->neutral, r->point, sizeof r->neutral);
}

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
    free(r->position);
    free(r->normal);
    assert_null(r->face);
}

static void command(fap_frame *frame, int fap, int32_t value)
{
    frame->state[fap] = FAP_CODED;
    frame->value[fap] = value;
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static int translates(int fap)
{
    const fap_info *info = fap_info_get(fap);
    return info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z;
}

static void random_frame(fap_frame *frame, uint32_t seed, int range)
{
    memset(frame, 0, sizeof *frame);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (translates(fap) && next(&seed) % 3)
            command(frame, fap, (int32_t)(next(&seed) % (uint32_t)(2 * range + 1)) - range);
}

static void check_pose_is_sane(const rig *r)
{
    const fap_mesh *mesh = fap_bank_mesh(r->bank);

    for (size_t axis = 0; axis < 3; axis++)
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            assert_true(fabsf(r->position[axis * r->stride + v]) < 2000);
            assert_true(fabsf(r->normal[axis * r->stride + v]) < 1.001f);
        }
}

/* --- FAPs reach their points --- */

static float moved(const rig *r, const fap_info *info)
{
    const int axis = info->motion - FAP_MOTION_X;
    return r->point[info->point][axis] - r->neutral[info->point][axis];
}

static void check_each_fap(int which, fap_blend blend)
{
    const fap_face_config cfg = config(blend);
    rig r;

    open_rig(&r, which, &cfg);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        fap_frame frame = { 0 };
        if (!translates(fap) || !fap_bank_point_get(r.bank, info->point)->present)
            continue;
        command(&frame, fap, 100);
        pose(&r, &frame);
        const float want = (float)info->sign * 100 * fap_fapu_step(fap_bank_fapu(r.bank), info->unit);
        if (fabsf(moved(&r, info) - want) > 0.01f)
            fail_msg("FAP %d %s: %g mm, not %g", fap, info->name, moved(&r, info), want);
    }
    close_rig(&r);
}

TEST(face, every_fap_moves_its_point_exactly)
{
    check_each_fap(BUILTIN, FAP_BLEND_GA);
    check_each_fap(BUILTIN, FAP_BLEND_QP);
    check_each_fap(BUILTIN, FAP_BLEND_ZHU);
    check_each_fap(BUILTIN, FAP_BLEND_PCA);
    check_each_fap(BUILTIN, FAP_BLEND_RBF);
}

TEST(face, every_fap_moves_its_point_exactly_on_the_default_face)
{
    check_each_fap(DEFAULT_FACE, FAP_BLEND_GA);
    check_each_fap(DEFAULT_FACE, FAP_BLEND_ZHU);
}

static void check_together(int which)
{
    rig r;

    open_rig(&r, which, NULL);
    for (uint32_t seed = 1; seed <= 20; seed++) {
        fap_frame frame;
        fap_face_stats stats;
        random_frame(&frame, seed, 60);
        for (int fap = 4; fap <= 11; fap++) /* lips and lids that do not cross */
            if (frame.value[fap] > 0)
                frame.value[fap] = -frame.value[fap];
        for (int fap = 19; fap <= 22; fap++)
            if (frame.value[fap] > 0)
                frame.value[fap] = -frame.value[fap];
        pose(&r, &frame);
        fap_face_last_stats(r.face, &stats);
        assert_true(stats.target_count > 20);
        assert_true(stats.residual_error_mm < 0.01f);
        check_pose_is_sane(&r);
    }
    close_rig(&r);
}

TEST(face, many_faps_at_once_are_exact_too)
{
    check_together(BUILTIN);
}

TEST(face, many_faps_at_once_are_exact_on_the_default_face)
{
    check_together(DEFAULT_FACE);
}

TEST(face, targets_are_the_faps_in_millimetres)
{
    const fap_fapu fapu = { 10, 62, 48, 20, 50 };
    fap_frame frame = { 0 };
    float target[FAP_POINT_COUNT][3];
    uint8_t wanted[FAP_POINT_COUNT][3];

    command(&frame, 3, 512);
    command(&frame, 23, 1000);
    command(&frame, 48, 1000);
    fap_face_targets(&fapu, &frame, target, wanted);
    const int chin = fap_point_by_name("2.1");
    int count = 0;
    for (int i = 0; i < FAP_POINT_COUNT * 3; i++)
        count += wanted[i / 3][i % 3];
    assert_int_equal(count, 1);
    assert_int_equal(wanted[chin][1], 1);
    assert_float_equal(target[chin][1], -10, 1e-5);
}

/* --- what must not happen --- */

TEST(face, nothing_commanded_is_the_neutral_face_to_the_bit)
{
    rig r;
    const fap_frame still = { 0 };

    open_rig(&r, BUILTIN, NULL);
    const fap_mesh *mesh = fap_bank_mesh(r.bank);
    pose(&r, &still);
    for (size_t axis = 0; axis < 3; axis++)
        assert_memory_equal(r.position + axis * r.stride, mesh->position + axis * r.stride,
                            mesh->vertex_count * sizeof(float));
    for (int k = 0; k < fap_bank_key_count(r.bank); k++)
        assert_true(fap_face_weights(r.face)[k] == 0);
    close_rig(&r);
}

static void check_absurd(fap_blend blend)
{
    static const int32_t values[] = { INT32_MAX, INT32_MIN, 1 << 20, -(1 << 20) };
    const fap_face_config cfg = config(blend);
    rig r;

    open_rig(&r, BUILTIN, &cfg);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        for (int first = 1; first <= 4; first++) {
            fap_frame frame = { .pts_us = INT64_MIN + 1 };
            for (int fap = first; fap <= FAP_COUNT; fap += 1 + (first > 2))
                command(&frame, fap, fap % 3 ? values[i] : values[(i + 1) % 4]);
            frame.viseme = (fap_viseme){ 255, 14, 255, 1 };
            frame.expression = (fap_expression){ 6, 255, 200, 63, 1, 1 };
            pose(&r, &frame);
            check_pose_is_sane(&r);
        }
    close_rig(&r);
}

TEST(face, absurd_values_do_not_break_it)
{
    check_absurd(FAP_BLEND_GA);
    check_absurd(FAP_BLEND_QP);
    check_absurd(FAP_BLEND_ZHU);
    check_absurd(FAP_BLEND_PCA);
    check_absurd(FAP_BLEND_RBF);
}

static void check_lips(rig *r, const char *upper, const char *lower)
{
    const int up = fap_point_by_name(upper), low = fap_point_by_name(lower);
    const float gap = r->neutral[up][1] - r->neutral[low][1];

    assert_true(r->point[up][1] - r->point[low][1] > fminf(gap, 0) - 0.05f);
}

TEST(face, lips_pressed_together_meet_and_do_not_pass)
{
    rig r;

    open_rig(&r, BUILTIN, NULL);
    for (int32_t press = 20; press <= 300; press += 40) {
        fap_frame frame = { 0 };
        for (int fap = 4; fap <= 11; fap++)
            if (fap != 6 && fap != 7)
                command(&frame, fap, press);
        pose(&r, &frame);
        check_lips(&r, "2.2", "2.3");
        check_lips(&r, "2.6", "2.8");
        check_lips(&r, "2.7", "2.9");
    }
    close_rig(&r);
}

TEST(face, lids_stay_outside_the_eyeball)
{
    rig r;
    float centre[3], radius;
    fap_frame frame = { 0 };

    open_rig(&r, BUILTIN, NULL);
    command(&frame, 19, 1024);
    pose(&r, &frame);
    if (!fap_bank_eye(r.bank, 0, centre, &radius))
        skip();
    const float *p = r.point[fap_point_by_name("3.1")], *q = r.neutral[fap_point_by_name("3.1")];
    const float now = hypotf(hypotf(p[0] - centre[0], p[1] - centre[1]), p[2] - centre[2]);
    const float before = hypotf(hypotf(q[0] - centre[0], q[1] - centre[1]), q[2] - centre[2]);
    assert_true(now > fminf(before, radius) - 0.5f);
    close_rig(&r);
}

/* --- methods --- */

static void check_never_worse(int which, int count)
{
    const fap_face_config qp = config(FAP_BLEND_QP), ga = config(FAP_BLEND_GA);
    rig a, b;

    open_rig(&a, which, &qp);
    open_rig(&b, which, &ga);
    for (uint32_t seed = 1; seed <= (uint32_t)count; seed++) {
        fap_frame frame;
        fap_face_stats qp_stats, ga_stats;
        random_frame(&frame, seed, 300);
        pose(&a, &frame), pose(&b, &frame);
        fap_face_last_stats(a.face, &qp_stats);
        fap_face_last_stats(b.face, &ga_stats);
        assert_true(ga_stats.target_error_mm <= qp_stats.target_error_mm * 1.0001f + 1e-3f);
    }
    close_rig(&a);
    close_rig(&b);
}

TEST(face, ga_is_never_worse_than_least_squares_in_millimetres)
{
    check_never_worse(BUILTIN, 200);
}

TEST(face, ga_is_never_worse_than_least_squares_on_the_default_face)
{
    check_never_worse(DEFAULT_FACE, 30);
}

/* FAPs that a mix of keys would need, rounded to integers. */
static void frame_of_keys(const rig *r, const int *key, const float *weight, int count, fap_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        float mm = 0;
        if (!translates(fap))
            continue;
        for (int i = 0; i < count; i++)
            mm += weight[i] *
                  fap_bank_key_get(r->bank, key[i])->point_mm[info->point][info->motion - FAP_MOTION_X];
        command(frame, fap,
                (int32_t)lrintf((float)info->sign * mm / fap_fapu_step(fap_bank_fapu(r->bank), info->unit)));
    }
}

TEST(face, least_squares_finds_the_units_that_made_the_face)
{
    const fap_face_config cfg = config(FAP_BLEND_QP);
    static const char *const names[] = { "jawOpen", "mouthSmileLeft", "browInnerUp", "eyeBlinkRight" };
    const float weight[] = { 0.6f, 0.5f, 0.7f, 0.4f };
    int key[4];
    rig r;
    fap_frame frame;
    fap_face_stats stats;

    open_rig(&r, BUILTIN, &cfg);
    for (int i = 0; i < 4; i++)
        if ((key[i] = fap_bank_key_find(r.bank, FAP_KEY_UNIT, names[i])) < 0)
            skip();
    frame_of_keys(&r, key, weight, 4, &frame);
    pose(&r, &frame);
    fap_face_last_stats(r.face, &stats);
    assert_true(stats.target_error_mm < 0.1f);
    for (int i = 0; i < 4; i++)
        assert_float_equal(fap_face_weights(r.face)[key[i]], weight[i], 0.1);
    close_rig(&r);
}

TEST(face, zhu_reaches_unseen_blends_of_its_keys)
{
    const fap_face_config cfg = config(FAP_BLEND_ZHU);
    rig r;
    float sum = 0;

    open_rig(&r, BUILTIN, &cfg);
    for (uint32_t seed = 1; seed <= 10; seed++) {
        uint32_t s = seed * 77;
        const int key[2] = { fap_bank_key_number(r.bank, FAP_KEY_EXPRESSION, 1 + (int)(next(&s) % 6)),
                             fap_bank_key_number(r.bank, FAP_KEY_VISEME, 1 + (int)(next(&s) % 14)) };
        const float weight[2] = { 0.5f, 0.6f };
        fap_frame frame;
        fap_face_stats stats;
        frame_of_keys(&r, key, weight, 2, &frame);
        pose(&r, &frame);
        fap_face_last_stats(r.face, &stats);
        sum += stats.fitness;
    }
    assert_true(sum / 10 >= 0.9f);
    close_rig(&r);
}

TEST(face, zhu_gives_the_same_bits_for_the_same_seed)
{
    fap_face_config cfg = config(FAP_BLEND_ZHU);
    rig a, b;
    fap_frame frame, other;

    open_rig(&a, BUILTIN, &cfg);
    open_rig(&b, BUILTIN, &cfg);
    random_frame(&frame, 3, 200);
    random_frame(&other, 4, 200);
    pose(&a, &frame);
    pose(&b, &other); /* earlier frames leave no trace */
    pose(&b, &frame);
    assert_memory_equal(a.position, b.position, 3 * a.stride * sizeof(float));
    close_rig(&b);
    cfg.seed = 2;
    open_rig(&b, BUILTIN, &cfg);
    pose(&b, &frame);
    assert_memory_not_equal(fap_face_weights(a.face), fap_face_weights(b.face),
                            (size_t)fap_bank_key_count(a.bank) * sizeof(float));
    close_rig(&a);
    close_rig(&b);
}

static void check_steady(int which, fap_blend blend)
{
    const fap_face_config cfg = config(blend);
    rig r;
    float last[512] = { 0 };

    open_rig(&r, which, &cfg);
    const int key_count = fap_bank_key_count(r.bank);
    for (int t = 0; t < 150; t++) {
        fap_frame frame = { 0 };
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            if (translates(fap))
                command(&frame, fap, (int32_t)lrint(120 * sin(0.004 * t * (1 + fap % 5) + fap)));
        pose(&r, &frame);
        for (int k = 0; k < key_count && k < 512; k++) {
            const float w = fap_face_weights(r.face)[k];
            if (t && fabsf(w - last[k]) > 0.1f)
                fail_msg("frame %d: %s jumps from %g to %g", t, fap_bank_key_get(r.bank, k)->name, last[k],
                         w);
            last[k] = w;
        }
    }
    close_rig(&r);
}

TEST(face, weights_move_little_between_neighbouring_frames)
{
    check_steady(BUILTIN, FAP_BLEND_QP);
    check_steady(BUILTIN, FAP_BLEND_GA);
}

TEST(face, weights_move_little_on_the_default_face)
{
    check_steady(DEFAULT_FACE, FAP_BLEND_GA);
}

/* --- visemes, expressions, head, eyes, blink --- */

TEST(face, visemes_and_expressions_show_their_keys)
{
    rig r;
    fap_frame frame = { 0 };

    open_rig(&r, BUILTIN, NULL);
    frame.state[1] = frame.state[2] = FAP_CODED;
    frame.viseme = (fap_viseme){ 10, 14, 42, 0 };
    frame.expression = (fap_expression){ 1, 63, 0, 30, 0, 0 };
    pose(&r, &frame);
    const float *w = fap_face_weights(r.face);
    assert_float_equal(w[fap_bank_key_number(r.bank, FAP_KEY_VISEME, 10)], 42.0 / 63, 1e-6);
    assert_float_equal(w[fap_bank_key_number(r.bank, FAP_KEY_VISEME, 14)], 21.0 / 63, 1e-6);
    assert_float_equal(w[fap_bank_key_number(r.bank, FAP_KEY_EXPRESSION, 1)], 1, 1e-6);
    close_rig(&r);
}

TEST(face, low_level_faps_override_a_viseme)
{
    rig r;
    fap_frame frame = { 0 };

    open_rig(&r, BUILTIN, NULL);
    frame.state[1] = FAP_CODED;
    frame.viseme = (fap_viseme){ 10, 0, 63, 0 };
    command(&frame, 5, 0);
    command(&frame, 4, 0);
    pose(&r, &frame);
    const int low = fap_point_by_name("2.3"), chin = fap_point_by_name("2.1");
    assert_float_equal(r.point[low][1], r.neutral[low][1], 0.01);
    assert_true(r.point[chin][1] < r.neutral[chin][1] - 0.5f); /* the jaw is the viseme's still */
    close_rig(&r);
}

static float turned_x(const rig *r, const char *name)
{
    const int p = fap_point_by_name(name);
    return r->point[p][0] - r->neutral[p][0];
}

TEST(face, the_head_turns_about_the_top_of_the_spine)
{
    rig r;
    fap_frame frame = { 0 };
    float m[3][3];

    open_rig(&r, BUILTIN, NULL);
    command(&frame, 49, 30000);
    command(&frame, 48, 10000);
    pose(&r, &frame);
    fap_head_rotation(10000, 30000, 0, m);
    const float *spine = fap_bank_point_get(r.bank, fap_point_by_name("7.1"))->position_mm;
    const int nose = fap_point_by_name("9.3");
    for (int i = 0; i < 3; i++) {
        float want = spine[i];
        for (int k = 0; k < 3; k++)
            want += m[i][k] * (r.neutral[nose][k] - spine[k]);
        assert_float_equal(r.point[nose][i], want, 0.01);
    }
    assert_true(turned_x(&r, "9.3") > 5);
    close_rig(&r);
}

TEST(face, eyeballs_turn_and_keep_their_shape)
{
    rig r;
    fap_frame frame = { 0 };
    float centre[3], radius;

    open_rig(&r, BUILTIN, NULL);
    if (!fap_bank_eye(r.bank, 0, centre, &radius))
        skip();
    const fap_mesh *mesh = fap_bank_mesh(r.bank);
    command(&frame, 23, 40000);
    pose(&r, &frame);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float before = 0, after = 0;
        for (size_t axis = 0; axis < 3 && mesh->part[v] == FAP_PART_EYE_LEFT; axis++) {
            before += powf(mesh->position[axis * mesh->stride + v] - centre[axis], 2);
            after += powf(r.position[axis * r.stride + v] - centre[axis], 2);
        }
        assert_float_equal(before, after, 0.05);
    }
    if (fap_bank_point_get(r.bank, fap_point_by_name("3.5"))->vertex_count)
        assert_true(turned_x(&r, "3.5") > 1);
    close_rig(&r);
}

TEST(face, pupils_widen_inside_the_iris_and_stay_on_the_ball)
{
    rig r;
    fap_frame frame = { 0 };
    float centre[3], radius;
    int moved_count = 0;

    open_rig(&r, BUILTIN, NULL);
    if (!fap_bank_eye(r.bank, 1, centre, &radius))
        skip();
    const fap_mesh *mesh = fap_bank_mesh(r.bank);
    command(&frame, 30, 300);
    pose(&r, &frame);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = r.position + v, *q = mesh->position + v;
        if (mesh->part[v] != FAP_PART_EYE_RIGHT)
            continue;
        const float now = hypotf(p[0] - centre[0], p[r.stride] - centre[1]);
        const float before = hypotf(q[0] - centre[0], q[r.stride] - centre[1]);
        assert_true(now >= before - 1e-3f);
        assert_float_equal(hypotf(now, p[2 * r.stride] - centre[2]),
                           hypotf(before, q[2 * r.stride] - centre[2]), 0.01);
        moved_count += now > before + 0.05f;
    }
    assert_true(moved_count > 0);
    close_rig(&r);
}

TEST(face, blinks_by_itself_about_every_two_and_a_half_seconds)
{
    fap_face_config cfg = config(FAP_BLEND_GA);
    rig r;
    int blinks = 0, closed = 0;

    cfg.blink = 1;
    open_rig(&r, BUILTIN, &cfg);
    const int lid = fap_point_by_name("3.1");
    for (int t = 0; t < 25 * 25; t++) {
        const fap_frame frame = { .pts_us = t * 40000 };
        pose(&r, &frame);
        const int now = r.point[lid][1] < r.neutral[lid][1] - 2;
        blinks += now && !closed;
        closed = now;
    }
    assert_in_range(blinks, 8, 11);
    close_rig(&r);
}

TEST(face, does_not_blink_when_the_stream_drives_the_lids)
{
    fap_face_config cfg = config(FAP_BLEND_GA);
    rig r;

    cfg.blink = 1;
    open_rig(&r, BUILTIN, &cfg);
    for (int t = 0; t < 200; t++) {
        fap_frame frame = { .pts_us = t * 40000 };
        command(&frame, 19, 0);
        pose(&r, &frame);
        const int lid = fap_point_by_name("3.1");
        assert_float_equal(r.point[lid][1], r.neutral[lid][1], 0.01);
    }
    close_rig(&r);
}

TEST(face, shows_key_models_directly)
{
    rig r;
    float *weight;

    open_rig(&r, BUILTIN, NULL);
    weight = calloc((size_t)fap_bank_key_count(r.bank), sizeof *weight);
    const int key = fap_bank_key_number(r.bank, FAP_KEY_VISEME, 10), chin = fap_point_by_name("2.1");
    weight[key] = 1;
    fap_face_pose_keys(r.face, weight, r.position, r.normal);
    fap_face_points(r.face, r.point);
    assert_float_equal(r.point[chin][1] - r.neutral[chin][1],
                       fap_bank_key_get(r.bank, key)->point_mm[chin][1], 0.05);
    check_pose_is_sane(&r);
    free(weight);
    close_rig(&r);
}

/* --- memory and arguments --- */

typedef struct budget {
    int left, live, calls;
} budget;

static void *count_alloc(void *user, size_t size)
{
    budget *b = user;

    b->calls++;
    if (b->left-- <= 0)
        return NULL;
    b->live++;
    return malloc(size);
}

static void count_free(void *user, void *ptr)
{
    ((budget *)user)->live--;
    free(ptr);
}

TEST(face, gives_everything_back_when_memory_runs_out)
{
    fap_bank *bank = test_bank(BUILTIN);
    fap_face_config cfg = config(FAP_BLEND_GA);
    fap_err err = FAP_E_NOMEM;

    for (int left = 0; left < 500 && err == FAP_E_NOMEM; left++) {
        budget b = { .left = left };
        fap_face *face;
        cfg.alloc = (fap_allocator){ count_alloc, count_free, &b };
        err = fap_face_open(&face, bank, &cfg);
        fap_face_close(&face);
        assert_int_equal(b.live, 0);
    }
    assert_int_equal(err, FAP_OK);
    fap_bank_close(&bank);
}

TEST(face, poses_without_allocating)
{
    fap_face_config cfg = config(FAP_BLEND_GA);
    budget b = { .left = 1 << 20 };
    rig r;
    fap_frame frame;

    cfg.alloc = (fap_allocator){ count_alloc, count_free, &b };
    open_rig(&r, BUILTIN, &cfg);
    const int before = b.calls;
    random_frame(&frame, 9, 300);
    pose(&r, &frame);
    assert_int_equal(b.calls, before);
    close_rig(&r);
}

TEST(face, refuses_a_bad_config)
{
    fap_bank *bank = test_bank(BUILTIN);
    fap_face *face;
    fap_face_config cfg = config(FAP_BLEND_GA);

    cfg.struct_size = 0;
    assert_int_equal(fap_face_open(&face, bank, &cfg), FAP_E_ARG);
    cfg = config((fap_blend)9);
    assert_int_equal(fap_face_open(&face, bank, &cfg), FAP_E_ARG);
    cfg = config(FAP_BLEND_GA);
    cfg.emphasis = NAN;
    assert_int_equal(fap_face_open(&face, bank, &cfg), FAP_E_ARG);
    assert_int_equal(fap_face_open(&face, NULL, NULL), FAP_E_ARG);
    assert_null(face);
    fap_bank_close(&bank);
}
