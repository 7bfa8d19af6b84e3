/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables: what a row of NAME.csv says about a frame behind its number and its time. */
#ifndef PLAYER_SINKS_CSV_H
#define PLAYER_SINKS_CSV_H

#include <stdio.h>

#include "player/sinks/sink.h"

typedef struct csv_kind {
    const char *name; /* for --csv */
    /* What writing needs; NULL: nothing. 0: no memory. */
    int (*open)(void **state);
    void (*close)(void *state);
    /* The header's line, without its end. */
    void (*put_names)(FILE *out, const fap_bank *bank);
    /* One frame: whole lines, each beginning with @head, "frame,time_s", where the header does. */
    void (*put_frame)(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank,
                      void *state);
    /* Bytes of a frame, roughly and rather too many. */
    double (*frame_size)(const fap_bank *bank);
} csv_kind;

extern const csv_kind csv_arkit;
/* All of them, then NULL; the first is what is written without --csv. */
extern const csv_kind *const csv_kinds[];

/* NULL: no such kind. */
const csv_kind *csv_kind_by_name(const char *name);

#endif
