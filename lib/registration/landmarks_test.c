/* SPDX-License-Identifier: BSD-2-Clause */
/* Landmarks from files, by whatever names people give them. */
#include "tests/test.h"

#include <stdio.h>
#include <string.h>

#include <fap/studio/landmarks.h>

static char where[FAP_ERROR_TEXT_SIZE];

static fap_err read_text(fap_take **t, const char *text, const fap_surface *scan)
{
    return fap_landmarks_read(t, text, strlen(text), scan, NULL, where);
}

TEST(landmarks, places_and_vertices_with_any_mark_between)
{
    fap_surface *scan;
    fap_take *t;

    assert_int_equal(fap_surface_create(&scan, 3, 0, NULL), FAP_OK);
    scan->position[2][1] = 7;
    assert_int_equal(
        read_text(&t, "point,x,y,z\n8.3,1,2.5,-3\n# a remark\n\"Nose tip\"\t4 5;6\r\n\n8.4,2\n", scan),
        FAP_OK);
    assert_int_equal(t->point_count, 3);
    assert_string_equal(t->name[1], "Nose tip");
    assert_float_equal(t->xyz[0][1], 2.5, 0);
    assert_float_equal(t->xyz[1][2], 6, 0);
    assert_float_equal(t->xyz[2][1], 7, 0);
    fap_take_close(&t);
    fap_surface_close(&scan);
}

TEST(landmarks, nonsense_is_refused_with_its_line)
{
    fap_take *t;

    assert_int_equal(read_text(&t, "8.3,1,2,3\n8.4,1,x,3\n", NULL), FAP_E_SYNTAX);
    assert_non_null(strstr(where, "line 2"));
    assert_int_equal(read_text(&t, "8.3,5\n", NULL), FAP_E_DATA);
    assert_int_equal(read_text(&t, "name,x,y,z\n", NULL), FAP_E_NOT_FOUND);
    assert_int_equal(read_text(&t, "", NULL), FAP_E_NOT_FOUND);
    assert_null(t);
}

TEST(landmarks, feature_points_and_the_68_point_scheme_become_pins)
{
    fap_bank *bank;
    fap_take *t;
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t count;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(read_text(&t, "8.3,1,2,3\n8.4,4,5,6\n9.3,7,8,9\n3.5,0,0,0\n", NULL), FAP_OK);
    assert_int_equal(fap_landmarks_pin(t, bank, pin, &count, where), FAP_OK);
    assert_int_equal(count, 3); /* a pupil is not on the skin */
    assert_float_equal(pin[0].at[0] + pin[1].at[0] + pin[2].at[0], 12, 0);
    fap_take_close(&t);

    char text[68 * 24] = "";
    for (int i = 0; i < 68; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d,%d,%d,%d\n", i, i, i % 7, i % 5);
    assert_int_equal(read_text(&t, text, NULL), FAP_OK);
    assert_int_equal(fap_landmarks_pin(t, bank, pin, &count, where), FAP_OK);
    assert_true(count > 25);
    fap_take_close(&t);

    assert_int_equal(read_text(&t, "8.3,1,2,3\n8.4,4,5,6\n", NULL), FAP_OK);
    assert_int_equal(fap_landmarks_pin(t, bank, pin, &count, where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "three"));
    fap_take_close(&t);
    fap_bank_close(&bank);
}
