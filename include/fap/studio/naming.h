/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Names for what a face does: FAP 1 (visemes) and FAP 2 (expressions) found in frames that carry low-level FAPs. The weights of
 * a bank's key models that come nearest, over a whole take at once, so that they do not jitter. Part of libfap-studio.
 */
#ifndef FAP_STUDIO_NAMING_H
#define FAP_STUDIO_NAMING_H

#include <fap/bank.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Start from fap_naming_config_init(). */
typedef struct fap_naming_config {
    size_t struct_size;
    int visemes, expressions; /**< which to find; 1, 1 */
    double rate_hz;           /**< of the frames; 25 */
    double steady_s;          /**< changes faster than this are rather noise; 0.04 */
    const fap_bank *bank;     /**< whose key models are meant; NULL: the built-in face's. Only for the call */
    fap_allocator alloc;
} fap_naming_config;
FAP_API void fap_naming_config_init(fap_naming_config *cfg);

/** What was found. */
typedef struct fap_naming_report {
    uint32_t frames; /**< that got a name that is not "none" */
    double left;     /**< RMS of what the names do not explain over RMS of all, 0 to 1 */
    uint32_t viseme_frames[FAP_VISEME_COUNT + 1]; /**< in which each is the stronger one; [0] none */
    uint32_t expression_frames[FAP_EXPRESSION_COUNT + 1];
} fap_naming_report;

/**
 * Sets FAP 1 and FAP 2 of every frame, as @p cfg asks; all else stays. Frames in order of time.
 * @param cfg     NULL: defaults
 * @param report  may be NULL
 * @return FAP_OK; FAP_E_NOT_FOUND the bank has no such key models; FAP_E_NOMEM, and nothing has changed
 */
FAP_API FAP_NODISCARD fap_err fap_name_frames(fap_frame *frame, size_t count, const fap_naming_config *cfg,
                                              fap_naming_report *report);

#ifdef __cplusplus
}
#endif
#endif
