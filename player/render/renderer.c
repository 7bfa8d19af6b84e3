/* SPDX-License-Identifier: BSD-2-Clause */
/* See renderer.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include "player/render/camera.h"
#include "player/render/context.h"
#include "player/render/gl_objects.h"
#include "player/render/overlay.h"
#include "player/render/portrait.h"
#include "player/render/renderer.h"
#include "player/render/shaders.h"
#include "player/render/studio.h"

/*
 * Pictures are drawn this many times as wide and high and then averaged. In software that takes two thirds of the time of
 * 4 samples a pixel, and smooths highlights and painted edges too (measured: Mesa 22.3, 52,000 triangles, 640 x 480).
 */
enum { OVERSAMPLING = 2 };

struct renderer {
    gl_context own; /* zeroed where the context is the caller's */
    gl_context_source source;
    gl_functions gl;
    int loaded; /* whether gl can be called */
    const fap_bank *bank;
    head_frame head;
    int width, height; /* 0: no targets */
    int dressed;       /* portrait and studio are whole */
    int begun;         /* a picture waits to be read back */
    int scale;         /* of what is drawn: OVERSAMPLING, or 1 where the context has no room for it */
    gl_target drawn, resolved;
    face_array face;
    portrait portrait;
    overlay over;
    studio studio;
};

/* --- making and unmaking --- */

static fap_err make_programs(renderer *r, char *where)
{
    const render_look plain = { 0 };
    fap_err err = portrait_make(&r->portrait, &r->gl, NULL, where);

    if (!err)
        err = overlay_make(&r->over, &r->gl, where);
    return err ? err : studio_make(&r->studio, &r->gl, &plain, where);
}

static fap_err make_face(renderer *r, char *where)
{
    const GLuint depth = gl_program_make(&r->gl, depth_vertex_source, depth_fragment_source, where);
    const fap_err err = depth ? face_array_make(&r->face, &r->gl, r->bank, depth) : FAP_E_UNSUPPORTED;

    r->gl.DeleteProgram(depth);
    return err;
}

static fap_err make_scene(renderer *r, int width, int height, char *where)
{
    const char *missing = gl_load(&r->gl, r->source.get_function);
    fap_err err;

    if (missing) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "this OpenGL has no %s", missing);
        return FAP_E_UNSUPPORTED;
    }
    r->loaded = 1;
    if ((err = make_programs(r, where)) || (err = make_face(r, where)))
        return err;
    r->dressed = 1;
    err = renderer_resize(r, width, height);
    if (err)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "no framebuffer of %d x %d pixels", width, height);
    return err;
}

static int possible_size(int width, int height)
{
    return width >= 1 && height >= 1 && width <= RENDER_MAX_SIZE && height <= RENDER_MAX_SIZE;
}

static renderer *allocate(const fap_bank *bank)
{
    renderer *r = calloc(1, sizeof *r);

    if (r) {
        r->bank = bank;
        r->head = head_frame_of(bank);
    }
    return r;
}

static fap_err finish(renderer **out, renderer *r, fap_err err)
{
    if (err)
        renderer_destroy(&r);
    *out = r;
    return err;
}

fap_err renderer_create(renderer **out, const char *name, const fap_bank *bank, int width, int height,
                        char *where)
{
    *out = NULL;
    *where = '\0';
    if (!possible_size(width, height))
        return FAP_E_ARG;
    renderer *r = allocate(bank);
    if (!r)
        return FAP_E_NOMEM;
    fap_err err = gl_context_open(&r->own, name, where);
    if (!err) {
        const gl_context_driver *d = r->own.driver;
        r->source = (gl_context_source){ d->get_function, d->make_current, r->own.state };
        err = make_scene(r, width, height, where);
    }
    return finish(out, r, err);
}

fap_err renderer_create_on(renderer **out, const gl_context_source *source, const fap_bank *bank, int width,
                           int height, char *where)
{
    *out = NULL;
    *where = '\0';
    if (!possible_size(width, height))
        return FAP_E_ARG;
    renderer *r = allocate(bank);
    if (!r)
        return FAP_E_NOMEM;
    r->source = *source;
    return finish(out, r, make_scene(r, width, height, where));
}

static void make_current(const renderer *r)
{
    if (r->source.make_current)
        r->source.make_current(r->source.user);
}

static void delete_targets(renderer *r)
{
    gl_target_delete(&r->gl, &r->drawn);
    gl_target_delete(&r->gl, &r->resolved);
    r->width = r->height = r->begun = 0;
}

static void delete_scene(renderer *r)
{
    make_current(r);
    delete_targets(r);
    face_array_delete(&r->face, &r->gl);
    overlay_delete(&r->over, &r->gl);
    portrait_delete(&r->portrait, &r->gl);
    studio_delete(&r->studio, &r->gl);
}

void renderer_destroy(renderer **r)
{
    if (!*r)
        return;
    if ((*r)->loaded)
        delete_scene(*r);
    gl_context_close(&(*r)->own);
    free(*r);
    *r = NULL;
}

fap_err renderer_dress(renderer *r, const render_look *look, char *where)
{
    *where = '\0';
    if (look->skin && !fap_bank_mesh(r->bank)->uv) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "this face has no texture coordinates; the default face has");
        return FAP_E_DATA;
    }
    make_current(r);
    portrait_delete(&r->portrait, &r->gl);
    studio_delete(&r->studio, &r->gl);
    r->dressed = 0;
    fap_err err = portrait_make(&r->portrait, &r->gl, look->skin, where);
    if (!err)
        err = studio_make(&r->studio, &r->gl, look, where);
    r->dressed = !err;
    return err;
}

/* A Raspberry Pi 4 has 4096 pixels a side. */
static int oversampling(const gl_functions *gl, int width, int height)
{
    GLint most = 0;

    gl->GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    return OVERSAMPLING * width <= most && OVERSAMPLING * height <= most ? OVERSAMPLING : 1;
}

fap_err renderer_resize(renderer *r, int width, int height)
{
    if (!possible_size(width, height))
        return FAP_E_ARG;
    if (width == r->width && height == r->height)
        return FAP_OK;
    make_current(r);
    delete_targets(r);
    r->scale = oversampling(&r->gl, width, height);
    if (!gl_target_make(&r->gl, &r->drawn, r->scale * width, r->scale * height, 1) ||
        !gl_target_make(&r->gl, &r->resolved, width, height, 0)) {
        delete_targets(r);
        return FAP_E_LIMIT;
    }
    r->width = width;
    r->height = height;
    return FAP_OK;
}

const char *renderer_description(const renderer *r)
{
    make_current(r);
    return (const char *)r->gl.GetString(GL_RENDERER);
}

const char *renderer_gl_name(int i)
{
    return gl_context_drivers[i] ? gl_context_drivers[i]->name : NULL;
}

/* --- drawing --- */

static render_lens lens_of(const renderer *r, const render_view *view)
{
    render_lens lens;

    camera_place(&lens, &r->head, view, (float)r->width / (float)r->height);
    return lens;
}

/* Pixels across a mark. */
static float mark_size(int height)
{
    return fmaxf(5, (float)height / 110);
}

static void draw_portrait(const renderer *r, const render_scene *scene, const render_lens *lens)
{
    const portrait_pose pose = {
        .face = &r->face,
        .mesh = fap_bank_mesh(r->bank),
        .position = scene->position,
        .normal = scene->normal,
        .head = &r->head,
        .lens = lens,
    };
    portrait_draw(&r->portrait, &r->gl, &pose);
}

static void draw_overlay(const renderer *r, const render_scene *scene, const render_lens *lens)
{
    if (scene->wireframe)
        overlay_draw_wire(&r->over, &r->gl, &r->face, lens);
    if (scene->mark_count)
        overlay_draw_marks(&r->over, &r->gl, scene->mark, scene->mark_count, lens,
                           (float)r->scale * mark_size(r->height));
}

/* A window's toolkit may have left any state behind: what matters here is set. */
static void draw_scene(const renderer *r, const render_scene *scene)
{
    const gl_functions *gl = &r->gl;
    const render_lens lens = lens_of(r, &scene->view);

    gl->BindFramebuffer(GL_FRAMEBUFFER, r->drawn.frame);
    gl->Viewport(0, 0, r->scale * r->width, r->scale * r->height);
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_BLEND);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE); /* the back of the head is half of the triangles */
    draw_portrait(r, scene, &lens);
    draw_overlay(r, scene, &lens);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
}

static fap_err draw_into(renderer *r, const render_scene *scene, render_target target, int first_on_top)
{
    if (!r->width || !r->dressed)
        return FAP_E_ARG;
    make_current(r);
    const fap_err err =
        face_array_send(&r->face, &r->gl, fap_bank_mesh(r->bank), scene->position, scene->normal);
    if (err)
        return err;
    draw_scene(r, scene);
    r->gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    studio_draw(&r->studio, &r->gl, r->drawn.colour, target.x, target.y, r->width, r->height, first_on_top);
    return FAP_OK;
}

fap_err renderer_begin(renderer *r, const render_scene *scene)
{
    if (r->begun)
        return FAP_E_ARG;
    const fap_err err = draw_into(r, scene, (render_target){ r->resolved.frame, 0, 0 }, 1);
    if (err)
        return err;
    r->gl.Flush(); /* what is queued here nobody draws */
    r->begun = 1;
    return FAP_OK;
}

fap_err renderer_finish(renderer *r, image *out)
{
    const gl_functions *gl = &r->gl;

    if (!r->begun || out->width != r->width || out->height != r->height)
        return FAP_E_ARG;
    r->begun = 0;
    make_current(r);
    gl->BindFramebuffer(GL_FRAMEBUFFER, r->resolved.frame);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, r->width, r->height, GL_RGBA, GL_UNSIGNED_BYTE, out->rgba);
    return gl->GetError() == GL_NO_ERROR ? FAP_OK : FAP_E_IO;
}

fap_err renderer_draw(renderer *r, const render_scene *scene, image *out)
{
    if (out->width != r->width || out->height != r->height)
        return FAP_E_ARG;
    const fap_err err = renderer_begin(r, scene);
    return err ? err : renderer_finish(r, out);
}

fap_err renderer_show(renderer *r, const render_scene *scene, render_target target)
{
    const fap_err err = draw_into(r, scene, target, 0);

    if (err)
        return err;
    return r->gl.GetError() == GL_NO_ERROR ? FAP_OK : FAP_E_IO;
}

int renderer_project(const renderer *r, const render_view *view, const float place_mm[3], float pixel[3])
{
    const render_lens lens = lens_of(r, view);
    return r->width && camera_project(&lens, place_mm, r->width, r->height, pixel);
}
#endif
