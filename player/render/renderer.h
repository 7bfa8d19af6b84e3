/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Draws one posed face offscreen with OpenGL 3.3 core into its own framebuffer object. The picture depends on its
 * arguments alone: the same ones give the same bits on one machine, and differ by a rounding on another.
 */
#ifndef PLAYER_RENDER_RENDERER_H
#define PLAYER_RENDER_RENDERER_H

#include <fap/bank.h>

#include "player/render/image.h"

typedef struct renderer renderer;

typedef enum render_camera {
    CAMERA_FRONT,
    CAMERA_LEFT,
    CAMERA_RIGHT,
    CAMERA_THREE_QUARTER,
    CAMERA_COUNT
} render_camera;

/* "front", "left", "right", "three-quarter"; -1: no such camera. */
int render_camera_by_name(const char *name);
const char *render_camera_name(render_camera camera);

enum { RENDER_MAX_SIZE = 8192 };

/*
 * @bank   the face; read while drawing, so it must outlive the renderer
 * @width  and @height: pixels, 1 to RENDER_MAX_SIZE
 * FAP_E_UNSUPPORTED: this build has no OpenGL, or none can be had here; @where (FAP_ERROR_TEXT_SIZE bytes) says which.
 */
fap_err renderer_create(renderer **out, const fap_bank *bank, int width, int height, char *where);
void renderer_destroy(renderer **r);

/*
 * Draws a pose (arrays as fap_face_pose() gives them) and reads it back.
 * @out  an image of the renderer's size; see image_create()
 */
fap_err renderer_draw(renderer *r, const float *position, const float *normal, render_camera camera,
                      image *out);

/* GL_RENDERER and GL_VERSION of the context, for reports: pictures differ by these. */
const char *renderer_description(const renderer *r);

#endif
