/* SPDX-License-Identifier: BSD-2-Clause */
/* Which key does what: one table for the keyboard, the panel that shows it and the test that it has no doubles. */
#ifndef PLAYER_WINDOW_KEYS_H
#define PLAYER_WINDOW_KEYS_H

#include "player/window/session.h"

/* Characters are themselves, as typed; keys that type none lie above them all. */
enum {
    PLAY_KEY_NAMED = 0x200000,
    PLAY_KEY_LEFT = PLAY_KEY_NAMED,
    PLAY_KEY_RIGHT,
    PLAY_KEY_UP,
    PLAY_KEY_DOWN,
    PLAY_KEY_HOME,
    PLAY_KEY_END,
    PLAY_KEY_PAGE_UP,
    PLAY_KEY_PAGE_DOWN,
    PLAY_KEY_ESCAPE,
    PLAY_KEY_F1, /* and so on */
    PLAY_KEY_F11 = PLAY_KEY_F1 + 10,
};

typedef struct play_key {
    int key;
    play_event event;
    int repeats;       /* acts again while it is held */
    const char *label; /* of the first key of a line of the help; NULL: belongs to the line above */
    const char *help;
} play_key;

extern const play_key play_keys[]; /* ends with a key of 0 */

/* What @key does; PLAY_NOTHING: nothing. @held: it was down already. Capitals are as their small letters. */
play_event play_key_event(int key, int held);

#endif
