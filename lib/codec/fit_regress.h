/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Formulas for one FAP of a take from others: features are a constant, FAPs and their squares, and a formula is
 * grown one feature at a time until its largest error is small enough.
 */
#ifndef LIB_CODEC_FIT_REGRESS_H
#define LIB_CODEC_FIT_REGRESS_H

#include <stddef.h>
#include <stdint.h>

#include "param/fit.h"

enum { FIT_MAX_COLUMNS = FAP_COUNT - 2, FIT_FEATURES = 1 + 2 * FIT_MAX_COLUMNS, FIT_FORMULA_MAX = 8 };

/* Feature 0 is the constant; column c has features 1 + 2c and 2 + 2c, to the powers 1 and 2. */
static inline int fit_feature(int column, int power)
{
    return 2 * column + power;
}

/* The take as the regression sees it. */
typedef struct fit_data {
    int columns; /* FAPs that take part */
    size_t rows;
    uint8_t fap[FIT_MAX_COLUMNS];
    double bound[FIT_MAX_COLUMNS]; /* by how much a FAP may miss */
    size_t exceptions;             /* rows in which it may miss by more */
    int32_t *value, *source;       /* [column * rows + row]: as it is, and as a decoder will have it */
    double *weight;                /* [rows], scratch */
    /* Sums over rows: of products of two features, of a feature and a FAP's value, of its squares. */
    double gram[FIT_FEATURES][FIT_FEATURES];
    double cross[FIT_MAX_COLUMNS][FIT_FEATURES];
    double energy[FIT_MAX_COLUMNS];
} fit_data;

typedef struct fit_formula {
    int terms;
    uint8_t feature[FIT_FORMULA_MAX];
    fit_number coefficient[FIT_FORMULA_MAX];
} fit_formula;

/* From value and source: the sums. */
void fap_fit_sum(fit_data *d);
/* A formula for @p column from the columns marked in @p allowed, of at most @p terms terms. 0: there is none. */
int fap_fit_find(fit_data *d, int column, const uint8_t allowed[FIT_MAX_COLUMNS], int terms,
                 fit_formula *out);

#endif
