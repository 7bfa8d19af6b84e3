/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * What feature points can tell about a bank: how many ways of moving they see, how well, and which key models look alike
 * to them. A solver can do no better than its points; this says so before anyone blames the solver. Part of
 * libfap-studio.
 */
#ifndef FAP_STUDIO_BANK_OBSERVE_H
#define FAP_STUDIO_BANK_OBSERVE_H

#include <fap/bank.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Two key models that the points can hardly tell apart, by bank index. */
typedef struct fap_alike {
    int key[2];
    float cosine; /**< of what they do to the seen axes, 1: the same up to strength, -1: opposites */
} fap_alike;

typedef struct fap_observation {
    int key_count; /**< keys looked at */
    int row_count; /**< point axes seen that at least one of them moves */
    int rank;      /**< independent ways of moving that the points see */
    double
        condition; /**< largest over smallest of their strengths (singular values), at least 1; 0: rank 0 */
    int unseen_count; /**< keys that move no seen axis by more than 0.05 mm ... */
    int *unseen;      /**< ... their bank indices */
    int alike_count;  /**< pairs with |cosine| of at least 0.98 ... */
    fap_alike *alike; /**< ... the most alike first */
} fap_observation;

/**
 * @param kinds  bit k set: keys of ::fap_key_kind k are looked at, 512 at most
 * @param seen   point axes that are known; NULL: all three of every point the face has
 * @return FAP_OK; FAP_E_ARG; FAP_E_LIMIT; FAP_E_NOMEM. *out is NULL unless FAP_OK; fap_bank_observe_free() it.
 */
FAP_API FAP_NODISCARD fap_err fap_bank_observe(fap_observation **out, const fap_bank *bank, unsigned kinds,
                                               const uint8_t seen[FAP_POINT_COUNT][3]);
/** Sets @p *o to NULL; accepts NULL. */
FAP_API void fap_bank_observe_free(fap_observation **o);

#ifdef __cplusplus
}
#endif
#endif
