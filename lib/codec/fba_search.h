/* SPDX-License-Identifier: BSD-2-Clause */
/* Levels by bits and errors: FAP_ENCODE_BITRATE and FAP_ENCODE_ERROR. All in integers. */
#ifndef LIB_CODEC_FBA_SEARCH_H
#define LIB_CODEC_FBA_SEARCH_H

#include "codec/fba_encode.h"
#include "codec/fba_mix.h"
#include "codec/fba_trellis.h"

/* Logarithms of lambda; at the least one it is 2 micrometres squared a bit. */
enum { SEARCH_OCTAVE = 16, SEARCH_LEAST = 10 * SEARCH_OCTAVE, SEARCH_LEVELS = 34 * SEARCH_OCTAVE };

typedef struct fba_search {
    fba_costs costs;
    int32_t *want;                  /* [FBA_PARAMS][capacity] values */
    int32_t *column, *next;         /* [capacity] paths of one parameter */
    int32_t (*best)[FBA_PARAMS];    /* [capacity] */
    uint8_t *best_left_out, *still; /* [capacity] */
    uint64_t *lambda;               /* [capacity] */
    int32_t *level, *best_level;    /* [capacity] logarithm of lambda */
    uint32_t *fixed, *moving;       /* [capacity] bits that lambda does not change, and those it does */
    trellis_state (*state)[TRELLIS_STATES]; /* [capacity] */
    int64_t *sum;                           /* [2 * (capacity + 2 * WINDOW_MAX)] */
    int32_t *load;                          /* [capacity + WINDOW_MAX] */
    mix_search mix;
    mix_value *mix_want, *mix_path;     /* [capacity] */
    mix_state (*mix_state)[MIX_STATES]; /* [capacity] */
    int quant, common_level;            /* of the run before; quant 0: none yet */
    int64_t intra_bits;                 /* of the last I plane, with what the models learnt behind it */
    uint64_t error, bits;               /* of the last trial */
} fba_search;

/* --- fba_search.c --- */

/* 0: no memory. */
int fap_fba_search_open(fap_encoder *e);
void fap_fba_search_close(fap_encoder *e);
/* Chooses quantiser, places and frames to leave out, for the first @p count frames of the queue. */
void fap_fba_search_run(fap_encoder *e, int count, int intra);
/* What the frames ask for; those that do not send a FAP keep what was asked for last. */
void fap_fba_gather(fap_encoder *e, int count);
/* Frames that were coded leave the queue. */
void fap_fba_search_done(fap_encoder *e, int done);
/* --- fba_try.c --- */

/* Tries lambda as it is in level: path, left_out, bits, error. */
void fap_fba_try(fap_encoder *e, int count, int intra);
/* What not to code a FAP is worth, after a trial of an I plane and what follows: its error and its bits. */
uint64_t fap_fba_worth(fap_encoder *e, int fap, int count);
/* With FAP_ENCODE_ERROR: how many frames are not off by more than is permitted where an I plane would do better. */
int fap_fba_search_carried(fap_encoder *e, int count);

/* --- fba_rate.c --- */

/* An error as a trial counts it. */
uint64_t fap_fba_square(const fap_encoder *e, int fap, int64_t units);

/*
 * Before an I plane: leaves FAPs of least effect out of the plan until the plane takes no more than its share. 0: it
 * cannot be sent with the first frame of the queue.
 */
int fap_fba_search_begin(fap_encoder *e, int count);
/* Bits of frame @p i of a trial, in 1/256, but for its symbols. */
uint32_t fap_fba_overhead(const fap_encoder *e, int i, int intra);
/* How full the fullest window is, of 1024. Needs a trial. */
int fap_fba_fullest(fap_encoder *e, int count, int intra);
/* Moves lambda with the load of the windows over each frame, later rounds less. */
void fap_fba_balance(fap_encoder *e, int count, int intra, int round);
/* Bits of a trial's I plane, and of what its P planes take more at first than later. */
int64_t fap_fba_start_bits(const fap_encoder *e, int count);
/* Bits that the frames may take by the mean rate. */
int64_t fap_fba_allowance(const fap_encoder *e, int count, int intra);
/*
 * Takes back changes of a P plane that are worth least for their bits: more of them the larger @p strength is, all
 * of them at -1. 0: nothing changed.
 */
int fap_fba_thin(fap_encoder *e, const fap_frame *want, const fba_coded_list *list, int32_t *level,
                 int strength);

#endif
