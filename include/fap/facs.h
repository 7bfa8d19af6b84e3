/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The Facial Action Coding System beside ARKit's coefficients, MPEG-4's visemes and expressions: four ways to say what a
 * face does, and the tables between them. Source: fap_tables/facs.csv, facs_expressions.csv, key_models.csv; each says
 * where its rows come from. docs/coefficients.md has what the ways there and back lose.
 */
#ifndef FAP_FACS_H
#define FAP_FACS_H

#include <fap/arkit.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_FACS_MAX_NUMBER 64 /**< of an action unit that a face has; higher ones are heads and eyes */

/** Intensities by the unit's own number (AU12 is [12]), both sides; slots without a unit are unused. */
typedef struct fap_facs {
    float unit[FAP_FACS_MAX_NUMBER + 1]; /**< 0 to 1: 1 is FACS's intensity E, OpenFace's 5 */
} fap_facs;

/** "lip corner puller"; NULL: no unit of that number is known here. */
FAP_API const char *fap_facs_name(int unit);
/** What a shape becomes when @p unit is at 1, 0 to 1. */
FAP_API float fap_facs_share(int unit, int shape);
/** Units to coefficients: their weighted sum, at most 1. Angles are left as they are. */
FAP_API void fap_facs_to_arkit(const fap_facs *in, fap_arkit *out);
/** Coefficients to units: the least squares of that within 0 to 1, both sides together. */
FAP_API void fap_facs_from_arkit(const fap_arkit *in, fap_facs *out);

/** The coefficients that a viseme (1 to 14) stands for; all 0 for another number. Angles are left as they are. */
FAP_API void fap_viseme_to_arkit(int viseme, fap_arkit *out);
/** The same of an expression (1 to 6) at full intensity. */
FAP_API void fap_expression_to_arkit(int expression, fap_arkit *out);
/** Action units of an expression (1 to 6) at full intensity; all 0 for another number. */
FAP_API void fap_expression_to_facs(int expression, fap_facs *out);

/**
 * The viseme, or mix of two, that comes nearest to what coefficients do to mouth and tongue, in square millimetres.
 * @return what is left, as a share of what was there: 0 is exact, 1 says that no viseme helps
 */
FAP_API float fap_arkit_to_viseme(fap_arkit_fit *fit, const fap_arkit *in, fap_viseme *out);
/** The same for one or two expressions and the whole face. */
FAP_API float fap_arkit_to_expression(fap_arkit_fit *fit, const fap_arkit *in, fap_expression *out);

#ifdef __cplusplus
}
#endif
#endif
