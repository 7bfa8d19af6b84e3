/* SPDX-License-Identifier: BSD-2-Clause */
/* The takes of a batch, and where everything about them lies. */
#ifndef ENCODER_BATCH_ITEMS_H
#define ENCODER_BATCH_ITEMS_H

#include <stddef.h>

#include "common/folder.h"
#include "encoder/batch/result.h"

typedef enum item_state { ITEM_WAITING, ITEM_RUNNING, ITEM_DONE } item_state;

/* Paths are made when the list is. */
typedef struct item {
    const char *name; /* relative to the folder of the takes, as below to that of the outputs */
    char *input;
    char *stem;   /* OUT/sub/take: .fap, .svg and .json behind it */
    char *ledger; /* OUT/.batch/sub/take.c3d: .claim, .result and .log behind it */
    item_state state;
} item;

typedef struct items {
    item *item;
    size_t count;
    folder_list files;
} items;

/* What is no capture by its ending (sound, pictures, documents) is left out. */
fap_err items_list(items *l, const options *opt);
void items_free(items *l);

enum { ITEM_PATH_SIZE = 4400 };

/* "@base@ending"; 0: too long. */
int item_path(char path[ITEM_PATH_SIZE], const char *base, const char *ending);
/* What the result of this take with these options is made of: another text, another result. */
void item_made_of(const item *it, const options *opt, char out[RESULT_VALUE_SIZE]);
/* 1: the take is done, with these options; @r says how. */
int item_result(const item *it, const options *opt, result *r);

#endif
