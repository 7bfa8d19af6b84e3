/* SPDX-License-Identifier: BSD-2-Clause */
/* Inputs and outputs on a chip whose time stands still while nobody waits. */
#include "tests/test.h"

#include <string.h>

#include "common/gpio/input.h"
#include "common/gpio/output.h"
#include "tests/fake_gpio.h"

static const int64_t ms = 1000000;

static gpio_spec line(const char *text, gpio_use use)
{
    char why[FAP_ERROR_TEXT_SIZE];
    gpio_spec s;

    assert_true(gpio_spec_parse(&s, text, use, why));
    return s;
}

static gpio_input opened(const gpio_driver *driver, const char *text)
{
    char why[FAP_ERROR_TEXT_SIZE];
    const gpio_spec spec = line(text, GPIO_INPUT);
    gpio_input in;

    fake_gpio_reset();
    assert_true(gpio_input_open(&in, driver, &spec, "test", why));
    return in;
}

/* The time of the edge in microseconds; -1: none. */
static int64_t edge_within(gpio_input *in, int64_t timeout_ms)
{
    gpio_event e;
    const int got = gpio_input_wait(in, timeout_ms < 0 ? -1 : timeout_ms * ms, &e);

    assert_true(got >= 0);
    return got ? e.time_ns / 1000 : -1;
}

TEST(gpio_input, the_edge_that_was_asked_for_comes_with_its_time)
{
    gpio_input in = opened(&fake_gpio, "fake:2:falling");

    fake_gpio_change(2, 1000, 1);
    fake_gpio_change(2, 2500, 0);
    assert_int_equal(edge_within(&in, -1), 2500);
    assert_int_equal(edge_within(&in, 10), -1);
    assert_int_equal(fake_gpio_time_us(), 12500);
    gpio_input_close(&in);
    assert_false(fake_gpio_is_open(2));
}

TEST(gpio_input, low_can_be_active)
{
    gpio_input in = opened(&fake_gpio, "fake:2:active-low:pull-up");

    assert_int_equal(fake_gpio_request(2)->bias, GPIO_PULL_UP);
    assert_string_equal(fake_gpio_request(2)->consumer, "test");
    fake_gpio_change(2, 1000, 1);
    fake_gpio_change(2, 2000, 0);
    assert_int_equal(edge_within(&in, 5), 2000);
    gpio_input_close(&in);
}

TEST(gpio_input, a_driver_that_debounces_is_left_to_it)
{
    gpio_input in = opened(&fake_gpio_debouncing, "fake:1:debounce=5ms");

    assert_int_equal(fake_gpio_request(1)->debounce_us, 5000);
    assert_int_equal(fake_gpio_request(1)->edge, GPIO_RISING);
    fake_gpio_change(1, 1000, 1);
    assert_int_equal(edge_within(&in, 5), 1000);
    gpio_input_close(&in);
}

TEST(gpio_input, another_driver_is_asked_for_all_edges_and_filtered)
{
    gpio_input in = opened(&fake_gpio, "fake:1:debounce=5ms");

    assert_int_equal(fake_gpio_request(1)->debounce_us, 0);
    assert_int_equal(fake_gpio_request(1)->edge, GPIO_BOTH);
    for (int i = 0; i <= 6; i++)
        fake_gpio_change(1, 1000 + 300 * i, !(i & 1)); /* bounces until 2.8 ms */
    fake_gpio_change(1, 50000, 0);
    fake_gpio_change(1, 80000, 1);
    fake_gpio_change(1, 81000, 0); /* a spike */
    assert_int_equal(edge_within(&in, 100), 7800);
    assert_int_equal(fake_gpio_time_us(), 7800); /* and not later */
    assert_int_equal(edge_within(&in, 100), -1);
    gpio_input_close(&in);
}

TEST(gpio_input, edges_that_were_queued_are_judged_by_their_times)
{
    gpio_input in = opened(&fake_gpio, "fake:1:debounce=5ms");

    fake_gpio_change(1, 1000, 1);
    fake_gpio_change(1, 2000, 0);
    fake_gpio_change(1, 10000, 1);
    fake_gpio_change(1, 30000, 0);
    fake_gpio_change(1, 31000, 1);
    fake_gpio_pass(100000);
    assert_int_equal(edge_within(&in, 0), 15000);
    assert_int_equal(edge_within(&in, 0), -1);
    gpio_input_close(&in);
}

TEST(gpio_input, edges_that_the_queue_lost_do_not_turn_the_line_round)
{
    gpio_input in = opened(&fake_gpio, "fake:1:debounce=5ms");

    /* The first sixteen fit, the last of them falls. */
    for (int i = 0; i < FAKE_QUEUE + 1; i++)
        fake_gpio_change(1, 1000 + 10 * i, !(i & 1));
    fake_gpio_pass(20000);
    assert_int_equal(fake_gpio_level(1), 1);
    assert_int_equal(edge_within(&in, 100), 25000); /* seen high at 20 ms */
    gpio_input_close(&in);
}

TEST(gpio_input, what_came_before_can_be_forgotten)
{
    gpio_input in = opened(&fake_gpio, "fake:1");

    fake_gpio_change(1, 1000, 1);
    fake_gpio_change(1, 2000, 0);
    fake_gpio_change(1, 3000, 1);
    fake_gpio_change(1, 9000, 0);
    fake_gpio_change(1, 9500, 1);
    fake_gpio_pass(5000);
    gpio_input_drain(&in);
    assert_int_equal(edge_within(&in, 100), 9500);
    gpio_input_close(&in);
}

static void refusal_says(gpio_fault fault, const char *detail, const char *words)
{
    char why[FAP_ERROR_TEXT_SIZE] = "";
    const gpio_spec spec = line("fake:1", GPIO_INPUT);
    gpio_input in;
    gpio_output out;

    fake_gpio_reset();
    fake_gpio_refuse(fault, detail);
    assert_false(gpio_input_open(&in, &fake_gpio, &spec, "test", why));
    assert_non_null(strstr(why, words));
    assert_non_null(strstr(why, "fake:1"));
    assert_false(gpio_output_open(&out, &fake_gpio, &spec, "test", why));
    assert_non_null(strstr(why, words));
    gpio_input_close(&in);
    gpio_output_close(&out);
}

TEST(gpio_input, refusals_say_what_to_do_next)
{
    refusal_says(GPIO_NO_LIBRARY, NULL, "apt install libgpiod-dev");
    refusal_says(GPIO_NO_CHIP, NULL, "gpiodetect");
    refusal_says(GPIO_NO_LINE, NULL, "gpioinfo");
    refusal_says(GPIO_BUSY, "spi0", "in use by spi0");
    refusal_says(GPIO_DENIED, NULL, "group");
    refusal_says(GPIO_REFUSED, "Invalid argument", "Invalid argument");
    refusal_says(GPIO_FAILED, "Input/output error", "Input/output error");
}

/* --- outputs --- */

static void open_output(gpio_output *out, const char *text)
{
    char why[FAP_ERROR_TEXT_SIZE];
    const gpio_spec spec = line(text, GPIO_OUTPUT);

    assert_true(gpio_output_open(out, &fake_gpio, &spec, "test", why));
}

TEST(gpio_output, is_inactive_before_and_after)
{
    gpio_output out;

    fake_gpio_reset();
    open_output(&out, "fake:3:active-low");
    assert_int_equal(fake_gpio_level(3), 1);
    gpio_output_set(&out, 1);
    assert_int_equal(fake_gpio_level(3), 0);
    gpio_output_close(&out);
    assert_int_equal(fake_gpio_level(3), 1);
    assert_false(fake_gpio_is_open(3));
}

TEST(gpio_output, sets_only_what_changes)
{
    gpio_output out;

    fake_gpio_reset();
    open_output(&out, "fake:3");
    gpio_output_set(&out, 0);
    gpio_output_set(&out, 1);
    gpio_output_set(&out, 1);
    assert_int_equal(fake_gpio_sets(3), 1);
    gpio_output_close(&out);
}

TEST(gpio_output, all_that_are_open_drop_at_a_signal)
{
    gpio_output a, b, c;

    fake_gpio_reset();
    open_output(&a, "fake:3");
    open_output(&b, "fake:4:active-low");
    open_output(&c, "fake:5");
    gpio_output_set(&a, 1);
    gpio_output_set(&b, 1);
    gpio_output_set(&c, 1);
    gpio_output_close(&c);
    fake_gpio_change(5, 0, 1); /* no longer ours */
    fake_gpio_pass(1);
    gpio_outputs_drop();
    assert_int_equal(fake_gpio_level(3), 0);
    assert_int_equal(fake_gpio_level(4), 1);
    assert_int_equal(fake_gpio_level(5), 1);
    gpio_output_close(&a);
    gpio_output_close(&b);
}

TEST(gpio_output, one_that_fails_is_given_up)
{
    gpio_output out;

    fake_gpio_reset();
    open_output(&out, "fake:3");
    fake_gpio_break();
    gpio_output_set(&out, 1);
    assert_true(out.failed);
    gpio_output_set(&out, 0);
    gpio_output_close(&out);
    assert_false(fake_gpio_is_open(3));
}

TEST(gpio_output, there_is_an_end_to_how_many)
{
    const gpio_spec spec = line("fake:7", GPIO_OUTPUT);
    char why[FAP_ERROR_TEXT_SIZE], text[] = "fake:0";
    gpio_output out[9];
    int opened_count = 0;

    fake_gpio_reset();
    for (; opened_count < 7; opened_count++, text[5]++)
        open_output(&out[opened_count], text);
    assert_true(gpio_output_open(&out[7], &fake_gpio, &spec, "test", why));
    fake_gpio_reset();
    assert_false(gpio_output_open(&out[8], &fake_gpio, &spec, "test", why));
    assert_non_null(strstr(why, "8 outputs"));
    assert_false(fake_gpio_is_open(7));
    for (int i = 0; i < 8; i++)
        gpio_output_close(&out[i]);
}

/* --- names --- */

TEST(gpio_host, chips_have_numbers_names_paths_and_labels)
{
    char path[32];

    assert_true(gpio_chip_path("0", path, sizeof path));
    assert_string_equal(path, "/dev/gpiochip0");
    assert_true(gpio_chip_path("gpiochip12", path, sizeof path));
    assert_string_equal(path, "/dev/gpiochip12");
    assert_true(gpio_chip_path("/dev/gpio/first", path, sizeof path));
    assert_string_equal(path, "/dev/gpio/first");
    assert_false(gpio_chip_path("pinctrl-bcm2711", path, sizeof path));
    assert_false(gpio_chip_path("gpiochip", path, sizeof path));
    assert_false(gpio_chip_path("/dev/a-path-that-does-not-fit-in-there", path, sizeof path));
}

TEST(gpio_host, lines_have_numbers_or_names)
{
    unsigned offset = 0;

    assert_true(gpio_line_number("17", &offset));
    assert_int_equal(offset, 17);
    assert_true(gpio_line_number("99999999999999999999999", &offset));
    assert_int_equal(offset, INT32_MAX);
    assert_false(gpio_line_number("GPIO17", &offset));
    assert_false(gpio_line_number("-1", &offset));
    assert_false(gpio_line_number("", &offset));
}
