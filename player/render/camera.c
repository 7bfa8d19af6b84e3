/* SPDX-License-Identifier: BSD-2-Clause */
/* See camera.h. */
#include <string.h>

#include "player/render/camera.h"

static const struct {
    const char *name;
    float turn_degrees; /* to the viewer's right about the head, positive shows the face's left side */
} cameras[CAMERA_COUNT] = {
    [CAMERA_FRONT] = { "front", 0 },
    [CAMERA_LEFT] = { "left", 88 },
    [CAMERA_RIGHT] = { "right", -88 },
    [CAMERA_THREE_QUARTER] = { "three-quarter", 38 },
};

int render_camera_by_name(const char *name)
{
    for (int i = 0; i < CAMERA_COUNT; i++)
        if (!strcmp(cameras[i].name, name))
            return i;
    return -1;
}

const char *render_camera_name(render_camera camera)
{
    return cameras[camera].name;
}

/* Lowest and highest skin vertex along an axis: the frame where a face lacks the points for a better one. */
static void extent(const fap_mesh *mesh, int axis, float *low, float *high)
{
    const float *v = mesh->position + (size_t)axis * mesh->stride;

    *low = *high = v[0];
    for (uint32_t i = 1; i < mesh->vertex_count; i++) {
        *low = fminf(*low, v[i]);
        *high = fmaxf(*high, v[i]);
    }
}

static float point_height(const fap_bank *bank, const char *name, float otherwise)
{
    const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(name));
    return p && p->present ? p->position_mm[1] : otherwise;
}

void camera_place(const fap_bank *bank, render_camera camera, float aspect, mat4 view_projection, vec3 eye)
{
    const float field_degrees = 16, above = 0.10f, below = 0.17f; /* of the head's height */
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float low[3], high[3];

    for (int a = 0; a < 3; a++)
        extent(mesh, a, &low[a], &high[a]);
    const float chin = point_height(bank, "2.1", low[1]), crown = point_height(bank, "11.4", high[1]);
    const float height = fmaxf(1, crown - chin);
    const float bottom = chin - below * height, top = crown + above * height;
    const float width = 1.12f * (high[0] - low[0]);
    const float half = 0.5f * fmaxf(top - bottom, width / aspect);

    vec3 centre = { 0.5f * (low[0] + high[0]), 0.5f * (bottom + top), 0.5f * (low[2] + high[2]) };
    const float distance = half / tanf(glm_rad(field_degrees / 2)) + 0.5f * (high[2] - low[2]);
    const float turn = glm_rad(cameras[camera].turn_degrees);
    eye[0] = centre[0] + distance * sinf(turn);
    eye[1] = centre[1] + 0.02f * distance;
    eye[2] = centre[2] + distance * cosf(turn);

    mat4 view, projection;
    glm_lookat(eye, centre, (vec3){ 0, 1, 0 }, view);
    glm_perspective(glm_rad(field_degrees), aspect, 0.3f * distance, 2 * distance, projection);
    glm_mat4_mul(projection, view, view_projection);
}
