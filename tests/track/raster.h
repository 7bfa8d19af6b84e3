/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Triangles, discs and balls into a picture, before a pinhole camera: what mirror films are drawn with. Not the player's renderer:
 * here every pixel must be where the camera's formula says, on every machine, with and without OpenGL.
 * Places are camera coordinates: x right, y down, z into the scene, millimetres.
 */
#ifndef TESTS_TRACK_RASTER_H
#define TESTS_TRACK_RASTER_H

#include <stdint.h>

#include <fap/studio/mirror.h>

typedef struct raster {
    fap_camera camera;  /* its lens must be straight */
    double shift_px[2]; /* where in its pixel a sample is taken, -0.5 to 0.5 */
    float *depth;       /* [height][width], millimetres; INFINITY: nothing */
    uint8_t *rgb;       /* [height][width][3] */
    uint8_t *owner;     /* [height][width]: 0 what is seen directly, else the mirror it is seen in */
    int drawing;        /* the owner whose pixels are drawn now */
} raster;

/* How much of a disc was drawn: pixels of it, and those where nothing was before it. */
typedef struct raster_cover {
    int pixels, seen;
} raster_cover;

int raster_make(raster *r, const fap_camera *camera); /* 0: no memory */
void raster_free(raster *r);
void raster_clear(raster *r, const uint8_t rgb[3]);

/* @colour: 0 to 255 a channel, blended between the corners. */
void raster_triangle(raster *r, const float corner[3][3], const float colour[3][3]);
/* A disc on a surface: hidden only by what is @sunk_mm before it. */
raster_cover raster_disc(raster *r, const double centre[3], const double normal[3], double radius_mm,
                         double sunk_mm, const uint8_t rgb[3]);
raster_cover raster_ball(raster *r, const double centre[3], double radius_mm, const uint8_t rgb[3]);
/*
 * A rectangle of glass: its pixels where nothing is before it belong to @owner from now on, empty.
 * @half  from its middle to the middles of two of its sides
 */
void raster_mirror(raster *r, const double middle[3], const double half[2][3], int owner,
                   const uint8_t rgb[3]);

#endif
