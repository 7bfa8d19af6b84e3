/* SPDX-License-Identifier: BSD-2-Clause */
/* A bank whose colours show what its maps say: sides of the slits, or regions. */
#ifndef DATABANK_PAINT_H
#define DATABANK_PAINT_H

#include <fap/bank.h>

typedef enum paint { PAINT_NONE, PAINT_MASKS, PAINT_REGIONS } paint;

/* Replaces @p *bank by a painted copy; maps that it has not got are found out as fapbank build would. */
fap_err paint_bank(fap_bank **bank, paint what);

#endif
