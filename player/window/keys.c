/* SPDX-License-Identifier: BSD-2-Clause */
/* See keys.h. */
#include <stddef.h>

#include "player/window/keys.h"

static const double to_the_end = 1e9; /* seconds */

#define SAME_LINE NULL, NULL

const play_key play_keys[] = {
    { ' ', { PLAY_PAUSE, 0, 0 }, 0, "space", "play, pause" },
    { PLAY_KEY_LEFT, { PLAY_STEP, -1, 0 }, 1, "left, right", "one frame back, on" },
    { PLAY_KEY_RIGHT, { PLAY_STEP, 1, 0 }, 1, SAME_LINE },
    { PLAY_KEY_PAGE_UP, { PLAY_SKIP, -1, 0 }, 1, "page up, page down", "one second back, on" },
    { PLAY_KEY_PAGE_DOWN, { PLAY_SKIP, 1, 0 }, 1, SAME_LINE },
    { PLAY_KEY_HOME, { PLAY_SEEK, 0, 0 }, 0, "home, end", "to the beginning, to the end" },
    { PLAY_KEY_END, { PLAY_SEEK, to_the_end, 0 }, 0, SAME_LINE },
    { PLAY_KEY_DOWN, { PLAY_SPEED_STEP, -1, 0 }, 1, "down, up", "slower, faster (also - and +)" },
    { PLAY_KEY_UP, { PLAY_SPEED_STEP, 1, 0 }, 1, SAME_LINE },
    { '-', { PLAY_SPEED_STEP, -1, 0 }, 1, SAME_LINE },
    { '+', { PLAY_SPEED_STEP, 1, 0 }, 1, SAME_LINE },
    { '=', { PLAY_SPEED, 1, 0 }, 0, "=", "speed 1x" },
    { 'l', { PLAY_LOOP, 0, 0 }, 0, "l", "loop" },
    { 'n', { PLAY_NEXT, 0, 0 }, 0, "n", "play from the beginning" },
    { '1',
      { PLAY_CAMERA, CAMERA_FRONT, 0 },
      0,
      "1 2 3 4",
      "view from the front, left, right, three-quarter" },
    { '2', { PLAY_CAMERA, CAMERA_LEFT, 0 }, 0, SAME_LINE },
    { '3', { PLAY_CAMERA, CAMERA_RIGHT, 0 }, 0, SAME_LINE },
    { '4', { PLAY_CAMERA, CAMERA_THREE_QUARTER, 0 }, 0, SAME_LINE },
    { 'r', { PLAY_RESET_VIEW, 0, 0 }, 0, "r", "reset the view" },
    { 'w', { PLAY_WIREFRAME, 0, 0 }, 0, "w", "wireframe" },
    { 'p', { PLAY_POINTS, 0, 0 }, 0, "p", "feature points with their numbers" },
    { 'f', { PLAY_BARS, 0, 0 }, 0, "f", "bars of the FAPs" },
    { 'b', { PLAY_NEXT_BLEND, 0, 0 }, 0, "b", "next blend method" },
    { PLAY_KEY_F1, { PLAY_EXPRESSION, 1, 0 }, 0, "F1 to F6", "joy, sadness, anger, fear, disgust, surprise" },
    { PLAY_KEY_F1 + 1, { PLAY_EXPRESSION, 2, 0 }, 0, SAME_LINE },
    { PLAY_KEY_F1 + 2, { PLAY_EXPRESSION, 3, 0 }, 0, SAME_LINE },
    { PLAY_KEY_F1 + 3, { PLAY_EXPRESSION, 4, 0 }, 0, SAME_LINE },
    { PLAY_KEY_F1 + 4, { PLAY_EXPRESSION, 5, 0 }, 0, SAME_LINE },
    { PLAY_KEY_F1 + 5, { PLAY_EXPRESSION, 6, 0 }, 0, SAME_LINE },
    { 's', { PLAY_SCREENSHOT, 0, 0 }, 0, "s", "save a picture" },
    { 'h', { PLAY_PANELS, 0, 0 }, 0, "h", "hide the controls" },
    { PLAY_KEY_F11, { PLAY_FULLSCREEN, 0, 0 }, 0, "F11", "full screen" },
    { '?', { PLAY_HELP, 0, 0 }, 0, "?", "these keys" },
    { 'q', { PLAY_QUIT, 0, 0 }, 0, "q, escape", "quit" },
    { PLAY_KEY_ESCAPE, { PLAY_QUIT, 1, 0 }, 0, SAME_LINE },
    { 0 },
};

static int small_letter(int key)
{
    return key >= 'A' && key <= 'Z' ? key - 'A' + 'a' : key;
}

play_event play_key_event(int key, int held)
{
    for (const play_key *k = play_keys; k->key; k++)
        if (k->key == small_letter(key))
            return held && !k->repeats ? (play_event){ PLAY_NOTHING, 0, 0 } : k->event;
    return (play_event){ PLAY_NOTHING, 0, 0 };
}
