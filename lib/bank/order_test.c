/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * In which order FAPs of both levels shape the face, docs/face.md "Who overrides whom": visemes and expressions add up,
 * each pair by its own rule; low-level FAPs override both where they speak, and nowhere else.
 */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bank/faces_test.h"

typedef struct rig {
    fap_bank *bank;
    fap_face *face;
    float *position;
    float rest[FAP_POINT_COUNT][3], point[FAP_POINT_COUNT][3]; /* neutral; from there */
} rig;

static void pose(rig *r, const fap_frame *f)
{
    fap_face_pose(r->face, f, r->position, NULL);
    fap_face_points(r->face, r->point);
    for (int i = 0; i < 3 * FAP_POINT_COUNT; i++)
        r->point[i / 3][i % 3] -= r->rest[i / 3][i % 3];
}

static void open_rig(rig *r, fap_blend blend)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    *r = (rig){ .bank = test_bank(BUILTIN) };
    assert_int_equal(fap_face_open(&r->face, r->bank, &cfg), FAP_OK);
    r->position = aligned_alloc(32, 3 * fap_face_stride(r->face) * sizeof(float));
    fap_face_points(r->face, r->rest);
}

static void close_rig(rig *r)
{
    free(r->position);
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
}

static const float *key_motion(const rig *r, fap_key_kind kind, int number, int p)
{
    return fap_bank_key_get(r->bank, fap_bank_key_number(r->bank, kind, number))->point_mm[p];
}

static float at(const rig *r, const char *name, int axis)
{
    return r->point[fap_point_by_name(name)][axis];
}

static fap_frame high(fap_viseme v, fap_expression e)
{
    fap_frame f = { .viseme = v, .expression = e };

    f.state[1] = v.select1 || v.select2 ? FAP_CODED : FAP_ABSENT;
    f.state[2] = e.select1 || e.select2 ? FAP_CODED : FAP_ABSENT;
    return f;
}

static void command(fap_frame *f, int fap, int32_t value)
{
    f->state[fap] = FAP_CODED;
    f->value[fap] = value;
}

/* Eyeballs are bodies: keys do not move them. The tongue, teeth and lids have their own rules on top. */
static int plain(int p)
{
    const int group = fap_point_get(p)->group;
    return group == 2 || group == 4 || group == 5 || group == 8;
}

/* Lips of a mix may be pushed apart, no more. */
static void expect_sum(const rig *r, const char *who, const fap_key_kind kind[4], const int number[4],
                       const float weight[4])
{
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int axis = 0; plain(p) && axis < 3; axis++) {
            float sum = 0;
            for (int i = 0; i < 4; i++)
                sum += number[i] ? weight[i] * key_motion(r, kind[i], number[i], p)[axis] : 0;
            if (fabsf(sum - r->point[p][axis]) > 0.02f)
                fail_msg("%s: %s axis %d is at %g, the keys say %g", who, fap_point_get(p)->name, axis,
                         r->point[p][axis], sum);
        }
}

TEST(order, two_visemes_mix_by_blend_and_two_expressions_add_by_intensity)
{
    static const fap_key_kind kind[4] = { FAP_KEY_VISEME, FAP_KEY_VISEME, FAP_KEY_EXPRESSION,
                                          FAP_KEY_EXPRESSION };
    const fap_frame f = high((fap_viseme){ 10, 4, 21, 0 }, (fap_expression){ 1, 30, 6, 20, 0, 0 });

    for (int i = 0; fap_blend_name(i); i++) {
        rig r;
        open_rig(&r, (fap_blend)i);
        pose(&r, &f);
        expect_sum(&r, fap_blend_name(i), kind, (int[]){ 10, 4, 1, 6 },
                   (float[]){ 21 / 63.0f, 42 / 63.0f, 30 / 63.0f, 20 / 63.0f });
        close_rig(&r);
    }
}

TEST(order, the_ends_of_blend_show_one_viseme_and_number_0_shows_none)
{
    static const fap_key_kind kind[4] = { FAP_KEY_VISEME, FAP_KEY_VISEME, FAP_KEY_EXPRESSION,
                                          FAP_KEY_EXPRESSION };
    static const struct {
        fap_viseme v;
        fap_expression e;
        int number[4];
        float weight[4];
    } cases[] = {
        { { 10, 14, 63, 0 }, { 0 }, { 10 }, { 1 } },
        { { 10, 14, 0, 0 }, { 0 }, { 0, 14 }, { 0, 1 } },
        { { 10, 0, 21, 0 }, { 0 }, { 10 }, { 21 / 63.0f } },
        { { 0, 10, 21, 0 }, { 0 }, { 0, 10 }, { 0, 42 / 63.0f } },
        { { 10, 10, 21, 0 }, { 0 }, { 10 }, { 1 } },
        { { 0 }, { 2, 63, 0, 63, 0, 0 }, { 0, 0, 2 }, { 0, 0, 1 } },
        { { 0 }, { 2, 20, 2, 22, 0, 0 }, { 0, 0, 2 }, { 0, 0, 42 / 63.0f } },
    };
    rig r;

    open_rig(&r, FAP_BLEND_GA);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const fap_frame f = high(cases[i].v, cases[i].e);
        pose(&r, &f);
        expect_sum(&r, "ga", kind, cases[i].number, cases[i].weight);
    }
    close_rig(&r);
}

/* Where the FAP's own axis of its own point has to be, whatever else is on. */
static float target_of(const rig *r, int fap, int32_t value)
{
    const fap_info *info = fap_info_get(fap);
    return (float)(info->sign * value) * fap_fapu_step(fap_bank_fapu(r->bank), (fap_unit)info->unit);
}

TEST(order, low_level_faps_override_visemes_and_expressions_exactly)
{
    static const struct {
        int fap;
        int32_t value;
    } low[] = { { 4, -60 }, { 5, -300 }, { 12, 80 }, { 13, 0 }, { 31, 90 }, { 33, 0 }, { 53, 40 } };

    for (int i = 0; fap_blend_name(i); i++) {
        fap_frame f = high((fap_viseme){ 10, 14, 40, 0 }, (fap_expression){ 3, 50, 6, 10, 0, 0 });
        rig r;
        open_rig(&r, (fap_blend)i);
        for (size_t k = 0; k < sizeof low / sizeof *low; k++)
            command(&f, low[k].fap, low[k].value);
        pose(&r, &f);
        for (size_t k = 0; k < sizeof low / sizeof *low; k++) {
            const fap_info *info = fap_info_get(low[k].fap);
            const float got = r.point[info->point][info->motion - FAP_MOTION_X],
                        want = target_of(&r, low[k].fap, low[k].value);
            if (fabsf(got - want) > 0.02f)
                fail_msg("%s: FAP %d is at %g mm, not %g", fap_blend_name(i), low[k].fap, got, want);
        }
        close_rig(&r);
    }
}

/* All but fat, whose tables cannot give way in part. */
TEST(order, what_no_low_level_fap_speaks_of_stays_as_the_expression_has_it)
{
    for (int i = 0; fap_blend_name(i); i++) {
        fap_frame f = high((fap_viseme){ 0 }, (fap_expression){ 3, 63, 0, 0, 0, 0 });
        rig r;
        if (i == FAP_BLEND_FAT)
            continue;
        open_rig(&r, (fap_blend)i);
        command(&f, 12, 100), command(&f, 13, 100);
        pose(&r, &f);
        const float brow = key_motion(&r, FAP_KEY_EXPRESSION, 3, fap_point_by_name("4.1"))[1];
        assert_true(brow < -3);
        if (at(&r, "4.1", 1) > 0.5f * brow)
            fail_msg("%s: the angry brow is at %g mm of %g", fap_blend_name(i), at(&r, "4.1", 1), brow);
        close_rig(&r);
    }
}

TEST(order, a_fap_of_0_holds_still_and_an_absent_one_does_not)
{
    for (int i = 0; fap_blend_name(i); i++) {
        fap_frame f = high((fap_viseme){ 10, 0, 63, 0 }, (fap_expression){ 0 });
        rig r;
        open_rig(&r, (fap_blend)i);
        pose(&r, &f);
        assert_true(at(&r, "2.3", 1) < -5);
        command(&f, 5, 0);
        pose(&r, &f);
        assert_float_equal(at(&r, "2.3", 1), 0, 0.02);
        close_rig(&r);
    }
}
