/* SPDX-License-Identifier: BSD-2-Clause */
/* See renderer.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include "player/render/camera.h"
#include "player/render/context.h"
#include "player/render/gl_objects.h"
#include "player/render/overlay.h"
#include "player/render/renderer.h"
#include "player/render/shaders.h"

enum { SAMPLES = 4 };

struct renderer {
    gl_context own; /* zeroed where the context is the caller's */
    gl_context_source source;
    gl_functions gl;
    int loaded; /* whether gl can be called */
    const fap_bank *bank;
    head_frame head;
    int width, height;         /* 0: no targets */
    gl_target drawn, resolved; /* multisampled, and what is read back */
    GLuint background, background_array;
    GLuint program;
    GLint view_projection, eye; /* uniforms */
    face_array face;
    overlay over;
};

/* --- making and unmaking --- */

static fap_err make_programs(renderer *r, char *where)
{
    const gl_functions *gl = &r->gl;

    r->background = gl_program_make(gl, background_vertex_source, background_fragment_source, where);
    r->program = gl_program_make(gl, face_vertex_source, face_fragment_source, where);
    if (!r->background || !r->program)
        return FAP_E_UNSUPPORTED;
    gl->GenVertexArrays(1, &r->background_array);
    r->view_projection = gl->GetUniformLocation(r->program, "view_projection");
    r->eye = gl->GetUniformLocation(r->program, "eye");
    return overlay_make(&r->over, gl, where);
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
    r->width = r->height = 0;
}

static void delete_scene(renderer *r)
{
    make_current(r);
    delete_targets(r);
    face_array_delete(&r->face, &r->gl);
    overlay_delete(&r->over, &r->gl);
    r->gl.DeleteProgram(r->program);
    r->gl.DeleteProgram(r->background);
    r->gl.DeleteVertexArrays(1, &r->background_array);
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

fap_err renderer_resize(renderer *r, int width, int height)
{
    if (!possible_size(width, height))
        return FAP_E_ARG;
    if (width == r->width && height == r->height)
        return FAP_OK;
    make_current(r);
    delete_targets(r);
    if (!gl_target_make(&r->gl, &r->drawn, width, height, SAMPLES, 1) ||
        !gl_target_make(&r->gl, &r->resolved, width, height, 0, 0)) {
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
    render_lens c;

    camera_place(&c, &r->head, view, (float)r->width / (float)r->height);
    return c;
}

static void draw_background(const renderer *r)
{
    const gl_functions *gl = &r->gl;

    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
    gl->UseProgram(r->background);
    gl->BindVertexArray(r->background_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_face(const renderer *r, const render_lens *c)
{
    const gl_functions *gl = &r->gl;

    gl->UseProgram(r->program);
    gl->UniformMatrix4fv(r->view_projection, 1, GL_FALSE, c->view_projection[0]);
    gl->Uniform3fv(r->eye, 1, c->eye);
    face_array_draw(&r->face, gl);
}

/* A window's toolkit may have left any state behind: what matters here is set. */
static void draw_scene(renderer *r, const render_scene *scene)
{
    const gl_functions *gl = &r->gl;
    render_lens c = lens_of(r, &scene->view);

    gl->BindFramebuffer(GL_FRAMEBUFFER, r->drawn.frame);
    gl->Viewport(0, 0, r->width, r->height);
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_BLEND);
    gl->Clear(GL_DEPTH_BUFFER_BIT);
    draw_background(r);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE); /* the back of the head is half of the triangles */
    draw_face(r, &c);
    if (scene->wireframe)
        overlay_draw_wire(&r->over, gl, &r->face, &c);
    if (scene->mark_count)
        overlay_draw_marks(&r->over, gl, scene->mark, scene->mark_count, &c, r->height);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
}

static void copy(const renderer *r, GLuint from, GLuint to, int x, int y)
{
    r->gl.BindFramebuffer(GL_READ_FRAMEBUFFER, from);
    r->gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    r->gl.BlitFramebuffer(0, 0, r->width, r->height, x, y, x + r->width, y + r->height, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
}

/* Leaves the picture in the target that can be read. */
static fap_err draw_resolved(renderer *r, const render_scene *scene)
{
    if (!r->width)
        return FAP_E_ARG;
    make_current(r);
    const fap_err err =
        face_array_send(&r->face, &r->gl, fap_bank_mesh(r->bank), scene->position, scene->normal);
    if (err)
        return err;
    draw_scene(r, scene);
    copy(r, r->drawn.frame, r->resolved.frame, 0, 0);
    return FAP_OK;
}

/* OpenGL's rows start at the bottom. */
static void turn_over(image *im)
{
    const size_t row = (size_t)im->width * 4;

    for (int y = 0; y < im->height / 2; y++) {
        uint8_t *a = im->rgba + (size_t)y * row, *b = im->rgba + (size_t)(im->height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) {
            const uint8_t swap = a[i];
            a[i] = b[i];
            b[i] = swap;
        }
    }
}

fap_err renderer_draw(renderer *r, const render_scene *scene, image *out)
{
    const gl_functions *gl = &r->gl;

    if (out->width != r->width || out->height != r->height)
        return FAP_E_ARG;
    const fap_err err = draw_resolved(r, scene);
    if (err)
        return err;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, r->resolved.frame);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, r->width, r->height, GL_RGBA, GL_UNSIGNED_BYTE, out->rgba);
    turn_over(out);
    return gl->GetError() == GL_NO_ERROR ? FAP_OK : FAP_E_IO;
}

fap_err renderer_show(renderer *r, const render_scene *scene, render_target target)
{
    const fap_err err = draw_resolved(r, scene);
    if (err)
        return err;
    copy(r, r->resolved.frame, target.framebuffer, target.x, target.y);
    r->gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    return r->gl.GetError() == GL_NO_ERROR ? FAP_OK : FAP_E_IO;
}

int renderer_project(const renderer *r, const render_view *view, const float place_mm[3], float pixel[3])
{
    const render_lens c = lens_of(r, view);
    return r->width && camera_project(&c, place_mm, r->width, r->height, pixel);
}
#endif
