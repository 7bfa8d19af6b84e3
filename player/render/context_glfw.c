/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * GLFW, by a window that nobody sees: for systems that give OpenGL to windows alone. Tried last, because it needs a display. The
 * window that shows the face has a context of its own; see player/window/window_glfw.c.
 */
#ifdef HAVE_GLFW
#include "player/render/context.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

enum { DUMMY_SIZE = 16 };

typedef struct glfw_state {
    GLFWwindow *window;
} glfw_state;

/* Hints are GLFW's own, not the window's: the next window must not find these. */
static GLFWwindow *hidden_window(void)
{
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    GLFWwindow *window = glfwCreateWindow(DUMMY_SIZE, DUMMY_SIZE, "face", NULL, NULL);
    glfwDefaultWindowHints();
    return window;
}

static void glfw_make_current(void *state)
{
    const glfw_state *s = state;
    glfwMakeContextCurrent(s->window);
}

static int glfw_open(void *state)
{
    glfw_state *s = state;

    s->window = glfwInit() ? hidden_window() : NULL;
    if (s->window)
        glfw_make_current(s);
    return s->window != NULL;
}

static gl_function glfw_get_function(const char *name)
{
    return glfwGetProcAddress(name);
}

/* GLFW itself stays: glfwTerminate() would take every other window of the process along. */
static void glfw_close(void *state)
{
    glfw_state *s = state;
    if (s->window)
        glfwDestroyWindow(s->window);
}

const gl_context_driver gl_context_glfw = {
    .name = "glfw",
    .missing = "GLFW gives no OpenGL 3.3 core context: it needs a display",
    .state_size = sizeof(glfw_state),
    .open = glfw_open,
    .make_current = glfw_make_current,
    .get_function = glfw_get_function,
    .close = glfw_close,
};
#endif
