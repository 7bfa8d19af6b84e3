/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What the FBA decoder and encoder share: the order of the coded parameters, their steps and symbol ranges.
 * Source: ISO/IEC 14496-2, face object plane; Annex C, Table C-1.
 */
#ifndef LIB_CODEC_FBA_H
#define LIB_CODEC_FBA_H

#include <stdint.h>

#include <fap/frame.h>
#include <fap/tables.h>

#include "codec/bits.h"
#include "param/frame.h"

/* Start codes, and those of drafts that old decoders take. */
enum {
    FBA_START_PREFIX = 0x000001,
    FBA_CODE_SEQUENCE = 0xB0,
    FBA_CODE_END = 0xB1,
    FBA_CODE_OBJECT = 0xBA,
    FBA_CODE_PLANE = 0xBB,
    FBA_CODE_DRAFT_OBJECT = 0x01,
    FBA_CODE_DRAFT_PLANE = 0x03,
};

enum { FBA_MASK_NONE, FBA_MASK_HOLD, FBA_MASK_INTERPOLATE, FBA_MASK_ALL }; /* fap_mask_type */

enum {
    FBA_BOUND_UNIT = 60, /* ranges are sent in this unit, 5 bits */
    FBA_BOUND_MAX = 31,
};

/* Parameters in the order in which they are coded: 3 of FAP 1, 4 of FAP 2, FAPs 3 to 68. */
enum {
    FBA_VISEME_SELECT1,
    FBA_VISEME_SELECT2,
    FBA_VISEME_BLEND,
    FBA_EXPRESSION_SELECT1,
    FBA_EXPRESSION_INTENSITY1,
    FBA_EXPRESSION_SELECT2,
    FBA_EXPRESSION_INTENSITY2,
    FBA_FIRST_FAP,
    FBA_PARAMS = FBA_FIRST_FAP + FAP_COUNT - 2
};

/* Which of the two kinds of plane a range belongs to. */
enum { FBA_P, FBA_I };

typedef struct fba_range {
    int16_t min, max; /* in levels */
} fba_range;

/* What an I plane sets and the P planes behind it keep. */
typedef struct fba_setup {
    uint8_t quant;
    uint8_t gender;
    uint8_t mask_type[FAP_GROUPS + 1];
    uint8_t coded[FAP_COUNT + 1];
    fba_range range[2][FAP_COUNT + 1]; /* FAPs 3..68 */
} fba_setup;

/* A coded parameter, with all that its symbols need. */
typedef struct fba_coded {
    uint8_t param, fap;
    uint16_t step; /* what one level is worth */
    struct {
        int16_t min;
        uint16_t size;
    } symbols[2]; /* [FBA_P], [FBA_I]: symbol 0 is level min */
} fba_coded;

/* The coded parameters of a setup, in order: computed once, used by every plane. */
typedef struct fba_coded_list {
    int count;
    fba_coded of[FBA_PARAMS];
} fba_coded_list;

void fap_fba_list_coded(fba_coded_list *list, const fba_setup *s);

/* The FAP a parameter belongs to. */
int fap_fba_fap(int param);
/* What one level of a parameter is worth. */
int32_t fap_fba_step(int param, int quant);
fba_range fap_fba_param_range(const fba_setup *s, int param, int intra);
static inline int fba_range_size(fba_range r)
{
    return r.max - r.min + 1;
}
/* A bound sent as @p n, in levels. */
int fap_fba_bound(int n, int quant);
/* The table's ranges; @p bound above 0: that one for all, as an encoder wrote that sends none. */
void fap_fba_default_ranges(fba_setup *s, int bound);

#endif
