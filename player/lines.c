/* SPDX-License-Identifier: BSD-2-Clause */
/* See lines.h. */
#include <stdio.h>
#include <string.h>

#include <fap/tables.h>

#include "common/gpio/trigger.h"
#include "common/tool.h"
#include "player/lines.h"
#include "player/report.h"

/* Contacts bounce for a few milliseconds; nobody presses a button twice within twenty. */
static const int64_t button_debounce_ns = 20 * 1000000;

/* --- buttons on the command line --- */

static int take_expression(const char *name, play_event *event)
{
    for (int i = 1; fap_expression_name(i); i++)
        if (!strcmp(name, fap_expression_name(i))) {
            *event = (play_event){ .action = PLAY_EXPRESSION, .value = i };
            return 1;
        }
    return 0;
}

static int take_action(const char *name, play_event *event)
{
    static const struct {
        const char *name;
        play_action action;
    } actions[] = {
        { "pause", PLAY_PAUSE }, { "next", PLAY_NEXT }, { "start", PLAY_START }, { "stop", PLAY_STOP }
    };
    static const char expression[] = "expression:";

    for (size_t i = 0; i < sizeof actions / sizeof *actions; i++)
        if (!strcmp(name, actions[i].name)) {
            *event = (play_event){ .action = actions[i].action };
            return 1;
        }
    return !strncmp(name, expression, sizeof expression - 1) &&
           take_expression(name + sizeof expression - 1, event);
}

int line_button_parse(line_button *b, const char *text, char *where)
{
    const char *equals = strrchr(text, '='); /* the last: debounce has one too */
    char line[FAP_ERROR_TEXT_SIZE];

    *b = (line_button){ 0 };
    if (!equals || !take_action(equals + 1, &b->event)) {
        snprintf(where, FAP_ERROR_TEXT_SIZE,
                 "expected CHIP:LINE=ACTION, where ACTION is pause, next, start, stop or expression:NAME (%s "
                 "to %s)",
                 fap_expression_name(1), fap_expression_name(FAP_EXPRESSION_COUNT));
        return 0;
    }
    snprintf(line, sizeof line, "%.*s", (int)(equals - text), text);
    if (!gpio_spec_parse(&b->spec, line, GPIO_INPUT, where))
        return 0;
    if (!b->spec.debounce_ns)
        b->spec.debounce_ns = button_debounce_ns;
    return 1;
}

/* --- opening --- */

static int open_input(gpio_lines *l, gpio_input *in, const char *option, const gpio_spec *spec)
{
    char where[FAP_ERROR_TEXT_SIZE];

    if (!gpio_spec_given(spec) || gpio_input_open(in, l->driver, spec, tool_name, where))
        return 1;
    return fault_set(&l->report->fault, EXIT_MISSING, "--%s %s", option, where);
}

static int open_output(gpio_lines *l, gpio_output *out, const char *option, const gpio_spec *spec)
{
    char where[FAP_ERROR_TEXT_SIZE];

    if (!gpio_spec_given(spec) || gpio_output_open(out, l->driver, spec, tool_name, where))
        return 1;
    return fault_set(&l->report->fault, EXIT_MISSING, "--%s %s", option, where);
}

static int open_buttons(gpio_lines *l)
{
    for (int i = 0; i < l->opt->button_count; i++)
        if (!open_input(l, &l->button[i], "button", &l->opt->button[i].spec))
            return 0;
    return 1;
}

int gpio_lines_open(gpio_lines *l, const gpio_driver *driver, const line_options *opt, play_report *report)
{
    *l = (gpio_lines){
        .opt = opt, .report = report, .driver = driver, .give_up_ns = INT64_MAX, .edge_ns = -1
    };
    if (!open_input(l, &l->trigger, "trigger", &opt->trigger) ||
        !open_output(l, &l->tally, "tally", &opt->tally) ||
        !open_output(l, &l->frame_sync, "frame-sync", &opt->frame_sync) ||
        !open_output(l, &l->end_pulse, "end-pulse", &opt->end_pulse) || !open_buttons(l))
        return 0;
    return 1;
}

/* --- what comes in --- */

static int give_up(gpio_lines *l, int exit_status, const char *where)
{
    l->waits = 0;
    return fault_set(&l->report->fault, exit_status, "--trigger %s", where);
}

int gpio_lines_await(gpio_lines *l)
{
    char where[FAP_ERROR_TEXT_SIZE];
    gpio_event edge;

    if (!l->trigger.driver)
        return 1;
    const int got = gpio_trigger_wait(&l->trigger, &l->opt->trigger, &edge, where);
    if (got <= 0)
        return give_up(l, got ? EXIT_MISSING : EXIT_DATA, where);
    l->edge_ns = edge.time_ns;
    return 1;
}

void gpio_lines_arm(gpio_lines *l)
{
    const gpio_spec *spec = l->driver ? &l->opt->trigger : NULL;

    for (int i = 0; l->driver && i < l->opt->button_count; i++)
        gpio_input_drain(&l->button[i]);
    if (!l->trigger.driver)
        return;
    gpio_trigger_arm(&l->trigger, spec);
    l->waits = 1;
    l->give_up_ns = spec->timeout_ns > 0 ? l->driver->now_ns() + spec->timeout_ns : INT64_MAX;
}

static void note_failure(gpio_lines *l, const char *option, const gpio_spec *spec)
{
    play_report_note(l->report, "--%s %s:%s failed and was given up", option, spec->chip, spec->line);
}

/* 1: an edge. */
static int poll_input(gpio_lines *l, gpio_input *in, const char *option, const gpio_spec *spec,
                      gpio_event *edge)
{
    const int got = in->driver ? gpio_input_wait(in, 0, edge) : 0;

    if (got >= 0)
        return got;
    note_failure(l, option, spec);
    gpio_input_close(in);
    return 0;
}

/* 1, with a fault: what has never started will not start any more. */
static int trigger_is_lost(gpio_lines *l)
{
    const gpio_spec *spec = &l->opt->trigger;
    char where[FAP_ERROR_TEXT_SIZE];

    if (!l->waits || (l->trigger.driver && l->driver->now_ns() < l->give_up_ns))
        return 0;
    if (l->trigger.driver)
        gpio_trigger_timeout_text(spec, where);
    else
        gpio_trigger_failure_text(spec, where);
    give_up(l, l->trigger.driver ? EXIT_DATA : EXIT_MISSING, where);
    return 1;
}

static int poll_trigger(gpio_lines *l, play_event *event)
{
    gpio_event edge;

    if (poll_input(l, &l->trigger, "trigger", &l->opt->trigger, &edge)) {
        if (!l->playing)
            l->edge_ns = edge.time_ns;
        l->waits = 0;
        *event = (play_event){ .action = PLAY_START };
        return 1;
    }
    *event = (play_event){ .action = PLAY_QUIT };
    return trigger_is_lost(l);
}

static void end_pulse_in_time(gpio_lines *l)
{
    if (l->end_pulse.active && l->driver->now_ns() >= l->pulse_ns)
        gpio_output_set(&l->end_pulse, 0);
}

int gpio_poll_action(gpio_lines *l, play_event *event)
{
    gpio_event edge;

    if (!l->driver)
        return 0;
    end_pulse_in_time(l);
    if (poll_trigger(l, event))
        return 1;
    for (int i = 0; i < l->opt->button_count; i++)
        if (poll_input(l, &l->button[i], "button", &l->opt->button[i].spec, &edge)) {
            *event = l->opt->button[i].event;
            return 1;
        }
    return 0;
}

/* --- what goes out --- */

void gpio_on_start(gpio_lines *l)
{
    l->playing = 1;
    l->waits = 0;
    gpio_output_set(&l->tally, 1);
}

void gpio_on_frame(gpio_lines *l)
{
    gpio_output_set(&l->frame_sync, !l->frame_sync.active);
    if (l->edge_ns < 0 || !l->driver)
        return;
    l->report->trigger_ms = (double)(l->driver->now_ns() - l->edge_ns) * 1e-6;
    l->report->triggers++;
    l->edge_ns = -1;
}

void gpio_on_stop(gpio_lines *l)
{
    l->playing = 0;
    gpio_output_set(&l->tally, 0);
}

void gpio_on_end(gpio_lines *l)
{
    if (!l->end_pulse.driver)
        return;
    gpio_output_set(&l->end_pulse, 1);
    l->pulse_ns = l->driver->now_ns() + l->opt->end_pulse.pulse_ns;
}

/* --- closing --- */

static void close_output(gpio_lines *l, gpio_output *out, const char *option, const gpio_spec *spec)
{
    if (out->failed)
        note_failure(l, option, spec);
    gpio_output_close(out);
}

void gpio_lines_close(gpio_lines *l)
{
    if (!l->driver)
        return;
    gpio_on_stop(l);
    if (l->end_pulse.active)
        l->driver->rest(l->pulse_ns - l->driver->now_ns());
    close_output(l, &l->tally, "tally", &l->opt->tally);
    close_output(l, &l->frame_sync, "frame-sync", &l->opt->frame_sync);
    close_output(l, &l->end_pulse, "end-pulse", &l->opt->end_pulse);
    gpio_input_close(&l->trigger);
    for (int i = 0; i < l->opt->button_count; i++)
        gpio_input_close(&l->button[i]);
    *l = (gpio_lines){ 0 };
}
