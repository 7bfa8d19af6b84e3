/* SPDX-License-Identifier: BSD-2-Clause */
/* What the skin of the built-in face hides: eyeballs, a band of teeth a jaw, the tongue. */
#include <math.h>

#include "bank/builtin.h"

enum { WET = 200, WHITE = 0xe6e2de, IRIS = 0x4a7358, PUPIL = 0x101010, TEETH = 0xe8e2d2, TONGUE = 0xb5605c };

static uint32_t add_vertex(cage_fine *f, float x, float y, float z, fap_part part, uint32_t rgb, int gloss)
{
    const uint32_t v = f->vertex_count++;

    f->position[v][0] = x, f->position[v][1] = y, f->position[v][2] = z;
    f->part[v] = (uint8_t)part;
    f->weight[v] = 255;
    for (int i = 0; i < 3; i++)
        f->colour[v][i] = (uint8_t)(rgb >> (16 - 8 * i));
    f->colour[v][3] = (uint8_t)gloss;
    return v;
}

static void add_triangle(cage_fine *f, uint32_t a, uint32_t b, uint32_t d)
{
    uint32_t *t = f->triangle[f->triangle_count++];
    t[0] = a, t[1] = b, t[2] = d;
}

static void add_quad(cage_fine *f, uint32_t a, uint32_t b, uint32_t d, uint32_t e)
{
    add_triangle(f, a, b, d);
    add_triangle(f, a, d, e);
}

/* Rows of @p columns vertices from @p first on. */
static void add_sheet(cage_fine *f, uint32_t first, uint32_t rows, uint32_t columns)
{
    for (uint32_t row = 0; row + 1 < rows; row++)
        for (uint32_t i = 0; i + 1 < columns; i++) {
            const uint32_t a = first + row * columns + i;
            add_quad(f, a, a + columns, a + columns + 1, a + 1);
        }
}

static void join_lanes(cage_fine *f, uint32_t pole)
{
    for (uint32_t lane = 0; lane < EYE_LANES; lane++) {
        const uint32_t next = (lane + 1) % EYE_LANES;
        add_triangle(f, pole, pole + 1 + lane, pole + 1 + next);
        for (uint32_t ring = 0; ring + 1 < EYE_RINGS; ring++) {
            const uint32_t a = pole + 1 + ring * EYE_LANES;
            add_quad(f, a + lane, a + EYE_LANES + lane, a + EYE_LANES + next, a + next);
        }
    }
}

/* Rings about the eye's axis: pupil and rim of the iris twice each (colours end sharply), then to the equator. */
static void add_eye(cage_fine *f, int right)
{
    static const float sine[EYE_RINGS] = { 0.15f, 0.18f, 0.46f, 0.5f, 0.8f, 1 };
    static const uint32_t rgb[EYE_RINGS] = { PUPIL, IRIS, IRIS, WHITE, WHITE, WHITE };
    const float cx = right ? -cage_eye_centre[0] : cage_eye_centre[0], r = cage_eye_radius;
    const float cy = cage_eye_centre[1], cz = cage_eye_centre[2];
    const fap_part part = right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT;
    const uint32_t pole = add_vertex(f, cx, cy, cz + r, part, PUPIL, 255);

    f->eye[right] = pole;
    for (int ring = 0; ring < EYE_RINGS; ring++)
        for (int lane = 0; lane < EYE_LANES; lane++) {
            const float s = sine[ring], a = (float)lane * 6.2831853f / EYE_LANES;
            add_vertex(f, cx + r * s * cosf(a), cy + r * s * sinf(a), cz + r * sqrtf(1 - s * s), part,
                       rgb[ring], 255);
        }
    join_lanes(f, pole);
}

/* One curved band a jaw: upper edge, then lower edge, right to left. */
static uint32_t add_teeth(cage_fine *f, int lower)
{
    const uint32_t first = f->vertex_count;
    const float top = lower ? -39.5f : -30, height = 9;

    for (int edge = 0; edge < 2; edge++)
        for (int i = 0; i < TEETH_COLUMNS; i++) {
            const float x = 44.0f * (float)(i - TEETH_COLUMNS / 2) / (TEETH_COLUMNS - 1);
            add_vertex(f, x, top - (float)edge * height, (lower ? 114 : 117) - x * x * 0.045f,
                       lower ? FAP_PART_TEETH_LOWER : FAP_PART_TEETH_UPPER, TEETH, WET);
        }
    add_sheet(f, first, 2, TEETH_COLUMNS);
    return first;
}

float cage_tongue_along(const cage_fine *f, uint32_t v)
{
    return (float)((v - f->tongue) / TONGUE_COLUMNS) / (TONGUE_ROWS - 1);
}

/* Rows from the root to the tip, each from the right border over the ridge to the left one. */
static void add_tongue(cage_fine *f)
{
    static const float z[TONGUE_ROWS] = { 76, 83, 90, 96, 102, 107, 110 };
    static const float half_width[TONGUE_ROWS] = { 16, 16, 16, 15, 13, 9, 3 };
    static const float y[TONGUE_ROWS] = { -38, -36.5f, -36, -36.5f, -38, -40, -41.5f };

    f->tongue = f->vertex_count;
    for (int row = 0; row < TONGUE_ROWS; row++)
        for (int i = 0; i < TONGUE_COLUMNS; i++) {
            const float s = 2.0f * (float)i / (TONGUE_COLUMNS - 1) - 1;
            add_vertex(f, s * half_width[row], y[row] - 4 * s * s, z[row], FAP_PART_TONGUE, TONGUE, WET);
        }
    add_sheet(f, f->tongue, TONGUE_ROWS, TONGUE_COLUMNS);
}

void cage_add_inside(cage_fine *f)
{
    add_eye(f, 0);
    add_eye(f, 1);
    f->teeth_upper = add_teeth(f, 0);
    f->teeth_lower = add_teeth(f, 1);
    add_tongue(f);
}
