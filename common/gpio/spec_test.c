/* SPDX-License-Identifier: BSD-2-Clause */
/* How a line is written on a command line. */
#include "tests/test.h"

#include <string.h>

#include "common/gpio/spec.h"

static gpio_spec takes(const char *text, gpio_use use)
{
    char why[FAP_ERROR_TEXT_SIZE];
    gpio_spec s;

    assert_true(gpio_spec_parse(&s, text, use, why));
    return s;
}

static void refuses(const char *text, gpio_use use, const char *reason)
{
    char why[FAP_ERROR_TEXT_SIZE] = "";
    gpio_spec s;

    assert_false(gpio_spec_parse(&s, text, use, why));
    assert_non_null(strstr(why, reason));
    assert_false(gpio_spec_given(&s));
}

TEST(gpio_spec, chip_and_line_are_enough)
{
    const gpio_spec s = takes("gpiochip0:17", GPIO_INPUT);

    assert_true(gpio_spec_given(&s));
    assert_string_equal(s.chip, "gpiochip0");
    assert_string_equal(s.line, "17");
    assert_int_equal(s.edge, GPIO_RISING);
    assert_int_equal(s.bias, GPIO_BIAS_AS_IS);
    assert_false(s.active_low);
    assert_int_equal(s.debounce_ns, 0);
    assert_int_equal(s.timeout_ns, -1);
}

TEST(gpio_spec, words_of_an_input_come_in_any_order)
{
    const gpio_spec s =
        takes("/dev/gpiochip1:GPIO17:timeout=10s:falling:debounce=500us:active-low:pull-up", GPIO_INPUT);

    assert_string_equal(s.chip, "/dev/gpiochip1");
    assert_string_equal(s.line, "GPIO17");
    assert_int_equal(s.edge, GPIO_FALLING);
    assert_int_equal(s.bias, GPIO_PULL_UP);
    assert_true(s.active_low);
    assert_int_equal(s.debounce_ns, 500000);
    assert_int_equal(s.timeout_ns, 10000000000);
}

TEST(gpio_spec, pulls_are_told_apart)
{
    assert_int_equal(takes("0:1:pull-down", GPIO_INPUT).bias, GPIO_PULL_DOWN);
    assert_int_equal(takes("0:1:pull-off", GPIO_INPUT).bias, GPIO_BIAS_OFF);
}

TEST(gpio_spec, times_have_units_and_limits)
{
    assert_int_equal(takes("0:1:debounce=7", GPIO_INPUT).debounce_ns, 7000000);
    assert_int_equal(takes("0:1:timeout=3600s", GPIO_INPUT).timeout_ns, 3600000000000);
    assert_int_equal(takes("0:1:debounce=1us", GPIO_INPUT).debounce_ns, 1000);
    refuses("0:1:timeout=3601s", GPIO_INPUT, "timeout=3601s");
    refuses("0:1:timeout=0s", GPIO_INPUT, "timeout");
    refuses("0:1:debounce=-5ms", GPIO_INPUT, "debounce");
    refuses("0:1:debounce=5m", GPIO_INPUT, "debounce");
    refuses("0:1:debounce=", GPIO_INPUT, "debounce");
    refuses("0:1:debounce=ms", GPIO_INPUT, "debounce");
    refuses("0:1:debounce=99999999999999999999999s", GPIO_INPUT, "debounce");
    refuses("0:1:debounce=9223372036854775807us", GPIO_INPUT, "debounce");
}

TEST(gpio_spec, pulses_say_how_long)
{
    assert_int_equal(takes("0:4", GPIO_PULSE).pulse_ns, 100000000);
    assert_int_equal(takes("0:4:250", GPIO_PULSE).pulse_ns, 250000000);
    assert_int_equal(takes("0:4:2s:active-low", GPIO_PULSE).pulse_ns, 2000000000);
    refuses("0:4:rising", GPIO_PULSE, "'rising'");
}

TEST(gpio_spec, outputs_know_only_which_level_is_active)
{
    assert_true(takes("0:4:active-low", GPIO_OUTPUT).active_low);
    refuses("0:4:pull-up", GPIO_OUTPUT, "'pull-up'");
    refuses("0:4:100", GPIO_OUTPUT, "'100'");
}

TEST(gpio_spec, what_is_missing_or_too_much_is_refused)
{
    char text[200];

    refuses("", GPIO_INPUT, "CHIP:LINE");
    refuses(":", GPIO_INPUT, "CHIP:LINE");
    refuses("gpiochip0", GPIO_INPUT, "CHIP:LINE");
    refuses("gpiochip0:", GPIO_INPUT, "CHIP:LINE");
    refuses(":17", GPIO_INPUT, "CHIP:LINE");
    refuses("0:17:", GPIO_INPUT, "last colon");
    refuses("0:17:rising:", GPIO_INPUT, "last colon");
    refuses("0:17::rising", GPIO_INPUT, "''");
    refuses("0:17:risin", GPIO_INPUT, "'risin'");
    memset(text, 'a', sizeof text);
    memcpy(text + 63, ":1", 3);
    takes(text, GPIO_INPUT);
    memcpy(text + 63, "a:1", 4);
    refuses(text, GPIO_INPUT, "CHIP:LINE");
}
