/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a dot looks like, and where in a picture something looks like it. The place is searched by eq. 3 of Lin, Yeh, Ouhyoung
 * 2001, the sum of the differences of red, green and blue over the dot's surroundings; then it is the middle of what has the dot's
 * colour rather than the skin's, which does not drift with the template.
 */
#ifndef LIB_TRACK_DOT_H
#define LIB_TRACK_DOT_H

#include <fap/studio/track.h>

enum { DOT_MAX_RADIUS = 15, DOT_MAX_HALF = DOT_MAX_RADIUS + 4, DOT_SIDE = 2 * DOT_MAX_HALF + 1 };

typedef struct dot {
    double radius;
    int half;                          /* the template is a square of 2 * half + 1 pixels */
    float rgb[DOT_SIDE * DOT_SIDE][3]; /* rows of 2 * half + 1 */
    float weight[DOT_SIDE * DOT_SIDE]; /* a disc somewhat larger than the dot; adds up to 1 */
    float colour[3], skin[3];          /* of its middle, and of what surrounds it */
    double area;                       /* pixels of its colour */
    float absent;                      /* cost of skin without a dot */
} dot;

/* At @at, which moves to the dot's middle. @radius 0: as found. */
void dot_learn(dot *d, const fap_picture *picture, double at[2], double radius);
/* Small changes of light are followed, where the dot is surely seen. */
void dot_follow(dot *d, const fap_picture *picture, const double at[2]);
/*
 * The best place within @search pixels of @at, which becomes that place. Of places that look alike the nearer one is better: @pull is what a
 * square pixel of distance costs. Returns the cost of its looks alone: 0 the same, 1 as bad as skin, INFINITY nowhere inside the picture.
 */
double dot_find(const dot *d, const fap_picture *picture, double search, double pull, double at[2]);

#endif
