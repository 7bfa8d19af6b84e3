/* SPDX-License-Identifier: BSD-2-Clause */
/* Deflated bytes, as zip and gzip carry them. inflate.c is the one file that knows zlib. */
#ifndef LIB_SHAPE_INFLATE_H
#define LIB_SHAPE_INFLATE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

/* Raw deflate of exactly @p out_size bytes. FAP_E_DATA where it is not that; FAP_E_UNSUPPORTED without zlib.
 */
fap_err fap_inflate(const uint8_t *data, size_t size, uint8_t *out, size_t out_size);

/* A whole .gz of at most @p max bytes unpacked, into malloc'ed memory with one NUL behind. */
fap_err fap_gunzip(const uint8_t *data, size_t size, size_t max, uint8_t **out, size_t *out_size);

#endif
