/* SPDX-License-Identifier: BSD-2-Clause */
/* A growing byte string, little-endian. A failed allocation is remembered and checked once at the end. */
#ifndef LIB_SHAPE_BYTES_H
#define LIB_SHAPE_BYTES_H

#include <stddef.h>
#include <stdint.h>

typedef struct fap_bytes {
    uint8_t *data;
    size_t size, room;
    int failed;
} fap_bytes;

void fap_bytes_put(fap_bytes *b, const void *data, size_t size);
void fap_bytes_8(fap_bytes *b, uint8_t value);
void fap_bytes_16(fap_bytes *b, uint16_t value);
void fap_bytes_32(fap_bytes *b, uint32_t value);
void fap_bytes_float(fap_bytes *b, float value);
void fap_bytes_free(fap_bytes *b);

#endif
