/* SPDX-License-Identifier: BSD-2-Clause */
/* The path of one parameter through its lattice that costs least: errors plus lambda times bits. */
#ifndef LIB_CODEC_FBA_TRELLIS_H
#define LIB_CODEC_FBA_TRELLIS_H

#include "codec/fba_cost.h"

enum { TRELLIS_STATES = 4 };

/* A survivor of one frame. */
typedef struct trellis_state {
    int32_t place;
    uint8_t from; /* its place in the frame before */
} trellis_state;

typedef struct trellis {
    const int32_t *want;                    /* [count] values */
    const uint64_t *lambda;                 /* [count] error a bit */
    const uint8_t *still;                   /* [count] 1: nothing may change in this frame */
    trellis_state (*state)[TRELLIS_STATES]; /* [count] */
    const fba_costs *costs;                 /* counts of P levels are loaded */
    int count, intra;
    int32_t start; /* place before the first frame, unless intra */
    int32_t step, widest;
    uint32_t nm;       /* of a unit */
    int64_t permitted; /* units; -1: errors count by their square. Otherwise only larger ones count, as more
                                  than all bits there are */
    fba_range range;   /* of P levels */
    int total;         /* sum of the counts of that range */
} trellis;

/* What it costs to show @p place for @p want. */
uint64_t fap_fba_error(const trellis *t, int32_t want, int32_t place);
/* The best path: [count] places. */
void fap_fba_trellis(const trellis *t, int32_t *path);

#endif
