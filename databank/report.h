/* SPDX-License-Identifier: BSD-2-Clause */
/* What fapbank did, in words or as JSON, and the exit status that follows. */
#ifndef DATABANK_REPORT_H
#define DATABANK_REPORT_H

#include <fap/bank.h>

#include "databank/build/recipe.h"
#include "databank/options.h"

typedef struct report {
    char where[FAP_ERROR_TEXT_SIZE]; /* the file at fault */
    recipe_outcome recipe;           /* of a text recipe; else all 0 */
    const char *missing;             /* a library this build lacks; NULL: none */
    fap_bank *bank;                  /* the one that was made or looked at; the report closes it */
    size_t size;                     /* of its file; 0: built in */
} report;

/* @return the exit status */
int report_print(report *rep, const options *opt, fap_err err);

#endif
