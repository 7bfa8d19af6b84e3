/* SPDX-License-Identifier: BSD-2-Clause */
/* Marker names. */
#include "take/take_test.h"

#include <fap/studio/markers.h>

static fap_take *named(const char *const *names, uint32_t count)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, count, 1, NULL), FAP_OK);
    for (uint32_t i = 0; i < count; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "%s", names[i]);
    return take;
}

static fap_markers map; /* large, and tests run one at a time */

static fap_err map_names(const char *const *names, uint32_t count, const char *csv, char *where)
{
    fap_take *take = named(names, count);
    const fap_err err = fap_markers_map(&map, take, csv, csv ? strlen(csv) : 0, where);

    fap_take_close(&take);
    return err;
}

static void assert_source(const char *point, int want)
{
    const fap_marker_source *s = &map.point[fap_point_by_name(point)];

    assert_int_equal(s->count, want >= 0);
    if (want >= 0)
        assert_int_equal(s->index[0], want);
}

TEST(markers, feature_points_may_be_named_as_such)
{
    static const char *const names[] = { "8.4", "Anna:FP8.3", "p2.1", "8.99", "2.10" };

    assert_int_equal(map_names(names, 5, NULL, NULL), FAP_OK);
    assert_source("8.4", 0);
    assert_source("8.3", 1);
    assert_source("2.1", 2);
    assert_source("2.10", 4);
    assert_int_equal(map.role[3], 0);
    assert_int_equal(map.used, 4);
}

TEST(markers, the_set_with_most_hits_wins_without_regard_to_case)
{
    static const char *const names[] = { "Face:mouth_up", "Face:CHIN", "Face:NoseTop", "Face:Unheard",
                                         "Face:Leye_Up" };

    assert_int_equal(map_names(names, 5, NULL, NULL), FAP_OK);
    assert_string_equal(map.set, "ANIMFACE");
    assert_source("8.1", 0);
    assert_source("2.10", 1);
    assert_int_equal(map.role[2] & FAP_MARKER_RIGID, FAP_MARKER_RIGID);
    assert_int_equal(map.role[3], 0);
    assert_int_equal(map.role[4], FAP_MARKER_IDLE);
    assert_source("3.1", -1);
}

TEST(markers, the_users_table_wins)
{
    static const char *const names[] = { "A", "B", "C", "8.3", "Mouth_Up" };
    static const char csv[] = "label,point\n# dots\na,8.4\nB,rigid\r\n\nC,~4.1\n8.3,none\n";

    assert_int_equal(map_names(names, 5, csv, NULL), FAP_OK);
    assert_source("8.4", 0);
    assert_int_equal(map.role[1], FAP_MARKER_RIGID);
    assert_source("4.1", 2);
    assert_true(map.point[fap_point_by_name("4.1")].near);
    assert_source("8.3", -1);
    assert_source("8.1", -1); /* one hit makes no set */
}

TEST(markers, several_markers_of_one_point_are_a_mean)
{
    static const char *const names[] = { "Up1", "Up2" };

    assert_int_equal(map_names(names, 2, "Up1,8.1\nUp2,8.1\nUp2,8.10\n", NULL), FAP_OK);
    assert_int_equal(map.point[fap_point_by_name("8.1")].count, 2);
    assert_source("8.10", 1);
}

TEST(markers, lines_that_make_no_sense_are_named)
{
    static const char *const names[] = { "A" };
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(map_names(names, 1, "A,8.4\nB,8.99\n", where), FAP_E_SYNTAX);
    assert_non_null(strstr(where, "line 2"));
    assert_int_equal(map_names(names, 1, "A 8.4\n", where), FAP_E_SYNTAX);
    assert_int_equal(map_names(names, 1, "A,12.1\n", where), FAP_E_SYNTAX);
}

TEST(markers, a_take_without_known_names_lists_what_it_has)
{
    static const char *const names[] = { "RASI", "LASI" };
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(map_names(names, 2, NULL, where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "RASI, LASI"));
}
