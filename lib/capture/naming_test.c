/* SPDX-License-Identifier: BSD-2-Clause */
/* What was made of a viseme or an expression is found to be that one; noise does not make names jump. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/facs.h>
#include <fap/face.h>
#include <fap/studio/naming.h>

enum { FRAMES = 30 };

/* Low-level FAPs of a mix of key models, as the built-in face has them. */
static void make_frame(fap_frame *f, const fap_bank *bank, fap_key_kind kind, int number, double weight)
{
    const fap_key *key = fap_bank_key_get(bank, fap_bank_key_number(bank, kind, number));

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const int axis = info->motion - FAP_MOTION_X;
        if (axis < 0 || axis > 2 || info->point < 0)
            continue;
        const double step = (double)fap_fapu_step(fap_bank_fapu(bank), info->unit);
        f->state[fap] = FAP_CODED;
        f->value[fap] +=
            (int32_t)lround(weight * info->sign * (double)key->point_mm[info->point][axis] / step);
    }
}

static int stronger(const fap_viseme *v)
{
    return v->blend >= 32 ? v->select1 : v->select2;
}

static double share_of(const fap_viseme *v, int number)
{
    return (v->select1 == number ? v->blend / 63.0 : 0) + (v->select2 == number ? 1 - v->blend / 63.0 : 0);
}

TEST(naming, every_viseme_is_found_in_its_own_faps)
{
    fap_bank *bank;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    for (int v = 1; v <= FAP_VISEME_COUNT; v++) {
        fap_frame frame[FRAMES] = { { 0 } };
        fap_naming_report r;
        for (int t = 0; t < FRAMES; t++)
            make_frame(&frame[t], bank, FAP_KEY_VISEME, v, t < 10 ? 0 : 1);
        assert_int_equal(fap_name_frames(frame, FRAMES, NULL, &r), FAP_OK);
        assert_int_equal(stronger(&frame[2].viseme), 0);
        assert_int_equal(stronger(&frame[25].viseme), v);
        assert_true(r.left < 0.35);
        assert_int_equal(r.viseme_frames[v] > 15, 1);
    }
    fap_bank_close(&bank);
}

TEST(naming, every_expression_is_found_at_half_its_intensity)
{
    fap_bank *bank;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    for (int e = 1; e <= FAP_EXPRESSION_COUNT; e++) {
        fap_frame frame[FRAMES] = { { 0 } };
        for (int t = 0; t < FRAMES; t++)
            make_frame(&frame[t], bank, FAP_KEY_EXPRESSION, e, 0.5);
        assert_int_equal(fap_name_frames(frame, FRAMES, NULL, NULL), FAP_OK);
        assert_int_equal(frame[15].expression.select1, e);
        assert_true(frame[15].expression.intensity1 > 22 && frame[15].expression.intensity1 < 38);
    }
    fap_bank_close(&bank);
}

TEST(naming, noise_does_not_make_names_jump)
{
    fap_bank *bank;
    fap_frame frame[FRAMES] = { { 0 } };
    double most = 0;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    for (int t = 0; t < FRAMES; t++) {
        make_frame(&frame[t], bank, FAP_KEY_VISEME, 10, 0.6);
        for (int fap = 3; fap <= FAP_COUNT; fap++) /* a millimetre or so either way */
            frame[t].value[fap] += frame[t].state[fap] ? (int32_t)lround(20 * sin(17.3 * t + 5.1 * fap)) : 0;
    }
    assert_int_equal(fap_name_frames(frame, FRAMES, NULL, NULL), FAP_OK);
    for (int t = 1; t < FRAMES; t++)
        most = fmax(most, fabs(share_of(&frame[t].viseme, 10) - share_of(&frame[t - 1].viseme, 10)));
    assert_true(most < 0.1);
    assert_float_equal(share_of(&frame[15].viseme, 10), 0.6, 0.2);
    fap_bank_close(&bank);
}

TEST(naming, only_what_is_asked_for_is_set)
{
    fap_bank *bank;
    fap_frame frame[2] = { { 0 } };
    fap_naming_config cfg;

    fap_naming_config_init(&cfg);
    cfg.expressions = 0;
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    make_frame(&frame[0], bank, FAP_KEY_EXPRESSION, 1, 1);
    make_frame(&frame[1], bank, FAP_KEY_EXPRESSION, 1, 1);
    assert_int_equal(fap_name_frames(frame, 2, &cfg, NULL), FAP_OK);
    assert_int_equal(frame[0].state[1], FAP_CODED);
    assert_int_equal(frame[0].state[2], FAP_ABSENT);
    cfg.visemes = 0;
    assert_int_equal(fap_name_frames(frame, 2, &cfg, NULL), FAP_E_NOT_FOUND);
    fap_bank_close(&bank);
}
