/* SPDX-License-Identifier: BSD-2-Clause */
/* Coefficient files: names however they are spelt, clocks however they count, and what is cut, foreign or made up. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/coefficients.h>

static fap_coefficients *read_bytes(const void *data, size_t size, double user_hz)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take_config cfg;
    fap_coefficients *take;

    fap_take_config_init(&cfg);
    cfg.rate_hz = user_hz;
    if (fap_coefficients_read(&take, data, size, &cfg, where) != FAP_OK)
        fail_msg("%s", where);
    return take;
}

static fap_coefficients *read_ok(const char *text)
{
    return read_bytes(text, strlen(text), 0);
}

static void assert_refused(const char *text, fap_err err, const char *word)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_coefficients *take;

    assert_int_equal(fap_coefficients_read(&take, text, strlen(text), NULL, where), err);
    assert_null(take);
    if (!strstr(where, word))
        fail_msg("'%s' does not say '%s'", where, word);
}

static void assert_note(const fap_coefficients *take, const char *word)
{
    for (uint32_t i = 0; i < take->note_count; i++)
        if (strstr(take->note[i], word))
            return;
    fail_msg("no note says '%s'", word);
}

static float value_of(const fap_coefficients *take, uint32_t frame, int channel)
{
    const int column = fap_coefficients_find(take, channel);

    assert_true(column >= 0);
    assert_true(frame < take->frame_count);
    const size_t i = (size_t)frame * take->channel_count + (size_t)column;
    assert_true(take->valid[i]);
    return take->value[i];
}

static int is_missing(const fap_coefficients *take, uint32_t frame)
{
    return !take->valid[(size_t)frame * take->channel_count];
}

static int shape(const char *name)
{
    const int s = fap_arkit_by_name(name);
    assert_true(s >= 0);
    return s;
}

/* Read, whole or refused, and never more than that: every length of it. */
static void assert_survives_every_cut(const void *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];

    for (size_t n = 0; n < size; n++) {
        uint8_t *cut = malloc(n ? n : 1);
        fap_coefficients *take;
        assert_non_null(cut);
        memcpy(cut, data, n);
        const fap_err err = fap_coefficients_read(&take, cut, n, NULL, where);
        assert_int_equal(err == FAP_OK, take != NULL);
        fap_coefficients_close(&take);
        free(cut);
    }
}

/* --- tables --- */

#define NAMES "EyeBlinkLeft,JawOpen,MouthClose,MouthSmileLeft,MouthSmileRight,TongueOut"
#define HEAD  "Timecode,BlendShapeCount," NAMES "\n"

TEST(livelink, columns_are_found_by_name_however_it_is_spelt)
{
    fap_coefficients *take = read_ok(
        "Timecode,BlendshapeCount,Angry,jawOpen,eyeBlink_L,EyeBlink_R,mouth_smile_left,face:BROWINNERUP,"
        "noseSneerRight,HeadYaw\r\n01:00:00:00.000,68,9,0.25,1,2,3,4,0.5,-0.75\r\n");

    assert_string_equal(take->format, "livelink");
    assert_int_equal(take->channel_count, 7);
    assert_float_equal(value_of(take, 0, shape("JawOpen")), 0.25, 1e-6);
    assert_float_equal(value_of(take, 0, shape("EyeBlinkLeft")), 1, 1e-6);
    assert_float_equal(value_of(take, 0, shape("EyeBlinkRight")), 2, 1e-6);
    assert_float_equal(value_of(take, 0, shape("MouthSmileLeft")), 3, 1e-6);
    assert_float_equal(value_of(take, 0, shape("BrowInnerUp")), 4, 1e-6);
    assert_float_equal(value_of(take, 0, FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_YAW), -0.75, 1e-6);
    assert_note(take, "Angry");
    fap_coefficients_close(&take);
}

TEST(livelink, mediapipes_table_is_one)
{
    fap_coefficients *take = read_ok(
        "time_ms,_neutral,browDownLeft,browDownRight,browInnerUp,browOuterUpLeft,browOuterUpRight,cheekPuff\n"
        "0,0.9,0.1,0.2,0.3,0.4,0.5,0.6\n40,0.9,0.1,0.2,0.3,0.4,0.5,0.7\n80,0.9,0.1,0.2,0.3,0.4,0.5,0.8\n");

    assert_float_equal(take->rate_hz, 25, 1e-9);
    assert_int_equal(take->channel_count, 6);
    assert_int_equal(take->note_count, 0); /* _neutral needs no words */
    assert_float_equal(value_of(take, 2, shape("CheekPuff")), 0.8, 1e-6);
    fap_coefficients_close(&take);
}

TEST(livelink, the_end_of_a_second_says_what_the_time_code_counts_in)
{
    fap_coefficients *sixty = read_ok(
        HEAD "13:00:00:56.5,61,0,0,0,0,0,0\n13:00:00:58.5,61,0,0,0,0,0,0\n13:00:01:00.5,61,0,0,0,0,0,0\n");
    fap_coefficients *thirty = read_ok(
        HEAD "13:00:00:28.0,61,0,0,0,0,0,0\n13:00:00:29.0,61,0,0,0,0,0,0\n13:00:01:00.0,61,0,0,0,0,0,0\n");
    fap_coefficients *fifty = read_ok(
        HEAD "13:00:00:48.0,61,0,0,0,0,0,0\n13:00:00:49.0,61,0,0,0,0,0,0\n13:00:01:00.0,61,0,0,0,0,0,0\n");

    assert_float_equal(sixty->rate_hz, 30, 1e-6); /* every second frame of sixty */
    assert_float_equal(thirty->rate_hz, 30, 1e-6);
    assert_float_equal(fifty->rate_hz, 50, 1e-6);
    assert_float_equal(sixty->start_s, 13 * 3600 + 56.5 / 60, 1e-6);
    assert_int_equal(sixty->note_count + thirty->note_count + fifty->note_count, 0);
    fap_coefficients_close(&sixty);
    fap_coefficients_close(&thirty);
    fap_coefficients_close(&fifty);
}

TEST(livelink, a_base_that_no_second_confirms_is_said_to_be_a_guess)
{
    fap_coefficients *take = read_ok(HEAD "13:00:00:31.0,61,0,0,0,0,0,0\n13:00:00:33.0,61,0,0,0,0,0,0\n");

    assert_float_equal(take->rate_hz, 30, 1e-6);
    assert_note(take, "guess");
    fap_coefficients_close(&take);
}

TEST(livelink, dropped_rows_are_gaps_and_midnight_is_no_end)
{
    fap_coefficients *take = read_ok(HEAD "23:59:59:56.0,61,0,0.1,0,0,0,0\n23:59:59:58.0,61,0,0.2,0,0,0,0\n"
                                          "00:00:00:00.0,61,0,0.3,0,0,0,0\n00:00:00:06.0,61,0,0.4,0,0,0,0\n");

    assert_int_equal(take->frame_count, 6);
    assert_float_equal(value_of(take, 2, shape("JawOpen")), 0.3, 1e-6);
    assert_true(is_missing(take, 3));
    assert_true(is_missing(take, 4));
    assert_float_equal(value_of(take, 5, shape("JawOpen")), 0.4, 1e-6);
    assert_float_equal(take->rate_hz, 30, 1e-6);
    assert_note(take, "2 of 6 frames are absent");
    fap_coefficients_close(&take);
}

TEST(livelink, a_camera_that_runs_slow_has_its_own_rate)
{
    char text[8192] = HEAD;

    for (int i = 0; i < 121; i++) {
        const double t = i * 1.0016;
        const int s = (int)(t / 60);
        snprintf(text + strlen(text), 64, "10:00:%02d:%06.3f,61,0,0,0,0,0,0\n", s, t - 60 * s);
    }
    fap_coefficients *take = read_ok(text);
    assert_int_equal(take->frame_count, 121);
    assert_float_equal(take->rate_hz, 60 / 1.0016, 1e-3);
    fap_coefficients_close(&take);
}

TEST(livelink, seconds_with_a_point_are_times_and_numbers_are_frames)
{
    fap_coefficients *times = read_ok(HEAD "10:00:00.000,61,0,0,0,0,0,0\n10:00:00.040,61,0,0,0,0,0,0\n"
                                           "10:00:00.080,61,0,0,0,0,0,0\n");
    fap_coefficients *frames = read_ok(HEAD "100,61,0,0,0,0,0,0\n101,61,0,0,0,0,0,0\n104,61,0,0,0,0,0,0\n");

    assert_float_equal(times->rate_hz, 25, 1e-6);
    assert_float_equal(frames->rate_hz, 0, 0);
    assert_int_equal(frames->frame_count, 5);
    fap_coefficients_close(&times);
    fap_coefficients_close(&frames);
}

TEST(livelink, the_users_rate_wins_and_rows_stay_where_they_are)
{
    const char text[] =
        HEAD "13:00:00:31.0,61,0,0,0,0,0,0\n13:00:00:33.0,61,0,0,0,0,0,0\n13:00:00:37.0,61,0,0,0,0,0,0\n";
    fap_coefficients *take = read_bytes(text, strlen(text), 24);

    assert_float_equal(take->rate_hz, 24, 0);
    assert_int_equal(take->frame_count, 4);
    fap_coefficients_close(&take);
}

TEST(livelink, times_that_do_not_rise_are_no_times)
{
    fap_coefficients *take = read_ok("time," NAMES "\n5,0,0.1,0,0,0,0\n5,0,0.2,0,0,0,0\n5,0,0.3,0,0,0,0\n");
    fap_coefficients *pictures =
        read_ok("time," NAMES "\n0.001,0,0.1,0,0,0,0\n0.002,0,0.2,0,0,0,0\n0.003,0,0.3,0,0,0,0\n");

    assert_float_equal(take->rate_hz, 0, 0);
    assert_int_equal(take->frame_count, 3);
    assert_note(take, "do not rise");
    assert_float_equal(pictures->rate_hz, 0, 0);
    assert_note(pictures, "pictures");
    fap_coefficients_close(&take);
    fap_coefficients_close(&pictures);
}

TEST(livelink, a_row_that_goes_back_is_left_out)
{
    fap_coefficients *take =
        read_ok("time," NAMES "\n0,0,0.1,0,0,0,0\n0.1,0,0.2,0,0,0,0\n0.05,0,0.9,0,0,0,0\n0.2,0,0.3,0,0,0,0\n"
                "0.3,0,0.4,0,0,0,0\n0.4,0,0.5,0,0,0,0\n");

    assert_int_equal(take->frame_count, 5);
    assert_float_equal(value_of(take, 2, shape("JawOpen")), 0.3, 1e-6);
    assert_note(take, "not later");
    fap_coefficients_close(&take);
}

TEST(livelink, values_stay_as_they_are_and_what_is_none_is_missing)
{
    fap_coefficients *take = read_ok(
        HEAD "13:00:00:00.0,61,-0.5,1.0533,nan,,1e9,0\n13:00:00:02.0,61,0.1\n13:00:00:04.0,61,0,1,0,0,0,0\n");
    const uint8_t *valid = take->valid;

    assert_float_equal(value_of(take, 0, shape("EyeBlinkLeft")), -0.5, 1e-6);
    assert_float_equal(value_of(take, 0, shape("JawOpen")), 1.0533, 1e-6);
    assert_false(valid[2] || valid[3] || valid[4]);
    assert_false(valid[take->channel_count + 1]); /* a row that breaks off */
    fap_coefficients_close(&take);
}

TEST(livelink, percent_is_told_from_shares)
{
    fap_coefficients *take =
        read_ok("frame\t"
                "EyeBlinkLeft\tJawOpen\tMouthClose\tMouthSmileLeft\tMouthSmileRight\tTongueOut\n"
                "1\t100\t50\t0\t0\t0\t0\n");

    assert_float_equal(value_of(take, 0, shape("JawOpen")), 0.5, 1e-6);
    assert_note(take, "percent");
    fap_coefficients_close(&take);
}

TEST(livelink, nonsense_is_refused_in_words)
{
    assert_refused("hello\n", FAP_E_UNKNOWN_FORMAT, "neither");
    assert_refused("", FAP_E_UNKNOWN_FORMAT, "neither");
    assert_refused("Timecode,JawOpen\n1,2\n", FAP_E_UNKNOWN_FORMAT, "neither");
    assert_refused(HEAD, FAP_E_NOT_FOUND, "not one row");
    assert_refused("time," NAMES "\n0,0,0,0,0,0,0\n0.01,0,0,0,0,0,0\n1e9,0,0,0,0,0,0\n", FAP_E_LIMIT, "span");
}

TEST(livelink, any_cut_is_read_or_refused)
{
    const char text[] = HEAD "23:59:59:56.0,61,0,0.1,0,0,0,0\n00:00:00:00.0,61,0,0.3,0,0,0,0\n";

    assert_survives_every_cut(text, sizeof text - 1);
}

TEST(livelink, what_is_written_reads_back)
{
    test_bytes bytes = { 0 };
    const fap_writer out = test_bytes_writer(&bytes);
    fap_coefficients *take;

    assert_int_equal(fap_coefficients_create(&take, 2, 100, NULL), FAP_OK);
    take->channel[0] = (uint8_t)shape("JawOpen");
    take->channel[1] = FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_PITCH;
    assert_int_equal(fap_coefficients_write_livelink(take, &out), FAP_E_ARG);
    take->rate_hz = 25;
    take->start_s = 86399;
    for (uint32_t i = 0; i < 200; i++) {
        take->value[i] = (float)i / 200 - 0.5f;
        take->valid[i] = i / 2 != 50;
    }
    assert_int_equal(fap_coefficients_write_livelink(take, &out), FAP_OK);
    fap_coefficients *back = read_bytes(bytes.data, bytes.size, 0);
    assert_int_equal(back->frame_count, 100);
    assert_int_equal(back->channel_count, 61);
    assert_float_equal(back->rate_hz, 25, 1e-3);
    assert_float_equal(back->start_s, 86399, 1e-3);
    assert_true(is_missing(back, 50));
    assert_float_equal(value_of(back, 99, shape("JawOpen")), 0.49, 1e-5);
    assert_float_equal(value_of(back, 0, FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_PITCH), -0.495, 1e-5);
    fap_coefficients_close(&take);
    fap_coefficients_close(&back);
    free(bytes.data);
}

/* --- packets --- */

enum { PACKET_MAX = 512 };

typedef struct packet {
    uint8_t data[PACKET_MAX];
    size_t size;
} packet;

static void put32(packet *p, uint32_t v)
{
    for (int i = 3; i >= 0; i--)
        p->data[p->size++] = (uint8_t)(v >> 8 * i);
}

static void put_float(packet *p, float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    put32(p, bits);
}

static void put_name(packet *p, const char *name)
{
    put32(p, (uint32_t)strlen(name));
    memcpy(p->data + p->size, name, strlen(name));
    p->size += strlen(name);
}

static packet make_packet(const char *subject, uint32_t frame, float jaw)
{
    packet p = { .data = { 6 }, .size = 1 };

    put_name(&p, "DEVICE");
    put_name(&p, subject);
    put32(&p, frame);
    put_float(&p, 0.25f);
    put32(&p, 60);
    put32(&p, 1);
    p.data[p.size++] = 61;
    for (int i = 0; i < 61; i++)
        put_float(&p, i == shape("JawOpen") ? jaw : 0);
    return p;
}

static void append(test_bytes *b, const packet *p)
{
    test_bytes_write(b, p->data, p->size);
}

static void append_length(test_bytes *b, size_t size)
{
    packet p = { .size = 0 };

    put32(&p, (uint32_t)size);
    append(b, &p);
}

/* Frames 100, 101 and 103; the counted kind has a head as well. */
static test_bytes recording(int lengths, int counted)
{
    static const uint32_t frames[] = { 100, 101, 103 };
    test_bytes b = { 0 };

    if (counted) {
        test_bytes_write(&b, "\6", 1);
        append_length(&b, 3);
    }
    for (int i = 0; i < 3; i++) {
        const packet p = make_packet("ANNA", frames[i], (float)i / 4);
        if (lengths)
            append_length(&b, p.size);
        append(&b, &p);
    }
    return b;
}

static void assert_is_recording(const fap_coefficients *take)
{
    assert_string_equal(take->format, "livelink packets");
    assert_int_equal(take->frame_count, 4);
    assert_float_equal(take->rate_hz, 60, 1e-6);
    assert_float_equal(value_of(take, 1, shape("JawOpen")), 0.25, 0);
    assert_true(is_missing(take, 2));
    assert_float_equal(value_of(take, 3, shape("JawOpen")), 0.5, 0);
}

TEST(packets, come_plain_behind_lengths_and_behind_a_count)
{
    for (int kind = 0; kind < 3; kind++) {
        test_bytes b = recording(kind > 0, kind > 1);
        fap_coefficients *take = read_bytes(b.data, b.size, 0);
        assert_is_recording(take);
        fap_coefficients_close(&take);
        free(b.data);
    }
}

static void append_pcap(test_bytes *b, const packet *p)
{
    const uint32_t size = (uint32_t)(14 + 20 + 8 + p->size);
    uint8_t head[16 + 42] = { 0 };

    memcpy(head + 8, &size, 4);
    memcpy(head + 12, &size, 4);
    head[16 + 14] = 0x45;
    head[16 + 14 + 9] = 17;
    test_bytes_write(b, head, sizeof head);
    append(b, p);
}

TEST(packets, come_as_pcap)
{
    static const uint32_t frames[] = { 100, 101, 103 };
    const uint32_t head[6] = { 0xa1b2c3d4, 0x00040002, 0, 0, 65535, 1 };
    test_bytes b = { 0 };

    test_bytes_write(&b, head, sizeof head);
    for (int i = 0; i < 3; i++) {
        const packet p = make_packet("ANNA", frames[i], (float)i / 4);
        append_pcap(&b, &p);
    }
    fap_coefficients *take = read_bytes(b.data, b.size, 0);
    assert_is_recording(take);
    fap_coefficients_close(&take);
    assert_survives_every_cut(b.data, b.size);
    free(b.data);
}

TEST(packets, of_somebody_else_are_left_out)
{
    test_bytes b = recording(0, 0);
    const packet other = make_packet("BERT", 102, 1);

    append(&b, &other);
    fap_coefficients *take = read_bytes(b.data, b.size, 0);
    assert_is_recording(take);
    assert_note(take, "another device");
    fap_coefficients_close(&take);
    free(b.data);
}

TEST(packets, what_lies_between_them_is_passed_over)
{
    test_bytes b = { 0 };

    for (uint32_t i = 0; i < 4; i++) {
        const packet p = make_packet("ANNA", 100 + i, 0.5f);
        append(&b, &p);
        test_bytes_write(&b, "\6\0\0\1junk", 8);
    }
    fap_coefficients *take = read_bytes(b.data, b.size, 0);
    assert_int_equal(take->frame_count, 4);
    assert_note(take, "passed over");
    fap_coefficients_close(&take);
    free(b.data);
}

TEST(packets, any_cut_is_read_or_refused)
{
    test_bytes b = recording(1, 1);

    assert_survives_every_cut(b.data, b.size);
    free(b.data);
}

/* --- action units --- */

#define UNITS                                                                                                \
    "frame, timestamp, confidence, success, pose_Rx, pose_Ry, pose_Rz, gaze_angle_x, gaze_angle_y, AU01_r, " \
    "AU12_r, AU45_r, AU28_c"

static int unit(int number)
{
    return FAP_CHANNEL_AU + number;
}

TEST(openface, intensities_are_shares_of_five)
{
    fap_coefficients *take = read_ok(UNITS "\n1, 0.000, 0.98, 1, 0, 0, 0, 0, 0, 2.50, 5.00, 3.20, 1\n"
                                           "2, 0.033, 0.98, 1, 0, 0, 0, 0, 0, 0.00, 1.00, 0.00, 0\n");

    assert_string_equal(take->format, "openface units");
    assert_float_equal(value_of(take, 0, unit(1)), 0.5, 1e-6);
    assert_float_equal(value_of(take, 0, unit(12)), 1, 1e-6);
    assert_float_equal(value_of(take, 0, unit(45)), 1, 1e-6); /* a blink, so the lids are shut */
    assert_float_equal(value_of(take, 0, unit(28)), 0.5, 1e-6);
    assert_float_equal(value_of(take, 1, unit(12)), 0.2, 1e-6);
    fap_coefficients_close(&take);
}

TEST(openface, intensities_that_were_divided_are_left_alone)
{
    fap_coefficients *take = read_ok(
        "frame,timestamp,confidence,success,AU01_r,AU12_r\n0,0,0.98,1,0.424,0.006\n1,0.04,0.98,1,1,0\n");

    assert_float_equal(value_of(take, 0, unit(1)), 0.424, 1e-6);
    assert_float_equal(value_of(take, 1, unit(1)), 1, 1e-6);
    assert_float_equal(take->rate_hz, 25, 1e-6);
    assert_note(take, "divided by 5");
    fap_coefficients_close(&take);
}

TEST(openface, what_is_not_trusted_and_other_faces_are_missing)
{
    fap_coefficients *take =
        read_ok("frame,face_id,timestamp,confidence,success,AU01_r\n1,0,0.00,0.9,1,2\n1,1,0.00,0.9,1,4\n"
                "2,0,0.04,0.3,1,3\n2,1,0.04,0.9,1,4\n3,0,0.08,0.9,0,3\n4,0,0.12,0.9,1,1\n");

    assert_int_equal(take->frame_count, 4);
    assert_float_equal(value_of(take, 0, unit(1)), 0.4, 1e-6);
    assert_true(is_missing(take, 1));
    assert_true(is_missing(take, 2));
    assert_float_equal(value_of(take, 3, unit(1)), 0.2, 1e-6);
    assert_note(take, "other faces");
    fap_coefficients_close(&take);
}

TEST(openface, three_means_other_units)
{
    assert_refused("AU01_r,AU02_r,AU03_r,AU04_r,AU05_r,AU06_r,AU07_r,AU08_r\n1,2,3,4,5,6,7,8\n",
                   FAP_E_UNSUPPORTED, "OpenFace 3");
}

TEST(openface, a_head_that_turns_with_its_eyes_on_the_camera)
{
    fap_coefficients *take = read_ok(UNITS "\n1, 0, 0.98, 1, 0, -0.3, 0, 0, 0, 0, 0, 0, 0\n"
                                           "2, 0.04, 0.98, 1, 0.2, 0, 0, 0, 0, 0, 0, 0, 0\n"
                                           "3, 0.08, 0.98, 1, 0, 0, 0.1, 0.25, 0.15, 0, 0, 0, 0\n");
    const int head = FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_YAW, eye = FAP_CHANNEL_ANGLE + FAP_ARKIT_LEFT_EYE_YAW;

    assert_float_equal(value_of(take, 0, head), 0.3, 1e-5); /* to the left; the eyes look right */
    assert_float_equal(value_of(take, 0, eye), 0.3, 1e-5);
    assert_float_equal(value_of(take, 1, head + 1), -0.2, 1e-5); /* down; the eyes look up */
    assert_float_equal(value_of(take, 1, eye + 1), -0.2, 1e-5);
    assert_float_equal(value_of(take, 2, head + 2), -0.1, 1e-5); /* towards the left shoulder */
    assert_true(value_of(take, 2, eye) < -0.2f && value_of(take, 2, eye + 1) > 0.1f); /* left, down */
    fap_coefficients_close(&take);
}

TEST(openface, any_cut_is_read_or_refused)
{
    const char text[] = UNITS
        "\n1, 0, 0.98, 1, 0, -0.3, 0, 0, 0, 0, 0, 0, 0\n2, 0.04, 0.98, 1, 0.2, 0, 0, 0, 0, 0, 0, 0, 0\n";

    assert_survives_every_cut(text, sizeof text - 1);
}

/* --- JSON --- */

static const char beat[] = "{\"names\":[\"browDownLeft\",\"jawOpen\",\"nobody\",\"tongueOut\"],\"frames\":["
                           "{\"weights\":[0.1,0.2,9,0.3],\"time\":0.0,\"rotation\":[1,2,[3,{\"a\":\"]\"}]]},"
                           "{\"weights\":[0.1,0.4,9,null],\"time\":0.0166667,\"rotation\":[]},"
                           "{\"time\":0.05,\"weights\":[0.1,0.6,9,0.3]}]}";

static const char audio2face[] =
    "{\"exportFps\":24,\"trackPath\":\"C:\\\\a\\\".wav\",\"numFrames\":2,\"facsNames\":[\"jawOpen\","
    "\"mouthClose\"],\"weightMat\":[[0.5,0],[0.25,0.125]]}";

TEST(coef_json, beat_has_names_weights_and_times)
{
    fap_coefficients *take = read_ok(beat);

    assert_string_equal(take->format, "BEAT JSON");
    assert_int_equal(take->channel_count, 3);
    assert_int_equal(take->frame_count, 4);
    assert_float_equal(take->rate_hz, 60, 1e-3);
    assert_float_equal(value_of(take, 1, shape("JawOpen")), 0.4, 1e-6);
    assert_float_equal(value_of(take, 3, shape("TongueOut")), 0.3, 1e-6);
    assert_true(is_missing(take, 2));
    fap_coefficients_close(&take);
}

TEST(coef_json, audio2face_has_a_matrix_and_a_rate)
{
    fap_coefficients *take = read_ok(audio2face);

    assert_string_equal(take->format, "Audio2Face JSON");
    assert_float_equal(take->rate_hz, 24, 0);
    assert_int_equal(take->frame_count, 2);
    assert_float_equal(value_of(take, 1, shape("MouthClose")), 0.125, 1e-6);
    fap_coefficients_close(&take);
}

TEST(coef_json, damage_is_survived)
{
    assert_survives_every_cut(beat, sizeof beat - 1);
    assert_survives_every_cut(audio2face, sizeof audio2face - 1);
    assert_refused("{\"weightMat\":[[1,2]]}", FAP_E_NOT_FOUND, "names");
    assert_refused("{\"facsNames\":[\"jawOpen\"],\"weightMat\":[]}", FAP_E_NOT_FOUND, "not one row");
}

/* --- real files --- */

static fap_coefficients *read_shared(const char *name)
{
    char path[256];
    uint8_t *data;
    size_t size;

    snprintf(path, sizeof path, "data/takes/%s", name);
    assert_int_equal(file_read(test_shared(path), 64 << 20, &data, &size), FAP_OK);
    fap_coefficients *take = read_bytes(data, size, 0);
    free(data);
    return take;
}

TEST(coef_real, live_link_at_thirty_in_sixtieths)
{
    fap_coefficients *take = read_shared("livelink/alex_rom_3.csv");

    assert_int_equal(take->channel_count, 61);
    assert_int_equal(take->frame_count, 4033); /* 4030 rows, three frames dropped */
    assert_float_equal(take->rate_hz, 30, 0.01);
    assert_float_equal(take->start_s, 13 * 3600 + 13 * 60 + 4 + 31.652 / 60, 1e-3);
    fap_coefficients_close(&take);
}

TEST(coef_real, live_link_calibrated)
{
    fap_coefficients *take = read_shared("livelink/MySlate_164_iPhone_cal.csv");

    assert_int_equal(take->frame_count, 1895);
    assert_float_equal(take->rate_hz, 59.904, 0.01);
    fap_coefficients_close(&take);
}

TEST(coef_real, packets_in_a_gzip)
{
    fap_coefficients *take = read_shared("livelink/dao.gesichter");

    assert_int_equal(take->frame_count, 187); /* 180 packets, and a jump of 8 frames */
    assert_float_equal(take->rate_hz, 60, 0.1);
    fap_coefficients_close(&take);
}

TEST(coef_real, action_units_without_points)
{
    fap_coefficients *take = read_shared("openface/facsvatar_jt.csv");

    assert_int_equal(take->channel_count, 17 + 3 + 4);
    assert_float_equal(take->rate_hz, 25, 1e-6);
    fap_coefficients_close(&take);
}
