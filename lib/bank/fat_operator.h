/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What the key models say about the whole face when FAPs are all that is known: the linear estimate
 * w = M' (M M' + lambda)^-1 t of their weights, M what keys do along the axes of the FAPs, t the FAPs in millimetres.
 */
#ifndef LIB_BANK_FAT_OPERATOR_H
#define LIB_BANK_FAT_OPERATOR_H

#include <fap/face.h>

#include "bank/face.h"

typedef struct fat_operator {
    int row_count, key_count;
    uint8_t fap[FAP_COUNT]; /* of each row: those that move a point of the skin or the tongue ... */
    uint8_t point[FAP_COUNT], axis[FAP_COUNT];
    float sign[FAP_COUNT], step_mm[FAP_COUNT];
    float *effect;                           /* M, [row_count][key_count], millimetres in the FAP's sense */
    double covariance[FAP_COUNT][FAP_COUNT]; /* S = M M' + lambda */
    double factor[FAP_COUNT][FAP_COUNT];     /* its Cholesky factor, lower left */
} fat_operator;

/* Non-zero: no memory. Close in either case. */
int fat_operator_open(fat_operator *op, const fap_face *face);
void fat_operator_close(fat_operator *op, const fap_face *face);
/* Key weights [key_count] for one millimetre of row @p row while all others stay. */
void fat_operator_weights(const fat_operator *op, const fap_face *face, int row, float *weight);
/* Row of @p fap, -1: none. */
int fat_operator_row(const fat_operator *op, int fap);
/* How far row @p row goes, on average, with each millimetre of @p leader; *alike is their correlation. */
double fat_operator_share(const fat_operator *op, int row, int leader, double *alike);

#endif
