/* SPDX-License-Identifier: BSD-2-Clause */
/* Units, visemes and expressions: there and back, and what has no name. */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include <fap/facs.h>
#include <fap/tables.h>

static fap_arkit_fit *open_fit(void)
{
    fap_arkit_fit *fit;

    assert_int_equal(fap_arkit_fit_open(&fit, NULL), FAP_OK);
    return fit;
}

TEST(facs, every_unit_has_a_name_and_moves_something)
{
    int units = 0;

    for (int unit = -1; unit <= FAP_FACS_MAX_NUMBER + 1; unit++) {
        float sum = 0;
        for (int s = 0; s < FAP_ARKIT_COUNT; s++)
            sum += fap_facs_share(unit, s);
        assert_int_equal(sum > 0, fap_facs_name(unit) != NULL);
        units += sum > 0;
    }
    assert_int_equal(units, 32);
    assert_string_equal(fap_facs_name(12), "lip corner puller");
}

TEST(facs, units_come_back_from_their_coefficients)
{
    for (int unit = 1; unit <= FAP_FACS_MAX_NUMBER; unit++) {
        fap_facs in = { { 0 } }, back;
        fap_arkit a = { .has_head = 0 };
        if (!fap_facs_name(unit) || unit == 45) /* of one instant the same as 43 */
            continue;
        in.unit[unit] = 0.6f;
        fap_facs_to_arkit(&in, &a);
        fap_facs_from_arkit(&a, &back);
        /* Mixes of others: 23 is some of 18 and 28, 25 of 10 and 16, and 26 is what 27 is, less of it. */
        if (unit == 23 || unit == 25 || unit == 26 || unit == 27)
            continue;
        for (int other = 1; other <= FAP_FACS_MAX_NUMBER; other++)
            assert_float_equal(back.unit[other], in.unit[other], 0.02);
    }
}

TEST(facs, coefficients_stay_within_their_limits)
{
    fap_facs in;
    fap_arkit a = { .has_head = 0 };

    for (int unit = 0; unit <= FAP_FACS_MAX_NUMBER; unit++)
        in.unit[unit] = unit % 2 ? 1 : NAN;
    fap_facs_to_arkit(&in, &a);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        assert_true(a.shape[s] >= 0 && a.shape[s] <= 1);
}

TEST(facs, visemes_come_back_from_their_coefficients)
{
    fap_arkit_fit *fit = open_fit();

    for (int v = 1; v <= 14; v++) {
        fap_viseme back;
        fap_arkit a = { .has_head = 0 };
        fap_viseme_to_arkit(v, &a);
        assert_true(fap_arkit_to_viseme(fit, &a, &back) < 0.02f);
        const int found = back.blend == 63 ? back.select1 : back.blend == 0 ? back.select2 : -1;
        assert_int_equal(found, v);
    }
    fap_arkit_fit_close(&fit);
}

TEST(facs, a_mix_of_two_visemes_comes_back_as_one)
{
    fap_arkit_fit *fit = open_fit();
    fap_arkit a = { .has_head = 0 }, b = { .has_head = 0 };
    fap_viseme back;

    fap_viseme_to_arkit(10, &a);
    fap_viseme_to_arkit(14, &b);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        a.shape[s] = (a.shape[s] * 21 + b.shape[s] * 42) / 63;
    assert_true(fap_arkit_to_viseme(fit, &a, &back) < 0.02f);
    assert_int_equal(back.select1, 14);
    assert_int_equal(back.select2, 10);
    assert_in_range(back.blend, 41, 43);
    fap_arkit_fit_close(&fit);
}

TEST(facs, expressions_come_back_alone_and_in_pairs)
{
    fap_arkit_fit *fit = open_fit();
    fap_expression back;

    for (int e = 1; e <= 6; e++) {
        fap_arkit a = { .has_head = 0 };
        fap_expression_to_arkit(e, &a);
        assert_true(fap_arkit_to_expression(fit, &a, &back) < 0.02f);
        assert_int_equal(back.select1, e);
        assert_in_range(back.intensity1, 61, 63);
        assert_true(back.intensity2 <= 2);
    }
    fap_arkit joy = { .has_head = 0 }, surprise = { .has_head = 0 };
    fap_expression_to_arkit(1, &joy);
    fap_expression_to_arkit(6, &surprise);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        joy.shape[s] = 0.8f * joy.shape[s] + 0.3f * surprise.shape[s];
    assert_true(fap_arkit_to_expression(fit, &joy, &back) < 0.05f);
    assert_int_equal(back.select1, 1);
    assert_int_equal(back.select2, 6);
    assert_in_range(back.intensity1, 48, 52);
    assert_in_range(back.intensity2, 17, 21);
    fap_arkit_fit_close(&fit);
}

/* The two tables say the same face in other words. */
TEST(facs, expressions_by_units_are_the_key_models_expressions)
{
    fap_arkit_fit *fit = open_fit();

    for (int e = 1; e <= 6; e++) {
        fap_facs facs;
        fap_arkit a = { .has_head = 0 };
        fap_expression back;
        fap_expression_to_facs(e, &facs);
        fap_facs_to_arkit(&facs, &a);
        const float rest = fap_arkit_to_expression(fit, &a, &back);
        assert_int_equal(back.select1, e);
        if (rest > 0.35f || back.intensity1 < 50)
            fail_msg("expression %d: %.2f left, intensity %d, %d at %d beside", e, (double)rest,
                     back.intensity1, back.select2, back.intensity2);
    }
    fap_arkit_fit_close(&fit);
}

TEST(facs, a_still_face_has_no_name)
{
    fap_arkit_fit *fit = open_fit();
    fap_arkit a = { .has_head = 0 };
    fap_viseme viseme;
    fap_expression expression;

    assert_float_equal(fap_arkit_to_viseme(fit, &a, &viseme), 0, 0);
    assert_int_equal(viseme.select1, 0);
    assert_float_equal(fap_arkit_to_expression(fit, &a, &expression), 0, 0);
    assert_int_equal(expression.select1, 0);
    assert_int_equal(expression.intensity1, 0);
    fap_viseme_to_arkit(15, &a);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        assert_float_equal(a.shape[s], 0, 0);
    fap_arkit_fit_close(&fit);
}
