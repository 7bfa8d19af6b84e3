/* SPDX-License-Identifier: BSD-2-Clause */
/* What is behind fap_arkit_fit: FAPs of every coefficient, viseme and expression, and what a unit of each is worth. */
#ifndef LIB_BANK_ARKIT_FIT_H
#define LIB_BANK_ARKIT_FIT_H

#include <fap/arkit.h>

#include "bank/qp.h"

enum { ARKIT_VISEMES = 15, ARKIT_EXPRESSIONS = 7 }; /* with 0, which is none */

struct fap_arkit_fit {
    fap_allocator alloc;
    fap_qp qp;
    float value[FAP_ARKIT_COUNT][FAP_COUNT + 1];
    float viseme[ARKIT_VISEMES][FAP_COUNT + 1], expression[ARKIT_EXPRESSIONS][FAP_COUNT + 1];
    double price[FAP_COUNT + 1];  /* square millimetres, with importance, of a unit squared */
    uint8_t asked[FAP_COUNT + 1]; /* of the frame that gram was made for */
    double gram[FAP_ARKIT_COUNT][FAP_ARKIT_COUNT];
    int has_gram;
};

/* Fills viseme and expression from value. */
void arkit_fit_name(fap_arkit_fit *fit);

#endif
