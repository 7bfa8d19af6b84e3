/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What lies over the face: timeline, buttons, bars, the list of keys. Draws state and returns actions; keeps none itself.
 * panel_imgui.cpp alone names Dear ImGui; a build without it has panel_none.c, and keys do everything.
 */
#ifndef PLAYER_WINDOW_PANEL_H
#define PLAYER_WINDOW_PANEL_H

#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

#include "player/window/session.h"

/* A name at a place of the window, in its own units from the top left corner. */
typedef struct panel_label {
    float x, y;
    const char *text;
    int faint;
} panel_label;

/* What is shown. Borrowed for the call. */
typedef struct panel_view {
    const session *session;
    const fap_frame *frame;
    const int32_t *farthest;           /* [FAP_COUNT + 1]: from 0 in this stream */
    const char *stream, *face, *sound; /* names; sound is "" where there is none */
    double kbit_s, kbit_s_now;         /* on average; over the last second, 0: not known */
    double error_mm;                   /* of the points before the residual, in this pose */
    const char *message;               /* NULL: none */
    const panel_label *label;
    int label_count;
} panel_view;

typedef struct panel panel;

/* @glfw_window: its callbacks are set already, and its context is current. NULL: none in this build. */
panel *panel_open(void *glfw_window);
void panel_close(panel *p); /* accepts NULL */

/* All below accept NULL. */

/* What the panels cover at the bottom and at the right, in the window's units. */
void panel_margins(const panel *p, const session *s, float *bottom, float *right);
/* 1: what the mouse does at that place of the window is the panels', not the face's. */
int panel_has_mouse(const panel *p, const session *s, double x, double y);
/* Draws over what is there. @return how many of @event[room] were filled */
int panel_draw(panel *p, const panel_view *v, play_event *event, int room);

#ifdef __cplusplus
}
#endif
#endif
