/* SPDX-License-Identifier: BSD-2-Clause */
/* No panels: a build without Dear ImGui. See panel.h. */
#include <stddef.h>

#include "player/window/panel.h"

#ifndef HAVE_IMGUI

panel *panel_open(void *glfw_window)
{
    (void)glfw_window;
    return NULL;
}

void panel_close(panel *p)
{
    (void)p;
}

void panel_margins(const panel *p, const session *s, float *bottom, float *right)
{
    (void)p, (void)s;
    *bottom = *right = 0;
}

int panel_has_mouse(const panel *p, const session *s, double x, double y)
{
    (void)p, (void)s, (void)x, (void)y;
    return 0;
}

int panel_draw(panel *p, const panel_view *v, play_event *event, int room)
{
    (void)p, (void)v, (void)event, (void)room;
    return 0;
}

#endif
