/* SPDX-License-Identifier: BSD-2-Clause */
/* What a person gives to a tracker: the dots of the first picture, the camera. */
#include "tests/test.h"

#include <stdio.h>
#include <string.h>

#include <fap/studio/tracks.h>

static fap_err read_dots(fap_track_dots *d, const char *table, char *where)
{
    return fap_track_dots_read(d, table, strlen(table), NULL, where);
}

TEST(dots_read, a_table_with_and_without_mirrors)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_track_dots d;

    assert_int_equal(
        read_dots(&d, "label,x,y,m1x,m1y,m2x,m2y\n8.4,10,20.5,,,3,4\n# a remark\n\n8.3,,,1,2,,\n", where), 0);
    assert_int_equal(d.count, 2);
    assert_int_equal(d.mirrors, 2);
    assert_string_equal(d.dot[0].name, "8.4");
    assert_memory_equal(d.dot[0].has, ((const uint8_t[]){ 1, 0, 1 }), 3);
    assert_memory_equal(d.dot[1].has, ((const uint8_t[]){ 0, 1, 0 }), 3);
    assert_float_equal(d.dot[0].at_px[0][1], 20.5, 0);
    assert_float_equal(d.dot[0].at_px[2][0], 3, 0);
    fap_track_dots_close(&d);
    assert_int_equal(read_dots(&d, "nose;4,5;7\r\nchin;1;2\r\n", where), 0);
    assert_int_equal(d.count, 2);
    assert_int_equal(d.mirrors, 0);
    assert_float_equal(d.dot[0].at_px[0][0], 4.5, 0);
    fap_track_dots_close(&d);
}

TEST(dots_read, what_is_wrong_is_told_with_its_line)
{
    static const struct {
        const char *table;
        fap_err err;
        const char *word;
    } wrong[] = {
        { "", FAP_E_NOT_FOUND, "no dot" },
        { "label,x,y\n", FAP_E_NOT_FOUND, "no dot" },
        { "label,x,y\n8.4,1,2\n8.3,1,\n", FAP_E_SYNTAX, "line 3" },
        { "8.4,1,2\n8.3,one,2\n", FAP_E_SYNTAX, "line 2" },
        { "8.4,1,2\n\n8.4,3,2\n", FAP_E_DATA, "line 3" },
        { "8.4,,,,\n", FAP_E_DATA, "no view" },
        { "8.4,1,2\n,3,2\n", FAP_E_SYNTAX, "without a label" },
    };
    char where[FAP_ERROR_TEXT_SIZE];
    fap_track_dots d;

    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(read_dots(&d, wrong[i].table, where), wrong[i].err);
        assert_non_null(strstr(where, wrong[i].word));
        assert_null(d.dot);
    }
}

TEST(dots_read, more_than_can_be_followed_is_refused)
{
    static char table[FAP_TRACK_MAX_POINTS * 16];
    char where[FAP_ERROR_TEXT_SIZE];
    fap_track_dots d;
    size_t used = 0;

    for (int i = 0; i < FAP_TRACK_MAX_POINTS / 2 + 1; i++)
        used += (size_t)snprintf(table + used, sizeof table - used, "p%d,1,2,3,4\n", i);
    assert_int_equal(read_dots(&d, table, where), FAP_E_LIMIT);
}

static fap_err read_camera(fap_camera *c, const char *json, char *where)
{
    return fap_camera_read(c, json, strlen(json), where);
}

TEST(camera_read, our_object_and_opencvs)
{
    static const char *const same[] = {
        "{\"width\":640,\"height\":480,\"fx\":900,\"fy\":901,\"cx\":320,\"cy\":241,\"k\":[0.1,-0.2,0,0]}",
        "{\"image_width\":640,\"image_height\":480,\"camera_matrix\":[[900,0,320],[0,901,241],[0,0,1]],"
        "\"distortion_coefficients\":[[0.1,-0.2,0,0,0]],\"avg_reprojection_error\":0.2}",
        "{\"camera_matrix\":{\"rows\":3,\"cols\":3,\"dt\":\"d\",\"data\":[900,0,320,0,901,241,0,0,1]},"
        "\"image_width\":640,\"image_height\":480,\"distortion_coefficients\":{\"data\":[0.1,-0.2,0,0,0,9,9,"
        "9]}}",
    };
    char where[FAP_ERROR_TEXT_SIZE];

    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        fap_camera c;
        assert_int_equal(read_camera(&c, same[i], where), FAP_OK);
        assert_int_equal(c.width_px, 640);
        assert_int_equal(c.height_px, 480);
        assert_float_equal(c.fx_px, 900, 0);
        assert_float_equal(c.fy_px, 901, 0);
        assert_float_equal(c.cx_px, 320, 0);
        assert_float_equal(c.cy_px, 241, 0);
        assert_float_equal(c.k[1], -0.2, 1e-12);
        assert_float_equal(c.k[4], 0, 0);
    }
}

TEST(camera_read, what_is_missing_is_named)
{
    static const struct {
        const char *json;
        fap_err err;
        const char *word;
    } wrong[] = {
        { "", FAP_E_SYNTAX, "JSON" },
        { "[1,2]", FAP_E_SYNTAX, "JSON" },
        { "{\"width\":640,", FAP_E_SYNTAX, "JSON" },
        { "{\"fx\":900}", FAP_E_DATA, "width" },
        { "{\"width\":640,\"height\":480,\"cx\":1,\"cy\":1}", FAP_E_DATA, "fx" },
        { "{\"width\":640,\"height\":480,\"fx\":-900,\"fy\":900,\"cx\":1,\"cy\":1}", FAP_E_DATA, "fx" },
        { "{\"width\":640,\"height\":480,\"fx\":900,\"fy\":900,\"cx\":1}", FAP_E_DATA, "cx" },
        { "{\"width\":640,\"height\":480,\"fx\":900,\"fy\":900,\"cx\":1,\"cy\":2,\"k\":[1e9]}", FAP_E_DATA,
          "k" },
        { "{\"width\":640,\"height\":480,\"camera_matrix\":[[900,0,320],[0,901]]}", FAP_E_DATA, "fx" },
    };
    char where[FAP_ERROR_TEXT_SIZE];
    fap_camera c;

    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(read_camera(&c, wrong[i].json, where), wrong[i].err);
        assert_non_null(strstr(where, wrong[i].word));
    }
}
