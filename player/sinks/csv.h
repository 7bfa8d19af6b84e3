/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables: what a row of NAME.csv says about a frame behind its number and its time. */
#ifndef PLAYER_SINKS_CSV_H
#define PLAYER_SINKS_CSV_H

#include <stdio.h>

#include "player/sinks/sink.h"

typedef struct csv_kind {
    const char *name; /* for --csv */
    /* Names of the columns behind "frame,time_s", a comma in front of each. */
    void (*put_names)(FILE *out, const fap_bank *bank);
    /* One frame: whole lines, each beginning with @head, "frame,time_s". */
    void (*put_frame)(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank);
    /* Bytes of a frame, roughly and rather too many. */
    double (*frame_size)(const fap_bank *bank);
} csv_kind;

/* All of them, then NULL; the first is what is written without --csv. */
extern const csv_kind *const csv_kinds[];

/* NULL: no such kind. */
const csv_kind *csv_kind_by_name(const char *name);

#endif
