/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the camera stands: a portrait lens that frames the whole head of any face. */
#ifndef PLAYER_RENDER_CAMERA_H
#define PLAYER_RENDER_CAMERA_H

#include <cglm/cglm.h>

#include <fap/bank.h>

#include "player/render/view.h"

/* What of a face the views are measured in; constant while its bank is. */
typedef struct head_frame {
    vec3 centre;
    float half_height, half_width, half_depth; /* millimetres, margins included */
} head_frame;

head_frame head_frame_of(const fap_bank *bank);

typedef struct render_lens {
    mat4 view_projection; /* clip coordinates from bank millimetres */
    vec3 eye;
} render_lens;

/* @aspect: width of the picture divided by its height. A view beyond its limits is held at them. */
void camera_place(render_lens *c, const head_frame *head, const render_view *view, float aspect);
/* The pixel, from the top left corner, and the depth (-1 to 1) of a place. 0: behind the camera. */
int camera_project(const render_lens *c, const float place_mm[3], int width, int height, float pixel[3]);

#endif
