/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Face data of a plane: what it sets and what values it carries. The caller reads into a copy and keeps it
 * when all went well.
 */
#ifndef LIB_CODEC_FBA_FACE_H
#define LIB_CODEC_FBA_FACE_H

#include <fap/error.h>
#include <fap/fit.h>

#include "codec/fba.h"
#include "codec/models.h"

/* What every plane changes. */
typedef struct fba_motion {
    int32_t value[FBA_PARAMS];
    uint8_t viseme_def, init_face, expression_def;
    uint16_t fap_bits[FAP_COUNT + 1]; /* what each took in the last plane */
} fba_motion;

typedef struct fba_face {
    int has_ranges; /* the defaults were installed */
    int swapped;    /* intensity1 stands in the place of select2 and the other way round */
    fba_setup setup;
    fba_coded_list list; /* of setup */
    fba_motion motion;
} fba_face;

/* Where it reads and what it needs; what went wrong, and where. */
typedef struct fba_face_reader {
    fap_bits *bits;
    model *model; /* [FBA_PARAMS], of P planes */
    model_pool *pool;
    int default_bound;
    uint64_t ranges_at; /* of the last I plane: where new range tables begin ... */
    uint64_t params_at; /* ... and where they end */
    uint64_t at;
    const char *what, *why;
} fba_face_reader;

/*
 * An I plane sets up the face, any plane moves it. FAP_OK; FAP_E_BITSTREAM, FAP_E_UNSUPPORTED or FAP_E_LIMIT,
 * and the reader says why.
 */
fap_err fap_fba_face_set_up(fba_face_reader *r, fba_face *face);
fap_err fap_fba_face_move(fba_face_reader *r, const fba_coded_list *list, fba_motion *motion, int intra);
/*
 * What the expression slots of a plane say about their order. 1: swapped; as they stand the second intensity is that of
 * nothing, and swapped it has an expression. 0: nothing. -1: not swapped; the first intensity can be no selection.
 */
int fap_fba_swap_evidence(const fba_motion *m);
/* The face in a frame: coded FAPs, and those that the stream leaves to the decoder, by @p fit (or NULL) first.
 * Others stay as they are. */
void fap_fba_face_show(const fba_face *face, const fap_fit *fit, fap_frame *frame);

#endif
