/* SPDX-License-Identifier: BSD-2-Clause */
/* Electromagnetic coils: all in one plane, most of them in the mouth, x forward, y to the left, z up. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

static const struct coil {
    const char *name;
    float x, y, z;
} coils[] = {
    { "TR", -46, 0, -6 }, { "TB", -30, 0, -4 },  { "TT", -11, 0, -10 },    { "UL", 10, 0, 6 },
    { "LL", 7, 0, -14 },  { "JAW", -6, 0, -24 }, { "JAWL", -10, 15, -22 }, { "ML", -10, 27, -6 },
};

enum { COILS = sizeof coils / sizeof *coils, FRAMES = 20 };

/* From frame 10: the tongue's tip 6 mm up and 3 back, the lower lip 5 down, its corner 2 to the left. */
static void move(const char *name, float at[3])
{
    if (!strcmp(name, "TT")) {
        at[2] += 6;
        at[0] -= 3;
    }
    if (!strcmp(name, "LL"))
        at[2] -= 5;
    if (!strcmp(name, "ML"))
        at[1] += 2;
}

static fap_capture *encode(uint32_t count)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture_config cfg;
    fap_capture *c;
    fap_take *take;

    assert_int_equal(fap_take_create(&take, count, FRAMES, NULL), FAP_OK);
    take->rate_hz = 25;
    for (uint32_t i = 0; i < count; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "%s", coils[i].name);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t i = 0; i < count; i++) {
            float at[3] = { coils[i].x, coils[i].y, coils[i].z };
            if (f >= FRAMES / 2)
                move(coils[i].name, at);
            fap_take_set(take, f, i, at);
        }
    fap_capture_config_init(&cfg);
    cfg.neutral_frame = 0;
    cfg.smooth_hz = -1;
    if (fap_capture_encode(&c, take, &cfg, where) != FAP_OK)
        fail_msg("%s", where);
    fap_take_close(&take);
    return c;
}

static double moved_mm(const fap_capture *c, int fap)
{
    const fap_info *info = fap_info_get(fap);
    return info->sign * fap_capture_frames(c)[FRAMES - 1].value[fap] *
           (double)fap_fapu_step(&fap_capture_report_get(c)->fapu, (fap_unit)info->unit);
}

TEST(coils, the_tongue_is_taken_along_the_heads_axes)
{
    fap_capture *c = encode(COILS);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_string_equal(r->axes, "+y+z+x");
    assert_true(r->axes_found);
    assert_float_equal(moved_mm(c, 44), 6, 0.1);
    assert_float_equal(moved_mm(c, 45), -3, 0.1);
    assert_float_equal(moved_mm(c, 52), -5, 0.1);
    assert_float_equal(moved_mm(c, 53), 2, 0.1);
    assert_int_equal(r->fap[46].coded, FRAMES);
    assert_int_equal(r->fap[47].coded, 0);
    fap_capture_close(&c);
}

TEST(coils, lips_jaw_and_tongue_are_no_head)
{
    fap_capture *c = encode(COILS);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_int_equal(r->rigid_count, 0);
    for (int fap = 48; fap <= 50; fap++)
        assert_non_null(r->fap[fap].reason);
    fap_capture_close(&c);
}

TEST(coils, one_in_the_mouth_does_not_move_the_lip)
{
    fap_capture *c = encode(COILS);
    const fap_capture_report *r = fap_capture_report_get(c);

    for (int fap = 51; fap <= 60; fap++)
        for (int k = 0; k < r->fap[fap].origin.marker_count && r->fap[fap].coded; k++)
            assert_true(coils[r->fap[fap].origin.marker[k]].name[1] == 'L');
    fap_capture_close(&c);
}
