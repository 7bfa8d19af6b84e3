/* SPDX-License-Identifier: BSD-2-Clause */
/* Both clocks on a time and a device that move when they are told to. */
#include <stdlib.h>
#include <string.h>

#include "player/audio/play_clock.h"
#include "player/audio/sound_clock.h"
#include "tests/test.h"

static int64_t fake_us;

static int64_t fake_now(void)
{
    return fake_us;
}

/* --- the clock that only counts --- */

static play_clock silent(void)
{
    play_clock c;

    fake_us = 5000000;
    assert_int_equal(play_clock_silent(&c, fake_now), FAP_OK);
    return c;
}

TEST(play_clock, stands_at_zero_until_started)
{
    play_clock c = silent();

    fake_us += 1000;
    assert_int_equal(play_clock_position_us(&c), 0);
    play_clock_start(&c);
    fake_us += 1000;
    assert_int_equal(play_clock_position_us(&c), 1000);
    play_clock_close(&c);
}

TEST(play_clock, a_pause_takes_no_time)
{
    play_clock c = silent();

    play_clock_start(&c);
    fake_us += 70;
    play_clock_pause(&c);
    fake_us += 1000000;
    assert_int_equal(play_clock_position_us(&c), 70);
    play_clock_start(&c);
    play_clock_start(&c);
    fake_us += 30;
    assert_int_equal(play_clock_position_us(&c), 100);
    play_clock_close(&c);
}

TEST(play_clock, seeks_and_changes_speed_from_where_it_is)
{
    play_clock c = silent();

    play_clock_start(&c);
    play_clock_seek(&c, 400000);
    fake_us += 100;
    play_clock_set_speed(&c, 0.5);
    assert_int_equal(play_clock_position_us(&c), 400100);
    fake_us += 100;
    assert_int_equal(play_clock_position_us(&c), 400150);
    play_clock_set_speed(&c, 4);
    fake_us += 100;
    assert_int_equal(play_clock_position_us(&c), 400550);
    play_clock_close(&c);
}

/* --- sound --- */

enum { RATE = 1000, LENGTH = 500, BUFFER = 20 }; /* one sample is a millisecond; sample i is 10 i */

typedef struct fake_device {
    int running, locked, closed;
} fake_device;

static void fake_run(void *state, int running)
{
    ((fake_device *)state)->running = running;
}

static void fake_lock(void *state)
{
    assert_int_equal(((fake_device *)state)->locked++, 0);
}

static void fake_unlock(void *state)
{
    assert_int_equal(--((fake_device *)state)->locked, 0);
}

static void fake_close(void *state)
{
    ((fake_device *)state)->closed++;
}

static const sound_device_driver fake_driver = { fake_run, fake_lock, fake_unlock, fake_close };

typedef struct stage {
    play_clock clock;
    sound_clock *sound;
    fake_device device;
    int16_t out[BUFFER];
} stage;

static void open_stage(stage *s, double offset_ms, int64_t delay_us)
{
    sound ramp = { malloc(LENGTH * sizeof(int16_t)), LENGTH, RATE, 1 };
    const sound_device device = { &fake_driver, &s->device, "fake", delay_us };

    fake_us = 7000000;
    *s = (stage){ 0 };
    for (int i = 0; i < LENGTH; i++)
        ramp.sample[i] = (int16_t)(10 * i);
    assert_int_equal(sound_clock_create(&s->sound, &ramp, offset_ms, fake_now), FAP_OK);
    sound_clock_attach(s->sound, &device);
    s->clock = (play_clock){ &sound_clock_kind, s->sound };
}

/* A buffer is asked for, and @ms pass. */
static void play_buffer(stage *s, int ms)
{
    assert_int_equal(s->device.running, 1);
    sound_clock_fill(s->sound, s->out, BUFFER);
    fake_us += ms * 1000;
}

static int64_t at_ms(const stage *s)
{
    const int64_t us = play_clock_position_us(&s->clock);
    assert_int_equal(us % 500, 0);
    return us / 1000;
}

TEST(sound_clock, is_where_the_sound_is)
{
    stage s;

    open_stage(&s, 0, 0);
    assert_int_equal(at_ms(&s), 0);
    play_clock_start(&s.clock);
    fake_us += 9000; /* nothing is heard before a device asks */
    assert_int_equal(at_ms(&s), 0);
    play_buffer(&s, 5);
    assert_int_equal(at_ms(&s), 5);
    fake_us += 15000;
    play_buffer(&s, 7);
    assert_int_equal(at_ms(&s), 27);
    assert_int_equal(s.out[3], 230);
    play_clock_close(&s.clock);
    assert_int_equal(s.device.closed, 1);
}

TEST(sound_clock, waits_for_a_device_that_asks_late_and_never_goes_back)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_start(&s.clock);
    play_buffer(&s, 300);
    assert_int_equal(at_ms(&s), 20);
    play_buffer(&s, 15);
    assert_int_equal(at_ms(&s), 35);
    play_buffer(&s, 0);
    assert_int_equal(at_ms(&s), 40);
    sound_clock_fill(s.sound, s.out, BUFFER); /* early: two in a row */
    assert_int_equal(at_ms(&s), 60);
    play_clock_close(&s.clock);
}

TEST(sound_clock, knows_what_the_device_still_has_in_front)
{
    stage s;

    open_stage(&s, 0, 20000);
    play_clock_start(&s.clock);
    play_buffer(&s, 20);
    assert_int_equal(at_ms(&s), 0);
    play_buffer(&s, 10);
    assert_int_equal(at_ms(&s), 10);
    play_clock_close(&s.clock);
}

TEST(sound_clock, pauses_and_goes_on_with_what_was_heard_last)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_start(&s.clock);
    play_buffer(&s, 8);
    play_clock_pause(&s.clock);
    assert_int_equal(s.device.running, 0);
    fake_us += 99000;
    assert_int_equal(at_ms(&s), 8);
    play_clock_start(&s.clock);
    play_buffer(&s, 4);
    assert_int_equal(s.out[0], 80);
    assert_int_equal(at_ms(&s), 12);
    play_clock_close(&s.clock);
}

TEST(sound_clock, seeks_while_it_plays_and_while_it_does_not)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_seek(&s.clock, 100000);
    assert_int_equal(at_ms(&s), 100);
    play_clock_start(&s.clock);
    play_buffer(&s, 8);
    assert_int_equal(s.out[0], 1000);
    play_clock_seek(&s.clock, 20000);
    assert_int_equal(at_ms(&s), 20);
    assert_int_equal(s.device.running, 1);
    play_buffer(&s, 1);
    assert_int_equal(s.out[1], 210);
    assert_int_equal(at_ms(&s), 21);
    play_clock_close(&s.clock);
}

TEST(sound_clock, is_resampled_at_other_speeds)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_set_speed(&s.clock, 0.5);
    play_clock_start(&s.clock);
    play_buffer(&s, 10);
    assert_int_equal(s.out[1], 5);
    assert_int_equal(s.out[2], 10);
    assert_int_equal(at_ms(&s), 5);
    play_clock_set_speed(&s.clock, 2);
    fake_us += 10000;
    play_buffer(&s, 10);
    assert_int_equal(s.out[0], 100);
    assert_int_equal(s.out[1], 120);
    assert_int_equal(at_ms(&s), 30);
    play_clock_close(&s.clock);
}

TEST(sound_clock, is_silent_at_speeds_nobody_understands_and_still_the_time)
{
    static const double speeds[] = { 0.1, 0.49, 2.01, 4 };

    for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
        const int16_t silence[BUFFER] = { 0 };
        stage s;

        open_stage(&s, 0, 0);
        play_clock_seek(&s.clock, 100000);
        play_clock_set_speed(&s.clock, speeds[i]);
        play_clock_start(&s.clock);
        play_buffer(&s, 10);
        assert_memory_equal(s.out, silence, sizeof silence);
        const double want_us = 100000 + 10000 * speeds[i];
        assert_true(llabs(play_clock_position_us(&s.clock) - (int64_t)want_us) <= 1);
        play_clock_close(&s.clock);
    }
}

TEST(sound_clock, begins_late_or_early_by_the_offset)
{
    stage s;

    open_stage(&s, 15, 0);
    play_clock_start(&s.clock);
    assert_int_equal(at_ms(&s), 0);
    play_buffer(&s, 1);
    assert_int_equal(s.out[14], 0);
    assert_int_equal(s.out[16], 10);
    assert_int_equal(at_ms(&s), 1);
    play_clock_close(&s.clock);

    open_stage(&s, -15, 0);
    play_clock_start(&s.clock);
    play_buffer(&s, 1);
    assert_int_equal(s.out[0], 150);
    assert_int_equal(at_ms(&s), 1);
    play_clock_close(&s.clock);
}

TEST(sound_clock, goes_on_behind_the_end_of_the_sound)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_seek(&s.clock, (LENGTH - 2) * 1000);
    play_clock_start(&s.clock);
    play_buffer(&s, 20);
    assert_int_equal(s.out[1], 10 * (LENGTH - 1));
    assert_int_equal(s.out[2], 0);
    play_buffer(&s, 20);
    assert_int_equal(at_ms(&s), LENGTH + 38);
    play_clock_close(&s.clock);
}

/* An hour of late pictures: the sound is asked for as ever, and the clock is where it would be without them. */
TEST(sound_clock, late_pictures_delay_nothing)
{
    stage s;

    open_stage(&s, 0, 0);
    play_clock_start(&s.clock);
    for (int64_t i = 1; i <= 180000; i++) {
        play_buffer(&s, BUFFER);
        if (i % 50 == 0)
            assert_int_equal(at_ms(&s), i * BUFFER);
    }
    play_clock_close(&s.clock);
}
