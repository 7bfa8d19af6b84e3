/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The built-in face in the making: builtin_shape.c sets the neutral mesh, builtin_units.c moves it, builtin.c
 * makes a bank of both. Everything is computed; no vertex was typed and none comes from anybody's model.
 */
#ifndef LIB_BANK_BUILTIN_H
#define LIB_BANK_BUILTIN_H

#include <fap/bank.h>

/* The skin is a grid of rows, crown to neck base, and columns, right to left; column 0 is the midline. */
enum { CAGE_ROWS = 21, CAGE_SIDE = 11, ROW_BROW = 4, ROW_CREASE = 5, ROW_EYE = 6, ROW_MOUTH = 13 };
enum { EYE_INNER = 3, EYE_OUTER = 7, MOUTH_CORNER = 5 };
enum { CAGE_MAX_VERTICES = 640, CAGE_MAX_TRIANGLES = 1280 };

/* Where a vertex stands to the openings: fields act on one lip or lid without touching the other. */
enum {
    IN_UPPER = 1,
    IN_LOWER = 2,
    IN_LID_UPPER = 4,
    IN_LID_LOWER = 8,
    IN_TONGUE = 16,
    IN_TEETH_LOWER = 32,
    IN_STILL = 64,
    IN_CREASE = 128
};

typedef struct cage {
    uint32_t vertex_count, triangle_count;
    float position[CAGE_MAX_VERTICES][3];
    uint8_t part[CAGE_MAX_VERTICES], weight[CAGE_MAX_VERTICES], colour[CAGE_MAX_VERTICES][4],
        in[CAGE_MAX_VERTICES];
    uint32_t triangle[CAGE_MAX_TRIANGLES][3];
    /* Vertex of [row][column + CAGE_SIDE]; the upper edge and, where a slit opens, the lower. */
    uint16_t upper[CAGE_ROWS][2 * CAGE_SIDE + 1], lower[CAGE_ROWS][2 * CAGE_SIDE + 1];
    uint16_t eye[2], teeth_upper, teeth_lower, tongue; /* first vertex of each */
} cage;

/* Rows and columns of the inner parts. */
enum { EYE_LANES = 8, EYE_RINGS = 4, TEETH_COLUMNS = 5, TONGUE_ROWS = 4 };

extern const float cage_eye_centre[3]; /* of the left eye */
extern const float cage_eye_radius;

/* The neutral face. */
void cage_build(cage *c);

/* How many units there are, and the name of one. */
int cage_unit_count(void);
const char *cage_unit_name(int unit);
/* Index of the unit of that name, -1: none. */
int cage_unit_find(const char *name);
/* Adds @p weight of @p unit's motion to @p motion (x[stride] y[stride] z[stride], millimetres). */
void cage_unit_add(const cage *c, int unit, float weight, float *motion, uint32_t stride);

#endif
