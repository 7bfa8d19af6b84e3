/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See window.h. The canvas is put into the window whole, by the oldest calls that OpenGL has: a picture of this size is nothing to
 * any of its implementations.
 */
#if defined HAVE_GLFW && defined HAVE_CAIRO
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <string.h>

#include "common/canvas/window.h"
#include "common/tool.h"

enum { GL_BGRA_8 = 0x80E1, GL_BYTES = 0x1401, GL_ALIGNMENT = 0x0CF5 };

/* OpenGL 1.1 */
typedef struct gl {
    void (*Viewport)(int x, int y, int width, int height);
    void (*RasterPos2f)(float x, float y);
    void (*PixelZoom)(float x, float y);
    void (*PixelStorei)(unsigned what, int value);
    void (*DrawPixels)(int width, int height, unsigned format, unsigned type, const void *data);
} gl;

typedef struct running {
    const canvas_window *what;
    const char *instead;
    fault *f;
    GLFWwindow *window;
    gl gl;
    canvas *sheet;
    double mouse[2]; /* on the canvas */
    int changed;
} running;

static void draw(running *w)
{
    int pixels_wide, pixels_high, window_wide;

    w->what->draw(w->what->user, w->sheet, w->mouse);
    glfwGetFramebufferSize(w->window, &pixels_wide, &pixels_high);
    glfwGetWindowSize(w->window, &window_wide, &(int){ 0 });
    const float zoom = window_wide > 0 ? (float)pixels_wide / (float)window_wide : 1;
    w->gl.Viewport(0, 0, pixels_wide, pixels_high);
    w->gl.RasterPos2f(-1, 1);
    w->gl.PixelZoom(zoom, -zoom); /* rows from the top */
    w->gl.PixelStorei(GL_ALIGNMENT, 4);
    w->gl.DrawPixels(w->what->width, w->what->height, GL_BGRA_8, GL_BYTES, canvas_pixels(w->sheet));
    glfwSwapBuffers(w->window);
    w->changed = 0;
}

/* --- hands --- */

static void on_mouse(GLFWwindow *window, double x, double y)
{
    running *w = glfwGetWindowUserPointer(window);

    w->mouse[0] = x;
    w->mouse[1] = y;
    w->changed = 1;
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    running *w = glfwGetWindowUserPointer(window);

    (void)mods;
    if (button != GLFW_MOUSE_BUTTON_LEFT || action != GLFW_PRESS)
        return;
    w->what->click(w->what->user, w->mouse);
    w->changed = 1;
}

/* 0: none that is told of. */
static int key_of(int key)
{
    switch (key) {
    case GLFW_KEY_BACKSPACE: return CANVAS_KEY_BACK;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER: return CANVAS_KEY_ENTER;
    case GLFW_KEY_ESCAPE: return CANVAS_KEY_ESCAPE;
    case GLFW_KEY_KP_ADD: return '=';
    case GLFW_KEY_KP_SUBTRACT: return '-';
    case GLFW_KEY_LEFT: return CANVAS_KEY_LEFT;
    case GLFW_KEY_RIGHT: return CANVAS_KEY_RIGHT;
    case GLFW_KEY_UP: return CANVAS_KEY_UP;
    case GLFW_KEY_DOWN: return CANVAS_KEY_DOWN;
    default: return key >= GLFW_KEY_SPACE && key <= GLFW_KEY_Z ? key : 0; /* they are ASCII's */
    }
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    running *w = glfwGetWindowUserPointer(window);
    const int told = key_of(key);

    (void)scancode;
    (void)mods;
    if (action == GLFW_RELEASE || !told)
        return;
    w->changed = 1;
    if (w->what->key(w->what->user, told) || told == CANVAS_KEY_ESCAPE)
        glfwSetWindowShouldClose(window, 1);
}

static void on_damage(GLFWwindow *window)
{
    running *w = glfwGetWindowUserPointer(window);
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

static int no_display(running *w)
{
    const char *why = NULL;

    glfwGetError(&why);
    return fault_set(w->f, EXIT_MISSING, "no window: %s; %s", why ? why : "no display", w->instead);
}

static int open_window(running *w)
{
    const canvas_window *what = w->what;
    char where[FAP_ERROR_TEXT_SIZE];

    if (canvas_open(&w->sheet, CANVAS_PNG, what->width, what->height, where) != FAP_OK)
        return fault_set(w->f, EXIT_DATA, "out of memory");
    if (!glfwInit())
        return no_display(w);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    w->window = glfwCreateWindow(what->width, what->height, what->title, NULL, NULL);
    if (!w->window)
        return no_display(w);
    glfwMakeContextCurrent(w->window);
    if (!load_gl(&w->gl))
        return fault_set(w->f, EXIT_MISSING, "no window: this OpenGL has no glDrawPixels; %s", w->instead);
    glfwSetWindowUserPointer(w->window, w);
    glfwSetCursorPosCallback(w->window, on_mouse);
    glfwSetMouseButtonCallback(w->window, on_button);
    glfwSetKeyCallback(w->window, on_key);
    glfwSetWindowRefreshCallback(w->window, on_damage);
    return 1;
}

static void close_window(running *w)
{
    if (w->window)
        glfwDestroyWindow(w->window);
    glfwTerminate();
    canvas_close(&w->sheet);
}

int canvas_window_run(const canvas_window *what, const char *instead, fault *f)
{
    running w = { .what = what, .instead = instead, .f = f, .changed = 1 };

    const int opened = open_window(&w);
    while (opened && !glfwWindowShouldClose(w.window)) {
        if (w.changed)
            draw(&w);
        glfwWaitEventsTimeout(0.5);
    }
    close_window(&w);
    return opened;
}
#endif
