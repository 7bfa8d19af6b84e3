/* SPDX-License-Identifier: BSD-2-Clause */
/* What the lines do around a show, on a chip whose time stands still while nobody waits. */
#include "tests/test.h"

#include <string.h>

#include "common/tool.h"
#include "player/lines.h"
#include "player/report.h"
#include "tests/fake_gpio.h"

typedef struct show {
    line_options opt;
    play_report report;
    gpio_lines lines;
} show;

static void ask(gpio_spec *spec, const char *text, gpio_use use)
{
    char why[FAP_ERROR_TEXT_SIZE];
    assert_true(gpio_spec_parse(spec, text, use, why));
}

static void ask_button(show *s, const char *text)
{
    char why[FAP_ERROR_TEXT_SIZE];
    assert_true(line_button_parse(&s->opt.button[s->opt.button_count++], text, why));
}

static void open_lines(show *s)
{
    fake_gpio_reset();
    assert_true(gpio_lines_open(&s->lines, &fake_gpio, &s->opt, &s->report));
}

/* Trigger 1, tally 2, frame sync 3, end pulse 4. */
static show *show_with(const char *trigger)
{
    static show s;

    memset(&s, 0, sizeof s);
    ask(&s.opt.trigger, trigger, GPIO_INPUT);
    ask(&s.opt.tally, "fake:2", GPIO_OUTPUT);
    ask(&s.opt.frame_sync, "fake:3", GPIO_OUTPUT);
    ask(&s.opt.end_pulse, "fake:4:50ms", GPIO_PULSE);
    tool_quiet = 1;
    return &s;
}

static play_event polled(show *s)
{
    play_event e;
    return gpio_poll_action(&s->lines, &e) ? e : (play_event){ .action = PLAY_NOTHING };
}

TEST(play_lines, without_any_nothing_happens)
{
    static show s;

    memset(&s, 0, sizeof s);
    open_lines(&s);
    assert_true(gpio_lines_await(&s.lines));
    gpio_on_start(&s.lines);
    gpio_on_frame(&s.lines);
    gpio_on_end(&s.lines);
    gpio_on_stop(&s.lines);
    assert_int_equal(polled(&s).action, PLAY_NOTHING);
    gpio_lines_close(&s.lines);
    gpio_lines_close(&s.lines);
    assert_int_equal(s.report.triggers, 0);
    assert_int_equal(s.report.note_count, 0);
    assert_int_equal(fake_gpio_time_us(), 0);
}

TEST(play_lines, the_trigger_is_waited_for_and_the_first_frame_timed)
{
    show *s = show_with("fake:1");

    open_lines(s);
    fake_gpio_change(1, 20000, 1);
    assert_true(gpio_lines_await(&s->lines));
    assert_int_equal(fake_gpio_time_us(), 20000);
    gpio_on_start(&s->lines);
    fake_gpio_pass(1500);
    gpio_on_frame(&s->lines);
    fake_gpio_pass(40000);
    gpio_on_frame(&s->lines);
    assert_int_equal(s->report.triggers, 1);
    assert_float_equal(s->report.trigger_ms, 1.5, 1e-9);
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, a_trigger_that_stays_away_is_a_fault)
{
    show *s = show_with("fake:1:falling:timeout=2s");

    open_lines(s);
    fake_gpio_change(1, 20000, 1);
    assert_false(gpio_lines_await(&s->lines));
    assert_int_equal(fake_gpio_time_us(), 2000000);
    assert_int_equal(s->report.fault.exit_status, EXIT_DATA);
    assert_non_null(strstr(s->report.fault.text, "fake:1: no falling edge within 2 s"));
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, tally_is_high_exactly_while_playing)
{
    show *s = show_with("fake:1");

    open_lines(s);
    assert_int_equal(fake_gpio_level(2), 0);
    for (int i = 0; i < 2; i++) { /* a pause between */
        gpio_on_start(&s->lines);
        gpio_on_start(&s->lines);
        assert_int_equal(fake_gpio_level(2), 1);
        gpio_on_stop(&s->lines);
        assert_int_equal(fake_gpio_level(2), 0);
    }
    gpio_on_start(&s->lines);
    gpio_lines_close(&s->lines);
    assert_int_equal(fake_gpio_level(2), 0);
    assert_int_equal(fake_gpio_sets(2), 6);
    tool_quiet = 0;
}

TEST(play_lines, every_frame_toggles_the_frame_sync)
{
    show *s = show_with("fake:1");

    open_lines(s);
    gpio_on_start(&s->lines);
    for (int i = 1; i <= 7; i++) {
        gpio_on_frame(&s->lines);
        assert_int_equal(fake_gpio_level(3), i & 1);
    }
    gpio_lines_close(&s->lines);
    assert_int_equal(fake_gpio_level(3), 0);
    assert_int_equal(fake_gpio_sets(3), 8);
    tool_quiet = 0;
}

TEST(play_lines, the_end_pulse_lasts_as_long_as_it_should)
{
    show *s = show_with("fake:1");

    open_lines(s);
    gpio_on_end(&s->lines);
    assert_int_equal(fake_gpio_level(4), 1);
    fake_gpio_pass(49000);
    polled(s);
    assert_int_equal(fake_gpio_level(4), 1);
    fake_gpio_pass(1000);
    polled(s);
    assert_int_equal(fake_gpio_level(4), 0);
    gpio_on_end(&s->lines); /* the next loop; the close lets it end */
    gpio_lines_close(&s->lines);
    assert_int_equal(fake_gpio_level(4), 0);
    assert_int_equal(fake_gpio_time_us(), 100000);
    tool_quiet = 0;
}

TEST(play_lines, a_window_starts_at_every_edge)
{
    show *s = show_with("fake:1:timeout=1s");

    open_lines(s);
    gpio_lines_arm(&s->lines);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    fake_gpio_change(1, 10000, 1);
    fake_gpio_pass(12000);
    assert_int_equal(polled(s).action, PLAY_START);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    gpio_on_start(&s->lines);
    fake_gpio_pass(3000);
    gpio_on_frame(&s->lines);
    assert_float_equal(s->report.trigger_ms, 5, 1e-9);
    fake_gpio_change(1, 20000, 0);
    fake_gpio_change(1, 30000, 1); /* while it plays: nothing is measured */
    fake_gpio_pass(2000000);
    assert_int_equal(polled(s).action, PLAY_START);
    gpio_on_frame(&s->lines);
    assert_int_equal(s->report.triggers, 1);
    assert_int_equal(polled(s).action, PLAY_NOTHING); /* the timeout was for the first */
    assert_int_equal(s->report.fault.exit_status, EXIT_OK);
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, a_window_gives_up_a_trigger_once)
{
    show *s = show_with("fake:1:timeout=1s");

    open_lines(s);
    fake_gpio_pass(5000000); /* loading takes its time, and that is not the trigger's */
    gpio_lines_arm(&s->lines);
    fake_gpio_pass(999000);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    fake_gpio_pass(1000);
    assert_int_equal(polled(s).action, PLAY_QUIT);
    assert_int_equal(s->report.fault.exit_status, EXIT_DATA);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, a_start_by_hand_ends_the_waiting)
{
    show *s = show_with("fake:1:timeout=1s");

    open_lines(s);
    gpio_lines_arm(&s->lines);
    gpio_on_start(&s->lines);
    fake_gpio_pass(2000000);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    fake_gpio_change(1, 3000000, 1); /* and the trigger is still one */
    fake_gpio_pass(1000000);
    assert_int_equal(polled(s).action, PLAY_START);
    assert_int_equal(s->report.fault.exit_status, EXIT_OK);
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, what_came_before_it_was_ready_is_forgotten)
{
    show *s = show_with("fake:1");

    ask_button(s, "fake:5=pause");
    open_lines(s);
    fake_gpio_change(1, 10000, 1);
    fake_gpio_change(5, 20000, 1);
    fake_gpio_pass(100000);
    gpio_lines_arm(&s->lines);
    assert_int_equal(polled(s).action, PLAY_NOTHING);
    gpio_lines_close(&s->lines);
    tool_quiet = 0;
}

TEST(play_lines, a_trigger_that_fails_ends_the_waiting_but_not_the_show)
{
    for (int started = 0; started < 2; started++) {
        show *s = show_with("fake:1");

        ask_button(s, "fake:5=pause");
        open_lines(s);
        gpio_lines_arm(&s->lines);
        if (started)
            gpio_on_start(&s->lines);
        fake_gpio_break();
        assert_int_equal(polled(s).action, started ? PLAY_NOTHING : PLAY_QUIT);
        assert_int_equal(polled(s).action, PLAY_NOTHING);
        assert_int_equal(s->report.fault.exit_status, started ? EXIT_OK : EXIT_MISSING);
        assert_int_equal(s->report.note_count, 2); /* once for each line, however often it is looked at */
        assert_non_null(strstr(s->report.note[1], "--button fake:5"));
        assert_false(fake_gpio_is_open(1));
        gpio_lines_close(&s->lines);
        tool_quiet = 0;
    }
}

TEST(play_lines, buttons_do_what_they_are_for_and_do_not_bounce)
{
    static show s;

    memset(&s, 0, sizeof s);
    ask_button(&s, "fake:5:active-low:pull-up=expression:joy");
    ask_button(&s, "fake:6:debounce=1ms=pause");
    open_lines(&s);
    fake_gpio_change(5, 0, 1);
    fake_gpio_change(5, 100000, 0);
    fake_gpio_change(5, 101000, 1);
    fake_gpio_change(5, 102000, 0);
    fake_gpio_change(6, 110000, 1);
    fake_gpio_pass(99000);
    assert_int_equal(polled(&s).action, PLAY_NOTHING);
    fake_gpio_pass(20000);
    assert_int_equal(polled(&s).action, PLAY_PAUSE);
    assert_int_equal(polled(&s).action, PLAY_NOTHING);
    fake_gpio_pass(10000);
    const play_event e = polled(&s);
    assert_int_equal(e.action, PLAY_EXPRESSION);
    assert_float_equal(e.value, 1, 0);
    assert_int_equal(polled(&s).action, PLAY_NOTHING);
    gpio_lines_close(&s.lines);
    assert_false(fake_gpio_is_open(5));
}

static void refuses_button(const char *text, const char *reason)
{
    char why[FAP_ERROR_TEXT_SIZE] = "";
    line_button b;

    assert_false(line_button_parse(&b, text, why));
    assert_non_null(strstr(why, reason));
}

TEST(play_lines, buttons_without_a_meaning_are_refused)
{
    refuses_button("fake:5", "pause, next");
    refuses_button("fake:5=dance", "pause, next");
    refuses_button("fake:5=expression:boredom", "joy to surprise");
    refuses_button("fake:5=expression:none", "joy to surprise");
    refuses_button("fake:5:debounce=5ms", "pause, next");
    refuses_button("fake=pause", "CHIP:LINE");
    refuses_button("fake:5:loud=pause", "'loud'");
}

TEST(play_lines, a_line_that_is_not_there_is_a_missing_device)
{
    show *s = show_with("fake:1");

    ask(&s->opt.frame_sync, "fake:9", GPIO_OUTPUT);
    fake_gpio_reset();
    assert_false(gpio_lines_open(&s->lines, &fake_gpio, &s->opt, &s->report));
    assert_int_equal(s->report.fault.exit_status, EXIT_MISSING);
    assert_non_null(strstr(s->report.fault.text, "--frame-sync fake:9: the chip has no such line"));
    gpio_lines_close(&s->lines);
    for (int i = 0; i < FAKE_LINES; i++)
        assert_false(fake_gpio_is_open(i));
    tool_quiet = 0;
}

TEST(play_lines, a_line_that_fails_does_not_stop_the_show)
{
    show *s = show_with("fake:1");

    open_lines(s);
    fake_gpio_break();
    gpio_on_start(&s->lines);
    gpio_on_frame(&s->lines);
    gpio_on_stop(&s->lines);
    gpio_lines_close(&s->lines);
    assert_int_equal(s->report.fault.exit_status, EXIT_OK);
    assert_int_equal(s->report.note_count, 2);
    assert_non_null(strstr(s->report.note[0], "--tally fake:2"));
    tool_quiet = 0;
}
