/* SPDX-License-Identifier: BSD-2-Clause */
/* See eye_look.h. */
#include "player/render/eye_look.h"

enum {
    WHITE_LEAST = 150,
    COLOURED_LEAST = 60
}; /* sRGB: of the darkest channel of the white; of the brightest of the iris */

typedef struct eyeball {
    const fap_mesh *mesh;
    fap_part part;
    vec3 centre, right, up, axis;
} eyeball;

static void read_vertex(const fap_mesh *mesh, const float *array, uint32_t i, vec3 out)
{
    for (int a = 0; a < 3; a++)
        out[a] = array[(size_t)a * mesh->stride + i];
}

static void eyeball_frame(eyeball *e, const fap_bank *bank, int right, float *radius)
{
    const fap_bank_point *pupil = fap_bank_point_get(bank, fap_point_by_name(right ? "3.6" : "3.5"));

    e->mesh = fap_bank_mesh(bank);
    e->part = right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT;
    if (!fap_bank_eye(bank, right, e->centre, radius))
        *radius = 0;
    glm_vec3_copy((vec3){ 0, 0, 1 }, e->axis);
    if (*radius > 0 && pupil && pupil->present)
        glm_vec3_sub((float *)pupil->position_mm, e->centre, e->axis);
    glm_vec3_normalize(e->axis);
    glm_vec3_crossn((vec3){ 0, 1, 0 }, e->axis, e->right);
    glm_vec3_cross(e->axis, e->right, e->up);
}

/* The direction of a vertex as seen along the axis; all of the back lies on the rim. */
static void seen_from_front(const eyeball *e, uint32_t i, vec2 out)
{
    vec3 d;

    read_vertex(e->mesh, e->mesh->position, i, d);
    glm_vec3_sub(d, (float *)e->centre, d);
    glm_vec3_normalize(d);
    out[0] = glm_vec3_dot(d, (float *)e->right);
    out[1] = glm_vec3_dot(d, (float *)e->up);
    if (glm_vec3_dot(d, (float *)e->axis) < 0)
        glm_vec2_normalize(out);
}

static int is_white(const uint8_t *rgb)
{
    return rgb[0] > WHITE_LEAST && rgb[1] > WHITE_LEAST && rgb[2] > WHITE_LEAST;
}

static int is_coloured(const uint8_t *rgb)
{
    return !is_white(rgb) && (rgb[0] > COLOURED_LEAST || rgb[1] > COLOURED_LEAST || rgb[2] > COLOURED_LEAST);
}

/* Between the last ring of vertices that is not white and the first that is. */
static float find_limbus(const eyeball *e, const int16_t (*on_eye)[2])
{
    float white = 1, dark = 0;

    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < e->mesh->vertex_count; i++) {
            if (e->mesh->part[i] != e->part)
                continue;
            const float r = hypotf(on_eye[i][0], on_eye[i][1]) / 32767;
            const int bright = is_white(e->mesh->colour + 4 * (size_t)i);
            if (!pass && bright)
                white = fminf(white, r);
            if (pass && !bright && r < white)
                dark = fmaxf(dark, r);
        }
    return dark > 0 && white < 0.8f ? 0.5f * (white + dark) : 0;
}

/* The mean colour, linear, of the vertices that @belongs chooses among those between two radii. */
static int mean_colour(const eyeball *e, const int16_t (*on_eye)[2], float from, float to,
                       int (*belongs)(const uint8_t *rgb), vec3 out)
{
    int count = 0;

    glm_vec3_zero(out);
    for (uint32_t i = 0; i < e->mesh->vertex_count; i++) {
        const uint8_t *rgb = e->mesh->colour + 4 * (size_t)i;
        const float r = hypotf(on_eye[i][0], on_eye[i][1]) / 32767;
        if (e->mesh->part[i] != e->part || r < from || r > to || !belongs(rgb))
            continue;
        for (int c = 0; c < 3; c++)
            out[c] += (float)rgb[c] * (float)rgb[c] / (255 * 255);
        count++;
    }
    if (count)
        glm_vec3_scale(out, 1 / (float)count, out);
    return count;
}

void eye_look_measure(eye_look *eye, const fap_bank *bank, int right, int16_t (*on_eye)[2])
{
    const fap_bank_point *lid = fap_bank_point_get(bank, fap_point_by_name(right ? "3.2" : "3.1"));
    float nearest = 2;
    eyeball e;

    *eye = (eye_look){ .lid = lid && lid->present && lid->vertex_count ? lid : NULL };
    eyeball_frame(&e, bank, right, &eye->radius_mm);
    if (eye->radius_mm <= 0)
        return;
    for (uint32_t i = 0; i < e.mesh->vertex_count; i++) {
        vec2 at;
        if (e.mesh->part[i] != e.part)
            continue;
        seen_from_front(&e, i, at);
        on_eye[i][0] = (int16_t)lrintf(32767 * at[0]);
        on_eye[i][1] = (int16_t)lrintf(32767 * at[1]);
        if (glm_vec2_norm(at) < nearest) {
            nearest = glm_vec2_norm(at);
            eye->front = i;
        }
    }
    eye->limbus = find_limbus(&e, (const int16_t(*)[2])on_eye);
    if (!mean_colour(&e, (const int16_t(*)[2])on_eye, 0, eye->limbus, is_coloured, eye->iris) ||
        !mean_colour(&e, (const int16_t(*)[2])on_eye, eye->limbus, 0.7f, is_white, eye->white))
        eye->limbus = 0;
}

void eye_look_pose(const eye_look *eye, const fap_mesh *mesh, const float *position, const float *normal,
                   vec3 gaze, vec3 lid)
{
    read_vertex(mesh, normal, eye->front, gaze);
    read_vertex(mesh, position, eye->front, lid);
    lid[1] += eye->radius_mm; /* without a lid nothing shades the eye */
    if (!eye->lid)
        return;
    glm_vec3_zero(lid);
    for (uint32_t k = 0; k < eye->lid->vertex_count; k++) {
        vec3 v;
        read_vertex(mesh, position, eye->lid->vertex[k], v);
        glm_vec3_muladds(v, 1 / (float)eye->lid->vertex_count, lid);
    }
}
