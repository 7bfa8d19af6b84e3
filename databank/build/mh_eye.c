/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Our own eyeballs in place of MakeHuman's, which are exact spheres without a pole and too coarse for a round
 * iris: rings about the axis stand where the colours change.
 */
#include <math.h>
#include <string.h>

#include "databank/build/makehuman.h"

enum { LANES = 40 };

/* Distance of each ring from the axis in millimetres and its colour; the last ones go round the back. */
static const struct ring {
    float from_axis;
    uint32_t rgb;
} rings[] = {
    { 1.2f, 0x080808 }, { 2.35f, 0x080808 }, { 2.65f, 0x2c3a30 }, { 3.3f, 0x6a8a62 }, { 4.6f, 0x54775a },
    { 5.5f, 0x3f6049 }, { 5.95f, 0x24352b }, { 6.35f, 0xa8aaa4 }, { 6.9f, 0xe4e1dc }, { 8.2f, 0xe9e5e0 },
    { 10, 0xe6dcd6 },   { 12, 0xdcc6be },    { 13.5f, 0xd0aaa2 },
};
enum { FRONT_RINGS = sizeof rings / sizeof *rings, BACK_RINGS = 3, RINGS = FRONT_RINGS + BACK_RINGS };

uint32_t mh_eye_vertices(void)
{
    return 1 + RINGS * LANES;
}

uint32_t mh_eye_triangles(void)
{
    return LANES + 2 * LANES * (RINGS - 1);
}

/* The sphere that MakeHuman's eye is: middle and half size of its box. */
static void measure(mh_face *f, int right)
{
    const mh_source *s = f->source;
    const uint32_t group = fap_obj_group(&s->obj, right ? "helper-r-eye" : "helper-l-eye");
    float low[3] = { 1e9f, 1e9f, 1e9f }, high[3] = { -1e9f, -1e9f, -1e9f };

    for (uint32_t i = 0; i < s->obj.face_count; i++)
        for (uint32_t c = 0; s->obj.face[i].group == group && c < s->obj.face[i].count; c++)
            for (int axis = 0; axis < 3; axis++) {
                const float x = s->rest[s->obj.vertex[s->obj.face[i].first + c]][axis];
                low[axis] = fminf(low[axis], x);
                high[axis] = fmaxf(high[axis], x);
            }
    float size = 0;
    for (int axis = 0; axis < 3; axis++) {
        f->eye_centre[right][axis] = (low[axis] + high[axis]) / 2;
        size += (high[axis] - low[axis]) / 6;
    }
    f->eye_radius[right] = fmaxf(1, size * 1.01f); /* the box of an 8-sided ring is a little small */
}

/* Fibres of the iris: lanes differ in brightness, the same way in both eyes. */
static float fibre(int ring, int lane)
{
    return ring >= 3 && ring <= 5 ? 1 + 0.16f * sinf(2.3f * (float)(lane * lane % 17) + (float)ring) : 1;
}

static void put(mh_face *f, int right, uint32_t v, float from_axis, float behind, int lane, uint32_t rgb,
                float light)
{
    const float angle = (float)lane * 6.2831853f / LANES, r = f->eye_radius[right];
    const float along = sqrtf(fmaxf(0, r * r - from_axis * from_axis));

    f->position[v][0] = f->eye_centre[right][0] + from_axis * cosf(angle);
    f->position[v][1] = f->eye_centre[right][1] + from_axis * sinf(angle);
    f->position[v][2] = f->eye_centre[right][2] + (behind > 0 ? -along : along);
    f->part[v] = right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT;
    f->weight[v] = 255;
    for (int i = 0; i < 3; i++)
        f->colour[v][i] = (uint8_t)fminf(255, (float)(rgb >> (16 - 8 * i) & 255) * light);
    f->colour[v][3] = 255;
}

static void put_ring(mh_face *f, int right, uint32_t first, int ring)
{
    const float r = f->eye_radius[right];
    const int back = ring >= FRONT_RINGS;
    const float away =
        back ? r * cosf(0.45f * (float)(ring - FRONT_RINGS)) : fminf(rings[ring].from_axis, r * 0.97f);

    for (int lane = 0; lane < LANES; lane++)
        put(f, right, first + 1 + (uint32_t)(ring * LANES + lane), away, back && ring > FRONT_RINGS, lane,
            back ? 0xc89a90 : rings[ring].rgb, fibre(ring, lane));
}

static void put_triangle(mh_face *f, uint32_t *t, uint32_t a, uint32_t b, uint32_t c)
{
    f->triangle[*t][0] = a, f->triangle[*t][1] = b, f->triangle[*t][2] = c;
    ++*t;
}

void mh_eye_build(mh_face *f, int right, uint32_t first, uint32_t triangle)
{
    measure(f, right);
    f->eye_first[right] = first;
    put(f, right, first, 0, 0, 0, 0x080808, 1);
    for (int ring = 0; ring < RINGS; ring++)
        put_ring(f, right, first, ring);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const uint32_t next = (lane + 1) % LANES;
        put_triangle(f, &triangle, first, first + 1 + lane, first + 1 + next);
        for (uint32_t ring = 0; ring + 1 < RINGS; ring++) {
            const uint32_t a = first + 1 + ring * LANES, b = a + LANES;
            put_triangle(f, &triangle, a + lane, b + lane, b + next);
            put_triangle(f, &triangle, a + lane, b + next, a + next);
        }
    }
}
