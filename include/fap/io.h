/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Bytes in and out through callbacks. libfap opens no files: a file is one way to have bytes.
 */
#ifndef FAP_IO_H
#define FAP_IO_H

#include <stddef.h>

/**
 * A source of bytes. @c read stores up to @p size bytes and returns how many: 0 at the end, (size_t)-1 when
 * reading failed. It may return fewer than asked for.
 */
typedef struct fap_reader {
    size_t (*read)(void *user, void *buf, size_t size);
    void *user;
} fap_reader;

/** A sink of bytes. @c write takes all @p size bytes and returns 0, or returns non-zero when writing failed. */
typedef struct fap_writer {
    int (*write)(void *user, const void *data, size_t size);
    void *user;
} fap_writer;

#endif
