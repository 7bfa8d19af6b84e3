/* SPDX-License-Identifier: BSD-2-Clause */
/* What the points of the built-in face can tell, and of faces made for the purpose. */
#include "tests/test.h"

#include <string.h>

#include <fap/studio/bank_build.h>
#include <fap/studio/bank_observe.h>

enum { UNITS = 1 << FAP_KEY_UNIT, ALL = 15 };

static fap_observation *observe(unsigned kinds, const uint8_t seen[FAP_POINT_COUNT][3])
{
    fap_bank *bank;
    fap_observation *o;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_bank_observe(&o, bank, kinds, seen), FAP_OK);
    fap_bank_close(&bank);
    return o;
}

TEST(bank_observe, more_points_never_see_less)
{
    static uint8_t jaw_only[FAP_POINT_COUNT][3];
    fap_observation *all = observe(UNITS, NULL);

    jaw_only[fap_point_by_name("2.1")][1] = 1;
    fap_observation *one = observe(UNITS, jaw_only);
    assert_int_equal(one->rank, 1);
    assert_int_equal(one->row_count, 1);
    assert_true(one->condition == 1);
    assert_true(all->rank > 20 && all->rank <= all->key_count);
    assert_true(all->condition > 1 && one->unseen_count > all->unseen_count);
    fap_bank_observe_free(&all);
    fap_bank_observe_free(&one);
    assert_null(one);
}

/* One axis knows no directions: whatever moves it looks alike. */
TEST(bank_observe, one_axis_cannot_tell_its_keys_apart)
{
    static uint8_t seen[FAP_POINT_COUNT][3];

    seen[fap_point_by_name("2.1")][1] = 1;
    fap_observation *o = observe(ALL, seen);
    const int movers = o->key_count - o->unseen_count;
    assert_true(movers >= 2);
    assert_int_equal(o->alike_count, movers * (movers - 1) / 2);
    fap_bank_observe_free(&o);
}

TEST(bank_observe, nothing_seen_is_rank_0)
{
    static const uint8_t nothing[FAP_POINT_COUNT][3];
    fap_observation *o = observe(ALL, nothing);

    assert_int_equal(o->rank, 0);
    assert_int_equal(o->unseen_count, o->key_count);
    assert_true(o->condition == 0);
    fap_bank_observe_free(&o);
}

TEST(bank_observe, refuses_what_makes_no_sense)
{
    fap_observation *o;
    fap_bank *bank;

    assert_int_equal(fap_bank_observe(&o, NULL, ALL, NULL), FAP_E_ARG);
    assert_null(o);
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_bank_observe(&o, bank, 0, NULL), FAP_E_ARG);
    fap_bank_close(&bank);
}
