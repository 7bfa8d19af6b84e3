/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The units of the built-in face as analytic fields: bells on the face's front, seen by one lip or lid only
 * where marked, and the jaw's hinge. Names are ARKit's, amounts about those of an adult face at full
 * strength.
 */
#include <math.h>
#include <string.h>

#include "bank/builtin.h"

enum side { RIGHT = -1, BOTH, LEFT };

/* Fields act on this. */
enum { ON_SKIN = 0, ON_JAW = 256 };

/*
 * One bell of a unit, written for the left side: centre and radii in x and y, the motion at the centre, and a
 * stretch of x about the midline. "in" limits it to marked vertices.
 */
typedef struct field {
    const char *unit;
    int in;
    float cx, cy, rx, ry;
    float dx, dy, dz, stretch;
} field;

enum { FAR = 1000 };
static const float tail = 0.012f; /* of a bell; cut off, it costs blocks that nobody sees move */
#define LID  30.5f, 31, 12, FAR
#define LIPS 0, -37

static const field fields[] = {
    { "browDown", ON_SKIN, 24, 45, 20, 9, -2, -7, 1, 0 },
    { "browInnerUp", ON_SKIN, 10, 47, 15, 13, 0, 8, 0, 0 },
    { "browOuterUp", ON_SKIN, 42, 47, 16, 12, 0, 8, 0, 0 },
    { "cheekPuff", ON_SKIN, 40, -34, 20, 20, 4, 0, 8, 0 },
    { "cheekSquint", ON_SKIN, 38, 8, 18, 12, 0, 5, 2, 0 },
    { "cheekSquint", IN_LID_LOWER, LID, 0, 2, 0.3f, 0 },
    { "eyeBlink", IN_LID_UPPER, 30.5f, 31, 11.5f, FAR, 0, -10, 0.8f, 0 },
    { "eyeBlink", IN_CREASE, LID, 0, -6, 3, 0 },
    { "eyeLookDown", IN_LID_UPPER, LID, 0, -4, 0.4f, 0 },
    { "eyeLookDown", IN_LID_LOWER, LID, 0, -1, 0, 0 },
    { "eyeLookDown", IN_CREASE, LID, 0, -2, 1, 0 },
    { "eyeLookUp", IN_LID_UPPER, LID, 0, 2.5f, -0.3f, 0 },
    { "eyeLookUp", IN_LID_LOWER, LID, 0, 1, 0, 0 },
    { "eyeLookIn", IN_LID_UPPER | IN_LID_LOWER, LID, -0.8f, 0, 0, 0 },
    { "eyeLookOut", IN_LID_UPPER | IN_LID_LOWER, LID, 0.8f, 0, 0, 0 },
    { "eyeSquint", IN_LID_LOWER, LID, 0, 3.5f, 0.4f, 0 },
    { "eyeSquint", IN_LID_UPPER, LID, 0, -1.5f, 0.3f, 0 },
    { "eyeWide", IN_LID_UPPER, LID, 0, 3, -0.6f, 0 },
    { "eyeWide", IN_LID_LOWER, LID, 0, -1, 0, 0 },
    { "jawForward", ON_JAW, 0, 0, 0, 0, 0, 0, 7, 0 },
    { "jawLeft", ON_JAW, 0, 0, 0, 0, 10, 0, 0, 0 },
    { "jawRight", ON_JAW, 0, 0, 0, 0, -10, 0, 0, 0 },
    { "mouthDimple", ON_SKIN, 26, -37, 12, 12, 5, 2, -3, 0 },
    { "mouthFrown", ON_SKIN, 25, -38, 12, 13, 1, -9, -2, 0 },
    { "mouthFunnel", ON_SKIN, LIPS, 26, 16, 0, 0, 6, -0.3f },
    { "mouthFunnel", IN_UPPER, LIPS, 20, 12, 0, 5, 2, 0 },
    { "mouthFunnel", IN_LOWER, LIPS, 20, 12, 0, -7, 2, 0 },
    { "mouthLeft", ON_SKIN, LIPS, 28, 18, 9, 0, 0, 0 },
    { "mouthRight", ON_SKIN, LIPS, 28, 18, -9, 0, 0, 0 },
    { "mouthLowerDown", IN_LOWER, 10, -41, 14, 13, 0, -8, -1, 0 },
    { "mouthPress", IN_UPPER, 14, -31, 14, 7, 0, -1.4f, -2, 0 },
    { "mouthPress", IN_LOWER, 14, -43, 14, 7, 0, 1.4f, -2, 0 },
    { "mouthPucker", ON_SKIN, LIPS, 28, 18, 0, 0, 9, -0.45f },
    { "mouthRollLower", IN_LOWER, 0, -42, 22, 7, 0, 2, -6, 0 },
    { "mouthRollUpper", IN_UPPER, 0, -32, 22, 7, 0, -2, -6, 0 },
    { "mouthShrugLower", IN_LOWER, 0, -45, 24, 16, 0, 6, 2, 0 },
    { "mouthShrugLower", IN_UPPER, LIPS, 22, 9, 0, 4.6f, 2, 0 },
    { "mouthShrugUpper", IN_UPPER, 0, -35, 24, 12, 0, 4, 2, 0 },
    { "mouthSmile", ON_SKIN, 26, -37, 15, 14, 6, 11, -5, 0 },
    { "mouthSmile", ON_SKIN, 38, -8, 16, 14, 1, 4, 3, 0 },
    { "mouthStretch", ON_SKIN, 26, -38, 15, 15, 8, -3, -4, 0 },
    { "mouthUpperUp", IN_UPPER, 11, -33, 13, 12, 0, 7, -1, 0 },
    { "noseSneer", IN_UPPER, 13, -12, 12, 16, 0, 6, 1, 0 },
    { "noseSneer", ON_SKIN, 10, 42, 12, 10, 0, -3, 1, 0 },
};

static const struct unit {
    const char *name, *field;
    int side;
} units[] = {
#define PAIR(name)                                                                                           \
    { name "Left", name, LEFT },                                                                             \
    {                                                                                                        \
        name "Right", name, RIGHT                                                                            \
    }
#define ONE(name)                                                                                            \
    {                                                                                                        \
        name, name, BOTH                                                                                     \
    }
    PAIR("browDown"),       ONE("browInnerUp"),     PAIR("browOuterUp"),   ONE("cheekPuff"),
    PAIR("cheekSquint"),    PAIR("eyeBlink"),       PAIR("eyeLookDown"),   PAIR("eyeLookIn"),
    PAIR("eyeLookOut"),     PAIR("eyeLookUp"),      PAIR("eyeSquint"),     PAIR("eyeWide"),
    ONE("jawForward"),      ONE("jawLeft"),         ONE("jawOpen"),        ONE("jawRight"),
    ONE("mouthClose"),      PAIR("mouthDimple"),    PAIR("mouthFrown"),    ONE("mouthFunnel"),
    ONE("mouthLeft"),       PAIR("mouthLowerDown"), PAIR("mouthPress"),    ONE("mouthPucker"),
    ONE("mouthRight"),      ONE("mouthRollLower"),  ONE("mouthRollUpper"), ONE("mouthShrugLower"),
    ONE("mouthShrugUpper"), PAIR("mouthSmile"),     PAIR("mouthStretch"),  PAIR("mouthUpperUp"),
    PAIR("noseSneer"),      ONE("tongueOut"),       ONE("_tongueUp"),      ONE("_tongueBack"),
#undef PAIR
#undef ONE
};
enum { UNIT_COUNT = sizeof units / sizeof *units };

int cage_unit_count(void)
{
    return UNIT_COUNT;
}

const char *cage_unit_name(int unit)
{
    return units[unit].name;
}

int cage_unit_find(const char *name)
{
    for (int u = 0; u < UNIT_COUNT; u++)
        if (!strcmp(units[u].name, name))
            return u;
    return -1;
}

static float clamp01(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static float ramp(float x)
{
    const float t = clamp01(x);
    return t * t * (3 - 2 * t);
}

/*
 * How much the skin follows the jaw: lower lip and chin fully, the corners of the mouth half, cheeks less the
 * higher they are; fading to the ears and down the neck.
 */
static float jaw_weight(const cage *c, uint32_t v)
{
    const float *p = c->position[v], corner = 0.45f, lip_y = -37;
    const float back = clamp01((p[2] - 30) / 45), neck = clamp01((p[1] + 118) / 30);
    const float x = fminf(1, fabsf(p[0]) / 25), middle = sqrtf(1 - x * x);

    if (c->in[v] & (IN_LID_UPPER | IN_LID_LOWER | IN_CREASE))
        return 0;
    if (c->in[v] & IN_LOWER)
        return (corner + (1 - corner) * fmaxf(middle, ramp((lip_y - p[1]) / 25))) * back * neck;
    return corner * (1 - fmaxf(c->in[v] & IN_UPPER ? middle : 0, ramp((p[1] - lip_y) / 25))) * back;
}

/* The jaw turns about an axis through the ears; at full strength it opens the lips by about 4 cm. */
static void jaw_open(const float p[3], float motion[3])
{
    const float hinge_y = 8, hinge_z = 22, sine = 0.33f, cosine = 0.944f;
    const float dy = p[1] - hinge_y, dz = p[2] - hinge_z;

    motion[1] = dy * cosine - dz * sine - dy;
    motion[2] = dz * cosine + dy * sine - dz;
}

/* @p s runs from 0 at the root to 1 at the tip. */
static void tongue_motion(const char *unit, float s, float motion[3])
{
    if (!strcmp(unit, "tongueOut")) {
        motion[1] = 5 * s;
        motion[2] = 28 * s;
    } else if (!strcmp(unit, "_tongueUp")) {
        motion[1] = 10 * s * s * s * s;
        motion[2] = 3 * s * s;
    } else if (!strcmp(unit, "_tongueBack")) {
        motion[1] = 8 * sinf(3.14159265f * fminf(1, 1.2f * s)) - 5 * s * s * s;
        motion[2] = -10 * s;
    }
}

/* A unit of both sides is its left half and that half's mirror image; sideways units only move, they do not
 * mirror. */
static void add_field(const field *f, const float p[3], int side, float motion[3])
{
    const int mirror = side == RIGHT || (side == BOTH && p[0] < 0);
    const int sideways = f->dx != 0 && side == BOTH && f->cx == 0;
    const float x = mirror ? -p[0] : p[0], u = (x - f->cx) / f->rx, v = (p[1] - f->cy) / f->ry;
    const float bell = p[2] > 50 ? fmaxf(0, expf(-(u * u + v * v)) - tail) : 0;

    motion[0] += bell * (mirror && !sideways ? -f->dx : f->dx) + bell * f->stretch * p[0];
    motion[1] += bell * f->dy;
    motion[2] += bell * f->dz;
}

/* With the jaw open, lips meet again a little below where they did: undone is what the jaw did to each. */
static void close_mouth(const cage *c, uint32_t v, float motion[3])
{
    const float *p = c->position[v], meet = 0.1f, up = (p[1] + 37) / 13, bell = expf(-up * up);
    float jaw[3] = { 0 };

    jaw_open(p, jaw);
    for (int axis = 0; axis < 3 && fabsf(p[0]) < 60; axis++)
        motion[axis] += bell * (meet - jaw_weight(c, v)) * jaw[axis] * ramp((60 - fabsf(p[0])) / 30);
}

static void hinge(const cage *c, uint32_t v, float motion[3])
{
    const float jaw = jaw_weight(c, v);

    jaw_open(c->position[v], motion);
    motion[1] *= jaw;
    motion[2] *= jaw;
}

static void slide_jaw(const cage *c, const field *f, uint32_t v, float motion[3])
{
    const float jaw = jaw_weight(c, v);

    motion[0] += jaw * f->dx;
    motion[2] += jaw * f->dz;
}

static void skin_field(const cage *c, const field *f, int side, float (*motion)[3])
{
    for (uint32_t v = 0; v < c->vertex_count; v++) {
        if (f->in == ON_JAW)
            slide_jaw(c, f, v, motion[v]);
        else if (f->in == ON_SKIN || c->in[v] & f->in)
            add_field(f, c->position[v], side, motion[v]);
    }
}

static void skin_motion(const cage *c, const struct unit *u, float (*motion)[3])
{
    const int opens = !strcmp(u->name, "jawOpen"), closes = !strcmp(u->name, "mouthClose");

    for (uint32_t v = 0; (opens || closes) && v < c->vertex_count; v++) {
        if (opens)
            hinge(c, v, motion[v]);
        else
            close_mouth(c, v, motion[v]);
    }
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (!strcmp(fields[i].unit, u->field))
            skin_field(c, &fields[i], u->side, motion);
}

/* Lower teeth and tongue are the jaw's; the tongue moves by itself as well. */
static void inside_motion(const cage_fine *f, const struct unit *u, uint32_t v, float motion[3])
{
    if (f->part[v] != FAP_PART_TEETH_LOWER && f->part[v] != FAP_PART_TONGUE)
        return;
    if (!strcmp(u->name, "jawOpen"))
        jaw_open(f->position[v], motion);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (fields[i].in == ON_JAW && !strcmp(fields[i].unit, u->field)) {
            motion[0] += fields[i].dx;
            motion[2] += fields[i].dz;
        }
    if (f->part[v] == FAP_PART_TONGUE)
        tongue_motion(u->name, cage_tongue_along(f, v), motion);
}

void cage_unit_add(cage_fine *f, int unit, float weight, float *motion, uint32_t stride)
{
    const cage *c = &f->cage;

    memset(f->cage_motion, 0, sizeof f->cage_motion);
    skin_motion(c, &units[unit], f->cage_motion);
    memset(f->motion, 0, sizeof f->motion);
    cage_smooth(c, (const float(*)[3])f->cage_motion, f->motion);
    for (uint32_t v = f->skin_count; v < f->vertex_count; v++)
        inside_motion(f, &units[unit], v, f->motion[v]);
    for (uint32_t v = 0; v < f->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++)
            motion[axis * stride + v] += weight * f->motion[v][axis];
}
