/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The FAP interpolation table (FIT): rational polynomials by which a decoder finds FAPs that were not sent from
 * those that were. Given as a text file, as the fields of the FIT node, or learnt from frames.
 * Source: ISO/IEC 14496-1, FIT node; ISO/IEC 14496-2, FAP interpolation. docs/codec.md describes the text.
 */
#ifndef FAP_FIT_H
#define FAP_FIT_H

#include <stddef.h>

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/frame.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A table. Never changes once made: any number of decoders and threads may share it. */
typedef struct fap_fit fap_fit;

/** @param where  FAP_ERROR_TEXT_SIZE bytes for line, column and what was expected; NULL: not wanted
 *  @return FAP_OK; FAP_E_SYNTAX; FAP_E_LIMIT; FAP_E_NOMEM; FAP_E_ARG. *fit is NULL unless FAP_OK. */
FAP_API FAP_NODISCARD fap_err fap_fit_parse(fap_fit **fit, const char *text, size_t size,
                                            const fap_allocator *alloc, char *where);
/** Writes the text; what it writes parses into an equal table. @return FAP_OK; FAP_E_IO */
FAP_API FAP_NODISCARD fap_err fap_fit_write(const fap_fit *fit, const fap_writer *out);
/** 1: an edge of the table ends at @p fap. */
FAP_API int fap_fit_gives(const fap_fit *fit, int fap);
/**
 * Give a value to FAPs of state FAP_ABSENT for which an edge exists whose sources are all known, in the order of
 * the graph. They become FAP_DERIVED and serve as sources themselves. Idempotent.
 */
FAP_API void fap_fit_apply(const fap_fit *fit, fap_frame *frame);
/** Sets @p *fit to NULL; accepts NULL. */
FAP_API void fap_fit_close(fap_fit **fit);

#ifdef __cplusplus
}
#endif
#endif
