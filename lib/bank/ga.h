/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The thesis's genetic algorithm over blend weights: three drawn, the worst replaced by the child of the two
 * best. An individual is its weights (genes) and what they do to the feature points (its vector); no surface
 * point is touched. Source: Zhu 2006 sections 3.2 and 3.4.3.
 */
#ifndef LIB_BANK_GA_H
#define LIB_BANK_GA_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/face.h>

#include "base/lanes.h"

typedef struct fap_ga fap_ga;

/*
 * What a caller of the algorithm defines. Vectors have @c size floats, a multiple of FAP_LANES, zeros at the end; genes
 * @c gene_count. Where fitness is the cosine a vector is three planes, x, y, z of all points, each such a multiple.
 */
typedef struct fap_ga_task {
    const float *target;
    const float *row_weight; /* error only: importance of each float of the vector */
    int size;
    int cosine; /* 1: fitness is the mean cosine of 3D vectors (eq. 3.3); 0: minus the squared error */
    fap_crossover crossover;
    int generations;
    uint64_t seed;
    float gene_max; /* error only: genes stay in 0 .. gene_max */
} fap_ga_task;

enum { FAP_GA_POINTS = (FAP_POINT_COUNT + FAP_LANES - 1) / FAP_LANES * FAP_LANES };

/* The target of a cosine, measured once. */
typedef struct fap_ga_aim {
    int plane, moving;               /* points with the padding; those that should move */
    float length;                    /* of all that should move, summed */
    float per_length[FAP_GA_POINTS]; /* 1 / length; 0 where nothing should move */
    float counts[FAP_GA_POINTS];     /* 1 where something should, else 0 */
} fap_ga_aim;

struct fap_ga {
    int capacity, count;      /* individuals */
    int size_max, gene_count; /* multiples of FAP_LANES */
    float *vector, *gene;     /* [capacity + 2][...]: the population, then the best so far, then the child */
    float *score;
    fap_ga_aim aim;
    void *block;
};

/* Non-zero: no memory. */
int fap_ga_open(fap_ga *ga, int capacity, int size_max, int gene_count, const fap_allocator *alloc);
void fap_ga_close(fap_ga *ga, const fap_allocator *alloc);
/* Empties the population. */
void fap_ga_clear(fap_ga *ga);
/* A new individual to fill in, all zero; *vector of size_max floats, *gene of gene_count. 0: the population
 * is full. */
int fap_ga_add(fap_ga *ga, float **vector, float **gene);
/* Runs the generations. The best individual ever, or NULL for an empty population; its score. */
const float *fap_ga_run(fap_ga *ga, const fap_ga_task *task, float *score);
/* Mean cosine over the points whose target moves (eq. 3.2, 3.3); 1 when none does. @p plane: points, a multiple of
 * FAP_LANES, at most FAP_GA_POINTS. */
float fap_ga_cosine(const float *target, const float *candidate, int plane);

#endif
