/* SPDX-License-Identifier: BSD-2-Clause */
/* Streams, faces and sounds that are exchanged while something plays; on the built-in face, without a window. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/tool.h"
#include "player/window/playback.h"
#include "tests/fake_gpio.h"
#include "tests/test.h"

static char stream[] = "tests/golden/blink/stream.fap";

typedef struct stage {
    play_options opt;
    play_report report;
    playback p;
} stage;

static void open_stage(stage *t)
{
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    *t = (stage){ .opt = { .stream = stream, .bank = "builtin", .paused = 1 } };
    fap_face_config_init(&t->opt.face);
    t->opt.face.blend = FAP_BLEND_QP;
    assert_true(playback_open(&t->p, &t->opt, &t->report));
}

static void close_stage(stage *t)
{
    playback_close(&t->p);
    assert_int_equal(t->report.fault.exit_status, 0);
}

static void drop(stage *t, const char *path)
{
    playback_drop(&t->p, 1, &path);
}

TEST(playback, poses_once_until_something_changes)
{
    stage t;

    open_stage(&t);
    assert_true(playback_advance(&t.p));
    assert_false(playback_advance(&t.p));
    session_act(&t.p.session, (play_event){ PLAY_STEP, 1, 0 });
    assert_true(playback_advance(&t.p));
    session_act(&t.p.session, (play_event){ PLAY_EXPRESSION, 1, 0 });
    assert_true(playback_advance(&t.p));
    assert_int_equal(t.p.scene.frame.expression.select1, 1);
    assert_false(playback_advance(&t.p));
    close_stage(&t);
    assert_int_equal(t.report.shown_frames, 3);
    assert_int_equal(session_frame(&t.report.window.session), 1);
}

TEST(playback, begins_when_the_first_picture_is_seen)
{
    stage t;

    open_stage(&t);
    t.p.starts = 1;
    playback_advance(&t.p);
    assert_false(t.p.session.playing);
    playback_seen(&t.p);
    assert_true(t.p.session.playing);
    close_stage(&t);
}

/* Trigger 1, tally 2, frame sync 3, end pulse 4, a button for joy 5. */
static void open_stage_with_lines(stage *t)
{
    line_options *o = &t->opt.lines;
    char why[FAP_ERROR_TEXT_SIZE];

    open_stage(t);
    fake_gpio_reset();
    assert_true(gpio_spec_parse(&o->trigger, "fake:1", GPIO_INPUT, why));
    assert_true(gpio_spec_parse(&o->tally, "fake:2", GPIO_OUTPUT, why));
    assert_true(gpio_spec_parse(&o->frame_sync, "fake:3", GPIO_OUTPUT, why));
    assert_true(gpio_spec_parse(&o->end_pulse, "fake:4:50ms", GPIO_PULSE, why));
    assert_true(line_button_parse(&o->button[o->button_count++], "fake:5=expression:joy", why));
    assert_true(gpio_lines_open(&t->p.lines, &fake_gpio, o, &t->report));
    tool_quiet = 1;
}

static void edge(int line)
{
    fake_gpio_change(line, fake_gpio_time_us() + 1, 1);
    fake_gpio_pass(30000);
    fake_gpio_change(line, fake_gpio_time_us() + 1, 0);
    fake_gpio_pass(30000);
}

/* A turn of the window. */
static void look(stage *t)
{
    playback_obey(&t->p);
    if (playback_advance(&t->p))
        playback_seen(&t->p);
}

TEST(playback, an_edge_starts_it_and_lines_tell_what_was_seen)
{
    stage t;

    open_stage_with_lines(&t);
    assert_true(playback_listens(&t.p));
    edge(1); /* before there is anything to see */
    look(&t);
    look(&t);
    assert_false(t.p.session.playing);
    assert_int_equal(fake_gpio_level(2), 0);
    assert_int_equal(fake_gpio_level(3), 0); /* what is seen while nothing plays is no frame */
    edge(1);
    assert_int_equal(playback_obey(&t.p), 1);
    assert_true(t.p.session.playing);
    t.p.ahead_us = 50000; /* so that the next picture is another */
    assert_true(playback_advance(&t.p));
    assert_int_equal(fake_gpio_level(2), 0);
    playback_seen(&t.p);
    assert_int_equal(fake_gpio_level(2), 1);
    assert_int_equal(fake_gpio_level(3), 1);
    assert_int_equal(t.report.triggers, 1);
    playback_seen(&t.p); /* drawn again because a panel moved */
    assert_int_equal(fake_gpio_level(3), 1);
    session_act(&t.p.session, (play_event){ PLAY_PAUSE, 0, 0 });
    look(&t);
    look(&t);
    assert_int_equal(fake_gpio_level(2), 0);
    assert_int_equal(fake_gpio_level(4), 0); /* a pause is not the end */
    close_stage(&t);
    for (int i = 0; i < FAKE_LINES; i++)
        assert_false(fake_gpio_is_open(i));
    tool_quiet = 0;
}

TEST(playback, a_button_makes_a_face)
{
    stage t;

    open_stage_with_lines(&t);
    look(&t);
    edge(5);
    look(&t);
    assert_int_equal(t.p.scene.frame.expression.select1, 1);
    assert_false(t.p.session.playing);
    edge(5);
    look(&t);
    assert_int_equal(t.p.session.expression, 0);
    close_stage(&t);
    tool_quiet = 0;
}

TEST(playback, the_end_and_every_new_round_give_a_pulse)
{
    stage t;

    open_stage_with_lines(&t);
    look(&t);
    session_act(&t.p.session, (play_event){ PLAY_START, 0, 0 });
    t.p.ahead_us = 50000;
    look(&t);
    session_act(&t.p.session, (play_event){ PLAY_SEEK, 1e6, 0 });
    t.p.session.loop = 1;
    look(&t);
    assert_int_equal(fake_gpio_level(4), 1);
    assert_int_equal(fake_gpio_level(2), 1);
    fake_gpio_pass(60000);
    look(&t);
    assert_int_equal(fake_gpio_level(4), 0);
    t.p.session.loop = 0;
    session_act(&t.p.session, (play_event){ PLAY_SEEK, 1e6, 0 });
    const int toggles = fake_gpio_sets(3);
    assert_true(playback_advance(&t.p));
    assert_int_equal(fake_gpio_level(2), 1); /* until the last frame has been seen */
    playback_seen(&t.p);
    assert_int_equal(fake_gpio_sets(3), toggles + 1);
    assert_int_equal(fake_gpio_level(4), 1);
    assert_int_equal(fake_gpio_level(2), 0);
    close_stage(&t);
    tool_quiet = 0;
}

TEST(playback, a_trigger_that_never_comes_ends_it)
{
    stage t;

    open_stage_with_lines(&t);
    t.opt.lines.trigger.timeout_ns = 1000000000;
    look(&t);
    fake_gpio_pass(1000000);
    look(&t);
    assert_true(t.p.session.quit);
    assert_int_equal(t.report.fault.exit_status, EXIT_DATA);
    playback_close(&t.p);
    tool_quiet = 0;
}

TEST(playback, what_ends_between_two_pictures_has_played)
{
    stage t;

    open_stage_with_lines(&t);
    look(&t);
    session_act(&t.p.session, (play_event){ PLAY_START, 0, 0 });
    session_act(&t.p.session, (play_event){ PLAY_SEEK, 1e6, 0 });
    look(&t);
    assert_false(t.p.session.playing);
    assert_int_equal(fake_gpio_sets(2), 2);
    assert_int_equal(fake_gpio_sets(3), 1);
    assert_int_equal(fake_gpio_level(4), 1);
    close_stage(&t);
    tool_quiet = 0;
}

TEST(playback, another_method_poses_the_same_moment)
{
    stage t;

    open_stage(&t);
    playback_advance(&t.p);
    session_act(&t.p.session, (play_event){ PLAY_BLEND, FAP_BLEND_RBF, 0 });
    assert_true(playback_advance(&t.p));
    assert_int_equal(t.p.face.blend, FAP_BLEND_RBF);
    assert_false(playback_advance(&t.p));
    close_stage(&t);
}

TEST(playback, takes_another_stream_and_keeps_the_old_one_when_that_is_none)
{
    stage t;

    open_stage(&t);
    drop(&t, "tests/golden/smile/stream.fap");
    assert_string_equal(t.p.stream, "tests/golden/smile/stream.fap");
    const int64_t frames = t.p.session.frame_count;
    drop(&t, "tests/no-such.fap");
    assert_non_null(strstr(playback_message(&t.p), "no-such.fap"));
    assert_string_equal(t.p.stream, "tests/golden/smile/stream.fap");
    assert_int_equal(t.p.session.frame_count, frames);
    assert_true(playback_advance(&t.p));
    close_stage(&t);
}

TEST(playback, keeps_its_face_when_what_is_dropped_is_none)
{
    stage t;

    open_stage(&t);
    drop(&t, "tests/no-such.fbank");
    assert_int_equal(t.p.bank_number, 0);
    playback_advance(&t.p);
    close_stage(&t);
}

TEST(playback, a_sound_becomes_the_clock_and_a_stream_ends_it)
{
    static const char *const both[] = { "tests/assets/demo_take.wav", stream };
    stage t;

    open_stage(&t);
    assert_string_equal(t.report.window.clock, "monotonic");
    playback_drop(&t.p, 2, both); /* the stream is taken first, whatever the order */
    if (!t.p.sound[0]) {
        close_stage(&t);
        skip();
    }
    assert_string_equal(t.report.window.clock, "sound");
    drop(&t, "Makefile"); /* no sound: the one before stays */
    assert_string_equal(t.report.window.clock, "sound");
    drop(&t, stream);
    assert_string_equal(t.report.window.clock, "monotonic");
    close_stage(&t);
}

TEST(playback, without_a_device_it_plays_and_says_so_once)
{
    stage t;

    open_stage(&t);
    setenv("SDL_AUDIODRIVER", "no-such-driver", 1);
    drop(&t, "tests/assets/demo_take.wav");
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    assert_string_equal(t.report.window.clock, "monotonic");
    if (t.report.sound_s > 0)
        assert_int_equal(t.report.note_count, 1);
    session_act(&t.p.session, (play_event){ PLAY_START, 0, 0 });
    assert_true(t.p.session.playing);
    close_stage(&t);
}

TEST(playback, a_picture_never_takes_the_place_of_another)
{
    char folder[] = "/tmp/playback-XXXXXX", command[64];
    stage t;
    image picture;

    open_stage(&t);
    snprintf(t.p.stream, sizeof t.p.stream, "a/b/take.one.fap");
    char *here = getcwd(NULL, 0);
    assert_non_null(here);
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(image_create(&picture, 4, 4), FAP_OK);
    playback_save(&t.p, &picture);
    if (t.report.window.screenshot_count) { /* else a build without libpng: nothing is left */
        assert_string_equal(t.report.window.screenshot, "take.one-00000.png");
        playback_save(&t.p, &picture);
        assert_string_equal(t.report.window.screenshot, "take.one-00000-2.png");
        assert_int_equal(access("take.one-00000-2.png", R_OK), 0);
    }
    image_free(&picture);
    assert_int_equal(chdir(here), 0);
    free(here);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
    close_stage(&t);
}
