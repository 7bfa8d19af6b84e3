/* SPDX-License-Identifier: BSD-2-Clause */
/* Both ways of fig. 6 are exact without noise; with noise the mirror's is the better one, as the paper has it. */
#include <stddef.h>

#include "noise_study.h"
#include "tests/test.h"

static void run(double variance_px2, int points, study_result result[STUDY_METHODS])
{
    const study_setting s = { variance_px2, points, 60 };

    assert_true(study_run(&s, result));
}

TEST(mirror_study, without_noise_every_method_is_exact)
{
    study_result r[STUDY_METHODS];

    run(0, 20, r);
    for (int m = 0; m < STUDY_METHODS; m++)
        assert_true(r[m].tenth_mm < 1e-6 && r[m].failed == 0);
}

TEST(mirror_study, with_noise_a_mirror_is_better_than_two_cameras_of_which_nothing_is_known)
{
    study_result r[STUDY_METHODS];

    for (int points = 12; points <= 100; points *= 2) {
        run(1, points, r);
        assert_true(r[STUDY_MIRROR].median_mm < r[STUDY_TWO_VIEWS].median_mm);
        assert_true(r[STUDY_REFINED].median_mm < r[STUDY_TWO_VIEWS].median_mm);
        assert_int_equal(r[STUDY_MIRROR].failed, 0);
    }
}

TEST(mirror_study, more_points_make_it_better)
{
    study_result few[STUDY_METHODS], many[STUDY_METHODS];

    run(1, 12, few);
    run(1, 100, many);
    for (int m = 0; m < STUDY_METHODS; m++)
        assert_true(many[m].median_mm < few[m].median_mm);
}
