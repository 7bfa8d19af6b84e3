/* SPDX-License-Identifier: BSD-2-Clause */
/* Streams asked for any time. */
#include "tests/test.h"

#include <stdio.h>
#include <string.h>

#include "player/timeline.h"

static fap_err load(timeline *t, const char *stream, char *where)
{
    stream_summary summary;
    return timeline_load(t, (const uint8_t *)stream, strlen(stream), NULL, &summary, where);
}

/* One frame in which FAP @a (and @b, where not 0; above @a) is coded. */
static size_t put_frame(char *out, size_t room, int number, int a, int value_a, int b, int value_b)
{
    size_t n = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        n += (size_t)snprintf(out + n, room - n, "%d ", fap == a || fap == b);
    n += (size_t)snprintf(out + n, room - n, "\n%d %d", number, value_a);
    if (b)
        n += (size_t)snprintf(out + n, room - n, " %d", value_b);
    n += (size_t)snprintf(out + n, room - n, "\n");
    return n;
}

/* open_jaw 0, 100, 50 at 25 Hz; FAP 5 comes with the second frame. */
static void load_three(timeline *t)
{
    char stream[2048], where[FAP_ERROR_TEXT_SIZE];
    size_t n = (size_t)snprintf(stream, sizeof stream, "2.1 three 25 3\n");

    n += put_frame(stream + n, sizeof stream - n, 0, 3, 0, 0, 0);
    n += put_frame(stream + n, sizeof stream - n, 1, 3, 100, 5, 40);
    put_frame(stream + n, sizeof stream - n, 2, 3, 50, 5, 80);
    assert_int_equal(load(t, stream, where), FAP_OK);
}

TEST(timeline, has_as_many_frames_as_the_stream_at_its_own_rate)
{
    const double rates[] = { 1, 24, 25, 29.97, 30, 59.94, 60, 100, 240 };
    timeline t;

    load_three(&t);
    for (size_t r = 0; r < sizeof rates / sizeof *rates; r++) {
        for (int64_t count = 1; count < 2000; count += 37) {
            t.rate_hz = rates[r];
            t.end_us = timeline_time_us(count - 1, rates[r]) + timeline_time_us(1, rates[r]);
            assert_int_equal(timeline_frame_count(&t, rates[r]), count);
        }
    }
    timeline_free(&t);
}

TEST(timeline, shows_the_streams_own_frames_at_its_own_rate)
{
    timeline t;
    fap_frame frame;

    load_three(&t);
    for (int k = 0; k < 3; k++) {
        timeline_sample(&t, timeline_time_us(k, 25), &frame);
        assert_memory_equal(frame.value, t.frame[k].value, sizeof frame.value);
        assert_memory_equal(frame.state, t.frame[k].state, sizeof frame.state);
    }
    timeline_free(&t);
}

TEST(timeline, rounding_of_times_does_not_move_values)
{
    timeline t;
    fap_frame frame;

    load_three(&t);
    for (int off = -2; off <= 2; off++) {
        timeline_sample(&t, t.frame[1].pts_us + off, &frame);
        assert_int_equal(frame.value[3], 100);
        assert_int_equal(frame.state[5], FAP_CODED);
    }
    timeline_free(&t);
}

TEST(timeline, values_in_between_are_interpolated)
{
    timeline t;
    fap_frame frame;

    load_three(&t);
    timeline_sample(&t, 10000, &frame);
    assert_int_equal(frame.value[3], 25);
    assert_int_equal(frame.pts_us, 10000);
    timeline_sample(&t, 60000, &frame);
    assert_int_equal(frame.value[3], 75);
    assert_int_equal(frame.value[5], 60);
    assert_int_equal(timeline_frame_count(&t, 50), 6);
    timeline_free(&t);
}

TEST(timeline, a_fap_that_was_not_sent_yet_stays_absent)
{
    timeline t;
    fap_frame frame;

    load_three(&t);
    timeline_sample(&t, 20000, &frame);
    assert_int_equal(frame.state[5], FAP_ABSENT);
    assert_int_equal(frame.value[5], 0);
    timeline_free(&t);
}

TEST(timeline, outside_the_stream_the_ends_stand_still)
{
    timeline t;
    fap_frame frame;

    load_three(&t);
    timeline_sample(&t, -1000000, &frame);
    assert_int_equal(frame.value[3], 0);
    timeline_sample(&t, 1000000, &frame);
    assert_int_equal(frame.value[3], 50);
    timeline_free(&t);
}

TEST(timeline, lips_that_were_not_sent_follow_the_others)
{
    timeline t;

    load_three(&t);
    assert_int_equal(t.frame[1].state[52], FAP_DERIVED); /* the outer lip follows the inner one, FAP 5 */
    assert_int_equal(t.frame[1].value[52], 40);
    timeline_free(&t);
}

TEST(timeline, extreme_values_do_not_overflow)
{
    char stream[2048], where[FAP_ERROR_TEXT_SIZE];
    timeline t;
    fap_frame frame;
    size_t n = (size_t)snprintf(stream, sizeof stream, "2.1 x 25 2\n");

    n += put_frame(stream + n, sizeof stream - n, 0, 48, -2147483647, 0, 0);
    put_frame(stream + n, sizeof stream - n, 1, 48, 2147483647, 0, 0);
    assert_int_equal(load(&t, stream, where), FAP_OK);
    timeline_sample(&t, 20000, &frame);
    assert_int_equal(frame.value[48], 0);
    timeline_sample(&t, 39990, &frame);
    assert_true(frame.value[48] > 2000000000);
    timeline_free(&t);
}

TEST(timeline, empty_and_malformed_streams_say_why)
{
    char where[FAP_ERROR_TEXT_SIZE];
    timeline t;

    assert_int_not_equal(load(&t, "", where), FAP_OK);
    assert_true(where[0]);
    assert_int_not_equal(load(&t, "2.1 none 25 0\n", where), FAP_OK);
    assert_true(where[0]);
    assert_int_not_equal(load(&t, "2.1 cut 25 1\n0 0 1\n", where), FAP_OK);
    assert_non_null(strstr(where, "line"));
    assert_null(t.frame);
}

TEST(timeline, knows_what_the_last_second_cost)
{
    timeline t;

    load_three(&t);
    assert_float_equal(timeline_kbit_s(&t, 80000), 0, 0);
    t.bits[0] = 1000, t.bits[1] = 2000, t.bits[2] = 3000;
    assert_float_equal(timeline_kbit_s(&t, 0), 25, 1e-9);
    assert_float_equal(timeline_kbit_s(&t, 100000), 6000.0 / 140, 1e-9);
    t.frame[1].pts_us = 900000;
    t.frame[2].pts_us = 1500000;
    assert_float_equal(timeline_kbit_s(&t, 1500000), 5, 1e-9);
    assert_float_equal(timeline_kbit_s(&t, 9000000), 0, 0);
    timeline_free(&t);
}
