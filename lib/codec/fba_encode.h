/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The inside of the FBA encoder. Frames wait in a queue (fba_encode.c); a run of them is planned: masks, ranges,
 * a quantiser, and for each frame the place of every parameter on the quantiser's lattice (fba_plan.c;
 * fba_search.c and fba_trellis.c where bits are weighed against errors; fba_leave.c for what the decoder can
 * derive); planes are written in a closed loop (fba_put.c) from what fba_write.c knows of the syntax.
 */
#ifndef LIB_CODEC_FBA_ENCODE_H
#define LIB_CODEC_FBA_ENCODE_H

#include <fap/encoder.h>

#include "codec/fba_face.h"
#include "codec/fba_window.h"
#include "codec/fba_write.h"

enum {
    ENCODER_INTRA_MAX = 10000,
    ENCODER_SKIP_MAX = 4096,
    ENCODER_END_BITS = 40,       /* stuffing and end code: room for them is always kept */
    ENCODER_VALUE_MAX = 1 << 30, /* what a decoder still adds up */
};

typedef struct fba_queued {
    fap_frame frame;
    int64_t number; /* in the stream, from 0 */
} fba_queued;

struct fba_search;

struct fap_encoder {
    fap_allocator alloc;
    fap_encoder_config cfg;
    fap_sensitivity sensitivity;
    uint32_t rate_16;
    int offset;
    int64_t number, first_pts_us, sent; /* of the last frame taken */
    int flushed, begun, ended, ready;

    fba_queued *queue; /* [capacity] frames waiting */
    int capacity, count;
    uint8_t set[FAP_COUNT + 1]; /* FAPs that the queue may hold without a new I plane */

    /* The plan for the first frames of the queue. */
    int32_t (*path)[FBA_PARAMS]; /* [capacity] lattice places */
    uint8_t *left_out;           /* [capacity] 1: the frame changes nothing and is not sent */
    fba_setup plan;              /* of an I plane */
    fba_coded_list plan_list;
    uint8_t plan_set[FAP_COUNT + 1];  /* FAPs that it stands for: coded, derived, or too dear to be sent */
    uint8_t plan_left[FAP_COUNT + 1]; /* those left to the decoder */
    struct fba_search *search;        /* NULL with FAP_ENCODE_QUANT */
    uint64_t max_error;               /* nm, FAP_ENCODE_ERROR */
    int64_t permitted[FAP_COUNT + 1]; /* units of each FAP, of the group */

    /* What the decoder has after the planes written so far. */
    fba_face face;
    fap_frame shown_now;
    int32_t at[FBA_PARAMS]; /* lattice places */
    model model[FBA_PARAMS];
    model_pool pool;
    model_node *node;
    int in_group;                     /* P planes may follow */
    int since_intra;                  /* frames of the group so far */
    int clipped_planes;               /* in a row, within the group */
    uint8_t group_set[FAP_COUNT + 1]; /* what the group carries, coded or derived */
    int64_t last_coded;               /* frame number, -1: none */
    uint32_t stuffing;                /* bits at the end of the last packet */
    int32_t wanted[FBA_PARAMS];       /* last values asked for; not with FAP_ENCODE_QUANT */
    fap_frame last_frame;             /* the last one that left the queue */
    int32_t peak[FBA_PARAMS];         /* largest change that was asked for, fading; FAPs 3..68 */

    fap_frame *shown; /* [capacity] the last packet, reconstructed */
    int shown_count;
    fba_window window;
    fap_encoder_stats stats;
    uint64_t error_sum_nm, error_items;
    uint32_t max_error_nm;
};

/* --- fba_plan.c --- */

/* The value that a frame asks for. */
int32_t fap_fba_wanted(const fap_frame *f, int param);
/* Nearest place on a lattice of @p step, halves away from zero. */
int32_t fap_fba_nearest(int64_t value, int32_t step);
/* Are all coded FAPs of @p f in @p set; with @p exactly, and no others? */
int fap_fba_in_set(const fap_frame *f, const uint8_t set[FAP_COUNT + 1], int exactly);
/* Plans what comes next. How many frames of the queue; *intra: they begin with an I plane. */
int fap_fba_plan(fap_encoder *e, int *intra);
/* A change of a value that was asked for. */
void fap_fba_note_change(fap_encoder *e, int param, int64_t change);
/* Masks of what is coded; ranges: of P planes that hold a path, of either kind that just hold two levels. */
void fap_fba_set_masks(fba_setup *s);
void fap_fba_fit_range(fap_encoder *e, int param, const int32_t *place, size_t stride, int count);
void fap_fba_set_range(fba_setup *s, int kind, int param, int32_t min, int32_t max);

/* Marks frames whose path changes nothing. */
void fap_fba_mark_unchanged(fap_encoder *e, const fba_coded_list *list, int count, int intra);

/* --- fba_leave.c --- */

/*
 * Leaves FAPs to the decoder for the whole of a group: e->plan is that of an I plane, path is complete, for all
 * FAPs coded so far. @p exactly: those that are shown within half a step, whatever the mode. 1: there were some.
 */
int fap_fba_leave_out(fap_encoder *e, int count, int exactly);

/* --- fba_put.c --- */

/* Writes @p count planned frames. How many were: fewer when no decoder need have memory for more. */
int fap_fba_put_frames(fap_encoder *e, fap_bit_writer *w, int count, int intra);
/* The last frame once more, where frames behind the last plane were left out. */
void fap_fba_put_repeat(fap_encoder *e, fap_bit_writer *w);

#endif
