/* SPDX-License-Identifier: BSD-2-Clause */
/* See portrait.h. */
#ifdef HAVE_GL
#include "player/render/gl_objects.h"
#include "player/render/lamps.h"
#include "player/render/portrait.h"
#include "player/render/shaders.h"

static void find_skin_uniforms(portrait *p, const gl_functions *gl)
{
    const GLuint program = p->skin_program;

    p->skin.view_projection = gl->GetUniformLocation(program, "view_projection");
    p->skin.view = gl->GetUniformLocation(program, "view");
    p->skin.half_key = gl->GetUniformLocation(program, "half_key");
}

static void find_eye_uniforms(portrait *p, const gl_functions *gl)
{
    const GLuint program = p->eye_program;

    p->eye.view_projection = gl->GetUniformLocation(program, "view_projection");
    p->eye.view = gl->GetUniformLocation(program, "view");
    p->eye.gaze = gl->GetUniformLocation(program, "gaze");
    p->eye.lid = gl->GetUniformLocation(program, "lid");
    p->eye.iris = gl->GetUniformLocation(program, "iris");
    p->eye.white = gl->GetUniformLocation(program, "white");
    p->eye.limbus = gl->GetUniformLocation(program, "limbus");
    p->eye.size = gl->GetUniformLocation(program, "size");
}

static GLuint make_skin_program(const gl_functions *gl, int textured, char *where)
{
    return textured ? gl_program_make(gl, textured_vertex_source, textured_fragment_source, where)
                    : gl_program_make(gl, face_vertex_source, face_fragment_source, where);
}

static fap_err take_skin(portrait *p, const gl_functions *gl, const image *picture, char *where)
{
    p->skin_picture = gl_texture_make(gl, picture);
    if (p->skin_picture)
        return FAP_OK;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "this OpenGL takes no texture of %d x %d pixels", picture->width,
             picture->height);
    return FAP_E_LIMIT;
}

fap_err portrait_make(portrait *p, const gl_functions *gl, const image *skin_picture, char *where)
{
    *p = (portrait){
        .skin_program = make_skin_program(gl, skin_picture != NULL, where),
        .eye_program = gl_program_make(gl, eye_vertex_source, eye_fragment_source, where),
    };
    if (!p->skin_program || !p->eye_program)
        return FAP_E_UNSUPPORTED;
    find_skin_uniforms(p, gl);
    find_eye_uniforms(p, gl);
    return skin_picture ? take_skin(p, gl, skin_picture, where) : FAP_OK;
}

void portrait_delete(portrait *p, const gl_functions *gl)
{
    gl->DeleteProgram(p->skin_program); /* OpenGL ignores 0 */
    gl->DeleteProgram(p->eye_program);
    gl->DeleteTextures(1, &p->skin_picture);
    *p = (portrait){ 0 };
}

/* The lens is long and the head far: one direction to the viewer serves all of it. */
static void direction_to_viewer(const portrait_pose *pose, vec3 out)
{
    glm_vec3_sub((float *)pose->lens->eye, (float *)pose->head->centre, out);
    glm_vec3_normalize(out);
}

static void draw_skin(const portrait *p, const gl_functions *gl, const portrait_pose *pose, vec3 view)
{
    vec3 key = { KEY_FROM }, half_key;

    glm_vec3_normalize(key);
    glm_vec3_add(key, view, half_key);
    glm_vec3_normalize(half_key);
    gl->UseProgram(p->skin_program);
    gl->UniformMatrix4fv(p->skin.view_projection, 1, GL_FALSE, pose->lens->view_projection[0]);
    gl->Uniform3fv(p->skin.view, 1, view);
    gl->Uniform3fv(p->skin.half_key, 1, half_key);
    gl->ActiveTexture(GL_TEXTURE0); /* where samplers look unless told otherwise */
    gl->BindTexture(GL_TEXTURE_2D, p->skin_picture);
    face_array_draw(pose->face, gl, RANGE_SKIN);
    face_array_draw(pose->face, gl, RANGE_INSIDE);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

static void draw_eye(const portrait *p, const gl_functions *gl, const portrait_pose *pose, int right)
{
    const eye_look *eye = &pose->face->eye[right];
    vec3 gaze, lid;

    eye_look_pose(eye, pose->mesh, pose->position, pose->normal, gaze, lid);
    gl->Uniform3fv(p->eye.gaze, 1, gaze);
    gl->Uniform3fv(p->eye.lid, 1, lid);
    gl->Uniform3fv(p->eye.iris, 1, eye->iris);
    gl->Uniform3fv(p->eye.white, 1, eye->white);
    gl->Uniform1f(p->eye.limbus, eye->limbus);
    gl->Uniform1f(p->eye.size, fmaxf(1, eye->radius_mm));
    face_array_draw(pose->face, gl, right ? RANGE_EYE_RIGHT : RANGE_EYE_LEFT);
}

static void draw_eyes(const portrait *p, const gl_functions *gl, const portrait_pose *pose, vec3 view)
{
    gl->UseProgram(p->eye_program);
    gl->UniformMatrix4fv(p->eye.view_projection, 1, GL_FALSE, pose->lens->view_projection[0]);
    gl->Uniform3fv(p->eye.view, 1, view);
    draw_eye(p, gl, pose, 0);
    draw_eye(p, gl, pose, 1);
}

void portrait_draw(const portrait *p, const gl_functions *gl, const portrait_pose *pose)
{
    vec3 view;

    direction_to_viewer(pose, view);
    draw_skin(p, gl, pose, view);
    draw_eyes(p, gl, pose, view);
}
#endif
