/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * What a FAP unit means on a face, in integers: how far it moves the feature point that it moves most. An encoder
 * weighs errors by it, and errors of whole frames are measured with it.
 */
#ifndef FAP_SENSITIVITY_H
#define FAP_SENSITIVITY_H

#include <fap/bank.h>
#include <fap/fapu.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_sensitivity {
    /** Nanometres for one unit of the FAP, to the nearest; for FAPs 1 and 2 for one step of 63 of a strength, of
     * the viseme or expression that moves most. Translations: the FAPU's share. Eyeballs: the arc at the front
     * of the eye. Pupils: half of the diameter's growth. Tongue curl: the arc of the tongue's border. Head: the
     * arc of the feature point farthest from the axis. */
    uint32_t nm[FAP_COUNT + 1];
} fap_sensitivity;

/** Of a bank: its FAPU, its eyes, its head, its visemes and expressions. */
FAP_API void fap_sensitivity_of_bank(const fap_bank *bank, fap_sensitivity *out);
/** Of a face 190 mm high, for want of a better one. */
FAP_API void fap_sensitivity_typical(fap_sensitivity *out);

/** How far a frame is from another, in nanometres. */
typedef struct fap_frame_error {
    int items;        /**< places that the wanted frame commands */
    uint64_t sum_nm;  /**< of the distances at all of them */
    uint32_t mean_nm; /**< sum over items, to the nearest; 0 without items */
    uint32_t max_nm;  /**< the largest */
    int max_fap;      /**< a FAP of the place where it is, 0: nowhere */
} fap_frame_error;

/**
 * Compare @p got with @p want at every place that @p want commands (state other than FAP_ABSENT): each feature
 * point (the axes commanded there taken together), each eyeball, each pupil, the head (its three angles taken
 * together), the viseme, the expression. FAPs that @p got lacks count as 0. Two mixes of visemes are as far apart
 * as if all of what is more in one and all of what is more in the other moved the same point apart: an upper bound.
 */
FAP_API void fap_sensitivity_compare(const fap_sensitivity *s, const fap_frame *want, const fap_frame *got,
                                     fap_frame_error *out);
/** mean_nm of it. */
FAP_API uint32_t fap_sensitivity_error_nm(const fap_sensitivity *s, const fap_frame *want,
                                          const fap_frame *got);

#ifdef __cplusplus
}
#endif
#endif
