/* SPDX-License-Identifier: BSD-2-Clause */
/* The tables against what the standard says of them elsewhere: counts, groups, mirror symmetry, signs. */
#include "tests/test.h"

#include <string.h>

#include <fap/tables.h>

TEST(tables, every_fap_has_its_row)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        assert_non_null(info);
        assert_non_null(info->name);
        assert_int_equal(fap_by_name(info->name), fap);
        assert_true(info->sign == 1 || info->sign == -1);
    }
    assert_null(fap_info_get(0));
    assert_null(fap_info_get(FAP_COUNT + 1));
}

TEST(tables, groups_cover_all_faps_once)
{
    int next = 1;
    for (int g = 1; g <= FAP_GROUPS; g++) {
        assert_int_equal(fap_group_first(g), next);
        for (int i = 0; i < fap_group_count(g); i++)
            assert_int_equal(fap_info_get(next + i)->group, g);
        next += fap_group_count(g);
    }
    assert_int_equal(next, FAP_COUNT + 1);
}

TEST(tables, point_groups_have_the_sizes_of_the_figure)
{
    static const int sizes[] = { 14, 14, 6, 4, 4, 1, 10, 15, 10, 6 }; /* groups 2 to 11 */
    int count[12] = { 0 };

    for (int i = 0; i < FAP_POINT_COUNT; i++)
        count[fap_point_get(i)->group]++;
    for (int g = 2; g <= 11; g++)
        assert_int_equal(count[g], sizes[g - 2]);
}

TEST(tables, mirrors_are_mutual)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++)
        assert_int_equal(fap_point_get(fap_point_get(i)->mirror)->mirror, i);
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (fap_mirror(fap))
            assert_int_equal(fap_mirror(fap_mirror(fap)), fap);
}

/* A mirrored pair of horizontal FAPs pulls to opposite sides, so that a copied value mirrors. */
TEST(tables, mirrored_faps_move_mirrored_points)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const int other = fap_mirror(fap);
        if (!other)
            continue;
        const fap_info *a = fap_info_get(fap), *b = fap_info_get(other);
        assert_int_equal(a->motion, b->motion);
        assert_int_equal(fap_point_get(a->point)->mirror, b->point);
        assert_int_equal(a->sign, a->motion == FAP_MOTION_X ? -b->sign : b->sign);
    }
}

TEST(tables, points_are_found_by_name)
{
    assert_int_equal(fap_point_by_name("8.4"), fap_point_index(8, 4));
    assert_string_equal(fap_point_get(fap_point_by_name("11.6"))->name, "11.6");
    assert_int_equal(fap_point_by_name("1.1"), -1);
}
