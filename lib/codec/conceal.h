/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A face while its units are lost: it goes on as it moved, slows down, and when nothing comes eases to rest. Never a step
 * larger than the largest the stream itself made. In integers. Not part of the standard, which leaves losses to decoders.
 */
#ifndef LIB_CODEC_CONCEAL_H
#define LIB_CODEC_CONCEAL_H

#include <fap/frame.h>

typedef struct fba_conceal {
    int lost;                        /* frames concealed in a row */
    int started;                     /* a frame was seen */
    int64_t number;                  /* of the frame seen last */
    int32_t shown[FAP_COUNT + 1];    /* value shown last, seen or concealed */
    int32_t velocity[FAP_COUNT + 1]; /* units a frame, times 256 */
    int32_t most[FAP_COUNT + 1];     /* the largest step seen, units a frame */
    fap_viseme viseme;
    fap_expression expression;
} fba_conceal;

/* A frame that was decoded. */
void fap_conceal_see(fba_conceal *c, const fap_frame *f);
/* What to show in place of the frame behind the last: known FAPs of @p f become FAP_CONCEALED; @p rate_hz frames a second. */
void fap_conceal_show(fba_conceal *c, fap_frame *f, int rate_hz);

#endif
