/* SPDX-License-Identifier: BSD-2-Clause */
/* A face that the bank itself has moved: a marker that is hardly ever seen comes back out of the others. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

enum { CAPS = 4, FRAMES = 300, SHOWN = 12 };

static const char *const names[] = { "2.1", "8.1", "8.2", "8.3", "8.4", "8.5", "8.6", "8.7", "8.8", "4.1",
                                     "4.2", "4.3", "4.4", "4.5", "4.6", "5.1", "5.2", "9.1", "9.2", "9.3" };
enum { NAMES = sizeof names / sizeof *names, POINTS = CAPS + NAMES };
static const float caps[CAPS][3] = { { 70, 110, 20 }, { -70, 110, 20 }, { 0, 130, 60 }, { 0, 100, -60 } };

/* jawOpen and a smile, each with a rhythm of its own; at rest in the first half second. */
static float share(const char *unit, uint32_t frame)
{
    const float t = frame < 30 ? 0 : (float)(frame - 30);
    if (!strcmp(unit, "jawOpen"))
        return 0.4f * (1 - cosf(0.15f * t));
    if (!strcmp(unit, "mouthSmileLeft") || !strcmp(unit, "mouthSmileRight"))
        return 0.3f * (1 - cosf(0.11f * t));
    return 0;
}

static void place(const fap_bank *bank, const char *name, uint32_t frame, float out[3])
{
    const int point = fap_point_by_name(name);

    memcpy(out, fap_bank_point_get(bank, point)->position_mm, 3 * sizeof *out);
    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        for (int axis = 0; axis < 3 && key->kind == FAP_KEY_UNIT; axis++)
            out[axis] += share(key->name, frame) * key->point_mm[point][axis];
    }
}

static fap_take *make_take(const fap_bank *bank)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, POINTS, FRAMES, NULL), FAP_OK);
    take->rate_hz = 25;
    for (uint32_t i = 0; i < CAPS; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "Cap%u", (unsigned)i);
    for (uint32_t i = 0; i < NAMES; i++)
        snprintf(take->name[CAPS + i], FAP_TAKE_NAME_SIZE, "%s", names[i]);
    for (uint32_t f = 0; f < FRAMES; f++) {
        for (uint32_t i = 0; i < CAPS; i++)
            fap_take_set(take, f, i, caps[i]);
        for (uint32_t i = 0; i < NAMES; i++) {
            float v[3];
            place(bank, names[i], f, v);
            fap_take_set(take, f, CAPS + i, v);
        }
    }
    return take;
}

/* But for the first and the last frames. */
static void hide(fap_take *take, const char *name)
{
    const uint32_t p = (uint32_t)fap_take_find(take, name);

    for (uint32_t f = SHOWN; f < FRAMES - SHOWN; f++)
        take->valid[f * POINTS + p] = 0;
}

static fap_capture *encode(const fap_take *take, const fap_bank *bank, fap_fill fill)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture_config cfg;
    fap_capture *c;

    fap_capture_config_init(&cfg);
    cfg.rigid = "Cap0,Cap1,Cap2,Cap3";
    cfg.neutral_frame = 5;
    cfg.bank = bank;
    cfg.fill = fill;
    if (fap_capture_encode(&c, take, &cfg, where) != FAP_OK)
        fail_msg("%s", where);
    return c;
}

static double error_mm(const fap_capture *got, const fap_capture *want, int fap)
{
    const fap_fapu *fapu = &fap_capture_report_get(want)->fapu;
    double worst = 0;

    for (uint32_t f = 0; f < FRAMES; f++)
        worst =
            fmax(worst, abs(fap_capture_frames(got)[f].value[fap] - fap_capture_frames(want)[f].value[fap]));
    return worst * (double)fap_fapu_step(fapu, (fap_unit)fap_info_get(fap)->unit);
}

TEST(bank_fill, a_corner_that_is_hardly_seen_follows_from_the_rest_of_the_face)
{
    fap_bank *bank;
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    fap_take *take = make_take(bank);
    fap_capture *whole = encode(take, bank, FAP_FILL_ALL);

    hide(take, "8.3");
    fap_capture *filled = encode(take, bank, FAP_FILL_ALL);
    assert_int_equal(fap_capture_report_get(filled)->gaps_by_bank, 1);
    assert_int_equal(fap_capture_report_get(filled)->gaps_eased, 0);
    assert_int_equal(fap_capture_fill_of(filled, 100, 53), FAP_SAMPLE_BANK);
    assert_int_equal(fap_capture_fill_of(filled, 100, 54), FAP_SAMPLE_MEASURED);
    assert_int_equal(fap_capture_fill_of(filled, 5, 53), FAP_SAMPLE_MEASURED);
    assert_true(fap_capture_report_get(whole)->fap[59].max > 100);
    assert_true(error_mm(filled, whole, 53) < 0.7);
    assert_true(error_mm(filled, whole, 59) < 0.7);
    fap_capture_close(&filled);
    fap_capture_close(&whole);
    fap_take_close(&take);
    fap_bank_close(&bank);
}

TEST(bank_fill, without_the_bank_the_corner_is_masked_out)
{
    fap_bank *bank;
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    fap_take *take = make_take(bank);

    hide(take, "8.3");
    fap_capture *c = encode(take, bank, FAP_FILL_TAKE);
    assert_int_equal(fap_capture_report_get(c)->gaps_by_bank, 0);
    assert_int_equal(fap_capture_frames(c)[100].state[53], FAP_HELD);
    fap_capture_close(&c);
    fap_take_close(&take);
    fap_bank_close(&bank);
}

TEST(bank_fill, too_few_points_in_sight_are_no_face)
{
    fap_bank *bank;
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    fap_take *take = make_take(bank);

    for (int i = 1; i < NAMES - 4; i++)
        hide(take, names[i]);
    fap_capture *c = encode(take, bank, FAP_FILL_ALL);
    assert_int_equal(fap_capture_report_get(c)->gaps_by_bank, 0);
    assert_true(fap_capture_report_get(c)->gaps_eased > 0);
    fap_capture_close(&c);
    fap_take_close(&take);
    fap_bank_close(&bank);
}
