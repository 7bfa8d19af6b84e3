/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Discontinuity masks: which vertices are of the upper or the lower lip, of the upper or the lower lid of an eye.
 * What moves one side of a slit has no business on the other. Source: Sanchez 2006 section 4.3.
 */
#ifndef LIB_BANK_MASK_H
#define LIB_BANK_MASK_H

#include <fap/bank.h>

/* The bit of the side a feature point is on; 0: on none, as the corners of the mouth and of the eyes are. */
uint8_t fap_mask_of_point(int point);
/* The bit across the slit; 0 for 0. */
uint8_t fap_mask_across(uint8_t bit);
/*
 * From distances along the surface: a vertex is of the side that is clearly nearer. @p mask: [stride].
 * Non-zero: no memory.
 */
int fap_mask_derive(const fap_bank *bank, uint8_t *mask, const fap_allocator *alloc);

#endif
