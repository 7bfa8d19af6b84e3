/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Motion of a key model as the bank keeps it: blocks of 8 vertices in 16-bit steps, blocks that stand still
 * left out. Motion comes as x[stride] y[stride] z[stride] in millimetres, stride a multiple of FAP_BLOCK.
 */
#ifndef LIB_BANK_PACK_H
#define LIB_BANK_PACK_H

#include <fap/bank.h>

/* Motion under this is taken for stillness: half the step that a 16-bit delta over 60 mm can hold anyway. */
#define FAP_PACK_STILL_MM 0.001f

/* The step in millimetres that makes the largest motion fit 16 bits; 1 where nothing moves. */
float fap_pack_scale(const float *motion, uint32_t stride);

/* Numbers of the blocks that move, ascending, into @p block (room for stride / FAP_BLOCK); NULL: only count.
 */
uint32_t fap_pack_blocks(const float *motion, uint32_t stride, uint16_t *block);

/* Fills @p delta [block_count][3][FAP_BLOCK]. */
void fap_pack_delta(const float *motion, uint32_t stride, const uint16_t *block, uint32_t block_count,
                    float scale_mm, int16_t *delta);

#endif
