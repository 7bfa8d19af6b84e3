/* SPDX-License-Identifier: BSD-2-Clause */
/* The thesis's way; the method ga asks it, too, so as never to end below it. */
#ifndef LIB_BANK_BLEND_ZHU_H
#define LIB_BANK_BLEND_ZHU_H

#include "bank/face.h"
#include "bank/ga.h"

typedef struct fap_zhu {
    fap_ga ga;
    float *beside; /* [2 * key_count] */
} fap_zhu;

/* Non-zero: no memory. Close in either case. */
int fap_zhu_open(fap_zhu *zhu, const fap_face *face);
void fap_zhu_close(fap_zhu *zhu, const fap_face *face);
/* @p weight  [FAP_REGION_MAX][key_count], all zero */
void fap_zhu_solve(fap_zhu *zhu, const fap_face *face, float *weight);

#endif
