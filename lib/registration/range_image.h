/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A scan as a picture of places: what a range scanner gives. Source: Yano & Harada 2009 section 3.1 (holes filled by blurring data
 * and matte, bilinear sampling).
 */
#ifndef LIB_REGISTRATION_RANGE_IMAGE_H
#define LIB_REGISTRATION_RANGE_IMAGE_H

#include "registration/cylinder.h"
#include "registration/laying.h"

typedef struct range_image {
    uint32_t columns, rows;
    float (*at)[3]; /* [rows * columns] head axes */
    float *matte;   /* [rows * columns] 1: seen or filled, 0: not */
    /* How places of the scan get into it: its own grid, or unrolled about the head. */
    uint32_t *sample_of; /* [scan vertices] of a grid: which sample; NULL: unrolled */
    cylinder axis;
    double left, top,
        pixel[2]; /* unrolled: angle and height of the first sample; radians and mm from one to the next */
    uint32_t filled;
} range_image;

/* The scan's own grid where it has one, else the scan unrolled by rays. FAP_E_NOMEM. */
fap_err range_image_open(range_image *im, const laying *l);
void range_image_close(range_image *im, const fap_allocator *alloc);
/* Small gaps only: @p rounds of blurring. */
fap_err range_image_fill(range_image *im, int rounds, const fap_allocator *alloc);
/* Column and row of a place on the scan; 0: it is not in the picture. */
int range_image_find(const range_image *im, const laying *l, const double at[3], double pixel[2]);
/* Bilinear; 0: there is nothing, or the edge of something. */
int range_image_sample(const range_image *im, const double pixel[2], float at[3]);

#endif
