/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See pick_window.h. The sheet is drawn by cairo and put into the window whole, pixel by pixel, by the oldest calls that OpenGL has: a
 * picture of this size is nothing to any of its implementations.
 */
#if defined HAVE_GLFW && defined HAVE_CAIRO
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/tables.h>

#include "common/tool.h"
#include "encoder/plot/canvas.h"
#include "encoder/track/pick_window.h"

enum { HEAD = 58, LENS_PX = 25, LENS_ZOOM = 8, LENS = LENS_PX * LENS_ZOOM };
enum { GL_BGRA_8 = 0x80E1, GL_BYTES = 0x1401, GL_ALIGNMENT = 0x0CF5 };

/* OpenGL 1.1 */
typedef struct gl {
    void (*Viewport)(int x, int y, int width, int height);
    void (*RasterPos2f)(float x, float y);
    void (*PixelZoom)(float x, float y);
    void (*PixelStorei)(unsigned what, int value);
    void (*DrawPixels)(int width, int height, unsigned format, unsigned type, const void *data);
} gl;

typedef struct picking {
    pick *p;
    const fap_picture *picture;
    fault *f;
    GLFWwindow *window;
    gl gl;
    canvas *sheet;
    uint8_t *shown; /* RGBA, the picture at the window's scale */
    double scale;
    int width, height; /* of the picture as shown */
    double mouse[2];   /* on the sheet */
    int changed;
} picking;

/* --- the picture --- */

static void copy_pixel(const fap_picture *p, double x, double y, uint8_t rgba[4])
{
    const int column = (int)fmin(fmax(lround(x), 0), p->width_px - 1),
              row = (int)fmin(fmax(lround(y), 0), p->height_px - 1);

    memcpy(rgba, p->rgb + (size_t)row * p->stride + 3 * (size_t)column, 3);
    rgba[3] = 255;
}

/* Pixels of the picture around a place, each as a square: what is clicked on can be seen. */
static void scale_picture(const fap_picture *p, double left, double top, double scale, int width, int height,
                          uint8_t *rgba)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            copy_pixel(p, left + (x + 0.5) / scale - 0.5, top + (y + 0.5) / scale - 0.5,
                       rgba + 4 * ((size_t)y * (size_t)width + (size_t)x));
}

static void to_picture(const picking *w, const double sheet[2], double at[2])
{
    at[0] = (sheet[0] + 0.5) / w->scale - 0.5;
    at[1] = (sheet[1] - HEAD + 0.5) / w->scale - 0.5;
}

static void to_sheet(const picking *w, const double at[2], double sheet[2])
{
    sheet[0] = (at[0] + 0.5) * w->scale - 0.5;
    sheet[1] = (at[1] + 0.5) * w->scale - 0.5 + HEAD;
}

/* --- drawing --- */

static void draw_head(const picking *w)
{
    const pick *p = w->p;
    const fap_track_dot *d = &p->dots.dot[p->label];
    const fap_point_info *info = fap_point_get(fap_point_by_name(d->name));
    char text[256];

    canvas_colour(w->sheet, 0x20242a, 1);
    canvas_box(w->sheet, 0, 0, w->width, HEAD);
    canvas_colour(w->sheet, 0xffffff, 1);
    if (p->finished)
        snprintf(text, sizeof text, "That is all. Return writes it; Backspace goes back.");
    else
        snprintf(text, sizeof text, "%s: click on %s%s%s   (%d of %d)", pick_view_name(p->view), d->name,
                 info ? ", " : "", info ? info->description : "", p->label + 1, p->dots.count);
    canvas_text(w->sheet, 12, 24, 16, CANVAS_LEFT, text);
    canvas_colour(w->sheet, 0xa8b0bc, 1);
    canvas_text(
        w->sheet, 12, 46, 12, CANVAS_LEFT,
        "Space: not seen here   Backspace: back   0, 1, 2: direct, mirrors   Return: done   Escape: give up");
}

static void draw_dot(const picking *w, const double at[2], uint32_t rgb, const char *name)
{
    double s[2];

    to_sheet(w, at, s);
    canvas_colour(w->sheet, rgb, 1);
    canvas_line(w->sheet, s[0] - 9, s[1], s[0] - 4, s[1], 1.5);
    canvas_line(w->sheet, s[0] + 4, s[1], s[0] + 9, s[1], 1.5);
    canvas_line(w->sheet, s[0], s[1] - 9, s[0], s[1] - 4, 1.5);
    canvas_line(w->sheet, s[0], s[1] + 4, s[0], s[1] + 9, 1.5);
    canvas_text(w->sheet, s[0] + 6, s[1] - 6, 11, CANVAS_LEFT, name);
}

static void draw_dots(const picking *w)
{
    static const uint32_t ink[FAP_TRACKS_VIEWS] = { 0x60ff60, 0xffd23c, 0x6cc8ff };

    for (int i = 0; i < w->p->dots.count; i++) {
        const fap_track_dot *d = &w->p->dots.dot[i];
        for (int view = 0; view < FAP_TRACKS_VIEWS; view++)
            if (d->has[view])
                draw_dot(w, d->at_px[view], ink[view], d->name);
    }
}

/* What is under the mouse, large, in the corner that the mouse is not in. */
static void draw_lens(const picking *w)
{
    static uint8_t rgba[4 * LENS * LENS];
    double at[2];

    to_picture(w, w->mouse, at);
    if (w->mouse[1] < HEAD || w->p->finished)
        return;
    scale_picture(w->picture, at[0] - (LENS_PX - 1) / 2.0, at[1] - (LENS_PX - 1) / 2.0, LENS_ZOOM, LENS, LENS,
                  rgba);
    const double x = w->mouse[0] < w->width / 2.0 ? w->width - LENS - 8 : 8, y = HEAD + 8;
    canvas_picture(w->sheet, x, y, rgba, LENS, LENS);
    canvas_colour(w->sheet, 0xffffff, 0.9);
    canvas_line(w->sheet, x + LENS / 2.0, y, x + LENS / 2.0, y + LENS, 1);
    canvas_line(w->sheet, x, y + LENS / 2.0, x + LENS, y + LENS / 2.0, 1);
}

static void draw(picking *w)
{
    int pixels_wide, pixels_high, window_wide;

    canvas_picture(w->sheet, 0, HEAD, w->shown, w->width, w->height);
    draw_dots(w);
    draw_lens(w);
    draw_head(w);
    glfwGetFramebufferSize(w->window, &pixels_wide, &pixels_high);
    glfwGetWindowSize(w->window, &window_wide, &(int){ 0 });
    const float zoom = window_wide > 0 ? (float)pixels_wide / (float)window_wide : 1;
    w->gl.Viewport(0, 0, pixels_wide, pixels_high);
    w->gl.RasterPos2f(-1, 1);
    w->gl.PixelZoom(zoom, -zoom); /* rows from the top */
    w->gl.PixelStorei(GL_ALIGNMENT, 4);
    w->gl.DrawPixels(w->width, w->height + HEAD, GL_BGRA_8, GL_BYTES, canvas_pixels(w->sheet));
    glfwSwapBuffers(w->window);
    w->changed = 0;
}

/* --- hands --- */

static void on_mouse(GLFWwindow *window, double x, double y)
{
    picking *w = glfwGetWindowUserPointer(window);

    w->mouse[0] = x;
    w->mouse[1] = y;
    w->changed = 1;
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    picking *w = glfwGetWindowUserPointer(window);
    double at[2];

    (void)mods;
    if (button != GLFW_MOUSE_BUTTON_LEFT || action != GLFW_PRESS || w->mouse[1] < HEAD)
        return;
    to_picture(w, w->mouse, at);
    pick_click(w->p, fmax(at[0], 0), fmax(at[1], 0));
    w->changed = 1;
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    picking *w = glfwGetWindowUserPointer(window);

    (void)scancode;
    (void)mods;
    if (action == GLFW_RELEASE)
        return;
    w->changed = 1;
    switch (key) {
    case GLFW_KEY_SPACE: pick_skip(w->p); break;
    case GLFW_KEY_BACKSPACE: pick_back(w->p); break;
    case GLFW_KEY_0:
    case GLFW_KEY_1:
    case GLFW_KEY_2: pick_go_to_view(w->p, key - GLFW_KEY_0); break;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
        w->p->finished = 1;
        glfwSetWindowShouldClose(window, 1);
        break;
    case GLFW_KEY_ESCAPE:
        w->p->finished = 0;
        glfwSetWindowShouldClose(window, 1);
        break;
    default: break;
    }
}

static void on_damage(GLFWwindow *window)
{
    picking *w = glfwGetWindowUserPointer(window);
    w->changed = 1;
}

/* --- the window --- */

/* Loads one call; a function pointer is no data pointer to ISO C, though it is to POSIX. */
static int load(void *to, const char *name)
{
    const GLFWglproc call = glfwGetProcAddress(name);

    memcpy(to, &call, sizeof call);
    return call != NULL;
}

static int load_gl(gl *g)
{
    return load(&g->Viewport, "glViewport") && load(&g->RasterPos2f, "glRasterPos2f") &&
           load(&g->PixelZoom, "glPixelZoom") && load(&g->PixelStorei, "glPixelStorei") &&
           load(&g->DrawPixels, "glDrawPixels");
}

/* As large as a usual screen shows, small pictures twice as large. */
static void choose_size(picking *w)
{
    const double most_wide = 1280, most_high = 860;

    w->scale = fmin(2, fmin(most_wide / w->picture->width_px, most_high / w->picture->height_px));
    w->width = (int)fmax(1, floor(w->picture->width_px * w->scale));
    w->height = (int)fmax(1, floor(w->picture->height_px * w->scale));
}

static int no_display(picking *w)
{
    const char *why = NULL;

    glfwGetError(&why);
    return fault_set(w->f, EXIT_MISSING, "no window: %s; write where the dots are into a table for --init",
                     why ? why : "no display");
}

static int open_window(picking *w)
{
    char where[FAP_ERROR_TEXT_SIZE];

    choose_size(w);
    w->shown = malloc(4 * (size_t)w->width * (size_t)w->height);
    if (!w->shown || canvas_open(&w->sheet, CANVAS_PNG, w->width, w->height + HEAD, where) != FAP_OK)
        return fault_set(w->f, EXIT_DATA, "out of memory");
    scale_picture(w->picture, 0, 0, w->scale, w->width, w->height, w->shown);
    if (!glfwInit())
        return no_display(w);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    w->window = glfwCreateWindow(w->width, w->height + HEAD, "where the dots are - fapenc track", NULL, NULL);
    if (!w->window)
        return no_display(w);
    glfwMakeContextCurrent(w->window);
    if (!load_gl(&w->gl))
        return fault_set(w->f, EXIT_MISSING, "no window: this OpenGL has no glDrawPixels");
    glfwSetWindowUserPointer(w->window, w);
    glfwSetCursorPosCallback(w->window, on_mouse);
    glfwSetMouseButtonCallback(w->window, on_button);
    glfwSetKeyCallback(w->window, on_key);
    glfwSetWindowRefreshCallback(w->window, on_damage);
    return 1;
}

static void close_window(picking *w)
{
    if (w->window)
        glfwDestroyWindow(w->window);
    glfwTerminate();
    canvas_close(&w->sheet);
    free(w->shown);
}

int pick_window_run(pick *p, const fap_picture *picture, fault *f)
{
    picking w = { .p = p, .picture = picture, .f = f, .changed = 1 };

    const int opened = open_window(&w);
    while (opened && !glfwWindowShouldClose(w.window)) {
        if (w.changed)
            draw(&w);
        glfwWaitEventsTimeout(0.5);
    }
    close_window(&w);
    return opened && (p->finished ||
                      fault_set(f, EXIT_DATA, "the window was closed before Return: nothing was written"));
}
#endif
