/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * FAPs that were not sent, derived from those that were: what an interpolation table gives, the other lip
 * contour, the other side of the face.
 * Source: ISO/IEC 14496-2, FAP interpolation; fap_tables/pairs.csv.
 */
#ifndef FAP_DERIVE_H
#define FAP_DERIVE_H

#include <fap/fit.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Fill absent FAPs: first the other lip contour, then the other side of the face. Filled ones get FAP_DERIVED.
 * FAPs that are coded, held or already derived keep their value. Idempotent.
 */
FAP_API void fap_derive(fap_frame *frame);
/** The same, with what the table @p fit gives before all else. NULL: fap_derive(). */
FAP_API void fap_derive_with(const fap_fit *fit, fap_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
