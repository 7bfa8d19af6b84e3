/* SPDX-License-Identifier: BSD-2-Clause */
/* Pupils between the corners of their eyes, on a face that keeps still otherwise. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

static const struct place {
    const char *name;
    float x, y, z;
} places[] = {
    { "3.5", 30, 40, 75 },  { "3.6", -30, 40, 75 },  { "3.7", 45, 40, 70 },   { "3.12", -45, 40, 70 },
    { "3.11", 15, 40, 72 }, { "3.8", -15, 40, 72 },  { "3.1", 30, 45, 76 },   { "3.2", -30, 45, 76 },
    { "3.3", 30, 35, 76 },  { "3.4", -30, 35, 76 },  { "Cap1", 70, 110, 20 }, { "Cap2", -70, 110, 20 },
    { "Cap3", 0, 130, 60 }, { "Cap4", 0, 100, -60 }, { "8.3", 25, -20, 83 },  { "8.4", -25, -20, 83 },
};

enum { PLACES = sizeof places / sizeof *places, FRAMES = 10, LOOKS_FROM = 5 };

typedef void motion(const char *name, float at[3]);

static void look_left(const char *name, float at[3])
{
    if (!strcmp(name, "3.5") || !strcmp(name, "3.6"))
        at[0] += 4;
}

/* The pose is wrong by 3 mm sideways all over the eyes. */
static void look_left_in_a_wrong_pose(const char *name, float at[3])
{
    look_left(name, at);
    if (name[0] == '3')
        at[0] += 3;
}

static void one_pupil_flies_away(const char *name, float at[3])
{
    look_left(name, at);
    if (!strcmp(name, "3.6"))
        at[0] += 13;
}

static void look_left_with_shut_eyes(const char *name, float at[3])
{
    look_left(name, at);
    if (!strcmp(name, "3.1") || !strcmp(name, "3.2"))
        at[1] -= 9;
}

static fap_capture *encode(motion *move)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture_config cfg;
    fap_capture *c;
    fap_take *take;

    assert_int_equal(fap_take_create(&take, PLACES, FRAMES, NULL), FAP_OK);
    take->rate_hz = 25;
    for (uint32_t i = 0; i < PLACES; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "%s", places[i].name);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t i = 0; i < PLACES; i++) {
            float at[3] = { places[i].x, places[i].y, places[i].z };
            if (f >= LOOKS_FROM)
                move(places[i].name, at);
            fap_take_set(take, f, i, at);
        }
    fap_capture_config_init(&cfg);
    cfg.rigid = "Cap1,Cap2,Cap3,Cap4";
    cfg.neutral_frame = 0;
    cfg.smooth_hz = -1;
    if (fap_capture_encode(&c, take, &cfg, where) != FAP_OK)
        fail_msg("%s", where);
    fap_take_close(&take);
    return c;
}

/* Both eyes, in the last frame. */
static void assert_yaw(const fap_capture *c, double mm)
{
    const fap_frame *last = &fap_capture_frames(c)[FRAMES - 1];

    for (int fap = 23; fap <= 24; fap++) {
        assert_int_equal(last->state[fap], FAP_CODED);
        assert_float_equal(last->value[fap], 1e5 * asin(mm / 12), 200);
        assert_float_equal(last->value[fap + 2], 0, 200);
    }
}

static void check(motion *move, double mm)
{
    fap_capture *c = encode(move);

    assert_yaw(c, mm);
    fap_capture_close(&c);
}

TEST(gaze, follows_the_pupils)
{
    check(look_left, 4);
}

TEST(gaze, is_measured_against_the_corners)
{
    check(look_left_in_a_wrong_pose, 4);
}

TEST(gaze, a_pupil_outside_its_eye_follows_the_other)
{
    check(one_pupil_flies_away, 4);
}

TEST(gaze, behind_shut_lids_is_unknown_and_held)
{
    fap_capture *c = encode(look_left_with_shut_eyes);
    const fap_frame *last = &fap_capture_frames(c)[FRAMES - 1];

    assert_int_equal(last->state[23], FAP_HELD);
    assert_int_equal(last->value[23], 0);
    assert_true(last->value[19] > 500);
    fap_capture_close(&c);
}
