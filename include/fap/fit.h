/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The FAP interpolation table (FIT): rational polynomials by which a decoder finds FAPs that were not sent from
 * those that were. Given as a text file, as the fields of the FIT node, or learnt from frames.
 * Source: ISO/IEC 14496-1, FIT node; ISO/IEC 14496-2, FAP interpolation. docs/fit.md describes the text.
 */
#ifndef FAP_FIT_H
#define FAP_FIT_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/frame.h>
#include <fap/io.h>
#include <fap/sensitivity.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A table. Never changes once made: any number of decoders and threads may share it. One block of memory. */
typedef struct fap_fit fap_fit;

/** Limits of a table; what exceeds one is refused with FAP_E_LIMIT. */
#define FAP_FIT_MAX_EDGES    256
#define FAP_FIT_MAX_FORMULAS 1024
#define FAP_FIT_MAX_TERMS    4096 /**< of all formulas */
#define FAP_FIT_MAX_FACTORS  16384
#define FAP_FIT_MAX_EXPONENT 16
#define FAP_FIT_MAX_TEXT     ((size_t)1 << 20) /**< bytes */

/**
 * The text of docs/fit.md: edges, each a set of FAPs to interpolate from, with a formula a FAP.
 *
 * @param where  FAP_ERROR_TEXT_SIZE bytes for line, column and what was expected; NULL: not wanted
 * @return FAP_OK; FAP_E_SYNTAX; FAP_E_LIMIT; FAP_E_NOMEM; FAP_E_ARG. *fit is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_fit_parse(fap_fit **fit, const char *text, size_t size,
                                            const fap_allocator *alloc, char *where);

/**
 * The fields of a FIT node, as a client of MPEG-4 Systems holds them. The node belongs to the caller and is read
 * by fap_fit_open() only.
 *
 * UNVERIFIED, from memory: sets are counted from 0; numbers behind 68 are the parts of FAPs 1 and 2, in the
 * order of fap_viseme and fap_expression: 69 viseme_select1, 70 viseme_select2, 71 viseme_blend, 72
 * expression_select1, 73 expression_intensity1, 74 expression_select2, 75 expression_intensity2; impulses are
 * there for edges only whose sources have such a part, a pair for each numerator term, and a pair that begins
 * with 0 is none.
 */
typedef struct fap_fit_node {
    const int32_t *faps; /**< sets of FAPs, a -1 behind each */
    size_t faps_count;
    const int32_t *graph; /**< pairs: the set that gives, the set that is given; most wanted first */
    size_t graph_count;
    /** Below "formula" is each FAP of the second set of each edge, in that order. */
    const int32_t *numerator_exp; /**< for each formula, each term, each FAP of the first set: its exponent */
    size_t numerator_exp_count;
    const int32_t *denominator_exp;
    size_t denominator_exp_count;
    const int32_t *numerator_impulse; /**< pairs: a source and the value it must have for the term to count */
    size_t numerator_impulse_count;
    const int32_t *numerator_terms; /**< for each formula; 0 terms: the value is 0 */
    size_t numerator_terms_count;
    const int32_t *denominator_terms; /**< for each formula; 0 terms: a polynomial */
    size_t denominator_terms_count;
    const float *numerator_coefs; /**< for each formula, each term */
    size_t numerator_coefs_count;
    const float *denominator_coefs;
    size_t denominator_coefs_count;
} fap_fit_node;

/**
 * A table of a node. Coefficients are kept in the fewest decimal digits that give the same float.
 *
 * @param where  as for fap_fit_parse(): the field and what is wrong with it
 * @return FAP_OK
 *         FAP_E_DATA         fields that contradict each other, or a number out of its range
 *         FAP_E_UNSUPPORTED  FAPs 1 and 2 as a whole, or a part of them to be given
 *         FAP_E_LIMIT; FAP_E_NOMEM; FAP_E_ARG
 * *fit is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_fit_open(fap_fit **fit, const fap_fit_node *node,
                                           const fap_allocator *alloc, char *where);

/**
 * The fields of a FIT node that says the same, for a sender. One block of memory. Coefficients become floats.
 * @return FAP_OK; FAP_E_NOMEM; FAP_E_ARG; FAP_E_UNSUPPORTED a condition on a FAP in an edge without viseme and
 *         expression parts, which a node cannot say. *node is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_fit_to_node(const fap_fit *fit, fap_fit_node **node,
                                              const fap_allocator *alloc);
/** Sets @p *node, of fap_fit_to_node(), to NULL; accepts NULL. */
FAP_API void fap_fit_node_close(fap_fit_node **node);

/** Writes the text; what it writes parses into an equal table. @return FAP_OK; FAP_E_IO; FAP_E_ARG */
FAP_API FAP_NODISCARD fap_err fap_fit_write(const fap_fit *fit, const fap_writer *out);
/** 1: an edge of the table ends at @p fap. */
FAP_API int fap_fit_gives(const fap_fit *fit, int fap);
/**
 * Give a value to FAPs of state FAP_ABSENT for which an edge exists whose sources are all known. They become
 * FAP_DERIVED and serve as sources themselves. The edges are gone through in order, and again as long as that
 * gives a FAP; no formula is computed twice, so a cycle ends. Idempotent; allocates nothing; NULL does nothing.
 *
 * Doubles, + - * / alone, terms in the order of the text, the factors of a term in that of their numbers: the same
 * on every machine with IEEE arithmetic. The value is rounded, halves away from zero, and kept within +-2^30. A
 * formula has no value, and the FAP is left to the next edge, where the denominator is within +-1e-9 or either sum
 * is not finite.
 */
FAP_API void fap_fit_apply(const fap_fit *fit, fap_frame *frame);
/** What fap_fit_learn() looks for; start from fap_fit_learn_config_init(). */
typedef struct fap_fit_learn_config {
    size_t struct_size; /**< sizeof of this struct, set by init */
    /** 200000; nanometres by which a FAP that is left out may miss, by @c sensitivity. FAPs that move nothing may
     * miss by their quantiser step. */
    uint32_t error_nm;
    const fap_sensitivity *sensitivity; /**< NULL: a typical face */
    /** NULL; otherwise FAP_COUNT + 1 numbers: by how many of its own units each FAP may miss. The two above then
     * mean nothing. */
    const uint32_t *error;
    int exceptions; /**< 0; in how many of 1000 frames it may miss by more, 0 to 1000 */
    int quant; /**< 1; sources are taken as this fap_quant makes them, 0 (exact) to 31: formulas that would blow up
                    their rounding are not found */
    int terms; /**< 4; of a formula at most, 1 to 8 */
    fap_allocator alloc;
} fap_fit_learn_config;

/** Sets every default. */
FAP_API void fap_fit_learn_config_init(fap_fit_learn_config *cfg);

/**
 * Find FAPs that a take need not carry, since few of those that it goes on carrying give them: an empty table when
 * there are none. Formulas are polynomials of degree 1 or 2 without mixed terms, found by least squares and pushed
 * towards the smallest largest error; coefficients have as few digits as that allows. No FAP is both given and a
 * source. Only FAPs known in every frame take part, FAPs 1 and 2 do not; a term needs eight frames to stand on.
 *
 * @param frames  the take; FAPs of any state but FAP_ABSENT count
 * @param cfg     NULL: defaults
 * @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM. *fit is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_fit_learn(fap_fit **fit, const fap_frame *frames, size_t count,
                                            const fap_fit_learn_config *cfg);

/** Sets @p *fit to NULL; accepts NULL. */
FAP_API void fap_fit_close(fap_fit **fit);

#ifdef __cplusplus
}
#endif
#endif
