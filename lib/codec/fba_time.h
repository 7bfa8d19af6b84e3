/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Media time of an FBA stream, in integers: frame rate, time code, skipped frames.
 * Source: ISO/IEC 14496-2, face object plane header.
 */
#ifndef LIB_CODEC_FBA_TIME_H
#define LIB_CODEC_FBA_TIME_H

#include <stdint.h>

/* What a plane header says about time. */
typedef struct fba_time_fields {
    int is_frame_rate, is_time_code;
    uint32_t rate_16; /* frames in 16 seconds */
    int offset;       /* frequency_offset: times 1000/1001 */
    uint32_t time_code_s, skipped;
} fba_time_fields;

/* Frames are counted from where the rate last changed, so that rounding does not add up. */
typedef struct fba_time {
    uint32_t rate_16;
    int offset, started;
    int64_t number; /* of the last frame */
    int64_t base_us, since_base;
    int64_t epoch_us; /* time code minus media time */
    int has_epoch;
} fba_time;

/* What fap_fba_time_advance() could not believe. */
enum { FBA_TIME_RATE_0 = 1, FBA_TIME_BACK = 2 };

void fap_fba_time_init(fba_time *t);
/* To the frame of the next plane; @p frames: how many the plane before it held. Returns FBA_TIME_ flags. */
unsigned fap_fba_time_advance(fba_time *t, const fba_time_fields *f, int frames);
int64_t fap_fba_time_us(const fba_time *t);
double fap_fba_rate_hz(uint32_t rate_16, int offset);
/* How long @p frames last. */
int64_t fap_fba_frames_us(uint32_t rate_16, int offset, int64_t frames);

#endif
