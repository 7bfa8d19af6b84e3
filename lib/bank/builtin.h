/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The built-in face in the making: builtin_shape.c sets the neutral cage, builtin_smooth.c rounds it,
 * builtin_inside.c adds eyes, teeth and tongue, builtin_units.c moves it all, builtin.c makes a bank of it. Everything is computed; no vertex was typed and none comes from anybody's model.
 */
#ifndef LIB_BANK_BUILTIN_H
#define LIB_BANK_BUILTIN_H

#include <fap/bank.h>

/* The cage of the skin is a grid of rows, crown to neck base, and columns, right to left; column 0 is the midline. */
enum { CAGE_ROWS = 21, CAGE_SIDE = 11, ROW_BROW = 4, ROW_CREASE = 5, ROW_EYE = 6, ROW_MOUTH = 13 };
enum { EYE_INNER = 3, EYE_OUTER = 7, MOUTH_CORNER = 5, LIP_COLUMNS = 2 * MOUTH_CORNER + 1 };
enum { CAGE_MAX_VERTICES = 624, CAGE_MAX_FACES = 640, CAGE_MAX_EDGES = 1280 };
enum { FINE_MAX_VERTICES = 2800, FINE_MAX_TRIANGLES = 5200 };

/* Where a vertex stands to the openings: fields act on one lip or lid without touching the other. */
enum { IN_UPPER = 1, IN_LOWER = 2, IN_LID_UPPER = 4, IN_LID_LOWER = 8, IN_CREASE = 16 };

typedef struct cage_edge {
    uint16_t end[2], face[2];
    uint8_t face_count, sharp;
} cage_edge;

/* The skin's control polygons. Where two vertices that are both marked sharp share an edge, it stays a line. */
typedef struct cage {
    uint32_t vertex_count, face_count, edge_count;
    float position[CAGE_MAX_VERTICES][3], colour[CAGE_MAX_VERTICES][3];
    float finish[CAGE_MAX_VERTICES][3]; /* gloss, head weight, nothing */
    uint8_t in[CAGE_MAX_VERTICES], sharp[CAGE_MAX_VERTICES];
    uint16_t face[CAGE_MAX_FACES][4]; /* the last two equal: a triangle */
    /* Vertex of [row][column + CAGE_SIDE]; the upper edge and, where a slit opens, the lower. */
    uint16_t upper[CAGE_ROWS][2 * CAGE_SIDE + 1], lower[CAGE_ROWS][2 * CAGE_SIDE + 1];
    uint16_t lip_upper[LIP_COLUMNS], lip_lower[LIP_COLUMNS]; /* the line where the lips meet */
    /* made of the above by cage_link() */
    cage_edge edge[CAGE_MAX_EDGES];
    uint16_t face_edge[CAGE_MAX_FACES][4];
    uint8_t valence[CAGE_MAX_VERTICES], sharp_edges[CAGE_MAX_VERTICES];
} cage;

/* What is drawn. The skin comes first: cage vertices where smoothing took them, then one an edge, then one a face. */
typedef struct cage_fine {
    cage cage;
    uint32_t vertex_count, skin_count, triangle_count;
    float position[FINE_MAX_VERTICES][3];
    uint8_t part[FINE_MAX_VERTICES], weight[FINE_MAX_VERTICES], colour[FINE_MAX_VERTICES][4];
    uint32_t triangle[FINE_MAX_TRIANGLES][3];
    uint32_t eye[2], teeth_upper, teeth_lower, tongue;                     /* first vertex of each */
    float cage_motion[CAGE_MAX_VERTICES][3], motion[FINE_MAX_VERTICES][3]; /* work */
} cage_fine;

/* Rows and columns of the inner parts. */
enum { EYE_LANES = 16, EYE_RINGS = 6, TEETH_COLUMNS = 11, TONGUE_ROWS = 7, TONGUE_COLUMNS = 5 };

extern const float cage_eye_centre[3]; /* of the left eye */
extern const float cage_eye_radius;

/* The neutral face. */
void cage_build(cage_fine *f);

/* Eyes, teeth and tongue, after the skin. */
void cage_add_inside(cage_fine *f);
/* Of a vertex of the tongue: 0 at the root, 1 at the tip. */
float cage_tongue_along(const cage_fine *f, uint32_t v);

/* Edges and what is counted about them. */
void cage_link(cage *c);
/* How many vertices one step of smoothing makes. */
uint32_t cage_fine_count(const cage *c);
/* One vector a cage vertex to one a fine vertex; linear, so it serves positions, colours and motions. */
void cage_smooth(const cage *c, const float (*in)[3], float (*out)[3]);
/* Four (three) small quads a face as triangles; returns how many. */
uint32_t cage_fine_triangles(const cage *c, uint32_t (*triangle)[3]);

/* How many units there are, and the name of one. */
int cage_unit_count(void);
const char *cage_unit_name(int unit);
/* Index of the unit of that name, -1: none. */
int cage_unit_find(const char *name);
/* Adds @p weight of @p unit's motion to @p motion (x[stride] y[stride] z[stride], millimetres). */
void cage_unit_add(cage_fine *f, int unit, float weight, float *motion, uint32_t stride);

#endif
