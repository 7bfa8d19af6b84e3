/* SPDX-License-Identifier: BSD-2-Clause */
/* Between FAPs and ARKit's coefficients, and what the table must be. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/arkit.h>
#include <fap/face.h>

static int shape_of(const char *name)
{
    const int s = fap_arkit_by_name(name);

    assert_true(s >= 0);
    return s;
}

static fap_arkit_fit *open_fit(void)
{
    fap_arkit_fit *fit;

    assert_int_equal(fap_arkit_fit_open(&fit, NULL), FAP_OK);
    return fit;
}

static void say(fap_frame *f, int fap, int32_t value)
{
    f->state[fap] = FAP_CODED;
    f->value[fap] = value;
}

/* A shape's name with left and right exchanged; itself when it has no side. */
static int mirror_of(int shape)
{
    char name[32];
    const char *left = strstr(fap_arkit_name(shape), "Left"), *right = strstr(fap_arkit_name(shape), "Right");
    const char *side = left ? left : right;

    if (!side)
        return shape;
    snprintf(name, sizeof name, "%.*s%s%s", (int)(side - fap_arkit_name(shape)), fap_arkit_name(shape),
             left ? "Right" : "Left", side + (left ? 4 : 5));
    return shape_of(name);
}

TEST(arkit, names_are_live_link_faces)
{
    assert_string_equal(fap_arkit_name(0), "EyeBlinkLeft");
    assert_string_equal(fap_arkit_name(17), "JawOpen");
    assert_string_equal(fap_arkit_name(51), "TongueOut");
    assert_null(fap_arkit_name(52));
    assert_null(fap_arkit_name(-1));
    assert_string_equal(fap_arkit_angle_name(0), "HeadYaw");
    assert_string_equal(fap_arkit_angle_name(8), "RightEyeRoll");
    assert_null(fap_arkit_angle_name(9));
    assert_int_equal(fap_arkit_by_name("jawOpen"), 17);
    assert_int_equal(fap_arkit_by_name("jawOpe"), -1);
    assert_int_equal(fap_arkit_by_name("jawOpenn"), -1);
}

TEST(arkit, the_right_side_of_the_table_is_the_left_ones_mirror)
{
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            const fap_info *info = fap_info_get(fap);
            const int other = fap_mirror(fap) ? fap_mirror(fap) : fap;
            const int sideways = other == fap && info->motion == FAP_MOTION_X;
            const int value = fap_arkit_value(s, fap);
            assert_int_equal(fap_arkit_value(mirror_of(s), other), sideways ? -value : value);
        }
}

TEST(arkit, every_shape_but_gaze_moves_something)
{
    for (int s = 0; s < FAP_ARKIT_COUNT; s++) {
        int moves = 0;
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            moves += fap_arkit_value(s, fap) != 0;
        assert_true(moves || !strncmp(fap_arkit_name(s), "EyeLook", 7));
    }
}

TEST(arkit, one_shape_gives_its_faps_and_comes_back_as_them)
{
    fap_arkit_fit *fit = open_fit();

    for (int s = 0; s < FAP_ARKIT_COUNT; s++) {
        fap_arkit in = { .shape = { 0 } }, out;
        fap_frame f = { 0 }, back = { 0 };
        in.shape[s] = 0.75f;
        if (s == shape_of("MouthClose"))
            in.shape[shape_of("JawOpen")] = 0.8f;
        fap_arkit_to_faps(&in, &f);
        if (s == shape_of("JawOpen"))
            assert_int_equal(f.value[3], lround(0.75 * fap_arkit_value(s, 3)));
        fap_arkit_from_faps(fit, &f, &out);
        fap_arkit_to_faps(&out, &back);
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            assert_true(abs(f.value[fap] - back.value[fap]) <= 12);
    }
    fap_arkit_fit_close(&fit);
}

TEST(arkit, nothing_asked_is_nothing_done)
{
    fap_arkit_fit *fit = open_fit();
    fap_frame f = { 0 };
    fap_arkit out;

    fap_arkit_from_faps(fit, &f, &out);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        assert_true(out.shape[s] == 0);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        say(&f, fap, 0);
    fap_arkit_from_faps(fit, &f, &out);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        assert_true(fabsf(out.shape[s]) < 1e-6f);
    fap_arkit_fit_close(&fit);
}

TEST(arkit, eyes_and_head_are_angles)
{
    fap_arkit_fit *fit = open_fit();
    fap_frame f = { 0 }, back = { 0 };
    fap_arkit out;

    say(&f, 23, 20000); /* both to the face's left, down */
    say(&f, 24, 20000);
    say(&f, 25, 10000);
    say(&f, 26, 10000);
    say(&f, 48, 5000);
    say(&f, 49, -7000);
    say(&f, 50, 3000);
    fap_arkit_from_faps(fit, &f, &out);
    assert_true(out.shape[shape_of("EyeLookOutLeft")] > 0.3f && out.shape[shape_of("EyeLookInRight")] > 0.3f);
    assert_true(out.shape[shape_of("EyeLookInLeft")] == 0 && out.shape[shape_of("EyeLookOutRight")] == 0);
    assert_true(out.shape[shape_of("EyeLookDownLeft")] > 0.15f && out.shape[shape_of("EyeLookUpLeft")] == 0);
    assert_true(out.angle[FAP_ARKIT_LEFT_EYE_YAW] < 0 && out.angle[FAP_ARKIT_LEFT_EYE_PITCH] > 0);
    fap_arkit_to_faps(&out, &back);
    for (int fap = 48; fap <= 50; fap++)
        assert_in_range(back.value[fap] + 100000, f.value[fap] + 99999, f.value[fap] + 100001);
    for (int fap = 23; fap <= 26; fap++)
        assert_in_range(back.value[fap], f.value[fap] - 1, f.value[fap] + 1);
    out.has_eyes = out.has_head = 0; /* as a reader of 52 columns has it */
    fap_arkit_to_faps(&out, &back);
    assert_int_equal(back.state[48], FAP_ABSENT);
    for (int fap = 23; fap <= 26; fap++)
        assert_in_range(back.value[fap], f.value[fap] - 1, f.value[fap] + 1);
    fap_arkit_fit_close(&fit);
}

TEST(arkit, lids_that_go_with_the_eyes_are_no_blink)
{
    fap_arkit_fit *fit = open_fit();
    fap_frame f = { 0 };
    fap_arkit out;

    say(&f, 25, 54000); /* EyeLookDownLeft is 1 */
    say(&f, 19, fap_arkit_value(shape_of("EyeLookDownLeft"), 19));
    fap_arkit_from_faps(fit, &f, &out);
    assert_true(out.shape[shape_of("EyeLookDownLeft")] > 0.999f);
    assert_true(out.shape[shape_of("EyeBlinkLeft")] < 0.02f);
    fap_arkit_fit_close(&fit);
}

TEST(arkit, coefficients_stay_within_their_bounds)
{
    static const int32_t extreme[] = { INT32_MIN, -100000, -1080, 1080, 100000, INT32_MAX };
    fap_arkit_fit *fit = open_fit();

    for (size_t i = 0; i < sizeof extreme / sizeof *extreme; i++)
        for (int step = 1; step <= 4; step++) {
            fap_frame f = { 0 };
            fap_arkit out;
            for (int fap = 3; fap <= FAP_COUNT; fap += step)
                say(&f, fap, fap % 3 ? extreme[i] : -(extreme[i] / 2));
            fap_arkit_from_faps(fit, &f, &out);
            for (int s = 0; s < FAP_ARKIT_COUNT; s++)
                assert_true(out.shape[s] >= 0 && out.shape[s] <= 1);
            assert_true(out.shape[shape_of("MouthClose")] <= out.shape[shape_of("JawOpen")]);
        }
    fap_arkit_fit_close(&fit);
}

TEST(arkit, a_closed_mouth_is_no_mouth_close)
{
    fap_arkit_fit *fit = open_fit();
    fap_frame f = { 0 };
    fap_arkit out;

    for (int fap = 5; fap <= 11; fap++)
        say(&f, fap, fap_arkit_value(shape_of("MouthClose"), fap) / 4);
    say(&f, 3, 0);
    fap_arkit_from_faps(fit, &f, &out);
    assert_true(out.shape[shape_of("MouthClose")] <= out.shape[shape_of("JawOpen")]);
    fap_arkit_fit_close(&fit);
}

TEST(arkit, a_frame_says_the_same_whatever_came_before)
{
    fap_arkit_fit *fit = open_fit();
    fap_frame a = { 0 }, b = { 0 };
    fap_arkit first, again;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        say(&a, fap, 40 * (fap % 7) - 90);
    say(&b, 3, 500);
    fap_arkit_from_faps(fit, &a, &first);
    fap_arkit_from_faps(fit, &b, &again);
    fap_arkit_from_faps(fit, &a, &again);
    assert_memory_equal(first.shape, again.shape, sizeof first.shape);
    fap_arkit_fit_close(&fit);
}

TEST(arkit, what_is_no_number_is_nothing)
{
    fap_arkit in = { .has_head = 1, .has_eyes = 1 };
    fap_frame f = { 0 };

    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        in.shape[s] = s % 2 ? NAN : INFINITY;
    for (int a = 0; a < FAP_ARKIT_ANGLE_COUNT; a++)
        in.angle[a] = NAN;
    fap_arkit_to_faps(&in, &f);
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        assert_int_equal(f.value[fap], 0);
    in.shape[17] = 3e38f;
    fap_arkit_to_faps(&in, &f);
    assert_int_equal(f.value[3], 1000000);
}

static void *refuse(void *user, size_t size)
{
    int *left = user;
    return (*left)-- > 0 ? malloc(size) : NULL;
}

static void give_back(void *user, void *block)
{
    (void)user;
    free(block);
}

TEST(arkit, no_memory_is_said)
{
    for (int left = 0; left < 2; left++) {
        int budget = left;
        const fap_allocator alloc = { refuse, give_back, &budget };
        fap_arkit_fit *fit = (fap_arkit_fit *)&budget;
        assert_int_equal(fap_arkit_fit_open(&fit, &alloc), FAP_E_NOMEM);
        assert_null(fit);
    }
    fap_arkit_fit_close(NULL);
}

/* --- what a face shows --- */

static void complete(const fap_frame *asked, fap_frame *shown)
{
    fap_bank *bank;
    fap_face *face;
    float point[FAP_POINT_COUNT][3];

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&face, bank, NULL), FAP_OK);
    float *position = aligned_alloc(32, 3 * fap_face_stride(face) * sizeof *position);
    fap_face_pose(face, asked, position, NULL);
    fap_face_points(face, point);
    *shown = *asked;
    fap_face_complete(bank, (const float(*)[3])point, shown);
    free(position);
    fap_face_close(&face);
    fap_bank_close(&bank);
}

TEST(face_shown, an_expression_becomes_its_faps)
{
    fap_frame asked = { 0 }, shown;

    asked.state[2] = FAP_CODED;
    asked.expression = (fap_expression){ .select1 = 1, .intensity1 = 63 };
    complete(&asked, &shown);
    assert_int_equal(shown.state[12], FAP_DERIVED);
    assert_true(shown.value[12] > 100 && shown.value[59] > 100); /* joy raises the corners */
    assert_int_equal(shown.state[48], FAP_ABSENT);               /* a turn is no place */
}

TEST(face_shown, what_was_commanded_stays_and_the_head_does_not_count)
{
    fap_frame asked = { 0 }, still, turned;

    say(&asked, 3, 400);
    say(&asked, 12, -77);
    complete(&asked, &still);
    say(&asked, 48, 9000);
    say(&asked, 49, 30000);
    say(&asked, 50, -12000);
    complete(&asked, &turned);
    assert_int_equal(still.value[3], 400);
    assert_int_equal(still.state[12], FAP_CODED);
    assert_true(still.value[5] < -100); /* the lower lip went along */
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (still.state[fap] == FAP_DERIVED && fap_info_get(fap)->group != 10) /* ears turn with the neck, the chin a little */
            assert_true(abs(still.value[fap] - turned.value[fap]) <= 8);
}
