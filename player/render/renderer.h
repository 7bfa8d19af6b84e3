/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Draws one posed face with OpenGL 3.3 core, always into its own framebuffer object: read back as a picture, or copied to a
 * window. The picture depends on its arguments alone: the same ones give the same bits on one machine, whichever way they
 * are drawn, and differ by a rounding on another.
 *
 * A renderer belongs to the thread that made it.
 */
#ifndef PLAYER_RENDER_RENDERER_H
#define PLAYER_RENDER_RENDERER_H

#include <stdint.h>

#include <fap/bank.h>

#include "player/render/image.h"
#include "player/render/look.h"
#include "player/render/view.h"

typedef struct renderer renderer;

enum { RENDER_MAX_SIZE = 8192 };

/* A context that the caller owns, OpenGL 3.3 core or later; it must outlive the renderer. */
typedef struct gl_context_source {
    void (*(*get_function)(const char *name))(void); /* as glfwGetProcAddress() */
    void (*make_current)(void *user);                /* NULL: the caller keeps it current */
    void *user;
} gl_context_source;

/* A place marked by a disc: a feature point. */
typedef struct render_mark {
    float place_mm[3];
    uint8_t rgb[3];
} render_mark;

/* What is drawn. Arrays are borrowed for the call. */
typedef struct render_scene {
    const float *position, *normal; /* a pose, as fap_face_pose() gives them */
    render_view view;
    int wireframe;           /* the edges of the triangles over the face */
    const render_mark *mark; /* over the face; those behind it are fainter */
    int mark_count;
} render_scene;

/*
 * @gl     "osmesa", "egl", "glfw": how to draw without a window; NULL: the first way that works here
 * @bank   the face; read while drawing, so it must outlive the renderer
 * @width  and @height: pixels, 1 to RENDER_MAX_SIZE
 * FAP_E_UNSUPPORTED: this build has no OpenGL, or none can be had here; @where (FAP_ERROR_TEXT_SIZE bytes) says which.
 */
fap_err renderer_create(renderer **out, const char *gl, const fap_bank *bank, int width, int height,
                        char *where);
/* The same with a context that is not the renderer's, a window's for example, which is current now. */
fap_err renderer_create_on(renderer **out, const gl_context_source *source, const fap_bank *bank, int width,
                           int height, char *where);
/* Frees what it has made in the context; accepts NULL in @r. */
void renderer_destroy(renderer **r);

/*
 * Another look than the studio and the bank's colours. After FAP_E_LIMIT the renderer draws nothing until a call succeeds.
 * @where  FAP_ERROR_TEXT_SIZE bytes
 * FAP_E_DATA: the face has no texture coordinates for the skin's picture. FAP_E_LIMIT: a picture is too large for this OpenGL.
 */
fap_err renderer_dress(renderer *r, const render_look *look, char *where);

/* Another size, within the same limits. After a failure the renderer has no size until a call succeeds. */
fap_err renderer_resize(renderer *r, int width, int height);

/*
 * Draws and reads back.
 * @out  an image of the renderer's size; see image_create()
 */
fap_err renderer_draw(renderer *r, const render_scene *scene, image *out);

/*
 * The two halves of renderer_draw(). Behind begin the scene's arrays are free again, and the context draws while the caller does
 * something else: poses the next frame, writes the picture before. One picture at a time: begin, finish, begin ...
 * FAP_E_ARG: nothing was begun, or twice.
 */
fap_err renderer_begin(renderer *r, const render_scene *scene);
fap_err renderer_finish(renderer *r, image *out);

/* Where in a framebuffer of the context a picture goes; 0 is the window. Rows count from the bottom, as OpenGL's. */
typedef struct render_target {
    unsigned framebuffer;
    int x, y;
} render_target;

/*
 * Draws into @target without reading back, in the renderer's size. Leaves @target bound for drawing, and depth test, culling
 * and blending off. The caller swaps.
 */
fap_err renderer_show(renderer *r, const render_scene *scene, render_target target);

/*
 * Where a place appears, for labels and for what the mouse points at.
 * @pixel  x and y from the top left corner, and the depth from -1 (near) to 1 (far)
 * @return 0: behind the camera
 */
int renderer_project(const renderer *r, const render_view *view, const float place_mm[3], float pixel[3]);

/* GL_RENDERER of the context, for reports: pictures differ by it. */
const char *renderer_description(const renderer *r);

/* Whether it is "osmesa", "egl" or "glfw", in this build or not. */
int render_gl_known(const char *name);

/* The names that renderer_create() takes in this build, in the order they are tried; NULL past the last. */
const char *renderer_gl_name(int i);

#endif
