/* SPDX-License-Identifier: BSD-2-Clause */
/* A window that shows a canvas, pixel by pixel, and tells of clicks and keys: what people point at things with. */
#ifndef COMMON_CANVAS_WINDOW_H
#define COMMON_CANVAS_WINDOW_H

#include "common/canvas/canvas.h"
#include "common/fault.h"

/* Letters and digits are themselves, in capitals. */
enum {
    CANVAS_KEY_SPACE = ' ',
    CANVAS_KEY_BACK = 256,
    CANVAS_KEY_ENTER,
    CANVAS_KEY_ESCAPE,
    CANVAS_KEY_LEFT,
    CANVAS_KEY_RIGHT,
    CANVAS_KEY_UP,
    CANVAS_KEY_DOWN
};

typedef struct canvas_window {
    const char *title;
    int width, height;
    /* Everything anew; @mouse: where it is on the canvas. */
    void (*draw)(void *user, canvas *c, const double mouse[2]);
    void (*click)(void *user, const double at[2]);
    /* Non-zero: the window closes. Escape and the window's own button close it anyway. */
    int (*key)(void *user, int key);
    void *user;
} canvas_window;

/* Until it is closed. 0: there is no window to be had; @f says so, @instead what to do then ("write them into a table"). */
int canvas_window_run(const canvas_window *w, const char *instead, fault *f);

#endif
