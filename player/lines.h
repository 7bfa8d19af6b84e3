/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The GPIO lines of a show: what starts it, what tells others of it, and buttons. Without a line asked for, everything here
 * does nothing, so that whoever plays calls it without asking. Nothing waits but gpio_lines_await() and the close. A line that
 * fails while it plays is given up with a note.
 */
#ifndef PLAYER_LINES_H
#define PLAYER_LINES_H

#include "common/gpio/input.h"
#include "common/gpio/output.h"
#include "player/window/session.h"

struct play_report;

enum { LINES_MAX_BUTTONS = 16 };

typedef struct line_button {
    gpio_spec spec;
    play_event event; /* what pressing it does */
} line_button;

/* Those that were not asked for have no chip. */
typedef struct line_options {
    gpio_spec trigger, tally, frame_sync, end_pulse;
    line_button button[LINES_MAX_BUTTONS];
    int button_count;
} line_options;

/* CHIP:LINE[:...]=pause, next, start, stop or expression:NAME. 0 with the reason in @where (FAP_ERROR_TEXT_SIZE bytes). */
int line_button_parse(line_button *b, const char *text, char *where);

typedef struct gpio_lines {
    const line_options *opt;
    struct play_report *report;
    const gpio_driver *driver;
    gpio_input trigger, button[LINES_MAX_BUTTONS];
    gpio_output tally, frame_sync, end_pulse;
    int playing;
    int waits;          /* for the first edge: nothing has started yet */
    int64_t give_up_ns; /* when that is late; INT64_MAX: never */
    int64_t edge_ns;    /* of a trigger whose first frame was not shown yet; -1: none */
    int64_t pulse_ns;   /* when the pulse that is out ends */
} gpio_lines;

/* @opt, @report: borrowed. @l must stay where it is. 0: the report's fault says why. */
int gpio_lines_open(gpio_lines *l, const gpio_driver *driver, const line_options *opt,
                    struct play_report *report);
/* Waits for the trigger. 1: it came, or there is none. */
int gpio_lines_await(gpio_lines *l);

/*
 * For those who do something else meanwhile. From here on edges count, and the trigger's timeout runs until something starts;
 * what came before is forgotten.
 */
void gpio_lines_arm(gpio_lines *l);
/*
 * What came in, if anything: call until 0. A trigger that fails or stays away for its timeout before anything started becomes a
 * fault and PLAY_QUIT.
 */
int gpio_poll_action(gpio_lines *l, play_event *event);

/* It plays from here, whoever started it; the next frame is the first. */
void gpio_on_start(gpio_lines *l);
/* A frame has been shown. */
void gpio_on_frame(gpio_lines *l);
/* It plays no more, or pauses. */
void gpio_on_stop(gpio_lines *l);
/* The end of the stream was shown, or with a loop it begins again. */
void gpio_on_end(gpio_lines *l);

/* Lets a pulse end first. All outputs are inactive afterwards; those that failed get a note. */
void gpio_lines_close(gpio_lines *l);

#endif
