/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Files out of a zip in memory (a Python wheel is one). Stored and deflated entries; no zip64, no encryption.
 * Source: PKWARE APPNOTE 6.3, end of central directory, central and local headers.
 */
#ifndef LIB_SHAPE_ZIP_H
#define LIB_SHAPE_ZIP_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

typedef struct fap_zip {
    const uint8_t *data; /* not copied */
    size_t size, directory;
    uint32_t count;
} fap_zip;

/* FAP_E_UNKNOWN_FORMAT: no zip. */
fap_err fap_zip_open(fap_zip *zip, const void *data, size_t size);

/* The entry called @p name into malloc'ed memory, one NUL behind it; at most @p max bytes. Its CRC is
 * checked. */
fap_err fap_zip_extract(const fap_zip *zip, const char *name, size_t max, uint8_t **out, size_t *out_size);

#endif
