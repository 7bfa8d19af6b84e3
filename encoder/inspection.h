/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What an .fba is made of, counted plane by plane while it is decoded: where the bits go, by plane type and by FAP, and
 * what I planes set. Counting only; inspect_text.c and inspect_json.c tell it.
 */
#ifndef ENCODER_INSPECTION_H
#define ENCODER_INSPECTION_H

#include <stddef.h>
#include <stdint.h>

#include "common/streams.h"

enum {
    INSPECT_QUANTS = 32,
    INSPECT_MASK_TYPES = 4,
    INSPECT_MAX_CHANGES = 8, /* of one group's mask that are kept */
    INSPECT_MAX_BROKEN = 16, /* broken planes whose reason is kept */
    INSPECT_WINDOW = 1024,   /* planes of two seconds: 512 at the highest rate there is */
};

/* Planes of one type. The parts add up to the bits. */
typedef struct plane_kind {
    uint64_t planes, bits, largest, start_codes;
    uint64_t header, setup, ranges, faps, runs, body;
} plane_kind;

/* The mask of a group as an I plane set it: the first, and each that differs from the one before. */
typedef struct mask_change {
    int64_t plane, frame; /* counted from 0 */
    int type, coded;      /* fap_mask_type; FAPs that are sent */
} mask_change;

typedef struct group_masks {
    uint64_t of_type[INSPECT_MASK_TYPES]; /* I planes */
    uint64_t changes;                     /* the first is none */
    int kept;
    mask_change change[INSPECT_MAX_CHANGES];
    int type;            /* of the last mask */
    uint32_t coded_bits; /* its FAPs */
} group_masks;

/* Symbol ranges that I planes set, in levels: the widest; narrower ones were in force too where they vary. */
typedef struct fap_ranges {
    int known, vary;
    int16_t i_min, i_max, p_min, p_max;
} fap_ranges;

/* One plane, for --planes. */
typedef struct plane_record {
    fap_plane_info info;
    int64_t frame, pts_us;
    uint32_t fap_bits;
    int coded; /* FAPs that it carries */
} plane_record;

typedef struct broken_plane {
    char why[FAP_ERROR_TEXT_SIZE];
} broken_plane;

typedef struct inspection {
    plane_kind kind[2]; /* P, I */
    uint64_t with_face, with_body;
    uint64_t quant_i[INSPECT_QUANTS], quant_all[INSPECT_QUANTS]; /* I planes, all planes */
    uint64_t male, female;                                       /* I planes that suggest it */
    group_masks group[FAP_GROUPS + 1];
    fap_ranges ranges[FAP_COUNT + 1];
    uint64_t fap_bits[2][FAP_COUNT + 1]; /* of P, of I planes */
    uint64_t derived[FAP_COUNT + 1];     /* frames in which the decoder found it */
    uint64_t largest_window_bits;        /* of two seconds; stuffing is of the plane in front of it */
    int broken_kept;
    broken_plane broken[INSPECT_MAX_BROKEN];
    plane_record *plane; /* when asked for */
    size_t plane_count, plane_room;
    int keep_planes, out_of_memory;
    /* two seconds of planes behind the newest, a ring */
    struct {
        int64_t pts_us;
        uint64_t bits;
    } window[INSPECT_WINDOW];
    uint64_t first, last, window_bits; /* last is behind the newest */
    int64_t plane_at;                  /* bit of the newest plane */
    const uint8_t *data;               /* the stream, kept by the caller */
    size_t size;
} inspection;

/* Whom stream_read() calls. @p in is zeroed but for keep_planes, data and size. */
frame_sink inspection_sink(inspection *in);
/* The stream is over: what lies behind its last plane counts as the last plane's. */
void inspection_end(inspection *in);
void inspection_free(inspection *in);

#endif
