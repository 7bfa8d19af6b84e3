/* SPDX-License-Identifier: BSD-2-Clause */
/* The pictures and rates of YUV4MPEG2. */
#ifndef PLAYER_SINKS_Y4M_H
#define PLAYER_SINKS_Y4M_H

#include <stddef.h>
#include <stdint.h>

#include "player/render/image.h"

/* @frames in @seconds. */
typedef struct y4m_rate {
    int64_t frames, seconds;
} y4m_rate;

/* 29.97 is 30000/1001; else exact to a millionth of a frame. */
y4m_rate y4m_rate_of(double hz);

/* Three planes one behind the other; those of colour are half as wide and high, rounded up. */
typedef struct y4m_picture {
    uint8_t *y, *u, *v; /* y is the caller's to free */
    size_t size;        /* of all three */
} y4m_picture;

/* 0: no memory. */
int y4m_picture_make(y4m_picture *p, int width, int height);
/* @im has the size that @p was made for. */
void y4m_picture_set(y4m_picture *p, const image *im);

#endif
