/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A blend method: from commanded rows (one axis of one feature point each) to weights of key models, or to a
 * shape of its own. One file a method, one const struct in it; blend.c lists them in the order of fap_blend.
 */
#ifndef LIB_BANK_BLEND_H
#define LIB_BANK_BLEND_H

#include <fap/face.h>

typedef struct fap_blend_method {
    const char *name, *summary; /* for --blend and --help */
    int regions;                /* 1: has weights of its own in each region; 0: one set for all */
    size_t state_size;          /* the face allocates it, zeroed; may be 0 */
    int (*open)(void *state, const fap_face *face);   /* NULL: nothing to do; non-zero: no memory */
    void (*close)(void *state, const fap_face *face); /* also after a failed open; NULL: nothing to do */
    /* Fills face->weight of every region; called with at least one commanded row. */
    void (*solve)(void *state, fap_face *face);
    /* What weights cannot say, added to the blended mesh; NULL: nothing. */
    void (*shape)(void *state, fap_face *face, float *position);
} fap_blend_method;

extern const fap_blend_method fap_blend_zhu, fap_blend_qp, fap_blend_ga, fap_blend_pca, fap_blend_rbf,
    fap_blend_fat, fap_blend_bones;

/* In the order of fap_blend, then NULL. */
extern const fap_blend_method *const fap_blend_methods[];

/* Weights from rows and base by the face's method; gaze and blink on top. */
void fap_face_solve(fap_face *face);

/* --- what methods share --- */

/* What @p weight[key_count] does to a row. */
float fap_face_row_motion(const fap_face *face, int row, const float *weight);
/* The same for weights of all regions, [FAP_REGION_MAX][key_count], and the fields of field_share. */
float fap_blend_row_motion(const fap_face *face, int row, const float *weight);
/* What is left of a row's target once gaze and blink have moved it. */
float fap_blend_row_target(const fap_face *face, int row);
/* What a squared millimetre of a row counts. */
float fap_blend_importance(int row);
/* Weights of a region. */
float *fap_blend_region(const fap_face *face, float *weight, int region);
/* The first region's weights are those of all. */
void fap_blend_copy_to_regions(const fap_face *face, float *weight);
/* Mean cosine along the commanded axes alone: what nobody asked for is neither right nor wrong. */
float fap_blend_fitness(const fap_face *face, const float *weight);
/* What @p weight leaves a commanded row short of, against what was asked, lids or not. */
float fap_blend_shortfall(const fap_face *face, int row, const float *weight);
/* Its square, summed over commanded rows: what stats.target_error_mm is made of. */
float fap_blend_squared_error(const fap_face *face, const float *weight);
/*
 * For each key, how much it moves points of a region that nobody speaks of against how much it moves commanded
 * ones, capped. Brows move the lids a little, too, but a command to the lids alone should close the eyes and
 * leave the brows in peace.
 * @param matrix  [FAP_ROWS][stride]: what keys do to rows
 * @param beside  [2 * key_count]; the second half is work
 */
void fap_blend_beside(const fap_face *face, int region, const float *matrix, size_t stride, float *beside);
/* The cap. */
extern const float fap_blend_most_beside;

#endif
