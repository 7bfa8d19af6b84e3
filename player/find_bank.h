/* SPDX-License-Identifier: BSD-2-Clause */
/* The face to play on: the one asked for, the default face, or the built-in one. */
#ifndef PLAYER_FIND_BANK_H
#define PLAYER_FIND_BANK_H

#include <fap/bank.h>

#include "player/report.h"

/*
 * @name  a .fbank file; "builtin"; NULL: default.fbank beside the build folder of this program, or where
 * installed, else the built-in face and a note Returns 0 and sets the report's fault when there is none.
 */
int find_bank(fap_bank **bank, const char *name, play_report *r);

#endif
