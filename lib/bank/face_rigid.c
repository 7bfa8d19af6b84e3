/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What moves as a body or is held by one: eyeballs, lids on the eyeballs, lower teeth, the tongue's curl, the
 * head. Source: ISO/IEC 14496-2, Annex C, FAPs 23 to 28 and 47 to 50; Lin et al. 2001 section 5.2 (lids slide
 * along the eyeball; teeth clamp above neutral).
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "base/mem.h"

static const float lid_reach = 1.5f; /* lids end this many eyeball radii from its centre */
static const float lid_clearance =
    1.02f; /* and stay this many radii away, if they were so far away to begin with */
static const double most_comparisons =
    1e8; /* lashes times skin; a mesh beyond it keeps its lashes where keys put them */

/* --- lists made at open --- */

static int list_part(fap_face *face, fap_face_list *list, fap_part part)
{
    const fap_mesh *mesh = face->mesh;

    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        list->count += mesh->part[v] == part;
    list->vertex = fap_mem_calloc(&face->alloc, list->count, sizeof *list->vertex);
    if (!list->vertex)
        return 1;
    for (uint32_t v = 0, n = 0; v < mesh->vertex_count; v++)
        if (mesh->part[v] == part)
            list->vertex[n++] = v;
    return 0;
}

static void vertex_at(const fap_mesh *mesh, const float *position, uint32_t v, float out[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = position[axis * mesh->stride + v];
}

static float square_distance(const float a[3], const float b[3])
{
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Skin in front of the eyeball's centre and near it. */
static int is_lid(const fap_face *face, const fap_face_eye *eye, uint32_t v)
{
    float p[3];

    vertex_at(face->mesh, face->mesh->position, v, p);
    return face->mesh->part[v] == FAP_PART_SKIN && p[2] > eye->centre[2] &&
           square_distance(p, eye->centre) < lid_reach * lid_reach * eye->radius * eye->radius;
}

static int list_rest(fap_face *face, fap_face_eye *eye)
{
    const fap_mesh *mesh = face->mesh;

    eye->rest = fap_mem_calloc(&face->alloc, eye->ball.count / FAP_LANES + 1, sizeof *eye->rest);
    if (!eye->rest)
        return 1;
    for (uint32_t i = 0; i < eye->ball.count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            eye->rest[i / FAP_LANES][axis][i % FAP_LANES] =
                mesh->position[axis * mesh->stride + eye->ball.vertex[i]] - eye->centre[axis];
    return 0;
}

static int list_lids(fap_face *face, fap_face_eye *eye)
{
    const uint32_t vertex_count = eye->present ? face->mesh->vertex_count : 0;

    for (uint32_t v = 0; v < vertex_count; v++)
        eye->lid.count += (uint32_t)is_lid(face, eye, v);
    eye->lid.vertex = fap_mem_calloc(&face->alloc, eye->lid.count, sizeof *eye->lid.vertex);
    eye->lid_radius = fap_mem_calloc(&face->alloc, eye->lid.count, sizeof *eye->lid_radius);
    if (!eye->lid.vertex || !eye->lid_radius)
        return 1;
    for (uint32_t v = 0, n = 0; v < vertex_count; v++) {
        float p[3];
        if (!is_lid(face, eye, v))
            continue;
        vertex_at(face->mesh, face->mesh->position, v, p);
        eye->lid.vertex[n] = v;
        eye->lid_radius[n++] = fminf(lid_clearance * eye->radius, sqrtf(square_distance(p, eye->centre)));
    }
    return 0;
}

static uint32_t nearest_lid(const fap_face *face, uint32_t v)
{
    float p[3], q[3], least = INFINITY;
    uint32_t best = v;

    vertex_at(face->mesh, face->mesh->position, v, p);
    for (int side = 0; side < 2; side++) {
        const fap_face_list *lid = &face->eye[side].lid;
        for (uint32_t i = 0; i < lid->count; i++) {
            vertex_at(face->mesh, face->mesh->position, lid->vertex[i], q);
            const float d = square_distance(p, q);
            if (d < least) {
                least = d;
                best = lid->vertex[i];
            }
        }
    }
    return best;
}

static void hang_lashes(fap_face *face)
{
    const double lids = (double)face->eye[0].lid.count + face->eye[1].lid.count;

    for (uint32_t v = 0; v < face->mesh->vertex_count; v++)
        face->follows[v] = v;
    if (lids * face->lash.count > most_comparisons)
        face->lash.count = 0;
    for (uint32_t i = 0; i < face->lash.count; i++)
        face->follows[face->lash.vertex[i]] = nearest_lid(face, face->lash.vertex[i]);
}

static void measure_tongue(fap_face *face)
{
    const float *x = face->mesh->position;

    face->tongue_middle = 0;
    face->tongue_half = 1e-3f;
    for (uint32_t i = 0; i < face->tongue.count; i++)
        face->tongue_middle += x[face->tongue.vertex[i]] / (float)face->tongue.count;
    for (uint32_t i = 0; i < face->tongue.count; i++)
        face->tongue_half = fmaxf(face->tongue_half, fabsf(x[face->tongue.vertex[i]] - face->tongue_middle));
}

static void level_blocks(fap_face *face)
{
    const uint8_t *w = face->mesh->head_weight;
    const uint32_t n = face->mesh->vertex_count;

    for (uint32_t b = 0; b < face->mesh->stride / FAP_BLOCK; b++) {
        face->block_level[b] = w[FAP_BLOCK * b];
        for (uint32_t v = FAP_BLOCK * b; v < FAP_BLOCK * (b + 1) && v < n; v++)
            if (w[v] != w[FAP_BLOCK * b])
                face->block_level[b] = -1;
    }
}

fap_err fap_face_open_parts(fap_face *face)
{
    const fap_mesh *mesh = face->mesh;

    face->follows = fap_mem_calloc(&face->alloc, mesh->vertex_count, sizeof *face->follows);
    face->lift = fap_mem_calloc(&face->alloc, mesh->stride, sizeof *face->lift);
    face->block_level = fap_mem_calloc(&face->alloc, mesh->stride / FAP_BLOCK, sizeof *face->block_level);
    int failed = !face->follows || !face->lift || !face->block_level;
    for (int side = 0; side < 2; side++) {
        fap_face_eye *eye = &face->eye[side];
        eye->present = fap_bank_eye(face->bank, side, eye->centre, &eye->radius);
        failed = failed || list_part(face, &eye->ball, side ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT) ||
                 list_rest(face, eye) || list_lids(face, eye);
    }
    failed = failed || list_part(face, &face->lower_teeth, FAP_PART_TEETH_LOWER) ||
             list_part(face, &face->tongue, FAP_PART_TONGUE) || list_part(face, &face->lash, FAP_PART_LASHES);
    if (failed)
        return FAP_E_NOMEM;
    hang_lashes(face);
    measure_tongue(face);
    level_blocks(face);
    return FAP_OK;
}

void fap_face_close_parts(fap_face *face)
{
    fap_mem_free(&face->alloc, face->follows);
    fap_mem_free(&face->alloc, face->lift);
    fap_mem_free(&face->alloc, face->block_level);
    fap_mem_free(&face->alloc, face->lower_teeth.vertex);
    fap_mem_free(&face->alloc, face->tongue.vertex);
    fap_mem_free(&face->alloc, face->lash.vertex);
    for (int side = 0; side < 2; side++) {
        fap_mem_free(&face->alloc, face->eye[side].ball.vertex);
        fap_mem_free(&face->alloc, face->eye[side].rest);
        fap_mem_free(&face->alloc, face->eye[side].lid.vertex);
        fap_mem_free(&face->alloc, face->eye[side].lid_radius);
    }
}

/* --- eyes --- */

static float value_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : (float)frame->value[fap];
}

/* FAPs 27 and 28, forward; the same limit as for any other point. */
static float thrust_of(const fap_face *face, const fap_frame *frame, int side)
{
    const float mm = value_of(frame, 27 + side) * fap_fapu_step(fap_bank_fapu(face->bank), FAP_UNIT_ES);
    return fminf(40, fmaxf(-40, mm));
}

static int32_t angle_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : frame->value[fap];
}

static void turn_about(float p[3], const float m[3][3], const float centre[3])
{
    const float d[3] = { p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] };

    for (int i = 0; i < 3; i++)
        p[i] = centre[i] + (m[i][0] * d[0] + m[i][1] * d[1] + m[i][2] * d[2]);
}

/* One eyeball of this frame. */
typedef struct gaze {
    float turn[3][3];
    float thrust, iris, pupil, wide; /* millimetres; radii at rest, and the pupil's now */
} gaze;

/*
 * FAPs 29 and 30 count the pupil's diameter. At rest it is a third of the iris (the standard's neutral face),
 * whose diameter is IRISD0.
 */
static gaze read_gaze(const fap_face *face, const fap_frame *frame, int side)
{
    const fap_fapu *fapu = fap_bank_fapu(face->bank);
    const int32_t yaw = angle_of(frame, 23 + side), pitch = angle_of(frame, 25 + side);
    gaze g = { .thrust = thrust_of(face, frame, side) };

    fap_head_rotation(pitch, yaw, 0, g.turn);
    g.iris = fminf(fapu->irisd_mm / 2, 0.9f * face->eye[side].radius);
    g.pupil = g.iris / 3;
    g.wide = g.pupil + value_of(frame, 29 + side) * fap_fapu_step(fapu, FAP_UNIT_IRISD) / 2;
    g.wide = fminf(0.9f * g.iris, fmaxf(0.2f * g.pupil, g.wide));
    return g;
}

/*
 * The ring between pupil and rim of the iris is stretched or squeezed along the ball. Every lane is worked on, those
 * outside the iris by a ratio of 1.
 */
static void dilate(float p[3][FAP_LANES], const gaze *g)
{
    const float rim = g->iris * g->iris, in = g->wide / g->pupil;
    const float slope = (g->iris - g->wide) / (g->iris - g->pupil);

    for (int k = 0; k < FAP_LANES; k++) {
        const float x = p[0][k], y = p[1][k], z = p[2][k], square = x * x + y * y;
        const int moves = square < rim && square > 0 && z >= 0;
        const float from = sqrtf(moves ? square : 1);
        const float ring = (g->wide + (from - g->pupil) * slope) / from;
        const float ratio = from < g->pupil ? in : ring;
        const float deep = z * z + square - ratio * ratio * square; /* stays on the ball */
        const float forward = sqrtf(deep > 0 ? deep : 0);
        p[0][k] = moves ? x * ratio : x;
        p[1][k] = moves ? y * ratio : y;
        p[2][k] = moves ? forward : z;
    }
}

static void turn(float p[3][FAP_LANES], const float m[3][3])
{
    for (int k = 0; k < FAP_LANES; k++) {
        const float x = p[0][k], y = p[1][k], z = p[2][k];
        for (int i = 0; i < 3; i++)
            p[i][k] = m[i][0] * x + m[i][1] * y + m[i][2] * z;
    }
}

/* Eyeballs are rigid: what keys did to them is undone. */
static void turn_ball(const fap_face *face, const fap_face_eye *eye, const gaze *g, float *position)
{
    const float centre[3] = { eye->centre[0], eye->centre[1], eye->centre[2] + g->thrust };
    float p[3][FAP_LANES];

    for (uint32_t first = 0; first < eye->ball.count; first += FAP_LANES) {
        const uint32_t rest = eye->ball.count - first, n = rest < FAP_LANES ? rest : FAP_LANES;
        memcpy(p, eye->rest[first / FAP_LANES], sizeof p);
        if (g->wide != g->pupil)
            dilate(p, g);
        turn(p, g->turn);
        for (size_t axis = 0; axis < 3; axis++)
            for (uint32_t k = 0; k < n; k++)
                position[axis * face->mesh->stride + eye->ball.vertex[first + k]] = centre[axis] + p[axis][k];
    }
}

void fap_face_turn_eyes(const fap_face *face, const fap_frame *frame, float *position)
{
    for (int side = 0; side < 2; side++) {
        if (!face->eye[side].present)
            continue;
        const gaze g = read_gaze(face, frame, side);
        turn_ball(face, &face->eye[side], &g, position);
    }
}

/*
 * Push lid vertices forward, not outward: FAPs fix the height of lids, and what they fix must stay. @p lift becomes how
 * far each of @p p, from the eyeball's centre, has to go.
 */
static void lift_of(const float p[3][FAP_LANES], const float radius[FAP_LANES], float lift[FAP_LANES])
{
    for (int k = 0; k < FAP_LANES; k++) {
        const float z = p[2][k], room = radius[k] * radius[k] - p[0][k] * p[0][k] - p[1][k] * p[1][k];
        const float way = sqrtf(room > 0 ? room : 0) - z;
        lift[k] = room > 0 && z > -radius[k] && way > 0 ? way : 0;
    }
}

static void slide_block(fap_face *face, const fap_face_eye *eye, const float centre[3], uint32_t first,
                        float *position)
{
    const size_t stride = face->mesh->stride;
    const uint32_t rest = eye->lid.count - first, n = rest < FAP_LANES ? rest : FAP_LANES;
    const uint32_t *vertex = eye->lid.vertex + first;
    float p[3][FAP_LANES] = { { 0 } }, radius[FAP_LANES] = { 0 }, lift[FAP_LANES];

    for (uint32_t k = 0; k < n; k++) {
        for (size_t axis = 0; axis < 3; axis++)
            p[axis][k] = position[axis * stride + vertex[k]] - centre[axis];
        radius[k] = eye->lid_radius[first + k];
    }
    lift_of((const float(*)[FAP_LANES])p, radius, lift);
    for (uint32_t k = 0; k < n; k++) {
        face->lift[vertex[k]] = lift[k];
        position[2 * stride + vertex[k]] += lift[k];
    }
}

static void slide_lid(fap_face *face, const fap_face_eye *eye, float thrust, float *position)
{
    const float centre[3] = { eye->centre[0], eye->centre[1], eye->centre[2] + thrust };

    for (uint32_t i = 0; i < eye->lid.count; i += FAP_LANES)
        slide_block(face, eye, centre, i, position);
}

void fap_face_slide_lids(fap_face *face, const fap_frame *frame, float *position)
{
    float *z = position + 2 * (size_t)face->mesh->stride;

    for (int side = 0; side < 2; side++)
        slide_lid(face, &face->eye[side], thrust_of(face, frame, side), position);
    for (uint32_t i = 0; i < face->lash.count; i++) {
        const uint32_t v = face->lash.vertex[i], skin = face->follows[v];
        if (skin != v)
            z[v] += face->lift[skin];
    }
}

/* --- mouth --- */

/* M9: upper and lower teeth touch in the neutral face, so lower teeth never rise above it. */
void fap_face_clamp_teeth(const fap_face *face, float *position)
{
    const size_t stride = face->mesh->stride;

    for (uint32_t i = 0; i < face->lower_teeth.count; i++) {
        const uint32_t v = face->lower_teeth.vertex[i];
        position[stride + v] = fminf(position[stride + v], face->mesh->position[stride + v]);
    }
}

/* FAP 47: each half of the tongue turns up about its middle line, the more the nearer to the border. */
void fap_face_curl_tongue(const fap_face *face, const fap_frame *frame, float *position)
{
    const float angle = fminf(1.5f, fmaxf(0, 1e-5f * value_of(frame, 47)));
    const size_t stride = face->mesh->stride;

    if (angle == 0)
        return;
    for (uint32_t i = 0; i < face->tongue.count; i++) {
        const uint32_t v = face->tongue.vertex[i];
        const float side = face->mesh->position[v] - face->tongue_middle;
        const float by = angle * fabsf(side) / face->tongue_half;
        position[v] += side * (cosf(by) - 1);
        position[stride + v] += fabsf(side) * sinf(by);
    }
}

/* --- head --- */

typedef struct head {
    int32_t pitch, yaw, roll;
    float turn[256][3][3];
    uint8_t known[256];
} head;

static int32_t part_of(int32_t angle, int level)
{
    return (int32_t)((int64_t)angle * level / 255);
}

/* Angles scaled by the weight: the neck twists along its length and the skin does not shear. */
static const float (*turn_of(head *h, int level))[3]
{
    if (!h->known[level]) {
        fap_head_rotation(part_of(h->pitch, level), part_of(h->yaw, level), part_of(h->roll, level),
                          h->turn[level]);
        h->known[level] = 1;
    }
    return (const float(*)[3])h->turn[level];
}

static void turn_lanes(fap_face *face, head *h, uint32_t first, float *position)
{
    const size_t stride = face->mesh->stride;

    for (uint32_t v = first; v < first + FAP_BLOCK && v < face->mesh->vertex_count; v++) {
        float p[3];
        vertex_at(face->mesh, position, v, p);
        turn_about(p, turn_of(h, face->mesh->head_weight[v]), face->spine);
        position[v] = p[0];
        position[stride + v] = p[1];
        position[2 * stride + v] = p[2];
    }
}

static uint32_t same_level(const fap_face *face, uint32_t b, uint32_t block_count)
{
    uint32_t end = b + 1;

    while (end < block_count && face->block_level[end] == face->block_level[b])
        end++;
    return end;
}

void fap_face_turn_head(fap_face *face, const fap_frame *frame, float *position)
{
    const uint32_t block_count = face->mesh->stride / FAP_BLOCK;
    head h = { .pitch = angle_of(frame, 48), .yaw = angle_of(frame, 49), .roll = angle_of(frame, 50) };

    if (!h.pitch && !h.yaw && !h.roll)
        return;
    for (uint32_t b = 0, end; b < block_count; b = end) {
        const int level = face->block_level[b];
        end = level < 0 ? b + 1 : same_level(face, b, block_count);
        if (level < 0)
            turn_lanes(face, &h, FAP_BLOCK * b, position);
        else if (level > 0)
            face->dsp.rotate(position + FAP_BLOCK * b, face->mesh->stride, turn_of(&h, level), face->spine,
                             (size_t)FAP_BLOCK * (end - b));
    }
    fap_face_measure(face, position, face->point);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        if (!fap_bank_point_get(face->bank, p)->vertex_count)
            turn_about(face->point[p], turn_of(&h, 255), face->spine);
}
