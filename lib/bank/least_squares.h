/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The problem that commanded rows pose to the units: bounded least squares with prices on what nobody asked
 * for. Used by the methods qp and ga.
 */
#ifndef LIB_BANK_LEAST_SQUARES_H
#define LIB_BANK_LEAST_SQUARES_H

#include <fap/face.h>

#include "bank/qp.h"

enum { FAP_RIVALS = 6 };

/* Two units that undo one another. */
typedef struct fap_rivals {
    int key[2];
    float stiffness_mm2;
} fap_rivals;

/*
 * What of a problem depends on which rows are commanded and which keys are shown, but not on how far: from frame to frame
 * the same. Kept, and made anew when it differs; the answer is the same either way.
 */
typedef struct fap_problem {
    uint8_t wanted[FAP_POINT_COUNT][3];
    int base_count, base_key[4], has_base_jaw, follows_on; /* base_count -1: not made yet */
    int n, *variable;                                      /* column of each variable */
    double *gram;                                          /* as fap_qp has it */
    float *last;                                           /* [key_count + 1]: the last answer, by column */
} fap_problem;

typedef struct fap_least_squares {
    fap_qp qp;
    fap_problem *problem; /* [1 + regions]: of the whole face, then of each region */
    int problem_count;
    float *basis;      /* [FAP_ROWS][key_count + 1]: columns, see close_over_jaw() */
    uint8_t *free_key; /* [key_count]: a variable of the problem */
    fap_rivals rivals[FAP_RIVALS];
    int rival_count;
    int cheek_row[2]; /* the sideways rows of the cheeks */
    float *beside;    /* [2 * key_count], see fap_blend_beside() */
    int *mover;       /* [key_count + 1]: work of one row, with reach */
    double *reach;
    float *pull;   /* [key_count + 1]: what the targets ask of each column */
    double *whole; /* [key_count + 1]: the last answer for the whole face, by variable */
} fap_least_squares;

/* Non-zero: no memory. Close in either case. */
int fap_least_squares_open(fap_least_squares *ls, const fap_face *face);
void fap_least_squares_close(fap_least_squares *ls, const fap_face *face);
/* The one minimum for this frame's rows and base. @p weight [key_count] */
void fap_least_squares_solve(fap_least_squares *ls, const fap_face *face, float *weight);
/* The same for one region, near the whole face's answer; only after fap_least_squares_solve() for this frame. */
void fap_least_squares_refine(fap_least_squares *ls, const fap_face *face, int region, float *weight);

/* Weights of units end here: a little beyond what was modelled. */
extern const float fap_most_of_a_unit;

#endif
