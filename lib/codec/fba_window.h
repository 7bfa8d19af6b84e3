/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The bits of any 2 seconds of media time. Windows are half open and slide by frames: as many frames in a row as
 * can begin within 2 seconds.
 */
#ifndef LIB_CODEC_FBA_WINDOW_H
#define LIB_CODEC_FBA_WINDOW_H

#include <stdint.h>

enum { WINDOW_MAX = 512 }; /* frames: 2 s at 255.9375 Hz */

typedef struct fba_window {
    int frames;     /* of a window */
    int64_t limit;  /* bits of a window; INT64_MAX: none */
    int64_t newest; /* frame number */
    int64_t sum, largest;
    uint32_t bits[WINDOW_MAX]; /* by frame number modulo frames */
} fba_window;

void fap_fba_window_init(fba_window *w, uint32_t rate_16, int offset, int64_t limit);
/* Bits of frame @p number, which is not before the newest. */
void fap_fba_window_add(fba_window *w, int64_t number, uint32_t bits);
/* Bits of the windows's last frames that are still in a window that ends with frame @p number. */
int64_t fap_fba_window_used(const fba_window *w, int64_t number);
/* Bits of frame @p number, 0 for one that is too old. */
uint32_t fap_fba_window_at(const fba_window *w, int64_t number);

#endif
