/* SPDX-License-Identifier: BSD-2-Clause */
/* The many shapes in which landmarks come as JSON give one take; what is missing or damaged is said. */
#include "take/take_test.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static fap_take *read_ok(const char *text)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    if (test_read_text(&take, text, where) != FAP_OK)
        fail_msg("%s", where);
    assert_string_equal(take->format, "landmarks JSON");
    return take;
}

static int has_note(const fap_take *take, const char *word)
{
    for (uint32_t i = 0; i < take->note_count; i++)
        if (strstr(take->note[i], word))
            return 1;
    return 0;
}

/* x to y of a frame's second point, from its first: the unit of these files is not known. */
static float slope(const fap_take *take, uint32_t frame)
{
    const float *a = fap_take_sample(take, frame, 0), *b = fap_take_sample(take, frame, 1);

    assert_non_null(a);
    assert_non_null(b);
    return (b[1] - a[1]) / (b[0] - a[0]);
}

#define FACE "[{\"x\":0.0,\"y\":0,\"z\":0},{\"x\":0.5,\"y\":0.25,\"z\":1e-1,\"visibility\":0}]"

TEST(landmarks, every_shape_of_file_gives_the_same_take)
{
    static const char *const texts[] = {
        "[" FACE "," FACE ",[]]",                                     /* frames of points */
        "[[" FACE "],[" FACE "," FACE "],[]]",                        /* frames of faces */
        "[[[0,0,0],[0.5,0.25,0.1]],[[0,0,0],[0.5,0.25,0.1,0.9]],[]]", /* bare numbers */
        "{\"fps\":30,\"frames\":[{\"timestamp\":0,\"landmarks\":" FACE
        "},{\"timestamp\":0.033,\"landmarks\":" FACE "},{\"timestamp\":0.067,\"landmarks\":null}]}",
        "\xef\xbb\xbf[{\"faceLandmarks\":[" FACE "],\"faceBlendshapes\":[{\"categories\":[{\"score\":1}]}]},"
        "{\"faceLandmarks\":[" FACE "]},{\"faceLandmarks\":[]}]",
        "{\"results\":[{\"face_landmarks\":[" FACE "]},{\"face_landmarks\":[" FACE
        "]},{\"face_landmarks\":[]}]}",
        "[{\"multi_face_landmarks\":[{\"landmark\":" FACE "}]},{\"multi_face_landmarks\":[{\"landmark\":" FACE
        "}]},{\"multi_face_landmarks\":null}]",
        "{\"t\":0,\"landmarks\":" FACE "}\n{\"t\":33,\"landmarks\":" FACE "}\n{\"t\":67,\"landmarks\":[]}\n",
        "[{\"keypoints\":" FACE "},{\"keypoints\":" FACE "},{\"keypoints\":[]}]",
    };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        fap_take *take = read_ok(texts[i]);
        assert_int_equal(take->point_count, 2);
        assert_int_equal(take->frame_count, 3);
        assert_string_equal(take->name[1], "1");
        assert_float_equal(slope(take, 0), 0.5, 1e-5);
        assert_float_equal(slope(take, 1), 0.5, 1e-5);
        assert_null(fap_take_sample(take, 2, 1));
        assert_false(take->unit_known);
        fap_take_close(&take);
    }
}

#define AT(time)         "{\"time\":" time ",\"landmarks\":" FACE "}"
#define NUMBERED(number) "{\"frame\":" number ",\"landmarks\":" FACE "}"

TEST(landmarks, times_give_the_rate_whatever_their_unit)
{
    static const char *const texts[] = {
        "{\"frames\":[" AT("5.0") "," AT("5.033") "," AT("5.067") "," AT("5.1") "]}",
        "{\"frames\":[" AT("0") "," AT("33") "," AT("67") "," AT("100") "]}",
        "[" AT("0") "," AT("33333") "," AT("66667") "," AT("100000") "]",
    };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        fap_take *take = read_ok(texts[i]);
        assert_float_equal(take->rate_hz, 30, 1e-6);
        assert_int_equal(take->frame_count, 4);
        fap_take_close(&take);
    }
}

TEST(landmarks, frames_that_were_left_out_are_gaps)
{
    fap_take *take = read_ok("[" AT("0") "," AT("40") "," AT("80") "," AT("200") "," AT("240") "]");

    assert_int_equal(take->frame_count, 7);
    assert_float_equal(take->rate_hz, 25, 1e-6);
    assert_null(fap_take_sample(take, 3, 0));
    assert_non_null(fap_take_sample(take, 5, 0));
    assert_true(has_note(take, "leave out 2 frames"));
    assert_string_equal(take->name[1], "1");
    fap_take_close(&take);

    take = read_ok("{\"fps\":50,\"frames\":[" NUMBERED("2") "," NUMBERED("4") "," NUMBERED("8") "]}");
    assert_int_equal(take->frame_count, 4);
    assert_float_equal(take->rate_hz, 25, 1e-6);
    assert_null(fap_take_sample(take, 2, 0));
    fap_take_close(&take);
}

TEST(landmarks, a_rate_that_its_times_deny_is_named)
{
    fap_take *take = read_ok("{\"fps\":30,\"frames\":[" AT("0") "," AT("40") "," AT("80") "]}");

    assert_float_equal(take->rate_hz, 25, 1e-6);
    assert_true(has_note(take, "says 30"));
    fap_take_close(&take);
}

TEST(landmarks, times_that_run_back_say_nothing)
{
    fap_take *take = read_ok("[" AT("0") "," AT("80") "," AT("40") "]");

    assert_float_equal(take->rate_hz, 0, 0);
    assert_int_equal(take->frame_count, 3);
    fap_take_close(&take);
}

/* --- 468 points in a picture --- */

static void put(test_bytes *b, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
static void put(test_bytes *b, const char *fmt, ...)
{
    char text[256];
    va_list args;

    va_start(args, fmt);
    const int n = vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    test_bytes_write(b, text, (size_t)n);
}

enum { EYE_A = 33, EYE_B = 263, TOP = 10, LOW = 2 };

/* A face as a picture of this shape shows it: eyes 0.2 widths apart, the nose's end 1.14 times that below the forehead. */
static void put_face(test_bytes *b, double height_per_width)
{
    for (int i = 0; i < 468; i++) {
        const double x = i == EYE_A ? 0.4 : i == EYE_B ? 0.6 : 0.5;
        const double y = (i == TOP ? 0 : i == LOW ? 0.228 : 0.1) / height_per_width;
        put(b, "%s{\"x\":%.6f,\"y\":%.6f,\"z\":0}", i ? "," : "", x, y);
    }
}

static fap_take *read_face(double height_per_width, const char *facts)
{
    test_bytes b = { 0 };

    put(&b, "{%s\"frames\":[{\"landmarks\":[", facts);
    put_face(&b, height_per_width);
    put(&b, "]}]}");
    test_bytes_write(&b, "", 1);
    fap_take *take = read_ok((const char *)b.data);
    free(b.data);
    return take;
}

static double face_height(const fap_take *take)
{
    const float *top = fap_take_sample(take, 0, TOP), *low = fap_take_sample(take, 0, LOW);
    const float *a = fap_take_sample(take, 0, EYE_A), *b = fap_take_sample(take, 0, EYE_B);

    return (double)((low[1] - top[1]) / (b[0] - a[0]));
}

TEST(landmarks, the_pictures_shape_is_read_or_seen_in_the_face)
{
    static const double shapes[] = { 9. / 16, 3. / 4, 1, 4. / 3, 16. / 9 };

    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        fap_take *take = read_face(shapes[i], "");
        assert_float_equal(face_height(take), 1.14, 1e-3);
        assert_true(has_note(take, "picture's size"));
        fap_take_close(&take);
    }
    fap_take *take = read_face(1, "\"image_width\":200,\"image_height\":100,");
    assert_float_equal(face_height(take), 0.57, 1e-3);
    assert_false(has_note(take, "picture's size"));
    fap_take_close(&take);
}

/* --- damage --- */

TEST(landmarks, a_file_cut_anywhere_keeps_what_is_whole)
{
    static const char text[] = "{\"frames\":[" AT("0") "," AT("40") "," AT("80") "]}";

    for (size_t size = 0; size < sizeof text; size++) {
        char where[FAP_ERROR_TEXT_SIZE];
        fap_take *take;
        const fap_err err = fap_take_read(&take, text, size, NULL, where);
        assert_true(take ? err == FAP_OK && !*where : err != FAP_OK && *where);
        if (size > sizeof text / 2)
            assert_true(take && (size >= sizeof text - 1 || has_note(take, "breaks off")));
        fap_take_close(&take);
    }
}

TEST(landmarks, what_is_no_landmark_file_says_what_was_looked_for)
{
    static const char *const texts[] = { "{\"landmarks\":[]}", "[[[]]]", "{\"x\":1}", "[[[\"a\"]]]",
                                         "{\"frames\":[{\"landmarks\":{\"nose\":1}}]}" };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char where[FAP_ERROR_TEXT_SIZE];
        fap_take *take;
        assert_int_equal(test_read_text(&take, texts[i], where), FAP_E_NOT_FOUND);
        if (!strstr(where, "andmarks"))
            fail_msg("%s: %s", texts[i], where);
    }
}

TEST(landmarks, points_without_numbers_are_missing)
{
    fap_take *take =
        read_ok("[[{\"x\":NaN,\"y\":0,\"z\":0},{\"x\":1,\"y\":2},{\"x\":null,\"y\":2,\"z\":1},[1,2,3]]]");

    assert_int_equal(take->point_count, 4);
    assert_null(fap_take_sample(take, 0, 0));
    assert_non_null(fap_take_sample(take, 0, 1));
    assert_null(fap_take_sample(take, 0, 2));
    assert_non_null(fap_take_sample(take, 0, 3));
    assert_true(has_note(take, "no z"));
    fap_take_close(&take);
}

/* --- real landmarks --- */

/* A shared CSV again as JSON, with or without the picture's size, each coordinate as it was. */
static void csv_to_json(const char *csv, test_bytes *out)
{
    char line[64 << 10];
    size_t at = strcspn(csv, "\n") + 1;
    int row = 0;

    put(out, "[");
    for (; csv[at]; at += strcspn(csv + at, "\n") + 1) {
        const size_t n = strcspn(csv + at, "\r\n");
        assert_true(n < sizeof line);
        memcpy(line, csv + at, n);
        line[n] = '\0';
        const char *cell = line;
        put(out, "%s{\"landmarks\":[", row++ ? ",\n" : "");
        for (int column = 0; column < 4 + 3 * 478; column++) {
            const size_t length = strcspn(cell, ",");
            if (column >= 4 && length)
                put(out, "%s%.*s", column == 4 ? "[" : (column - 4) % 3 ? "," : "],[", (int)length, cell);
            cell += length + (cell[length] == ',');
        }
        put(out, out->data[out->size - 1] == '[' ? "],\"time_ms\":%.*s}" : "]],\"time_ms\":%.*s}",
            (int)strcspn(strchr(line, ',') + 1, ","), strchr(line, ',') + 1);
    }
    put(out, "]");
}

TEST(landmarks, a_real_table_and_its_json_are_the_same_take)
{
    static const char *const files[] = { "data/takes/mediapipe/wolfgang_facemesh478_24fps.csv",
                                         "data/takes/mediapipe/face_noface_facemesh478.csv" };

    for (int i = 0; i < 2; i++) {
        test_bytes json = { 0 };
        fap_take *a, *b;
        uint8_t *csv;
        size_t size;
        assert_int_equal(file_read(test_shared(files[i]), 64 << 20, &csv, &size), FAP_OK);
        char *text = malloc(size + 1);
        assert_non_null(text);
        memcpy(text, csv, size);
        text[size] = '\0';
        csv_to_json(text, &json);
        assert_int_equal(fap_take_read(&a, csv, size, NULL, NULL), FAP_OK);
        assert_int_equal(fap_take_read(&b, json.data, json.size, NULL, NULL), FAP_OK);
        assert_string_equal(b->format, "landmarks JSON");
        assert_int_equal(a->frame_count, b->frame_count);
        assert_int_equal(a->point_count, b->point_count);
        assert_float_equal(a->rate_hz, b->rate_hz, 1e-6);
        assert_true(has_note(b, "16:9"));
        for (size_t k = 0; k < (size_t)a->point_count * a->frame_count; k++) {
            assert_int_equal(a->valid[k], b->valid[k]);
            assert_float_equal(a->xyz[k][1], b->xyz[k][1], 1e-3);
        }
        fap_take_close(&a);
        fap_take_close(&b);
        free(json.data);
        free(text);
        free(csv);
    }
}
