/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The neutral built-in face: a revolved cage (one width and depth a row) onto which a nose, lips, sockets,
 * chin and ears are pressed as smooth fields; eyes and mouth are slits in the grid whose edges are pulled
 * apart and lined. Lengths follow the usual proportions of an adult head; the origin is the top of the spine.
 */
#include <math.h>
#include <string.h>

#include "bank/builtin.h"

typedef struct vec {
    float x, y, z;
} vec;

const float cage_eye_centre[3] = { 30.5f, 31, 97 };
const float cage_eye_radius = 12;

enum { AXIS_Z = 35 }; /* the skull's own vertical axis stands this far before the spine */

/* Height, half width, depth before and behind the axis. The crown is one vertex more, above. */
static const struct row {
    int16_t y, width, front, back;
} rows[CAGE_ROWS] = {
    { 130, 48, 60, 56 },  { 100, 68, 82, 80 }, { 74, 74, 91, 87 },  { 55, 75, 93, 88 },  { 45, 74, 92, 88 },
    { 39, 73, 89, 88 },   { 31, 72, 87, 87 },  { 22, 72, 87, 86 },  { 12, 71, 88, 84 },  { 0, 70, 89, 80 },
    { -9, 68, 90, 76 },   { -18, 66, 90, 72 }, { -28, 64, 91, 68 }, { -37, 61, 90, 65 }, { -46, 58, 89, 62 },
    { -57, 53, 87, 58 },  { -69, 46, 88, 56 }, { -81, 38, 82, 55 }, { -88, 46, 50, 55 }, { -106, 50, 34, 56 },
    { -128, 56, 36, 60 },
};

/* Sine of the angle of each column of the left half, of 1000; past the ear the angle goes on in degrees. */
static const int16_t column_sine[8] = { 0, 80, 160, 240, 333, 413, 507, 600 };
static const int16_t column_degrees[CAGE_SIDE + 1 - 8] = { 53, 93, 138, 180 };

static float column_angle(int side)
{
    return side < 8 ? asinf(column_sine[side] / 1000.0f) : column_degrees[side - 8] * 0.01745329f;
}

static float bump(float x, float y, float cx, float cy, float rx, float ry)
{
    const float u = (x - cx) / rx, v = (y - cy) / ry;
    return expf(-(u * u + v * v));
}

/* Below the chin the back rows are a neck, as wide as it is; the narrowing of the jaw is for the front only.
 */
static float row_width(const struct row *r, int side)
{
    const float neck = 52;
    return side >= 9 && r->width < neck ? neck : r->width;
}

static vec revolve(int row, int side)
{
    const struct row *r = &rows[row];
    const float angle = column_angle(side), c = cosf(angle);

    return (vec){ row_width(r, side) * sinf(angle), r->y, AXIS_Z + (c > 0 ? r->front : r->back) * c };
}

/* Ridge heights of the nose by row, and how a row of it falls off sideways. */
static void press_nose(vec *p, int row, int side)
{
    static const int8_t height[CAGE_ROWS] = { [3] = 1, [4] = 3, 2, 5, 10, 17, 24, 27, 15 };
    static const float slim[4] = { 1, 0.75f, 0.2f, 0 }, wide[4] = { 1, 0.8f, 0.46f, 0.06f };

    if (side > 3)
        return;
    p->z += height[row] * (row >= 9 ? wide : slim)[side];
    if (row >= 4 && row <= 8)
        p->x *= 0.85f;
    if (row == ROW_MOUTH - 2)
        p->y -= side == 2 ? -2 : 1;
}

/* The outer lip contours run together at the corners; lips and philtrum stand out. */
static void press_lips(vec *p, int row, int side)
{
    static const float closing[10] = { 0.1f, 0, 0.06f, 0.2f, 0.42f, 0.75f, 0.7f, 0.4f, 0.15f, 0 };

    if ((row == ROW_MOUTH - 1 || row == ROW_MOUTH + 1) && side < 10)
        p->y += closing[side] * (rows[ROW_MOUTH].y - p->y);
    if (row == ROW_MOUTH && side == MOUTH_CORNER + 1)
        p->x -= 3.5f;
    p->z += 5 * bump(p->x, p->y, 0, -37, 22, 12);
    if (row == ROW_MOUTH && side < MOUTH_CORNER)
        p->z += 1.5f;
}

static void press_face(vec *p, int row, int side)
{
    press_nose(p, row, side);
    press_lips(p, row, side);
    p->z += 4 * bump(p->x, p->y, 44, 2, 16, 14);   /* cheek bone */
    p->z -= 4 * bump(p->x, p->y, 45, -32, 14, 16); /* hollow of the cheek */
    p->z -= 6 * bump(p->x, p->y, 26, 31, 16, 11);  /* socket */
    p->z += 3 * bump(p->x, p->y, 30, 47, 22, 6);   /* ridge of the brow */
    p->z += 5 * bump(p->x, p->y, 0, -71, 16, 9);   /* chin boss */
    p->z -= 4 * bump(p->x, p->y, 0, -56, 18, 5);   /* fold under the lip */
}

/* The ear is the ridge of the column beside it. */
static void press_ear(vec *p, int row, int side)
{
    static const int8_t out[CAGE_ROWS] = { [5] = 6, 13, 14, 13, 10, 7, 3 };

    if (side != 9)
        return;
    p->x += out[row];
    p->z -= out[row] * 0.6f;
}

static vec on_eye(float x, float y, float clearance)
{
    const float r = cage_eye_radius + clearance, dx = x - cage_eye_centre[0], dy = y - cage_eye_centre[1];
    const float left = r * r - dx * dx - dy * dy;
    return (vec){ x, y, cage_eye_centre[2] + sqrtf(left > 16 ? left : 16) };
}

/* Lids and what frames them lie on spheres a little larger than the eye. */
static void press_lids(vec *p, int row, int side, int lower)
{
    static const float x[5] = { 17, 23.5f, 30.5f, 37.5f, 45 };
    static const float top[5] = { 29.5f, 35, 36.5f, 35, 31 }, bottom[5] = { 29.5f, 28.2f, 26.8f, 27.8f, 31 };
    static const float crease[5] = { 32, 39.5f, 41, 40, 34 }, bag[5] = { 24, 21.5f, 20.5f, 21, 25 };
    const int i = side - EYE_INNER;

    if (i < 0 || i > 4)
        return;
    if (row == ROW_EYE)
        *p = i == 0 || i == 4 ? (vec){ x[i], top[i], i ? 99 : 103 }
                              : on_eye(x[i], lower ? bottom[i] : top[i], 1.4f);
    else if (row == ROW_CREASE && i > 0 && i < 4)
        *p = on_eye(x[i], crease[i], 3);
    else if (row == ROW_EYE + 1 && i > 0 && i < 4)
        *p = on_eye(x[i], bag[i], 3);
}

static vec skin_place(int row, int column, int lower)
{
    const int side = column < 0 ? -column : column;
    vec p = revolve(row, side);

    press_face(&p, row, side);
    press_ear(&p, row, side);
    press_lids(&p, row, side, lower);
    if (column < 0)
        p.x = -p.x;
    return p;
}

static uint16_t add_vertex(cage *c, vec p, fap_part part, uint32_t rgb, int gloss, int in)
{
    const uint32_t v = c->vertex_count++;

    c->position[v][0] = p.x, c->position[v][1] = p.y, c->position[v][2] = p.z;
    c->part[v] = (uint8_t)part;
    c->weight[v] = 255;
    c->colour[v][0] = (uint8_t)(rgb >> 16), c->colour[v][1] = (uint8_t)(rgb >> 8),
    c->colour[v][2] = (uint8_t)rgb;
    c->colour[v][3] = (uint8_t)gloss;
    c->in[v] = (uint8_t)in;
    return (uint16_t)v;
}

/* At the corners of an opening a quad shrinks to a triangle; what is left of the other half is dropped. */
static void add_triangle(cage *c, uint32_t a, uint32_t b, uint32_t d)
{
    if (a == b || b == d || d == a)
        return;
    uint32_t *t = c->triangle[c->triangle_count++];
    t[0] = a, t[1] = b, t[2] = d;
}

/* Counter-clockwise from the upper left corner, as seen from outside. */
static void add_quad(cage *c, uint32_t a, uint32_t b, uint32_t d, uint32_t e)
{
    add_triangle(c, a, b, d);
    add_triangle(c, a, d, e);
}

enum {
    SKIN = 0xc99a80,
    WARM = 0xcf9178,
    LIP = 0xb0605a,
    LIP_EDGE = 0xbd7d6b,
    BROW = 0x5c4432,
    MOUTH = 0x5a2222,
    LID = 0xbb8a72,
    WET = 200
};

static uint32_t skin_colour(int row, int side)
{
    if (row == ROW_MOUTH && side <= MOUTH_CORNER)
        return LIP;
    if ((row == ROW_MOUTH - 1 || row == ROW_MOUTH + 1) && side < MOUTH_CORNER)
        return LIP_EDGE;
    if (row == ROW_BROW && side >= 2 && side <= EYE_OUTER)
        return BROW;
    if (row == ROW_EYE && side >= EYE_INNER && side <= EYE_OUTER)
        return LID;
    return (row == 9 || row == 10) && (side < 2 || side > 4) && side < 8 ? WARM : SKIN;
}

static int is_mouth_slit(int row, int side)
{
    return row == ROW_MOUTH && side < MOUTH_CORNER;
}

static int is_eye_slit(int row, int side)
{
    return row == ROW_EYE && side > EYE_INNER && side < EYE_OUTER;
}

/* Which lip a row belongs to; the lid edges and the crease have their own marks. */
static int skin_in(int row, int side, int lower)
{
    int in = row < ROW_MOUTH || (is_mouth_slit(row, side) && !lower) ? IN_UPPER
             : row > ROW_MOUTH || is_mouth_slit(row, side)           ? IN_LOWER
                                                                     : 0;
    if (is_eye_slit(row, side))
        in |= lower ? IN_LID_LOWER : IN_LID_UPPER;
    if (row == ROW_CREASE && side > EYE_INNER && side < EYE_OUTER)
        in = IN_CREASE;
    return in;
}

static uint16_t add_skin(cage *c, int row, int column, int lower)
{
    const int side = column < 0 ? -column : column;
    const uint32_t rgb = skin_colour(row, side);

    const uint16_t v = add_vertex(c, skin_place(row, column, lower), FAP_PART_SKIN, rgb, rgb == LIP ? 90 : 30,
                                  skin_in(row, side, lower));
    if (row >= CAGE_ROWS - 3)
        c->weight[v] = (uint8_t)(row == CAGE_ROWS - 1 ? 0 : row == CAGE_ROWS - 2 ? 110 : 230);
    return v;
}

static void add_skin_row(cage *c, int row)
{
    uint16_t *up = c->upper[row], *low = c->lower[row];

    for (int column = 1 - CAGE_SIDE; column <= CAGE_SIDE; column++) {
        const int side = column < 0 ? -column : column, i = column + CAGE_SIDE;
        up[i] = low[i] = add_skin(c, row, column, 0);
        if (is_mouth_slit(row, side) || is_eye_slit(row, side))
            low[i] = add_skin(c, row, column, 1);
    }
    up[0] = up[2 * CAGE_SIDE]; /* the seam at the back */
    low[0] = low[2 * CAGE_SIDE];
}

static void build_skin(cage *c)
{
    for (int row = 0; row < CAGE_ROWS; row++)
        add_skin_row(c, row);
    const uint32_t crown = add_vertex(c, (vec){ 0, 143, AXIS_Z - 4 }, FAP_PART_SKIN, SKIN, 30, IN_UPPER);
    for (int i = 0; i < 2 * CAGE_SIDE; i++) {
        add_triangle(c, crown, c->upper[0][i], c->upper[0][i + 1]);
        for (int row = 0; row + 1 < CAGE_ROWS; row++)
            add_quad(c, c->lower[row][i], c->upper[row + 1][i], c->upper[row + 1][i + 1],
                     c->lower[row][i + 1]);
    }
}

/* An opening is lined by a strip from its edge to a copy of it set back; @p move says where to. */
typedef vec (*lining)(vec p, int lower);

static uint16_t line_vertex(cage *c, uint16_t edge, int lower, lining move, uint32_t rgb, int gloss)
{
    const float *p = c->position[edge];
    return add_vertex(c, move((vec){ p[0], p[1], p[2] }, lower), FAP_PART_SKIN, rgb, gloss, c->in[edge]);
}

/* Edges run from the right corner to the left one, both included; closed at the back when @p wall. */
static void line_opening(cage *c, const uint16_t *up, const uint16_t *low, int count, lining move,
                         uint32_t rgb, int gloss, int wall)
{
    uint16_t back_up[2 * MOUTH_CORNER + 1], back_low[2 * MOUTH_CORNER + 1];

    for (int i = 0; i < count; i++) {
        back_up[i] = back_low[i] = line_vertex(c, up[i], 0, move, rgb, gloss);
        if (up[i] != low[i])
            back_low[i] = line_vertex(c, low[i], 1, move, rgb, gloss);
    }
    for (int i = 0; i + 1 < count; i++) {
        add_quad(c, up[i], back_up[i], back_up[i + 1], up[i + 1]);
        add_quad(c, back_low[i], low[i], low[i + 1], back_low[i + 1]);
        if (wall)
            add_quad(c, back_up[i], back_low[i], back_low[i + 1], back_up[i + 1]);
    }
}

static vec into_mouth(vec p, int lower)
{
    return (vec){ p.x * 1.05f, p.y + (lower ? -20.0f : 20.0f), p.z - 36 };
}

static vec into_socket(vec p, int lower)
{
    return (vec){ p.x, p.y + (lower ? -1.0f : 1.0f), p.z - 7 };
}

static void build_linings(cage *c)
{
    const int m = CAGE_SIDE - MOUTH_CORNER, right = CAGE_SIDE - EYE_OUTER, left = CAGE_SIDE + EYE_INNER;
    const int lids = EYE_OUTER - EYE_INNER + 1;

    line_opening(c, &c->upper[ROW_MOUTH][m], &c->lower[ROW_MOUTH][m], 2 * MOUTH_CORNER + 1, into_mouth, MOUTH,
                 120, 1);
    line_opening(c, &c->upper[ROW_EYE][right], &c->lower[ROW_EYE][right], lids, into_socket, LID, 60, 0);
    line_opening(c, &c->upper[ROW_EYE][left], &c->lower[ROW_EYE][left], lids, into_socket, LID, 60, 0);
}

/* Rings about the eye's axis: pupil, rim of the iris twice (its colour ends sharply), the equator. */
static void build_eye(cage *c, int right)
{
    static const float ring_sine[EYE_RINGS] = { 0.2f, 0.46f, 0.52f, 1 };
    static const uint32_t rgb[EYE_RINGS] = { 0x101010, 0x4a7358, 0xe6e2de, 0xe6e2de };
    const float cx = right ? -cage_eye_centre[0] : cage_eye_centre[0], r = cage_eye_radius;
    const fap_part part = right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT;
    const uint32_t pole =
        add_vertex(c, (vec){ cx, cage_eye_centre[1], cage_eye_centre[2] + r }, part, 0x101010, 255, IN_STILL);

    c->eye[right] = (uint16_t)pole;
    for (int ring = 0; ring < EYE_RINGS; ring++)
        for (int lane = 0; lane < EYE_LANES; lane++) {
            const float s = ring_sine[ring], a = lane * 6.2831853f / EYE_LANES;
            const vec p = { cx + r * s * cosf(a), cage_eye_centre[1] + r * s * sinf(a),
                            cage_eye_centre[2] + r * sqrtf(1 - s * s) };
            add_vertex(c, p, part, rgb[ring], 255, IN_STILL);
        }
    for (uint32_t lane = 0; lane < EYE_LANES; lane++) {
        const uint32_t next = (lane + 1) % EYE_LANES;
        add_triangle(c, pole, pole + 1 + lane, pole + 1 + next);
        for (uint32_t ring = 0; ring + 1 < EYE_RINGS; ring++) {
            const uint32_t a = pole + 1 + ring * EYE_LANES;
            add_quad(c, a + lane, a + EYE_LANES + lane, a + EYE_LANES + next, a + next);
        }
    }
}

/* One curved band a jaw: upper edge, then lower edge, right to left. */
static uint16_t build_teeth(cage *c, int lower)
{
    const uint16_t first = (uint16_t)c->vertex_count;
    const float top = lower ? -39.5f : -30, height = 9;
    const fap_part part = lower ? FAP_PART_TEETH_LOWER : FAP_PART_TEETH_UPPER;

    for (int edge = 0; edge < 2; edge++)
        for (int i = 0; i < TEETH_COLUMNS; i++) {
            const float x = 11.0f * (i - TEETH_COLUMNS / 2);
            add_vertex(c, (vec){ x, top - edge * height, (lower ? 114 : 117) - x * x * 0.045f }, part,
                       0xe8e2d2, WET, lower ? IN_TEETH_LOWER : IN_STILL);
        }
    for (uint32_t i = first; i + 1 < (uint32_t)first + TEETH_COLUMNS; i++)
        add_quad(c, i, i + TEETH_COLUMNS, i + TEETH_COLUMNS + 1, i + 1);
    return first;
}

/* Rows from the root to the tip; right border, ridge, left border. */
static void build_tongue(cage *c)
{
    static const int16_t row_z[TONGUE_ROWS] = { 76, 90, 101, 109 },
                         half_width[TONGUE_ROWS] = { 16, 16, 13, 5 };
    static const int16_t row_y[TONGUE_ROWS] = { -38, -36, -38, -41 };

    c->tongue = (uint16_t)c->vertex_count;
    for (int row = 0; row < TONGUE_ROWS; row++)
        for (int i = -1; i <= 1; i++)
            add_vertex(c, (vec){ (float)(i * half_width[row]), row_y[row] - (i ? 4.0f : 0), row_z[row] },
                       FAP_PART_TONGUE, 0xb5605c, WET, IN_TONGUE);
    for (uint32_t row = 0; row + 1 < TONGUE_ROWS; row++)
        for (uint32_t i = 0; i < 2; i++) {
            const uint32_t a = c->tongue + row * 3 + i;
            add_quad(c, a, a + 3, a + 4, a + 1);
        }
}

void cage_build(cage *c)
{
    memset(c, 0, sizeof *c);
    build_skin(c);
    build_linings(c);
    build_eye(c, 0);
    build_eye(c, 1);
    c->teeth_upper = build_teeth(c, 0);
    c->teeth_lower = build_teeth(c, 1);
    build_tongue(c);
}
