/* SPDX-License-Identifier: BSD-2-Clause */
/* See renderer.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include "player/render/camera.h"
#include "player/render/context.h"
#include "player/render/gl_objects.h"
#include "player/render/lamps.h"
#include "player/render/overlay.h"
#include "player/render/renderer.h"
#include "player/render/shaders.h"

/*
 * Pictures are drawn this many times as wide and high and then averaged. In software that takes two thirds of the time of
 * 4 samples a pixel, and smooths highlights and painted edges too (measured: Mesa 22.3, 52,000 triangles, 640 x 480).
 */
enum { OVERSAMPLING = 2 };

/* Programs and where their uniforms are. */
typedef struct skin_program {
    GLuint program;
    GLint view_projection, view, half_key;
} skin_program;

typedef struct eye_program {
    GLuint program;
    GLint view_projection, view, gaze, lid, iris, white, limbus, size;
} eye_program;

typedef struct studio_program {
    GLuint program;
    GLint place, first_on_top, drawn;
} studio_program;

struct renderer {
    gl_context own; /* zeroed where the context is the caller's */
    gl_context_source source;
    gl_functions gl;
    int loaded; /* whether gl can be called */
    const fap_bank *bank;
    head_frame head;
    int width, height; /* 0: no targets */
    int begun;         /* a picture waits to be read back */
    int scale;         /* of what is drawn: OVERSAMPLING, or 1 where the context has no room for it */
    gl_target drawn, resolved;
    studio_program studio;
    GLuint empty_array; /* core profiles want one even where no vertices are read */
    skin_program skin;
    eye_program eyes;
    face_array face;
    overlay over;
};

/* --- making and unmaking --- */

static void find_skin_uniforms(skin_program *p, const gl_functions *gl)
{
    p->view_projection = gl->GetUniformLocation(p->program, "view_projection");
    p->view = gl->GetUniformLocation(p->program, "view");
    p->half_key = gl->GetUniformLocation(p->program, "half_key");
}

static void find_eye_uniforms(eye_program *p, const gl_functions *gl)
{
    p->view_projection = gl->GetUniformLocation(p->program, "view_projection");
    p->view = gl->GetUniformLocation(p->program, "view");
    p->gaze = gl->GetUniformLocation(p->program, "gaze");
    p->lid = gl->GetUniformLocation(p->program, "lid");
    p->iris = gl->GetUniformLocation(p->program, "iris");
    p->white = gl->GetUniformLocation(p->program, "white");
    p->limbus = gl->GetUniformLocation(p->program, "limbus");
    p->size = gl->GetUniformLocation(p->program, "size");
}

static fap_err make_programs(renderer *r, char *where)
{
    const gl_functions *gl = &r->gl;

    r->studio.program = gl_program_make(gl, studio_vertex_source, studio_fragment_source, where);
    r->skin.program = gl_program_make(gl, face_vertex_source, face_fragment_source, where);
    r->eyes.program = gl_program_make(gl, eye_vertex_source, eye_fragment_source, where);
    if (!r->studio.program || !r->skin.program || !r->eyes.program)
        return FAP_E_UNSUPPORTED;
    r->studio.place = gl->GetUniformLocation(r->studio.program, "place");
    r->studio.first_on_top = gl->GetUniformLocation(r->studio.program, "first_on_top");
    r->studio.drawn = gl->GetUniformLocation(r->studio.program, "drawn");
    gl->GenVertexArrays(1, &r->empty_array);
    find_skin_uniforms(&r->skin, gl);
    find_eye_uniforms(&r->eyes, gl);
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
    r->width = r->height = r->begun = 0;
}

static void delete_scene(renderer *r)
{
    make_current(r);
    delete_targets(r);
    face_array_delete(&r->face, &r->gl);
    overlay_delete(&r->over, &r->gl);
    r->gl.DeleteProgram(r->skin.program);
    r->gl.DeleteProgram(r->eyes.program);
    r->gl.DeleteProgram(r->studio.program);
    r->gl.DeleteVertexArrays(1, &r->empty_array);
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
    render_lens c;

    camera_place(&c, &r->head, view, (float)r->width / (float)r->height);
    return c;
}

/* The lens is long and the head far: one direction to the eye serves all of it. */
static void direction_to_eye(const renderer *r, const render_lens *lens, vec3 out)
{
    glm_vec3_sub((float *)lens->eye, (float *)r->head.centre, out);
    glm_vec3_normalize(out);
}

static void use_skin(const renderer *r, const render_lens *lens, vec3 view)
{
    const gl_functions *gl = &r->gl;
    vec3 key = { KEY_FROM }, half_key;

    glm_vec3_normalize(key);
    glm_vec3_add(key, view, half_key);
    glm_vec3_normalize(half_key);
    gl->UseProgram(r->skin.program);
    gl->UniformMatrix4fv(r->skin.view_projection, 1, GL_FALSE, lens->view_projection[0]);
    gl->Uniform3fv(r->skin.view, 1, view);
    gl->Uniform3fv(r->skin.half_key, 1, half_key);
}

static void draw_eye(const renderer *r, const render_scene *scene, int right)
{
    const gl_functions *gl = &r->gl;
    const eye_look *eye = &r->face.eye[right];
    vec3 gaze, lid;

    eye_look_pose(eye, fap_bank_mesh(r->bank), scene->position, scene->normal, gaze, lid);
    gl->Uniform3fv(r->eyes.gaze, 1, gaze);
    gl->Uniform3fv(r->eyes.lid, 1, lid);
    gl->Uniform3fv(r->eyes.iris, 1, eye->iris);
    gl->Uniform3fv(r->eyes.white, 1, eye->white);
    gl->Uniform1f(r->eyes.limbus, eye->limbus);
    gl->Uniform1f(r->eyes.size, fmaxf(1, eye->radius_mm));
    face_array_draw(&r->face, gl, RANGE_EYE_LEFT + (unsigned)right, RANGE_EYE_LEFT + (unsigned)right + 1);
}

static void draw_face(const renderer *r, const render_scene *scene, const render_lens *lens)
{
    const gl_functions *gl = &r->gl;
    vec3 view;

    direction_to_eye(r, lens, view);
    gl->UseProgram(r->eyes.program);
    gl->UniformMatrix4fv(r->eyes.view_projection, 1, GL_FALSE, lens->view_projection[0]);
    gl->Uniform3fv(r->eyes.view, 1, view);
    use_skin(r, lens, view);
    face_array_draw(&r->face, gl, RANGE_SKIN, RANGE_SKIN + 1);
    face_array_draw(&r->face, gl, RANGE_INSIDE, RANGE_INSIDE + 1);
    gl->UseProgram(r->eyes.program);
    draw_eye(r, scene, 0);
    draw_eye(r, scene, 1);
}

/* Pixels across a mark. */
static float mark_size(int height)
{
    return fmaxf(5, (float)height / 110);
}

/* A window's toolkit may have left any state behind: what matters here is set. */
static void draw_scene(renderer *r, const render_scene *scene)
{
    const gl_functions *gl = &r->gl;
    render_lens c = lens_of(r, &scene->view);

    gl->BindFramebuffer(GL_FRAMEBUFFER, r->drawn.frame);
    gl->Viewport(0, 0, r->scale * r->width, r->scale * r->height);
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_BLEND);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE); /* the back of the head is half of the triangles */
    draw_face(r, scene, &c);
    if (scene->wireframe)
        overlay_draw_wire(&r->over, gl, &r->face, &c);
    if (scene->mark_count)
        overlay_draw_marks(&r->over, gl, scene->mark, scene->mark_count, &c,
                           (float)r->scale * mark_size(r->height));
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
}

/* The face before the studio. @first_on_top: 0 as OpenGL counts rows, 1 as pictures do. */
static void draw_studio(const renderer *r, render_target target, int first_on_top)
{
    const gl_functions *gl = &r->gl;
    const float place[4] = { (float)target.x, (float)target.y, (float)r->width, (float)r->height };

    gl->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl->Viewport(target.x, target.y, r->width, r->height);
    gl->UseProgram(r->studio.program);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, r->drawn.colour);
    gl->Uniform1i(r->studio.drawn, 0);
    gl->Uniform4fv(r->studio.place, 1, place);
    gl->Uniform1i(r->studio.first_on_top, first_on_top);
    gl->BindVertexArray(r->empty_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

static fap_err draw_into(renderer *r, const render_scene *scene, render_target target, int first_on_top)
{
    if (!r->width)
        return FAP_E_ARG;
    make_current(r);
    const fap_err err =
        face_array_send(&r->face, &r->gl, fap_bank_mesh(r->bank), scene->position, scene->normal);
    if (err)
        return err;
    draw_scene(r, scene);
    draw_studio(r, target, first_on_top);
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
    const render_lens c = lens_of(r, view);
    return r->width && camera_project(&c, place_mm, r->width, r->height, pixel);
}
#endif
