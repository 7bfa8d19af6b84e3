/* SPDX-License-Identifier: BSD-2-Clause */
/* See spec.h. */
#include <stdio.h>
#include <string.h>

#include "common/gpio/spec.h"

static const int64_t ns_per_us = 1000, ns_per_ms = 1000000, ns_per_s = 1000000000;

/* --- times --- */

static int64_t unit_ns(const char *unit)
{
    return !strcmp(unit, "us")                      ? ns_per_us
           : !strcmp(unit, "ms") || unit[0] == '\0' ? ns_per_ms
           : !strcmp(unit, "s")                     ? ns_per_s
                                                    : 0;
}

/* Digits and a unit, from 1 us to an hour. */
static int take_time(const char *text, int64_t *ns)
{
    const int64_t most_ns = 3600 * ns_per_s;
    int64_t value = 0;
    const char *end = text;

    for (; *end >= '0' && *end <= '9' && value <= most_ns; end++)
        value = value * 10 + (*end - '0');
    const int64_t unit = unit_ns(end);
    if (end == text || !unit || value < 1 || value > most_ns / unit)
        return 0;
    *ns = value * unit;
    return 1;
}

/* "debounce=5ms" with @name "debounce=". */
static int take_named_time(const char *word, const char *name, int64_t *ns)
{
    return !strncmp(word, name, strlen(name)) && take_time(word + strlen(name), ns);
}

/* --- words --- */

static int take_edge(gpio_spec *s, const char *word)
{
    if (!strcmp(word, "rising"))
        s->edge = GPIO_RISING;
    else if (!strcmp(word, "falling"))
        s->edge = GPIO_FALLING;
    else
        return 0;
    return 1;
}

static int take_bias(gpio_spec *s, const char *word)
{
    static const char *const names[] = {
        [GPIO_BIAS_OFF] = "pull-off",
        [GPIO_PULL_UP] = "pull-up",
        [GPIO_PULL_DOWN] = "pull-down",
    };
    for (int i = GPIO_BIAS_OFF; i <= GPIO_PULL_DOWN; i++)
        if (!strcmp(word, names[i])) {
            s->bias = (gpio_bias)i;
            return 1;
        }
    return 0;
}

static int take_input_word(gpio_spec *s, const char *word)
{
    return take_edge(s, word) || take_bias(s, word) || take_named_time(word, "debounce=", &s->debounce_ns) ||
           take_named_time(word, "timeout=", &s->timeout_ns);
}

static int take_word(gpio_spec *s, const char *word, gpio_use use)
{
    if (!strcmp(word, "active-low")) {
        s->active_low = 1;
        return 1;
    }
    switch (use) {
    case GPIO_INPUT: return take_input_word(s, word);
    case GPIO_PULSE: return take_time(word, &s->pulse_ns);
    case GPIO_OUTPUT: break;
    }
    return 0;
}

static const char *words_of(gpio_use use)
{
    switch (use) {
    case GPIO_INPUT:
        return "rising, falling, active-low, pull-up, pull-down, pull-off, debounce=5ms or timeout=10s";
    case GPIO_PULSE: return "active-low, or how long, such as 250ms";
    case GPIO_OUTPUT: break;
    }
    return "active-low";
}

/* --- all of it --- */

/* Copies up to the next colon into @word. 0: empty, or too long. */
static int next_word(const char **text, char word[GPIO_NAME_SIZE])
{
    const size_t length = strcspn(*text, ":");
    const int fits = length > 0 && length < GPIO_NAME_SIZE;

    snprintf(word, GPIO_NAME_SIZE, "%.*s", (int)(length < GPIO_NAME_SIZE ? length : GPIO_NAME_SIZE - 1),
             *text);
    *text += length + ((*text)[length] == ':');
    return fits;
}

int gpio_spec_parse(gpio_spec *spec, const char *text, gpio_use use, char *where)
{
    gpio_spec s = { .edge = GPIO_RISING, .timeout_ns = -1, .pulse_ns = 100 * ns_per_ms };
    char word[GPIO_NAME_SIZE];
    const size_t length = strlen(text);

    *spec = (gpio_spec){ 0 };
    if (!next_word(&text, s.chip) || !next_word(&text, s.line)) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "expected CHIP:LINE, such as gpiochip0:17 or gpiochip0:GPIO17");
        return 0;
    }
    int ends_open = length > 0 && text[-1] == ':'; /* a colon with nothing behind it */
    while (*text) {
        if (!next_word(&text, word) || !take_word(&s, word, use)) {
            snprintf(where, FAP_ERROR_TEXT_SIZE, "'%s' says nothing about a line here; expected %s", word,
                     words_of(use));
            return 0;
        }
        ends_open = text[-1] == ':';
    }
    if (ends_open) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "something is missing behind the last colon: %s", words_of(use));
        return 0;
    }
    *spec = s;
    return 1;
}
