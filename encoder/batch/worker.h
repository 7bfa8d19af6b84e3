/* SPDX-License-Identifier: BSD-2-Clause */
/* One take of a batch in a process of its own: whatever it does, the others go on. */
#ifndef ENCODER_BATCH_WORKER_H
#define ENCODER_BATCH_WORKER_H

#include <sys/types.h>

#include "encoder/batch/items.h"

enum { WORKER_MAX = 256 };

typedef struct worker {
    pid_t pid; /* 0: none */
    item *it;
    char claim[ITEM_PATH_SIZE];
} worker;

/* A batch that a signal ends takes its workers and their claims along. Before the first worker. */
void workers_watch(void);
/* Starts on a take whose claim is ours. 0: errno says why. */
int worker_start(worker *w, item *it, const options *opt, const char *claim);
/* 1: it has ended, its result is written and its claim given back; 0: it is at work. */
int worker_ended(worker *w, const options *opt);

#endif
