/* SPDX-License-Identifier: BSD-2-Clause */
/* Actions on a stream of ten frames a second that lasts two seconds, on a time that moves when it is told to. */
#include <math.h>
#include <stdlib.h>

#include "player/window/session.h"
#include "tests/test.h"

static int64_t fake_us;

static int64_t fake_now(void)
{
    return fake_us;
}

typedef struct stage {
    play_clock clock;
    session s;
} stage;

static void open_stage(stage *t)
{
    fake_us = 1000000;
    assert_int_equal(play_clock_silent(&t->clock, fake_now), FAP_OK);
    session_open(&t->s, &t->clock, 2000000, 10);
}

static void close_stage(stage *t)
{
    play_clock_close(&t->clock);
}

static void act(stage *t, play_action action, double value)
{
    session_act(&t->s, (play_event){ action, value, 0 });
}

static void wait_ms(stage *t, int ms)
{
    fake_us += ms * INT64_C(1000);
    session_tick(&t->s, 0);
}

TEST(session, begins_paused_at_the_beginning)
{
    stage t;

    open_stage(&t);
    assert_int_equal(t.s.frame_count, 20);
    wait_ms(&t, 500);
    assert_int_equal(t.s.at_us, 0);
    assert_false(t.s.playing);
    close_stage(&t);
}

TEST(session, plays_pauses_and_goes_on)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_PAUSE, 0);
    wait_ms(&t, 250);
    assert_int_equal(t.s.at_us, 250000);
    assert_int_equal(session_frame(&t.s), 2);
    act(&t, PLAY_PAUSE, 0);
    wait_ms(&t, 900);
    assert_int_equal(t.s.at_us, 250000);
    act(&t, PLAY_PAUSE, 0);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 350000);
    close_stage(&t);
}

TEST(session, start_and_stop_do_not_toggle)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    act(&t, PLAY_START, 0);
    assert_true(t.s.playing);
    act(&t, PLAY_STOP, 0);
    act(&t, PLAY_STOP, 0);
    assert_false(t.s.playing);
    close_stage(&t);
}

TEST(session, ends_on_the_last_frame_and_begins_again_when_asked)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 5000);
    assert_false(t.s.playing);
    assert_int_equal(t.s.at_us, 2000000);
    assert_int_equal(session_frame(&t.s), 19);
    act(&t, PLAY_PAUSE, 0);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 100000);
    close_stage(&t);
}

TEST(session, loops_without_losing_time)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_LOOP, 0);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 1990);
    wait_ms(&t, 30);
    assert_int_equal(t.s.at_us, 20000);
    assert_int_equal(t.s.loops, 1);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 120000);
    wait_ms(&t, 9000); /* a machine that slept */
    assert_int_equal(t.s.at_us, 1120000);
    assert_true(t.s.playing);
    close_stage(&t);
}

TEST(session, steps_by_whole_frames_within_the_stream)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 250);
    act(&t, PLAY_STEP, 1);
    assert_false(t.s.playing);
    assert_int_equal(t.s.at_us, 300000);
    act(&t, PLAY_STEP, -2);
    assert_int_equal(t.s.at_us, 100000);
    act(&t, PLAY_STEP, -9);
    assert_int_equal(t.s.at_us, 0);
    act(&t, PLAY_STEP, 900);
    assert_int_equal(t.s.at_us, 1900000);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 1900000);
    close_stage(&t);
}

/* At 30 Hz times are no whole microseconds: no step may stand still or take two. */
TEST(session, steps_through_every_frame_of_odd_rates)
{
    static const double rates[] = { 29.97, 30, 60, 23.976, 15, 7 };

    for (size_t r = 0; r < sizeof rates / sizeof *rates; r++) {
        stage t;

        open_stage(&t);
        session_change(&t.s, &t.clock, (int64_t)(600 * 1e6 / rates[r] + 0.5), rates[r]);
        assert_int_equal(t.s.frame_count, 600);
        for (int i = 0; i < 600; i++, act(&t, PLAY_STEP, 1))
            assert_int_equal(session_frame(&t.s), i);
        for (int i = 599; i >= 0; i--, act(&t, PLAY_STEP, -1))
            assert_int_equal(session_frame(&t.s), i);
        close_stage(&t);
    }
}

TEST(session, seeks_and_skips_within_the_stream)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_SEEK, 1.25);
    assert_int_equal(t.s.at_us, 1250000);
    act(&t, PLAY_SKIP, -1);
    assert_int_equal(t.s.at_us, 250000);
    act(&t, PLAY_SKIP, -1);
    assert_int_equal(t.s.at_us, 0);
    act(&t, PLAY_SEEK, 77);
    assert_int_equal(t.s.at_us, 2000000);
    act(&t, PLAY_SEEK, -1);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 100);
    act(&t, PLAY_SEEK, 1);
    assert_true(t.s.playing);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 1100000);
    act(&t, PLAY_SEEK, (double)NAN);
    assert_int_equal(t.s.at_us, 0);
    close_stage(&t);
}

TEST(session, next_plays_from_the_beginning)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_SEEK, 1);
    act(&t, PLAY_NEXT, 0);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 100000);
    close_stage(&t);
}

TEST(session, speed_stays_between_a_tenth_and_four)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_SPEED, 100);
    assert_float_equal(t.s.speed, 4, 0);
    act(&t, PLAY_SPEED, 0);
    assert_float_equal(t.s.speed, 0.1, 0);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 1000);
    assert_int_equal(t.s.at_us, 100000);
    close_stage(&t);
}

TEST(session, speed_steps_along_the_usual_ones)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_SPEED_STEP, 1);
    assert_float_equal(t.s.speed, 1.5, 0);
    act(&t, PLAY_SPEED_STEP, -2);
    assert_float_equal(t.s.speed, 0.75, 0);
    act(&t, PLAY_SPEED, 0.6);
    act(&t, PLAY_SPEED_STEP, 1);
    assert_float_equal(t.s.speed, 0.75, 0);
    act(&t, PLAY_SPEED, 0.6);
    act(&t, PLAY_SPEED_STEP, -1);
    assert_float_equal(t.s.speed, 0.5, 0);
    act(&t, PLAY_SPEED_STEP, -99);
    assert_float_equal(t.s.speed, 0.1, 0);
    act(&t, PLAY_SPEED_STEP, 99);
    assert_float_equal(t.s.speed, 4, 0);
    close_stage(&t);
}

TEST(session, late_pictures_skip_frames_and_are_counted)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    wait_ms(&t, 100);
    wait_ms(&t, 100);
    assert_int_equal(t.s.late_frames, 0);
    wait_ms(&t, 500);
    assert_int_equal(t.s.at_us, 700000); /* where the sound is, whatever was drawn */
    assert_int_equal(t.s.late_frames, 4);
    act(&t, PLAY_SPEED, 4);
    wait_ms(&t, 100);
    assert_int_equal(t.s.late_frames, 4);
    close_stage(&t);
}

TEST(session, shows_the_time_at_which_it_will_be_seen)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    act(&t, PLAY_SPEED, 0.5);
    fake_us += 100000;
    session_tick(&t.s, 20000);
    assert_int_equal(t.s.at_us, 60000);
    act(&t, PLAY_SEEK, 1.999);
    session_tick(&t.s, 20000);
    assert_true(t.s.playing); /* the sound is not over yet */
    assert_int_equal(session_frame(&t.s), 19);
    close_stage(&t);
}

TEST(session, another_stream_keeps_how_it_is_shown)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_START, 0);
    act(&t, PLAY_LOOP, 0);
    act(&t, PLAY_SPEED, 0.5);
    act(&t, PLAY_CAMERA, CAMERA_LEFT);
    wait_ms(&t, 1000);
    session_change(&t.s, &t.clock, 1000000, 25);
    assert_int_equal(t.s.at_us, 0);
    assert_int_equal(t.s.frame_count, 25);
    wait_ms(&t, 100);
    assert_int_equal(t.s.at_us, 50000);
    assert_true(t.s.loop);
    assert_int_equal(t.s.camera, CAMERA_LEFT);
    close_stage(&t);
}

TEST(session, the_view_stays_within_reason_and_comes_back)
{
    stage t;

    open_stage(&t);
    session_act(&t.s, (play_event){ PLAY_ORBIT, 350, 700 });
    assert_float_equal(t.s.view.yaw_degrees, -10, 1e-4);
    assert_float_equal(t.s.view.pitch_degrees, 89, 0);
    assert_int_equal(t.s.camera, -1);
    act(&t, PLAY_ZOOM, 1000);
    assert_true(t.s.view.distance >= 0.05f && t.s.view.distance < 1);
    act(&t, PLAY_ZOOM, -1000);
    assert_true(t.s.view.distance <= 10 && t.s.view.distance > 1);
    session_act(&t.s, (play_event){ PLAY_PAN, 99, -99 });
    assert_true(t.s.view.right <= 2 && t.s.view.up >= -2);
    act(&t, PLAY_RESET_VIEW, 0);
    assert_int_equal(t.s.camera, CAMERA_FRONT);
    assert_float_equal(t.s.view.right, 0, 0);
    act(&t, PLAY_CAMERA, CAMERA_COUNT);
    act(&t, PLAY_CAMERA, -1);
    assert_int_equal(t.s.camera, CAMERA_FRONT);
    close_stage(&t);
}

TEST(session, blend_methods_go_round)
{
    stage t;
    int seen = 0, count = 0;

    open_stage(&t);
    while (fap_blend_name(count))
        count++;
    for (int i = 0; i < count; i++, act(&t, PLAY_NEXT_BLEND, 0))
        seen |= 1 << t.s.blend;
    assert_int_equal(seen, (1 << count) - 1);
    assert_int_equal(t.s.blend, FAP_BLEND_GA);
    act(&t, PLAY_BLEND, FAP_BLEND_RBF);
    assert_int_equal(t.s.blend, FAP_BLEND_RBF);
    act(&t, PLAY_BLEND, 99);
    act(&t, PLAY_BLEND, -1);
    assert_int_equal(t.s.blend, FAP_BLEND_RBF);
    close_stage(&t);
}

TEST(session, an_expression_is_put_on_and_taken_off)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_EXPRESSION, 1);
    assert_int_equal(t.s.expression, 1);
    act(&t, PLAY_EXPRESSION, 6);
    assert_int_equal(t.s.expression, 6);
    act(&t, PLAY_EXPRESSION, 6);
    assert_int_equal(t.s.expression, 0);
    act(&t, PLAY_EXPRESSION, 7);
    assert_int_equal(t.s.expression, 0);
    close_stage(&t);
}

TEST(session, escape_closes_the_help_first)
{
    stage t;

    open_stage(&t);
    act(&t, PLAY_HELP, 0);
    act(&t, PLAY_QUIT, 1);
    assert_false(t.s.help);
    assert_false(t.s.quit);
    act(&t, PLAY_HELP, 0);
    act(&t, PLAY_QUIT, 0);
    assert_true(t.s.quit);
    close_stage(&t);
}

TEST(session, no_action_of_any_number_breaks_it)
{
    stage t;

    open_stage(&t);
    srand(1);
    for (int i = 0; i < 20000; i++) {
        act(&t, (play_action)(rand() % PLAY_ACTION_COUNT), rand() % 41 - 20);
        wait_ms(&t, rand() % 200);
        assert_in_range(t.s.at_us, 0, t.s.length_us);
        assert_in_range(session_frame(&t.s), 0, t.s.frame_count - 1);
    }
    close_stage(&t);
}
