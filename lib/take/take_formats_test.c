/* SPDX-License-Identifier: BSD-2-Clause */
/* TRC, Nexus, Motive and plain tables: what each has of its own, what is missing, and what cannot be read. */
#include "take/take_test.h"

#include <math.h>

static fap_take *read_ok(const char *text)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    if (test_read_text(&take, text, where) != FAP_OK)
        fail_msg("%s", where);
    return take;
}

static void assert_refused(const char *text, fap_err err, const char *word)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    assert_int_equal(test_read_text(&take, text, where), err);
    assert_null(take);
    if (!strstr(where, word))
        fail_msg("'%s' does not say '%s'", where, word);
}

static void assert_sample(const fap_take *take, uint32_t frame, uint32_t point, float x, float y, float z)
{
    const float *v = fap_take_sample(take, frame, point);

    assert_non_null(v);
    assert_float_equal(v[0], x, 1e-4);
    assert_float_equal(v[1], y, 1e-4);
    assert_float_equal(v[2], z, 1e-4);
}

#define TRC_HEAD                                                                                             \
    "PathFileType\t4\t(X/Y/"                                                                                 \
    "Z)\tx.trc\r\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\r\n60.00\t60\t3\t66\tcm\r\n"            \
    "Frame#\tTime\tChin\t\t\tMouth L\t\t\r\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n"

TEST(trc, names_decide_how_many_points_there_are)
{
    fap_take *take =
        read_ok(TRC_HEAD "\r\n1\t0.0\t1\t2\t3\t4\t5\t6\t9\t9\t9\r\n2\t0.017\t\t\t\t4.5\t5\t6e-1\r\n"
                         "3\t0.033\t0\t0\t0\t7\t8\t9");

    assert_string_equal(take->format, "trc");
    assert_int_equal(take->point_count, 2);
    assert_int_equal(take->frame_count, 3);
    assert_string_equal(take->name[1], "Mouth L");
    assert_float_equal(take->rate_hz, 60, 1e-9);
    assert_sample(take, 0, 0, 10, 20, 30);
    assert_null(fap_take_sample(take, 1, 0));
    assert_sample(take, 1, 1, 45, 50, 6);
    assert_null(fap_take_sample(take, 2, 0)); /* exactly 0,0,0 */
    assert_sample(take, 2, 1, 70, 80, 90);
    fap_take_close(&take);
}

TEST(trc, absent_rows_are_gaps)
{
    fap_take *take =
        read_ok(TRC_HEAD "1\t0.0\t1\t2\t3\t4\t5\t6\n2\t0.0\t1\t2\t3\t4\t5\t6\n5\t0.0\t1\t2\t3\t4\t5\t6\n");

    assert_int_equal(take->frame_count, 5);
    assert_null(fap_take_sample(take, 2, 0));
    assert_sample(take, 4, 0, 10, 20, 30);
    fap_take_close(&take);
}

TEST(trc, what_is_cut_or_nameless_is_refused_in_words)
{
    assert_refused("PathFileType\t4\n", FAP_E_SYNTAX, "line 3");
    assert_refused("PathFileType\t4\nDataRate\n60\nFrame#\tTime\t\n", FAP_E_NOT_FOUND, "no marker");
    assert_refused("PathFileType\t4\nDataRate\n60\nSomething\n", FAP_E_SYNTAX, "line 4");
    assert_refused(TRC_HEAD, FAP_E_NOT_FOUND, "not one row");
    assert_refused(TRC_HEAD "1\t0\t\t\t\t\t\t\n", FAP_E_NOT_FOUND, "missing");
}

TEST(nexus, the_trajectories_are_found_behind_other_sections)
{
    fap_take *take =
        read_ok("Devices\n2000\n,,Force\nFrame,Sub Frame,Fx\n,,N\n1,0,5\n\nTrajectories,,,,,\n100,,,,,\n"
                ",,Anna:Chin,,,Anna:*7,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n"
                "1,0,1,2,3,4,5,6\n2,0,,,,7,8,9\n,,,,,\n9,0,1,1,1,1,1,1\n");

    assert_string_equal(take->format, "nexus");
    assert_float_equal(take->rate_hz, 100, 1e-9);
    assert_int_equal(take->frame_count, 2);
    assert_int_equal(fap_take_find(take, "chin"), 0);
    assert_null(fap_take_sample(take, 1, 0));
    assert_sample(take, 1, 1, 7, 8, 9);
    fap_take_close(&take);
}

TEST(nexus, semicolons_and_decimal_commas_are_read)
{
    fap_take *take =
        read_ok("Trajectories\n100\n;;Chin;;\nFrame;Sub Frame;X;Y;Z\n;;m;m;m\n1;0;0,5;1,25;-2\n");

    assert_sample(take, 0, 0, 500, 1250, -2000);
    fap_take_close(&take);
}

#define MOTIVE_HEAD "Format Version,1.23,Export Frame Rate,120.0,Length Units,Centimeters\n\n"

TEST(motive, markers_are_kept_and_bodies_are_not)
{
    fap_take *take =
        read_ok(MOTIVE_HEAD
                ",Type,Rigid Body,Rigid Body,Rigid Body,Marker,Marker,Marker,Marker,Marker,Marker\n"
                ",Name,Head,Head,Head,Face:Chin,Face:Chin,Face:Chin,Unlabeled 9,Unlabeled 9,Unlabeled 9\n"
                ",ID,\"A\",\"A\",\"A\",\"B\",\"B\",\"B\",\"C\",\"C\",\"C\"\n"
                ",,Position,Position,Position,Position,Position,Position,Position,Position,Position\n"
                "Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z\n0,0.0,9,9,9,1,2,3,8,8,8\n1,0.0083,9,9,9,,,,8,8,8\n");

    assert_string_equal(take->format, "motive");
    assert_int_equal(take->point_count, 1);
    assert_string_equal(take->name[0], "Face:Chin");
    assert_sample(take, 0, 0, 10, 20, 30);
    assert_null(fap_take_sample(take, 1, 0));
    assert_float_equal(take->rate_hz, 120, 1e-9);
    fap_take_close(&take);
}

TEST(motive, a_time_code_column_is_in_nobodys_way)
{
    fap_take *take =
        read_ok(MOTIVE_HEAD ",,Type,Marker,Marker,Marker\n,,Name,A:Chin,A:Chin,A:Chin\n,,ID,1,1,1\n"
                            ",,,Position,Position,Position\nFrame,Time,TimeCode,X,Y,Z\n"
                            "0,0.0,10:20:30:01,1,2,3\n2,0.0167,10:20:30:03,1,2,3\n");

    assert_int_equal(take->point_count, 1);
    assert_int_equal(take->frame_count, 3);
    assert_sample(take, 0, 0, 10, 20, 30);
    assert_null(fap_take_sample(take, 1, 0)); /* a dropped frame */
    fap_take_close(&take);
}

TEST(motive, a_take_without_markers_says_so)
{
    assert_refused(MOTIVE_HEAD "Frame,Time,X,Y,Z\n0,0,1,2,3\n", FAP_E_NOT_FOUND, "Marker");
    assert_refused(
        MOTIVE_HEAD
        ",,Marker,Marker,Marker\n,,Unlabeled:1,Unlabeled:1,Unlabeled:1\n,,Position,Position,Position\n"
        "Frame,Time,X,Y,Z\n0,0,1,2,3\n",
        FAP_E_NOT_FOUND, "unlabeled");
}

TEST(table, columns_are_found_by_name_in_any_order_and_style)
{
    static const char *const texts[] = {
        ("\xef\xbb\xbf"
         "frame;8.3_x;8.3_y;8.3_z;note\n1;1,5;2;3;a\n2;NA;2;3;b\n"),
        "time,8.3.Z,8.3.X,8.3.Y\n0,3,1.5,2\n0.04,3,nan,2\n",
        "# made by hand\n\n8.3 X\t8.3 Y\t8.3 Z\n1.5\t2\t3\n-\t2\t3\n",
    };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        fap_take *take = read_ok(texts[i]);
        assert_string_equal(take->format, "table");
        assert_string_equal(take->name[0], "8.3");
        assert_int_equal(take->frame_count, 2);
        assert_float_equal(fap_take_sample(take, 0, 0)[0] / fap_take_sample(take, 0, 0)[2], 0.5, 1e-5);
        assert_null(fap_take_sample(take, 1, 0));
        assert_false(take->unit_known);
        fap_take_close(&take);
    }
}

TEST(table, times_give_the_rate)
{
    fap_take *take = read_ok("time_ms,a_x,a_y,a_z,b_x,b_y,b_z\n0,0,0,0,100,0,0\n33,0,0,0,100,0,0\n67,0,0,0,"
                             "100,0,0\n100,0,0,0,100,0,0\n");

    assert_float_equal(take->rate_hz, 30, 1e-6);
    assert_sample(take, 2, 1, 100, 0, 0); /* a table says missing by an empty cell, so 0,0,0 is a place */
    assert_sample(take, 2, 0, 0, 0, 0);
    fap_take_close(&take);
}

TEST(table, rows_without_numbers_are_placed_by_their_times)
{
    fap_take *take = read_ok("time,a_x,a_y,a_z\n0,1,2,3\n0.04,1,2,3\n0.08,1,2,3\n0.20,4,5,6\n0.24,1,2,3\n");

    assert_float_equal(take->rate_hz, 25, 1e-6);
    assert_int_equal(take->frame_count, 7);
    assert_string_equal(take->name[0], "a");
    assert_null(fap_take_sample(take, 3, 0));
    assert_non_null(fap_take_sample(take, 5, 0));
    assert_non_null(strstr(take->note[0], "leave out 2 frames"));
    fap_take_close(&take);
}

TEST(table, the_user_knows_rate_and_unit_better)
{
    static const char text[] = "a_x,a_y,a_z\n1,2,3\n4,5,6\n";
    fap_take_config cfg;
    fap_take *take;

    fap_take_config_init(&cfg);
    cfg.rate_hz = 48;
    cfg.mm_per_unit = 2;
    assert_int_equal(fap_take_read(&take, text, sizeof text - 1, &cfg, NULL), FAP_OK);
    assert_float_equal(take->rate_hz, 48, 0);
    assert_sample(take, 1, 0, 8, 10, 12);
    assert_true(take->unit_known);
    fap_take_close(&take);
}

TEST(take, a_head_whose_rate_the_times_deny_is_named)
{
    fap_take *take = read_ok("PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate\tUnits\n60\tmm\n"
                             "Frame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n1\t0.000\t1\t2\t3\n2\t0.005\t1\t2\t3\n");

    assert_float_equal(take->rate_hz, 60, 0);
    assert_non_null(strstr(take->note[0], "the times say 200"));
    fap_take_close(&take);
}

TEST(take, a_point_is_found_behind_its_subjects_name)
{
    fap_take *take =
        read_ok("Anna:Set 2:Chin_x,Anna:Set 2:Chin_y,Anna:Set 2:Chin_z,Nose_x,Nose_y,Nose_z\n1,2,3,4,5,6\n");

    assert_int_equal(fap_take_find(take, "chin"), 0);
    assert_int_equal(fap_take_find(take, "anna:set 2:chin"), 0);
    assert_int_equal(fap_take_find(take, "Anna:Nose"), -1);
    assert_int_equal(fap_take_find(take, "NOSE"), 1);
    fap_take_close(&take);
}

TEST(table, points_of_known_models_are_numbers_whatever_stands_in_front)
{
    test_bytes b = { 0 };
    char cell[64];
    fap_take *take;

    for (int i = 0; i < 68 * 3; i++)
        test_bytes_write(
            &b, cell,
            (size_t)snprintf(cell, sizeof cell, "%slandmark_%d_%c", i ? "," : "", i / 3, 'x' + i % 3));
    test_bytes_write(&b, "\n", 1);
    for (int i = 0; i < 68 * 3; i++)
        test_bytes_write(&b, cell, (size_t)snprintf(cell, sizeof cell, "%s%d", i ? "," : "", i));
    assert_int_equal(fap_take_read(&take, b.data, b.size, NULL, NULL), FAP_OK);
    assert_string_equal(take->name[0], "0");
    assert_string_equal(take->name[67], "67");
    fap_take_close(&take);
    free(b.data);
}

TEST(table, names_that_repeat_or_are_too_long_stay_apart)
{
    fap_take *take = read_ok("a_x,a_y,a_z,A_x,A_y,A_z\n1,2,3,4,5,6\n");

    assert_string_equal(take->name[0], "a");
    assert_string_equal(take->name[1], "A_2");
    assert_sample(take, 0, 0, 1 * (float)take->mm_per_unit, 2 * (float)take->mm_per_unit,
                  3 * (float)take->mm_per_unit);
    fap_take_close(&take);
}

/* An OpenFace export cut down to three points of 68, pixels beside millimetres. */
#define OPENFACE_HEAD                                                                                        \
    "frame, face_id, timestamp, confidence, success, x_8, X_8, X_67, Y_8, Y_67, Z_8, Z_67, AU01_r\n"

TEST(openface, millimetres_in_the_cameras_frame_become_the_heads)
{
    fap_take *take = read_ok(OPENFACE_HEAD "1, 0, 0.000, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n"
                                           "2, 0, 0.033, 0.20, 0, 300, 1, 2, 30, 4, 500, 6, 0\n"
                                           "3, 0, 0.067, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n"
                                           "4, 0, 0.100, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n");

    assert_string_equal(take->format, "openface");
    assert_int_equal(take->point_count, 2);
    assert_string_equal(take->name[0], "8");
    assert_sample(take, 0, 0, 1, -30, -500);
    assert_null(fap_take_sample(take, 1, 0)); /* the tracker does not trust it */
    assert_float_equal(take->rate_hz, 30, 1e-6);
    assert_true(take->unit_known);
    fap_take_close(&take);
}

TEST(openface, what_the_tracker_calls_a_failure_is_missing)
{
    fap_take *take = read_ok(OPENFACE_HEAD "1, 0, 0.000, 0.98, 0, 300, 1, 2, 30, 4, 500, 6, 0\n"
                                           "2, 0, 0.033, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n");

    assert_null(fap_take_sample(take, 0, 0));
    assert_non_null(fap_take_sample(take, 1, 0));
    fap_take_close(&take);
}

TEST(openface, of_several_faces_the_one_seen_most_is_taken)
{
    fap_take *take = read_ok(OPENFACE_HEAD "1, 0, 0.000, 0.98, 1, 0, 9, 9, 9, 9, 9, 9, 0\n"
                                           "1, 1, 0.000, 0.98, 1, 0, 1, 2, 3, 4, 5, 6, 0\n"
                                           "2, 1, 0.033, 0.98, 1, 0, 1, 2, 3, 4, 5, 6, 0\n"
                                           "3, 0, 0.0667, 0.98, 1, 0, 9, 9, 9, 9, 9, 9, 0\n"
                                           "3, 1, 0.0667, 0.98, 1, 0, 1, 2, 3, 4, 5, 6, 0\n");

    assert_int_equal(take->frame_count, 3);
    for (uint32_t f = 0; f < 3; f++)
        assert_sample(take, f, 0, 1, -3, -5);
    assert_float_equal(take->rate_hz, 30, 1e-6);
    assert_non_null(strstr(take->note[0], "2 faces"));
    fap_take_close(&take);
}

/* Eyes 60 mm apart; corners 30 mm; and X_67, by which the format is known. */
#define EYES_HEAD                                                                                            \
    "X_36,X_39,X_42,X_45,X_67,Y_36,Y_39,Y_42,Y_45,Y_67,Z_36,Z_39,Z_42,Z_45,Z_67,frame,timestamp,confidence," \
    "success"
#define EYES "-45,-15,15,45,0,0,0,0,0,60,500,500,500,500,500,"

static void assert_pupils(const fap_take *take, uint32_t frame, float x, float y)
{
    const int right = fap_take_find(take, "pupil_r"), left = fap_take_find(take, "pupil_l");

    assert_sample(take, frame, (uint32_t)right, -30 + x, y, -500 + sqrtf(144 - x * x - y * y));
    assert_sample(take, frame, (uint32_t)left, 30 + x, y, -500 + sqrtf(144 - x * x - y * y));
}

TEST(openface, where_the_eyes_look_becomes_pupils)
{
    static const char *const texts[] = {
        EYES_HEAD ",gaze_0_x,gaze_0_y,gaze_0_z,gaze_1_x,gaze_1_y,gaze_1_z\n" EYES
                  "1,0,1,1,0,0,-1,0,0,-1\n"                   /* into the camera */
        EYES "2,0.04,1,1,0.5,0,-0.8660254,0.5,0,-0.8660254\n" /* the picture's right, the subject's left */
        EYES "3,0.08,1,1,0,0.5,-0.8660254,0,0.5,-0.8660254\n" /* down */
        EYES "4,0.12,1,1,0,0,0,0,0,0\n",
        EYES_HEAD ",gaze_angle_x,gaze_angle_y\n" EYES "1,0,1,1,0,0\n" EYES "2,0.04,1,1,0.5235988,0\n" EYES
                  "3,0.08,1,1,0,0.5235988\n" EYES "4,0.12,1,1,,\n",
    };

    for (int i = 0; i < 2; i++) {
        fap_take *take = read_ok(texts[i]);
        assert_string_equal(take->format, "openface");
        assert_int_equal(take->point_count, 5 + 2);
        assert_pupils(take, 0, 0, 0);
        assert_pupils(take, 1, 6, 0);
        assert_pupils(take, 2, 0, -6);
        assert_null(fap_take_sample(take, 3, (uint32_t)fap_take_find(take, "pupil_l")));
        fap_take_close(&take);
    }
}

TEST(openface, gaze_beside_action_units_is_no_point)
{
    assert_refused(
        "frame,timestamp,confidence,success,gaze_0_x,gaze_0_y,gaze_0_z,gaze_1_x,gaze_1_y,gaze_1_z,AU01_r\n"
        "1,0,1,1,0,0,-1,0,0,-1,0.5\n",
        FAP_E_UNSUPPORTED, "action units");
}

TEST(openface, times_of_an_image_sequence_are_no_rate)
{
    fap_take *take = read_ok(OPENFACE_HEAD "1, 0, 0.001, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n"
                                           "2, 0, 0.002, 0.98, 1, 300, 1, 2, 30, 4, 500, 6, 0\n");

    assert_float_equal(take->rate_hz, 0, 0);
    fap_take_close(&take);
}

TEST(take, coefficients_are_named_for_what_they_are)
{
    assert_refused("Timecode,BlendShapeCount,EyeBlinkLeft\n00:00:00:01.0,61,0.5\n", FAP_E_UNSUPPORTED,
                   "ARKit");
    assert_refused("frame,confidence,AU01_r\n1,1,0.5\n", FAP_E_UNSUPPORTED, "action units");
}

TEST(table, picture_fractions_count_widths_and_heights)
{
    fap_take *take =
        read_ok("frame,image_width,image_height,x_0,y_0,z_0,x_1,y_1,z_1\n1,200,100,0,0,0,0.5,0.5,0.5\n");
    const float *a = fap_take_sample(take, 0, 0), *b = fap_take_sample(take, 0, 1);

    assert_float_equal((b[1] - a[1]) / (b[0] - a[0]), 0.5, 1e-5);
    fap_take_close(&take);
}

TEST(take, what_is_no_take_is_refused)
{
    assert_refused("", FAP_E_UNKNOWN_FORMAT, "C3D");
    assert_refused("hello\nworld\n", FAP_E_UNKNOWN_FORMAT, "C3D");
    assert_refused("2.1 test 25 1\n0 1\n", FAP_E_UNKNOWN_FORMAT, "TRC");
}

TEST(take, units_are_known_by_their_beginnings)
{
    assert_float_equal(fap_take_unit_mm("mm"), 1, 0);
    assert_float_equal(fap_take_unit_mm(" Meters"), 1000, 0);
    assert_float_equal(fap_take_unit_mm("mete"), 1000, 0);
    assert_float_equal(fap_take_unit_mm("m  "), 1000, 0);
    assert_float_equal(fap_take_unit_mm("Centimeters"), 10, 0);
    assert_float_equal(fap_take_unit_mm("deg"), 0, 0);
    assert_float_equal(fap_take_unit_mm(""), 0, 0);
}

TEST(take, sizes_that_cannot_be_are_refused_before_allocating)
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, FAP_TAKE_MAX_POINTS + 1, 1, NULL), FAP_E_LIMIT);
    assert_int_equal(fap_take_create(&take, 4096, UINT32_MAX, NULL), FAP_E_LIMIT);
    assert_int_equal(fap_take_create(&take, 0, 1, NULL), FAP_E_ARG);
    assert_null(take);
}

TEST(trc, a_head_that_counts_wrong_is_named)
{
    fap_take *take = read_ok(TRC_HEAD "\r\n1\t0.000\t1\t2\t3\t4\t5\t6\r\n");

    assert_int_equal(take->note_count, 2);
    assert_non_null(strstr(take->note[0], "announces 66 markers, line 4 names 2"));
    assert_non_null(strstr(take->note[1], "announces 3 frames, there are 1"));
    fap_take_close(&take);
}

/* What real files hold, what is wrong with them, and what is said about it: a piece of a note or of the error. */
static const struct real_file {
    const char *name;
    fap_err err;
    uint32_t points, frames;
    double rate_hz;
    const char *first, *says[3];
} real_files[] = {
    { "format_samples/10002-20130626160334-Unnamed.trc", FAP_E_NOT_FOUND, .says = { "names no marker" } },
    { "format_samples/Anto.trc", FAP_OK, 34, 128, 100, "R.Poignee", { NULL } },
    { "format_samples/Dance.c3d",
      FAP_OK,
      40,
      499,
      65.0533,
      "Channel101",
      { "past the end of their section", "header says 499 frames, POINT:FRAMES 500", "POINT:DATA_START 0" } },
    { "format_samples/Dec_real.c3d", FAP_OK, 36, 89, 50, "RFT1", { "75 labels for 36 points" } },
    { "format_samples/PiG_Calibration-FlatFoot-One.c3d",
      FAP_OK,
      112,
      1,
      100,
      "LFHD",
      { "139 parameters repeat", "26 points are angles" } },
    { "format_samples/T.trc", FAP_OK, 41, 89, 30, "RFHD", { NULL } },
    { "format_samples/TESTBPI.c3d", FAP_OK, 26, 450, 50, "RFT1", { "48 labels for 26 points" } },
    { "format_samples/Truncated.trc", FAP_E_SYNTAX, .says = { "ends inside its head" } },
    { "format_samples/bad_parameter_section.c3d",
      FAP_OK,
      45,
      332,
      120,
      "P1",
      { "into the data at byte 5632" } },
    { "format_samples/nexus_markers.csv", FAP_OK, 51, 580, 100, "boite:gauche_ext", { NULL } },
    { "format_samples/parameterOverflow.c3d", FAP_E_NOT_FOUND,
      .says = { "all 101 frames of all 106 points" } },
    { "format_samples/pc_int.c3d", FAP_OK, 36, 89, 50, "RFT1", { "75 labels for 36 points" } },
    { "format_samples/sample_optitrack_take.csv",
      FAP_OK,
      3,
      250,
      120,
      "Rigid Body 1:Marker1",
      { "6 unlabeled", "1 rigid bodies" } },
    { "format_samples/sgi_int.c3d",
      FAP_OK,
      36,
      89,
      50,
      "RFT1",
      { "75 labels for 36 points", "run on into the data" } },
    { "format_samples/shd01.c3d", FAP_OK, 27, 237, 250, "AbcdeFghijk:RASI", { NULL } },
    { "optical_animface/jaw_60hz.trc", FAP_OK, 41, 1590, 60, "ForeHead_M", { NULL } },
    { "optical_animface/jaw_60hz.c3d", FAP_OK, 41, 1590, 60, "ForeHead_M", { NULL } },
    { "optical_animface/eyebrows_60hz_int16.c3d", FAP_OK, 41, 902, 60, "ForeHead_M", { NULL } },
    { "optical_animface/eyebrows_60hz_nexus.csv", FAP_OK, 41, 902, 60, "Face:ForeHead_M", { NULL } },
    { "optical_blenderface/Subject_01.csv", FAP_OK, 16, 1714, 0, "CL7", { "no unit in the file" } },
    { "optical_blenderface/Blender_Scalingdata.csv", FAP_E_UNKNOWN_FORMAT, .says = { "neither C3D" } },
    { "openface/OpenFace_Test.csv", FAP_OK, 70, 100, 0, "0", { "image sequence without times" } },
    { "openface/openfacer_lara_0001-0600.csv", FAP_OK, 70, 600, 30, "0", { NULL } },
    { "openface/facsvatar_jt.csv", FAP_E_UNSUPPORTED, .says = { "action units" } },
    { "mediapipe/wolfgang_facemesh478_24fps.csv", FAP_OK, 478, 240, 23.976, "0", { "no unit in the file" } },
    { "mediapipe/face_noface_facemesh478.csv", FAP_OK, 478, 169, 26.3985, "0", { "no unit in the file" } },
    { "ema/F01_B01_S01_R01_N.mat", FAP_OK, 8, 262, 100, "TR", { NULL } },
    { "ema/ag501_0021.pos", FAP_OK, 8, 5021, 250, "Sensor1", { "8 of 16 channels", "have no names" } },
    { "livelink/alex_rom_3.csv", FAP_E_UNSUPPORTED, .says = { "ARKit" } },
    { "livelink/dao.gesichter", FAP_E_UNKNOWN_FORMAT, .says = { "neither C3D" } },
};

static int is_said(const fap_take *take, const char *where, const char *piece)
{
    int said = strstr(where, piece) != NULL;

    for (uint32_t i = 0; take && i < take->note_count; i++)
        said |= strstr(take->note[i], piece) != NULL;
    return said;
}

static void check_content(const struct real_file *f, const fap_take *take)
{
    if (take->point_count != f->points || take->frame_count != f->frames ||
        strcmp(take->name[0], f->first) != 0 || fabs(take->rate_hz - f->rate_hz) > 1e-4)
        fail_msg("%s: %u points, %u frames, %g Hz, %s first", f->name, take->point_count, take->frame_count,
                 take->rate_hz, take->name[0]);
}

TEST(take, every_real_file_reads_or_says_why_not_and_names_its_faults)
{
    for (size_t i = 0; i < sizeof real_files / sizeof *real_files; i++) {
        const struct real_file *f = &real_files[i];
        char where[FAP_ERROR_TEXT_SIZE];
        uint32_t expected = 0;
        fap_take *take;
        assert_int_equal(test_read_shared(&take, f->name, where), f->err);
        assert_true(take ? !*where : *where != 0);
        if (take)
            check_content(f, take);
        for (; expected < 3 && f->says[expected]; expected++)
            if (!is_said(take, where, f->says[expected]))
                fail_msg("%s: nothing says '%s'", f->name, f->says[expected]);
        if (take && take->note_count != expected)
            fail_msg("%s: %u notes, %u expected; the last: %s", f->name, take->note_count, expected,
                     take->note[take->note_count - 1]);
        fap_take_close(&take);
    }
}

TEST(take, the_same_motion_is_the_same_in_every_format)
{
    fap_take *a, *b;

    assert_int_equal(test_read_shared(&a, "optical_animface/jaw_60hz.c3d", NULL), FAP_OK);
    assert_int_equal(test_read_shared(&b, "optical_animface/jaw_60hz.trc", NULL), FAP_OK);
    for (size_t i = 0; i < (size_t)a->point_count * a->frame_count; i++)
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(a->xyz[i][axis], b->xyz[i][axis], 2e-4);
    fap_take_close(&a);
    fap_take_close(&b);
}
