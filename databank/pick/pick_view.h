/* SPDX-License-Identifier: BSD-2-Clause */
/* A scan seen from one side, without perspective, drawn by casting a ray for every pixel: the same rays tell depth (Zhu 2006, 4.2). */
#ifndef DATABANK_PICK_PICK_VIEW_H
#define DATABANK_PICK_PICK_VIEW_H

#include <fap/studio/surface.h>

#include "surface/nearest.h"

typedef enum pick_side { PICK_RIGHT, PICK_FRONT, PICK_LEFT, PICK_SIDES } pick_side;

/* A surface that is looked at. Arrays are borrowed. */
typedef struct pick_scene {
    const float (*position)[3];
    const uint32_t (*triangle)[3];
    uint32_t vertex_count, triangle_count;
    const uint8_t (*colour)[4]; /* NULL: plaster */
    const surface_index *index;
    float (*normal)[3]; /* own */
} pick_scene;

typedef struct pick_view {
    int width, height;
    uint8_t *rgba;
    double right[3], up[3], toward[3]; /* of the picture, in the scene's axes */
    double middle[3], pixel, depth; /* middle of the picture; length of a pixel; half of the scene's depth */
} pick_view;

/* 0: out of memory. */
int pick_scene_open(pick_scene *s);
void pick_scene_close(pick_scene *s);

int pick_view_open(pick_view *v, int width, int height);
void pick_view_close(pick_view *v);
/* @turn as in pick.h. @focus NULL: all of the scene; else what is in the middle, @zoom times as large. */
void pick_view_draw(pick_view *v, const pick_scene *s, const double turn[3][3], pick_side side,
                    const float *focus, double zoom);
/* What is under a pixel; 0: nothing. */
int pick_view_cast(const pick_view *v, const pick_scene *s, double x, double y, float at[3]);
void pick_view_project(const pick_view *v, const float at[3], double pixel[2]);

#endif
