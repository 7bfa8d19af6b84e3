/* SPDX-License-Identifier: BSD-2-Clause */
/* See camera.h and view.h. */
#include <string.h>

#include "player/render/camera.h"

/* Fixed views stand a little above the middle of the head. */
#define A_LITTLE_ABOVE 1.145763f

static const struct {
    const char *name;
    render_view view;
} cameras[CAMERA_COUNT] = {
    [CAMERA_FRONT] = { "front", { 0, A_LITTLE_ABOVE, 1.0002f, 0, 0 } },
    [CAMERA_LEFT] = { "left", { 88, A_LITTLE_ABOVE, 1.0002f, 0, 0 } },
    [CAMERA_RIGHT] = { "right", { -88, A_LITTLE_ABOVE, 1.0002f, 0, 0 } },
    [CAMERA_THREE_QUARTER] = { "three-quarter", { 38, A_LITTLE_ABOVE, 1.0002f, 0, 0 } },
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

render_view render_view_of(render_camera camera)
{
    return cameras[camera].view;
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

head_frame head_frame_of(const fap_bank *bank)
{
    const float above = 0.10f, below = 0.17f, beside = 0.06f; /* margins, in heights and widths of the head */
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float low[3], high[3];

    for (int a = 0; a < 3; a++)
        extent(mesh, a, &low[a], &high[a]);
    const float chin = point_height(bank, "2.1", low[1]), crown = point_height(bank, "11.4", high[1]);
    const float height = fmaxf(1, crown - chin);
    const float bottom = chin - below * height, top = crown + above * height;
    return (head_frame){
        .centre = { 0.5f * (low[0] + high[0]), 0.5f * (bottom + top), 0.5f * (low[2] + high[2]) },
        .half_height = 0.5f * (top - bottom),
        .half_width = (0.5f + beside) * (high[0] - low[0]),
        .half_depth = 0.5f * (high[2] - low[2]),
    };
}

void camera_place(render_lens *c, const head_frame *head, const render_view *view, float aspect)
{
    const float field = glm_rad(16);
    const float yaw = glm_rad(view->yaw_degrees), pitch = glm_rad(glm_clamp(view->pitch_degrees, -89, 89));
    const float half = fmaxf(head->half_height, head->half_width / aspect);
    const float whole = half / tanf(field / 2) + head->half_depth;
    const float distance = glm_clamp(view->distance, 0.05f, 10) * whole;
    const vec3 right = { cosf(yaw), 0, -sinf(yaw) };
    const vec3 up = { -sinf(yaw) * sinf(pitch), cosf(pitch), -cosf(yaw) * sinf(pitch) };
    const vec3 back = { sinf(yaw) * cosf(pitch), sinf(pitch), cosf(yaw) * cosf(pitch) };
    vec3 centre;
    mat4 look, projection;

    for (int a = 0; a < 3; a++) {
        centre[a] = head->centre[a] + half * (view->right * right[a] + view->up * up[a]);
        c->eye[a] = centre[a] + distance * back[a];
    }
    const float near = fmaxf(0.02f * whole, distance - 3 * head->half_depth - 2 * half);
    glm_lookat(c->eye, centre, (vec3){ 0, 1, 0 }, look);
    glm_perspective(field, aspect, near, distance + 3 * head->half_depth + 2 * half, projection);
    glm_mat4_mul(projection, look, c->view_projection);
}

int camera_project(const render_lens *c, const float place_mm[3], int width, int height, float pixel[3])
{
    vec4 place = { place_mm[0], place_mm[1], place_mm[2], 1 }, clip;

    glm_mat4_mulv((vec4 *)c->view_projection, place, clip);
    if (clip[3] <= 0)
        return 0;
    pixel[0] = (0.5f + 0.5f * clip[0] / clip[3]) * (float)width;
    pixel[1] = (0.5f - 0.5f * clip[1] / clip[3]) * (float)height;
    pixel[2] = clip[2] / clip[3];
    return 1;
}
