/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The neutral built-in face: a revolved cage (one width and depth a row) onto which a nose, lips, sockets,
 * chin and ears are pressed as smooth fields; eyes and mouth are slits in the grid whose edges are pulled
 * apart and lined. What is drawn is that cage after a step of smoothing. Lengths follow the usual proportions of an adult head; the origin is the top of the spine.
 */
#include <math.h>
#include <stdlib.h>
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
    { 131, 56, 66, 62 },  { 100, 71, 84, 82 }, { 74, 74, 91, 87 },  { 55, 75, 93, 88 },  { 45, 74, 92, 88 },
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

/* How far the lips are parted sideways: 1 in the middle, 0 at the corner. */
static float lip_taper(int side)
{
    const float t = (float)side / MOUTH_CORNER;
    return side < MOUTH_CORNER ? 1 - t * t : 0;
}

/* How far a lip's ridge stands before the line where lips meet. */
static float lip_ridge(int side, int lower)
{
    return lip_taper(side) * (lower ? 2 : 2.5f);
}

/*
 * The outer lip contours run together at the corners; lips and philtrum stand out. The edges of the slit are
 * the ridges of the lips, the line where they meet lies behind them.
 */
static void press_lips(vec *p, int row, int side, int lower)
{
    static const float closing[10] = { 0.06f, 0, 0.06f, 0.2f, 0.45f, 0.75f, 0.65f, 0.4f, 0.15f, 0 };

    if ((row == ROW_MOUTH - 1 || row == ROW_MOUTH + 1) && side < 10)
        p->y += closing[side] * (rows[ROW_MOUTH].y - p->y);
    if (row == ROW_MOUTH && side == MOUTH_CORNER + 1)
        p->x -= 2;
    p->z += 5 * bump(p->x, p->y, 0, -37, 22, 12);
    if (row != ROW_MOUTH)
        return;
    p->y += lip_taper(side) * (lower ? -3.6f : 3);
    p->z += lip_ridge(side, lower);
}

static void press_face(vec *p, int row, int side, int lower)
{
    press_nose(p, row, side);
    p->z += 4 * bump(p->x, p->y, 44, 2, 16, 14);   /* cheek bone */
    p->z -= 4 * bump(p->x, p->y, 45, -32, 14, 16); /* hollow of the cheek */
    p->z -= 6 * bump(p->x, p->y, 26, 31, 16, 11);  /* socket */
    p->z += 3 * bump(p->x, p->y, 30, 47, 22, 6);   /* ridge of the brow */
    p->z += 5 * bump(p->x, p->y, 0, -71, 16, 9);   /* chin boss */
    p->z -= 4 * bump(p->x, p->y, 0, -56, 18, 5);   /* fold under the lip */
    press_lips(p, row, side, lower);
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
                              : on_eye(x[i], lower ? bottom[i] : top[i], 2);
    else if (row == ROW_CREASE && i > 0 && i < 4)
        *p = on_eye(x[i], crease[i], 3);
    else if (row == ROW_EYE + 1 && i > 0 && i < 4)
        *p = on_eye(x[i], bag[i], 3);
}

static vec skin_place(int row, int column, int lower)
{
    const int side = column < 0 ? -column : column;
    vec p = revolve(row, side);

    press_face(&p, row, side, lower);
    press_ear(&p, row, side);
    press_lids(&p, row, side, lower);
    if (column < 0)
        p.x = -p.x;
    return p;
}

static uint16_t add_vertex(cage *c, vec p, uint32_t rgb, int gloss, int in)
{
    const uint32_t v = c->vertex_count++;

    c->position[v][0] = p.x, c->position[v][1] = p.y, c->position[v][2] = p.z;
    for (int i = 0; i < 3; i++)
        c->colour[v][i] = (float)(rgb >> (16 - 8 * i) & 255);
    c->finish[v][0] = (float)gloss;
    c->finish[v][1] = 255;
    c->in[v] = (uint8_t)in;
    return (uint16_t)v;
}

static void add_face(cage *c, uint16_t a, uint16_t b, uint16_t d, uint16_t e)
{
    uint16_t *f = c->face[c->face_count++];
    f[0] = a, f[1] = b, f[2] = d, f[3] = e;
}

/*
 * Counter-clockwise from the upper left corner, as seen from outside. At the corners of an opening a quad
 * shrinks to a triangle.
 */
static void add_quad(cage *c, uint16_t a, uint16_t b, uint16_t d, uint16_t e)
{
    if (a == b)
        add_face(c, b, d, e, e);
    else if (d == e)
        add_face(c, a, b, d, d);
    else
        add_face(c, a, b, d, e);
}

enum {
    SKIN = 0xc99a80,
    WARM = 0xcf9178,
    LIP = 0xb0605a,
    LIP_EDGE = 0xbd7d6b,
    BROW = 0x3a281c,
    LIP_LINE = 0x8a4440,
    MOUTH_RIM = 0x7a3836,
    MOUTH = 0x4a1a1c,
    MOUTH_BACK = 0x260c0e,
    LID = 0xbb8a72,
    LASHES = 0x7a5546
};

static uint32_t skin_colour(int row, int side)
{
    if (row == ROW_MOUTH && side <= MOUTH_CORNER)
        return LIP;
    if ((row == ROW_MOUTH - 1 || row == ROW_MOUTH + 1) && side < MOUTH_CORNER)
        return LIP_EDGE;
    if (row == ROW_EYE && side >= EYE_INNER && side <= EYE_OUTER)
        return LASHES;
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

    const uint16_t v =
        add_vertex(c, skin_place(row, column, lower), rgb, rgb == LIP ? 90 : 30, skin_in(row, side, lower));
    c->sharp[v] = row == ROW_EYE && side >= EYE_INNER && side <= EYE_OUTER;
    if (row >= CAGE_ROWS - 3)
        c->finish[v][1] = row == CAGE_ROWS - 1 ? 0 : row == CAGE_ROWS - 2 ? 110 : 230;
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
    const uint16_t crown = add_vertex(c, (vec){ 0, 149, AXIS_Z - 4 }, SKIN, 30, IN_UPPER);
    for (int i = 0; i < 2 * CAGE_SIDE; i++) {
        add_face(c, crown, c->upper[0][i], c->upper[0][i + 1], c->upper[0][i + 1]);
        for (int row = 0; row + 1 < CAGE_ROWS; row++)
            add_quad(c, c->lower[row][i], c->upper[row + 1][i], c->upper[row + 1][i + 1],
                     c->lower[row][i + 1]);
    }
}

/* --- linings: strips from the edge of an opening inwards --- */

/* One ring of a lining, both edges from the right corner to the left one, corners shared. */
typedef struct ring {
    int count;
    uint16_t up[LIP_COLUMNS], low[LIP_COLUMNS];
} ring;

typedef struct finish {
    uint32_t rgb;
    int gloss, sharp;
} finish;

/* @p move says where a vertex of the ring @p depth steps inwards comes from its edge's. */
typedef vec (*lining)(vec edge, int lower, int side, int depth);

static uint16_t line_vertex(cage *c, uint16_t edge, vec at, const finish *f)
{
    const uint16_t v = add_vertex(c, at, f->rgb, f->gloss, c->in[edge]);
    c->sharp[v] = (uint8_t)f->sharp;
    return v;
}

static void line_ring(cage *c, const ring *edge, lining move, int depth, const finish *f, ring *out)
{
    out->count = edge->count;
    for (int i = 0; i < edge->count; i++) {
        const float *p = c->position[edge->up[i]], *q = c->position[edge->low[i]];
        const int side = abs(i - edge->count / 2);
        out->up[i] = out->low[i] =
            line_vertex(c, edge->up[i], move((vec){ p[0], p[1], p[2] }, 0, side, depth), f);
        if (edge->up[i] != edge->low[i])
            out->low[i] = line_vertex(c, edge->low[i], move((vec){ q[0], q[1], q[2] }, 1, side, depth), f);
    }
}

static void join_rings(cage *c, const ring *front, const ring *back)
{
    for (int i = 0; i + 1 < front->count; i++) {
        add_quad(c, front->up[i], back->up[i], back->up[i + 1], front->up[i + 1]);
        add_quad(c, back->low[i], front->low[i], front->low[i + 1], back->low[i + 1]);
    }
}

static void close_ring(cage *c, const ring *r)
{
    for (int i = 0; i + 1 < r->count; i++)
        add_quad(c, r->up[i], r->low[i], r->low[i + 1], r->up[i + 1]);
}

/* Ridge of the lip, the line where lips meet, their inside, the bag, its back. */
static vec into_mouth(vec p, int lower, int side, int depth)
{
    static const float away[5] = { 0, 0, 1.5f, 13, 16 }, back[5] = { 0, 0.3f, 6, 15, 46 },
                       wide[5] = { 1, 1, 1, 1.06f, 0.9f };
    const float t = lip_taper(side), up = lower ? -1 : 1;

    return (vec){ p.x * wide[depth], rows[ROW_MOUTH].y + up * sqrtf(t) * away[depth],
                  p.z - lip_ridge(side, lower) - back[depth] };
}

static vec into_socket(vec p, int lower, int side, int depth)
{
    (void)side;
    return (vec){ p.x, p.y + (lower ? -1.0f : 1.0f), p.z - 7 * (float)depth };
}

static void line_mouth(cage *c)
{
    static const finish finishes[5] = {
        { 0 }, { LIP_LINE, 60, 1 }, { MOUTH_RIM, 60, 0 }, { MOUTH, 60, 0 }, { MOUTH_BACK, 20, 0 }
    };
    const int m = CAGE_SIDE - MOUTH_CORNER;
    ring edge = { LIP_COLUMNS, { 0 }, { 0 } }, front, back;

    memcpy(edge.up, &c->upper[ROW_MOUTH][m], sizeof edge.up);
    memcpy(edge.low, &c->lower[ROW_MOUTH][m], sizeof edge.low);
    front = edge;
    for (int depth = 1; depth < 5; depth++) {
        line_ring(c, &edge, into_mouth, depth, &finishes[depth], &back);
        join_rings(c, &front, &back);
        if (depth == 1) {
            memcpy(c->lip_upper, back.up, sizeof back.up);
            memcpy(c->lip_lower, back.low, sizeof back.low);
        }
        front = back;
    }
    close_ring(c, &back);
}

static void line_eye(cage *c, int first)
{
    static const finish lid = { LID, 60, 0 };
    const size_t size = sizeof(uint16_t) * (EYE_OUTER - EYE_INNER + 1);
    ring edge = { EYE_OUTER - EYE_INNER + 1, { 0 }, { 0 } }, back;

    memcpy(edge.up, &c->upper[ROW_EYE][first], size);
    memcpy(edge.low, &c->lower[ROW_EYE][first], size);
    line_ring(c, &edge, into_socket, 1, &lid, &back);
    join_rings(c, &edge, &back);
}

/* --- from the cage to what is drawn --- */

static uint8_t to_byte(float x)
{
    return (uint8_t)(x < 0 ? 0 : x > 255 ? 255 : x + 0.5f);
}

/* Brows are narrower than the cage is fine: their colour is laid on what is drawn. */
static void paint_brow(const float p[3], float rgb[3])
{
    const float along = (fabsf(p[0]) - 29) / 20, above = p[1] - (45.5f + 2 * along - 3.5f * along * along);
    const float hair = p[2] < 50 ? 0 : 1.2f * expf(-powf(along, 8) - above * above / 12);

    for (int i = 0; i < 3; i++)
        rgb[i] += fminf(hair, 0.9f) * ((float)(BROW >> (16 - 8 * i) & 255) - rgb[i]);
}

/* The skin is the smoothed cage; colours and weights go through the same sums. */
static void draw_skin(cage_fine *f)
{
    const cage *c = &f->cage;

    f->skin_count = f->vertex_count = cage_fine_count(c);
    cage_smooth(c, c->position, f->position);
    cage_smooth(c, c->colour, f->motion);
    for (uint32_t v = 0; v < f->skin_count; v++) {
        paint_brow(f->position[v], f->motion[v]);
        for (int i = 0; i < 3; i++)
            f->colour[v][i] = to_byte(f->motion[v][i]);
    }
    cage_smooth(c, c->finish, f->motion);
    for (uint32_t v = 0; v < f->skin_count; v++) {
        f->colour[v][3] = to_byte(f->motion[v][0]);
        f->weight[v] = to_byte(f->motion[v][1]);
        f->part[v] = FAP_PART_SKIN;
    }
    f->triangle_count = cage_fine_triangles(c, f->triangle);
}

void cage_build(cage_fine *f)
{
    cage *c = &f->cage;

    memset(f, 0, sizeof *f);
    build_skin(c);
    line_mouth(c);
    line_eye(c, CAGE_SIDE - EYE_OUTER);
    line_eye(c, CAGE_SIDE + EYE_INNER);
    cage_link(c);
    draw_skin(f);
    cage_add_inside(f);
}
