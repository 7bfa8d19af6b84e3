/* SPDX-License-Identifier: BSD-2-Clause */
/* Grey pictures laid over a mesh by its texture coordinates. mask.c is the one file that knows libjpeg. */
#ifndef DATABANK_MASK_H
#define DATABANK_MASK_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

typedef struct mask {
    uint32_t width, height;
    uint8_t *grey;
} mask;

/* FAP_E_DATA: no JPEG; FAP_E_LIMIT: over 8192 pixels a side; FAP_E_UNSUPPORTED: built without libjpeg. */
fap_err mask_decode(mask *m, const uint8_t *data, size_t size);
void mask_free(mask *m);
/* 0 to 1, bilinear; v upwards as in OBJ. An empty mask is 0 everywhere. */
float mask_sample(const mask *m, float u, float v);

#endif
