/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * What can go wrong. A code says what; the handle's fap_*_last_error() says where.
 */
#ifndef FAP_ERROR_H
#define FAP_ERROR_H

#include <fap/api.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Every error: name, value, text. Values are never renumbered. */
#define FAP_ERRORS(X)                                                                                        \
    X(FAP_OK, 0, "success")                                                                                  \
    X(FAP_E_AGAIN, -1, "call the other half of send/receive first")                                          \
    X(FAP_E_END, -2, "end of the data")                                                                      \
    X(FAP_E_ARG, -3, "invalid argument")                                                                     \
    X(FAP_E_NOMEM, -4, "out of memory")                                                                      \
    X(FAP_E_BITSTREAM, -5, "bitstream breaks the standard")                                                  \
    X(FAP_E_SYNTAX, -6, "text breaks the file format")                                                       \
    X(FAP_E_DATA, -7, "data is damaged or inconsistent")                                                     \
    X(FAP_E_LIMIT, -8, "data exceeds a safety limit")                                                        \
    X(FAP_E_UNSUPPORTED, -9, "valid, but not supported")                                                     \
    X(FAP_E_IO, -10, "reading or writing failed")                                                            \
    X(FAP_E_NOT_FOUND, -11, "not found")                                                                     \
    X(FAP_E_UNKNOWN_FORMAT, -12, "format not recognised")

typedef enum fap_err {
#define X(name, value, text) name = value,
    FAP_ERRORS(X)
#undef X
} fap_err;

/** One line for people. Never NULL, also for codes of a newer library; static. */
FAP_API const char *fap_strerror(fap_err err);

/** Room for "where": a place and a reason, always terminated. */
#define FAP_ERROR_TEXT_SIZE 256

#ifdef __cplusplus
}
#endif
#endif
