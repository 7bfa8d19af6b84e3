/* SPDX-License-Identifier: BSD-2-Clause */
/* A bank whose colours show what its maps say: sides of the slits, or regions. */
#ifndef DATABANK_PAINT_H
#define DATABANK_PAINT_H

#include <fap/bank.h>

typedef enum paint { PAINT_NONE, PAINT_MASKS, PAINT_REGIONS } paint;

/* Replaces @p *bank by a painted copy; maps that it has not got are found out as fapbank build would. */
fap_err paint_bank(fap_bank **bank, paint what);

/* Masks and regions, where the bank has none, found out as fapbank build would. */
fap_err paint_find_maps(fap_bank **bank);
/* The colour of a vertex of these sides; left as it is where there are none. */
void paint_mask_colour(uint8_t mask, uint8_t colour[4]);

#endif
