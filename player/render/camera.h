/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the camera stands: a portrait lens that frames the whole head of any face. */
#ifndef PLAYER_RENDER_CAMERA_H
#define PLAYER_RENDER_CAMERA_H

#include <cglm/cglm.h>

#include "player/render/renderer.h"

/* @view_projection: clip coordinates from bank millimetres. @eye: the camera's place. */
void camera_place(const fap_bank *bank, render_camera camera, float aspect, mat4 view_projection, vec3 eye);

#endif
