/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Films of a face with dots between two mirrors, of which everything is known: where every dot is, where it appears, and what hides
 * it. The set-up is that of Lin, Yeh, Ouhyoung 2001, fig. 2 and 3: one camera, a mirror near either cheek, a ruler below the chin.
 */
#ifndef TESTS_TRACK_FILM_H
#define TESTS_TRACK_FILM_H

#include <stdint.h>

#include <fap/bank.h>
#include <fap/studio/mirror.h>

enum { FILM_DOTS = 54, FILM_VIEWS = 1 + FAP_MIRROR_MAX }; /* the last two dots are the ruler's ends */

typedef struct film_config {
    int width_px, height_px;
    double rate_hz, seconds;
    double dot_mm;    /* across */
    int mirrors;      /* 0 to 2 */
    int samples;      /* pictures that are averaged to one */
    double shutter;   /* how much of a frame's time they are spread over: motion blur; 0 to 1 */
    double noise;     /* of every channel of every pixel, standard deviation, of 255 */
    int interlaced;   /* the odd rows are half a frame later */
    int hides;        /* a ball passes before the mouth */
    int one_colour;   /* all dots; else neighbours differ */
    double ruler_mm;  /* from one end to the other */
    double swiftness; /* of all motion; 1: talking, head swaying */
    uint32_t seed;
} film_config;

/* 640 x 480, 30 Hz, 3 s, 3 mm, two mirrors, nothing in the way of seeing well. */
void film_config_init(film_config *cfg);

/* A dot at one instant. */
typedef struct film_dot {
    double place[3]; /* camera millimetres */
    double pixel[FILM_VIEWS][2];
    double shown[FILM_VIEWS]; /* how much of it is seen, 0 to 1; 0 too when it is seen edge on */
} film_dot;

typedef struct film film;

/* @bank is read until close. NULL: no memory, or a face without the dots' feature points. */
film *film_open(const film_config *cfg, const fap_bank *bank);
void film_close(film **f);

const fap_camera *film_camera(const film *f);
const fap_mirror_plane *film_mirror(const film *f); /* [mirrors] */
int film_frames(const film *f);
const char *film_dot_name(int dot); /* its feature point, "8.4", or "ruler A" and "ruler B" */

/*
 * The picture of a frame.
 * @rgb  [height][width][3]
 * @dot  [FILM_DOTS], may be NULL: the truth in the middle of the exposure; of an interlaced frame its first field's
 */
void film_draw(film *f, int frame, uint8_t *rgb, film_dot *dot);
/* Places alone, at any time; pixels too, shown is 0. */
void film_places(film *f, double at_s, film_dot *dot);

#endif
