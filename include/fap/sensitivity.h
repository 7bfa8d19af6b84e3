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
    /** Nanometres for one unit of the FAP; for FAPs 1 and 2 for one step of 63 of a strength, of the viseme or
     * expression that moves most. */
    uint32_t nm[FAP_COUNT + 1];
} fap_sensitivity;

/** Of a bank: its FAPU, its eyes, its head, its visemes and expressions. */
FAP_API void fap_sensitivity_of_bank(const fap_bank *bank, fap_sensitivity *out);
/** Of a face 190 mm high, for want of a better one. */
FAP_API void fap_sensitivity_typical(fap_sensitivity *out);

#ifdef __cplusplus
}
#endif
#endif
