/* SPDX-License-Identifier: BSD-2-Clause */
/* How visemes, expressions and extras blend from units: fap_tables/key_models.csv in memory. */
#ifndef LIB_BANK_RECIPE_H
#define LIB_BANK_RECIPE_H

#include <fap/bank.h>

typedef struct fap_recipe_row {
    fap_key_kind kind;
    int number;
    const char *name; /* of the key model */
    const char *unit;
    float weight;
    int last; /* the key model ends with this row */
} fap_recipe_row;

/* Rows of one key model stand together. NULL past the end. */
const fap_recipe_row *fap_recipe_get(int row, fap_recipe_row *out);

#endif
