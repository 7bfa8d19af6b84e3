/* SPDX-License-Identifier: BSD-2-Clause */
/* Inner lips from outer ones: a made-up face on a still head, whose outer lips move as each test says. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

/* The mouth's eight, lids and brows to place the face, a headband. Millimetres. */
static const struct place {
    const char *name;
    float x, y, z;
} places[] = {
    { "8.1", 0, -14, 97 },   { "8.2", 0, -30, 96 },    { "8.3", 25, -22, 83 }, { "8.4", -25, -22, 83 },
    { "8.5", 12, -15, 93 },  { "8.6", -12, -15, 93 },  { "8.7", 12, -28, 92 }, { "8.8", -12, -28, 92 },
    { "3.7", 45, 40, 70 },   { "3.12", -45, 40, 70 },  { "9.3", 0, 8, 105 },   { "4.3", 32, 66, 84 },
    { "4.4", -32, 66, 84 },  { "2.1", 0, -60, 80 },    { "9.1", 15, 3, 88 },   { "9.2", -15, 3, 88 },
    { "Cap1", 70, 110, 20 }, { "Cap2", -70, 110, 20 }, { "Cap3", 0, 130, 60 }, { "Cap4", 0, 100, -60 },
};

enum { PLACES = sizeof places / sizeof *places, FRAMES = 12, MOVES_FROM = 6 };

typedef void motion(const char *name, float at[3]);

static void lower_lip_down(const char *name, float at[3])
{
    if (!strcmp(name, "8.2") || !strcmp(name, "8.7") || !strcmp(name, "8.8"))
        at[1] -= 10;
}

static void lower_lip_far_up(const char *name, float at[3])
{
    if (!strcmp(name, "8.2") || !strcmp(name, "8.7") || !strcmp(name, "8.8"))
        at[1] += 25;
}

/* The edge of the upper lip turns in the plane of the face: what is 8.1's left goes up, its right goes down. */
static void upper_lip_turns(const char *name, float at[3])
{
    if (!strcmp(name, "8.5"))
        at[1] += 8;
    if (!strcmp(name, "8.6"))
        at[1] -= 8;
}

static fap_capture *encode(motion *move, const char *hidden)
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
            if (f >= MOVES_FROM)
                move(places[i].name, at);
            if (!hidden || strcmp(hidden, places[i].name) != 0)
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

/* In the last frame, millimetres along the FAP's axis. */
static double moved_mm(const fap_capture *c, int fap)
{
    const fap_fapu *u = &fap_capture_report_get(c)->fapu;
    const fap_info *info = fap_info_get(fap);

    assert_int_equal(fap_capture_report_get(c)->fap[fap].coded, FRAMES);
    return (double)fap_fapu_step(u, (fap_unit)info->unit) * info->sign *
           fap_capture_frames(c)[FRAMES - 1].value[fap];
}

TEST(lips, inner_ones_go_with_the_outer_ones)
{
    fap_capture *c = encode(lower_lip_down, NULL);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_float_equal(moved_mm(c, 52), -10, 0.1);
    assert_float_equal(moved_mm(c, 5), -10, 0.1);
    assert_float_equal(moved_mm(c, 10), -10, 2); /* beside the corner, which stays, the edge turns */
    assert_float_equal(moved_mm(c, 4), 0, 0.1);
    assert_int_equal(r->fap[5].origin.how, FAP_HOW_DERIVED);
    assert_int_equal(r->fap[5].near, 1);
    assert_int_equal(r->fap[52].origin.how, FAP_HOW_DIRECT);
    fap_capture_close(&c);
}

/* The offset from 8.1 to 2.2 points down; it leans where the edge leans, and 2.2 does not stay below 8.1. */
TEST(lips, an_offset_turns_with_the_edge)
{
    fap_capture *c = encode(upper_lip_turns, NULL);
    const double left_mm = moved_mm(c, 8), right_mm = moved_mm(c, 9);

    assert_float_equal(moved_mm(c, 51), 0, 0.1);
    assert_float_equal(moved_mm(c, 4), 0, 2);
    assert_true(left_mm > 4);
    assert_true(right_mm < -3); /* down to the lower lip, no further */
    fap_capture_close(&c);
}

TEST(lips, that_would_pass_each_other_meet)
{
    fap_capture *c = encode(lower_lip_far_up, NULL);
    const fap_bank_point *upper, *lower;
    fap_bank *bank;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    upper = fap_bank_point_get(bank, fap_point_by_name("2.2"));
    lower = fap_bank_point_get(bank, fap_point_by_name("2.3"));
    const double gap = (double)(upper->position_mm[1] - lower->position_mm[1]) / fap_capture_face_scale(c);
    fap_bank_close(&bank);
    assert_float_equal(moved_mm(c, 5) - moved_mm(c, 4), gap, 0.1);
    assert_float_equal(moved_mm(c, 52), 25, 0.1); /* markers are believed */
    fap_capture_close(&c);
}

TEST(lips, without_the_outer_point_nothing_is_said)
{
    fap_capture *c = encode(lower_lip_down, "8.2");
    const fap_capture_report *r = fap_capture_report_get(c);

    /* 8.7 and 8.8 tell 8.2; without a marker on either lip's corner 2.4 would be a guess. */
    assert_int_not_equal(r->fap[52].origin.how, FAP_HOW_DIRECT);
    assert_int_equal(r->fap[4].origin.how, FAP_HOW_DERIVED);
    fap_capture_close(&c);
    c = encode(lower_lip_down, "8.3");
    assert_int_equal(fap_capture_report_get(c)->fap[12].coded, 0);
    fap_capture_close(&c);
}
