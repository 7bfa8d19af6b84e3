/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The .fbank file, as docs/fbank.md describes it: what the loader and the writer must agree on. All
 * little-endian, so that on most machines a loaded file is used in place.
 */
#ifndef LIB_BANK_FORMAT_H
#define LIB_BANK_FORMAT_H

#include <stddef.h>
#include <stdint.h>

#define FBANK_MAGIC                                                                                          \
    "\211FBANK\r\n" /* 8 bytes; breaks visibly where a transfer changes line ends or drops the 8th bit */

enum {
    FBANK_MAJOR = 1, /* another one means another meaning; a minor one only adds chunks */
    FBANK_MINOR = 1,
    FBANK_HEAD_SIZE = 32,
    FBANK_ENTRY_SIZE = 16,
    FBANK_ALIGN = 32,
    FBANK_MAX_CHUNKS = 64,
    FBANK_POINT_SIZE = 24, /* PNTS record */
    FBANK_KEY_SIZE = 48,   /* KEYS record */
    FBANK_KEY_NAME = 32,   /* of it: the name, with a NUL */
    FBANK_MAX_KEYS = 4096,
    FBANK_REGION_HEAD = 32, /* REGN: borders, before the distances */
    FBANK_BASIS_HEAD = 16,  /* PCAC: counts, before the records */
    FBANK_BASIS_SIZE = 32,  /* PCAC record */
    FBANK_MAX_COMPONENTS = 128,
    FBANK_MAX_MODELS = 512,
};
#define FBANK_MAX_SIZE      (256u << 20)
#define FBANK_MAX_VERTICES  (65536u * 8) /* block numbers are 16 bits */
#define FBANK_MAX_TRIANGLES (4u << 20)

/* CRC-32 as in zip and PNG. */
uint32_t fbank_crc32(const uint8_t *data, size_t size);
/* The same over more bytes: @p before is that of those in front of them, 0 when there are none. */
uint32_t fbank_crc32_add(uint32_t before, const uint8_t *data, size_t size);

#endif
