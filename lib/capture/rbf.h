/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Values between scattered centres: radial functions, an inverse multiquadric of its own radius for each centre, and an
 * affine part. What is asked for is the mix: how much of each centre's value a place takes, since that stays the same
 * over a take while the values change. Source: Sanchez Lorenzo et al. 2003, section 5.1, eq. 13 to 16.
 */
#ifndef LIB_CAPTURE_RBF_H
#define LIB_CAPTURE_RBF_H

#include <stdint.h>

/* Far centres say nothing about a lip: the nearest ones are enough, and a set of 478 points stays quick. */
enum { RBF_MOST = 16 };

typedef struct rbf_centre {
    double at[3];
    uint8_t side; /* fap_mask bit; nothing passes to the side across. 0: free */
    uint8_t use;  /* 0: not there */
} rbf_centre;

typedef struct rbf_mix {
    uint32_t count; /* 0: no centre */
    uint16_t centre[RBF_MOST];
    double weight[RBF_MOST], distance[RBF_MOST]; /* ascending distance */
} rbf_mix;

/* The mix at a place; weights sum to one. */
void rbf_mix_at(rbf_mix *out, const rbf_centre *centre, uint32_t count, const double at[3], uint8_t side);

#endif
