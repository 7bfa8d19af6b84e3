/* SPDX-License-Identifier: BSD-2-Clause */
/* See pack.h. */
#include <math.h>

#include "bank/pack.h"

enum { STEPS = 32767 };

float fap_pack_scale(const float *motion, uint32_t stride)
{
    float most = 0;

    for (uint32_t i = 0; i < 3 * stride; i++)
        most = fmaxf(most, fabsf(motion[i]));
    return most > FAP_PACK_STILL_MM ? most / STEPS : 1;
}

static int block_moves(const float *motion, uint32_t stride, uint32_t block)
{
    for (int axis = 0; axis < 3; axis++)
        for (int lane = 0; lane < FAP_BLOCK; lane++)
            if (fabsf(motion[axis * stride + block * FAP_BLOCK + lane]) > FAP_PACK_STILL_MM)
                return 1;
    return 0;
}

uint32_t fap_pack_blocks(const float *motion, uint32_t stride, uint16_t *block)
{
    uint32_t count = 0;

    for (uint32_t b = 0; b < stride / FAP_BLOCK; b++) {
        if (!block_moves(motion, stride, b))
            continue;
        if (block)
            block[count] = (uint16_t)b;
        count++;
    }
    return count;
}

void fap_pack_delta(const float *motion, uint32_t stride, const uint16_t *block, uint32_t block_count,
                    float scale_mm, int16_t *delta)
{
    for (uint32_t b = 0; b < block_count; b++)
        for (int axis = 0; axis < 3; axis++)
            for (int lane = 0; lane < FAP_BLOCK; lane++)
                *delta++ = (int16_t)lrintf(motion[axis * stride + block[b] * FAP_BLOCK + lane] / scale_mm);
}
