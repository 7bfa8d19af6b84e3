/* SPDX-License-Identifier: BSD-2-Clause */
/* See window.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/tool.h"
#include "player/window/window.h"

static void no_window(play_report *r, const char *why)
{
    fault_set(
        &r->fault, EXIT_MISSING,
        "no window here: %s; say where to instead: -o NAME.png, NAME.mp4, NAME.csv (see fapplay --help)",
        why);
}

#ifdef HAVE_GLFW

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fap/tables.h>

#include "player/render/renderer.h"
#include "player/window/keys.h"
#include "player/window/panel.h"
#include "player/window/playback.h"

enum { MOST_EVENTS = 16, LEAST_SIDE = 64, SETTLING = 3 };
static const double idle_s = 0.02, listening_s = 0.001, least_frame_s = 1.0 / 125;

typedef struct window {
    playback play;
    GLFWwindow *glfw;
    renderer *renderer;
    unsigned bank_number; /* that the renderer was made for */
    int width, height;    /* of the renderer, pixels */
    panel *panel;
    panel_label label[FAP_POINT_COUNT];
    render_mark mark[FAP_POINT_COUNT];
    int mark_count;
    char name[FAP_POINT_COUNT][8]; /* "11.6" */
    double mouse_x, mouse_y;
    int dragging; /* the button that holds the face, -1: none */
    int key_is_held;
    int redraw;               /* pictures to draw although nothing plays: panels take some to settle */
    int fullscreen, place[4]; /* as it is; where the window was before */
} window;

static window *window_of(GLFWwindow *glfw)
{
    return glfwGetWindowUserPointer(glfw);
}

static void act(window *w, play_event event)
{
    session_act(&w->play.session, event);
    w->redraw = SETTLING;
}

/* --- keys --- */

static const struct {
    int glfw, key;
} named_keys[] = {
    { GLFW_KEY_LEFT, PLAY_KEY_LEFT },       { GLFW_KEY_RIGHT, PLAY_KEY_RIGHT },
    { GLFW_KEY_UP, PLAY_KEY_UP },           { GLFW_KEY_DOWN, PLAY_KEY_DOWN },
    { GLFW_KEY_HOME, PLAY_KEY_HOME },       { GLFW_KEY_END, PLAY_KEY_END },
    { GLFW_KEY_PAGE_UP, PLAY_KEY_PAGE_UP }, { GLFW_KEY_PAGE_DOWN, PLAY_KEY_PAGE_DOWN },
    { GLFW_KEY_ESCAPE, PLAY_KEY_ESCAPE },
};

static int named_key(int glfw)
{
    if (glfw >= GLFW_KEY_F1 && glfw <= GLFW_KEY_F12)
        return PLAY_KEY_F1 + glfw - GLFW_KEY_F1;
    for (size_t i = 0; i < sizeof named_keys / sizeof *named_keys; i++)
        if (named_keys[i].glfw == glfw)
            return named_keys[i].key;
    return 0;
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int modifiers)
{
    window *w = window_of(glfw);

    (void)scancode, (void)modifiers;
    w->key_is_held = action == GLFW_REPEAT; /* for the character that follows */
    if (action != GLFW_RELEASE)
        act(w, play_key_event(named_key(key), w->key_is_held));
}

/* Characters come as the layout has them: '?' is where the person has it. */
static void on_character(GLFWwindow *glfw, unsigned character)
{
    window *w = window_of(glfw);

    if (character < PLAY_KEY_NAMED)
        act(w, play_key_event((int)character, w->key_is_held));
}

/* --- mouse --- */

static int panels_have_mouse(const window *w)
{
    return panel_has_mouse(w->panel, &w->play.session, w->mouse_x, w->mouse_y);
}

static void on_button(GLFWwindow *glfw, int button, int action, int modifiers)
{
    window *w = window_of(glfw);

    w->redraw = SETTLING;
    if (action == GLFW_RELEASE && button == w->dragging)
        w->dragging = -1;
    if (action != GLFW_PRESS || panels_have_mouse(w))
        return;
    w->dragging =
        button == GLFW_MOUSE_BUTTON_LEFT && modifiers & GLFW_MOD_SHIFT ? GLFW_MOUSE_BUTTON_RIGHT : button;
}

/* A drag across the window's height is half a turn; a moved face stays under the mouse. */
static void on_move(GLFWwindow *glfw, double x, double y)
{
    window *w = window_of(glfw);
    int width, height;

    glfwGetWindowSize(glfw, &width, &height);
    const double right = (x - w->mouse_x) / fmax(1, height), down = (y - w->mouse_y) / fmax(1, height);
    w->mouse_x = x;
    w->mouse_y = y;
    w->redraw = SETTLING;
    if (w->dragging == GLFW_MOUSE_BUTTON_LEFT)
        act(w, (play_event){ PLAY_ORBIT, -180 * right, 180 * down });
    else if (w->dragging >= 0)
        act(w, (play_event){ PLAY_PAN, -2 * right * w->play.session.view.distance,
                             2 * down * w->play.session.view.distance });
}

static void on_scroll(GLFWwindow *glfw, double x, double y)
{
    window *w = window_of(glfw);

    (void)x;
    if (!panels_have_mouse(w))
        act(w, (play_event){ PLAY_ZOOM, y, 0 });
}

/* --- the rest that happens to a window --- */

static void on_drop(GLFWwindow *glfw, int count, const char **paths)
{
    window *w = window_of(glfw);

    playback_drop(&w->play, count, paths);
    w->redraw = SETTLING;
}

static void on_size(GLFWwindow *glfw, int width, int height)
{
    (void)width, (void)height;
    window_of(glfw)->redraw = SETTLING;
}

static void on_refresh(GLFWwindow *glfw)
{
    window_of(glfw)->redraw = SETTLING;
}

/* Moved to a display of another density: letters are made anew. */
static void on_scale(GLFWwindow *glfw, float x, float y)
{
    window *w = window_of(glfw);

    (void)x, (void)y;
    panel_close(w->panel);
    w->panel = panel_open(glfw);
    w->redraw = SETTLING;
}

static void set_callbacks(window *w)
{
    glfwSetWindowUserPointer(w->glfw, w);
    glfwSetKeyCallback(w->glfw, on_key);
    glfwSetCharCallback(w->glfw, on_character);
    glfwSetMouseButtonCallback(w->glfw, on_button);
    glfwSetCursorPosCallback(w->glfw, on_move);
    glfwSetScrollCallback(w->glfw, on_scroll);
    glfwSetDropCallback(w->glfw, on_drop);
    glfwSetFramebufferSizeCallback(w->glfw, on_size);
    glfwSetWindowRefreshCallback(w->glfw, on_refresh);
    glfwSetWindowContentScaleCallback(w->glfw, on_scale);
}

/* --- opening --- */

static void name_points(window *w)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_point_info *info = fap_point_get(i);
        snprintf(w->name[i], sizeof w->name[i], "%u.%u", info->group % 100u, info->index % 100u);
    }
}

static int open_renderer(window *w)
{
    static const gl_context_source source = { glfwGetProcAddress, NULL, NULL };
    char where[FAP_ERROR_TEXT_SIZE] = "";
    play_report *r = w->play.report;

    renderer_destroy(&w->renderer);
    w->bank_number = w->play.bank_number;
    const fap_err err =
        renderer_create_on(&w->renderer, &source, w->play.scene.bank, w->width, w->height, where);
    if (err) {
        no_window(r, where[0] ? where : fap_strerror(err));
        return 0;
    }
    snprintf(r->renderer, sizeof r->renderer, "%s", renderer_description(w->renderer));
    return dress_renderer(w->renderer, &w->play.opt->dress, &r->fault);
}

static const char *glfw_words(void)
{
    const char *words = NULL;

    glfwGetError(&words);
    return words ? words : "GLFW does not say why";
}

static int open_glfw(window *w)
{
    const play_options *o = w->play.opt;

    if (!glfwInit()) {
        no_window(w->play.report, glfw_words());
        return 0;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "fapplay");
    w->glfw = glfwCreateWindow(o->width, o->height, "fapplay", NULL, NULL);
    if (!w->glfw) {
        no_window(w->play.report, glfw_words());
        return 0;
    }
    glfwSetWindowSizeLimits(w->glfw, 4 * LEAST_SIDE, 4 * LEAST_SIDE, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwMakeContextCurrent(w->glfw);
    glfwSwapInterval(1);
    return 1;
}

static void show_title(window *w)
{
    char title[PLAYBACK_PATH_SIZE + 16];
    const char *slash = strrchr(w->play.stream, '/');

    snprintf(title, sizeof title, "%s - fapplay", slash ? slash + 1 : w->play.stream);
    glfwSetWindowTitle(w->glfw, title);
}

/* The picture fills what the panels leave, so that the face is in the middle of it. */
static int fit_renderer(window *w)
{
    int width, height, window_width, window_height;
    float bottom, right;

    glfwGetFramebufferSize(w->glfw, &width, &height);
    glfwGetWindowSize(w->glfw, &window_width, &window_height);
    panel_margins(w->panel, &w->play.session, &bottom, &right);
    const float density = (float)width / fmaxf(1, (float)window_width);
    width -= (int)(right * density);
    height -= (int)(bottom * density);
    width = width < LEAST_SIDE ? LEAST_SIDE : width > RENDER_MAX_SIZE ? RENDER_MAX_SIZE : width;
    height = height < LEAST_SIDE ? LEAST_SIDE : height > RENDER_MAX_SIZE ? RENDER_MAX_SIZE : height;
    if (w->renderer && width == w->width && height == w->height)
        return 1;
    w->width = width;
    w->height = height;
    return !w->renderer || renderer_resize(w->renderer, width, height) == FAP_OK;
}

static int window_open(window *w)
{
    if (!open_glfw(w))
        return 0;
    set_callbacks(w);
    w->panel = panel_open(w->glfw);
    name_points(w);
    show_title(w);
    fit_renderer(w);
    return open_renderer(w);
}

static void window_close(window *w)
{
    panel_close(w->panel);
    renderer_destroy(&w->renderer);
    if (w->glfw)
        glfwDestroyWindow(w->glfw);
    glfwTerminate();
}

/* --- drawing --- */

/* Those the face has; what the stream commands now stands out. */
static void mark_points(window *w)
{
    const scene *s = &w->play.scene;
    static const uint8_t moved[3] = { 255, 196, 64 }, other[3] = { 120, 190, 255 };

    w->mark_count = 0;
    for (int i = 0; i < FAP_POINT_COUNT && w->play.session.points; i++) {
        const fap_bank_point *p = fap_bank_point_get(s->bank, i);
        render_mark *m = &w->mark[w->mark_count];
        if (!p || !p->present)
            continue;
        memcpy(m->place_mm, s->point[i], sizeof m->place_mm);
        memcpy(m->rgb, fap_point_get(i)->moved ? moved : other, sizeof m->rgb);
        w->label[w->mark_count++].text = w->name[i];
    }
}

/* Places of the names, in the window's units; those of the far side are faint. */
static int place_labels(window *w, float density)
{
    float pixel[FAP_POINT_COUNT][3], depth = 0;
    int count = 0;

    for (int i = 0; i < w->mark_count; i++) {
        if (!renderer_project(w->renderer, &w->play.session.view, w->mark[i].place_mm, pixel[count]))
            continue;
        depth += pixel[count][2];
        w->label[count++].text = w->label[i].text;
    }
    for (int i = 0; i < count; i++) {
        w->label[i].x = pixel[i][0] / density;
        w->label[i].y = pixel[i][1] / density;
        w->label[i].faint = pixel[i][2] > depth / (float)count;
    }
    return count;
}

static float density_of(const window *w)
{
    int width, window_width, unused;

    glfwGetFramebufferSize(w->glfw, &width, &unused);
    glfwGetWindowSize(w->glfw, &window_width, &unused);
    return fmaxf(1e-3f, (float)width / fmaxf(1, (float)window_width));
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void draw_panel(window *w)
{
    playback *p = &w->play;
    play_event event[MOST_EVENTS];
    fap_face_stats stats;

    fap_face_last_stats(p->scene.face, &stats);
    const panel_view view = {
        .session = &p->session,
        .frame = &p->scene.frame,
        .farthest = p->scene.farthest,
        .stream = name_of(p->stream),
        .face = p->report->face,
        .sound = name_of(p->sound),
        .kbit_s = p->scene.kbit_s,
        .kbit_s_now = timeline_kbit_s(&p->scene.line, p->session.at_us),
        .error_mm = stats.target_error_mm,
        .message = playback_message(p),
        .label = w->label,
        .label_count = place_labels(w, density_of(w)),
    };
    const int count = panel_draw(w->panel, &view, event, MOST_EVENTS);
    for (int i = 0; i < count; i++)
        act(w, event[i]);
}

static void take_pictures(window *w, const render_scene *what)
{
    session *s = &w->play.session;
    image picture;

    for (; s->screenshots > 0; s->screenshots--) {
        if (image_create(&picture, w->width, w->height))
            return;
        if (renderer_draw(w->renderer, what, &picture) == FAP_OK)
            playback_save(&w->play, &picture);
        image_free(&picture);
    }
}

static int draw(window *w)
{
    const scene *s = &w->play.scene;
    int width, height;

    mark_points(w);
    const render_scene what = {
        .position = s->position,
        .normal = s->normal,
        .view = w->play.session.view,
        .wireframe = w->play.session.wireframe,
        .mark = w->mark,
        .mark_count = w->mark_count,
    };
    take_pictures(w, &what);
    glfwGetFramebufferSize(w->glfw, &width, &height);
    const fap_err err = renderer_show(w->renderer, &what, (render_target){ 0, 0, height - w->height });
    if (err)
        return fault_set(&w->play.report->fault, EXIT_DATA, "drawing failed: %s", fap_strerror(err));
    draw_panel(w);
    glfwSwapBuffers(w->glfw);
    return 1;
}

/* --- the loop --- */

static void apply_fullscreen(window *w)
{
    int *p = w->place;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;

    w->fullscreen = w->play.session.fullscreen;
    if (w->fullscreen && mode) {
        glfwGetWindowPos(w->glfw, &p[0], &p[1]);
        glfwGetWindowSize(w->glfw, &p[2], &p[3]);
        glfwSetWindowMonitor(w->glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else if (!w->fullscreen && p[2])
        glfwSetWindowMonitor(w->glfw, NULL, p[0], p[1], p[2], p[3], GLFW_DONT_CARE);
    glfwSwapInterval(1);
}

/* Everything that is not as the session wants it. */
static int follow_session(window *w)
{
    if (w->fullscreen != w->play.session.fullscreen)
        apply_fullscreen(w);
    if (!fit_renderer(w))
        return fault_set(&w->play.report->fault, EXIT_DATA, "cannot draw %d x %d pixels", w->width,
                         w->height);
    if (w->bank_number == w->play.bank_number)
        return 1;
    show_title(w);
    return open_renderer(w);
}

/* A display that does not hold back (none of its own, or hidden) would be drawn to without end. */
static void hold_back(double began_s)
{
    const double left_s = least_frame_s - (glfwGetTime() - began_s);

    if (left_s > 0.001)
        glfwWaitEventsTimeout(left_s);
}

/* One picture; or, while nothing moves, a short rest. */
static int turn(window *w)
{
    playback *p = &w->play;
    const double began_s = glfwGetTime();
    const int said = playback_message(p) != NULL;

    if (p->session.playing || w->redraw)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(playback_listens(p) ? listening_s : idle_s);
    if (playback_obey(p) || said != (playback_message(p) != NULL))
        w->redraw = SETTLING;
    if (p->session.quit)
        return 1;
    if (!playback_advance(p) && !w->redraw)
        return 1;
    w->redraw -= w->redraw > 0;
    if (!follow_session(w) || !draw(w))
        return 0;
    playback_seen(p);
    hold_back(began_s);
    return 1;
}

static void loop(window *w)
{
    session *s = &w->play.session;

    while (!s->quit && turn(w))
        if (glfwWindowShouldClose(w->glfw))
            s->quit = 1;
}

void window_run(const play_options *o, play_report *r)
{
    window w = { .dragging = -1, .redraw = SETTLING };

    if (playback_open(&w.play, o, r) && window_open(&w))
        loop(&w);
    window_close(&w);
    playback_close(&w.play);
}

#else

void window_run(const play_options *o, play_report *r)
{
    (void)o;
    no_window(r, "this fapplay was built without GLFW");
}

#endif
