/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Scans of one person's expressions and visemes, and the motions that lead there from the face at rest. Sources: Zhu 2006
 * section 4.7 (a databank of 11 expressions and 14 visemes from scans), Yano & Harada 2009 section 4.1 (ICP, stencil mask,
 * Laplacian smoothing). Part of libfap-studio; docs/shape.md.
 */
#ifndef FAP_STUDIO_EXPRESSION_H
#define FAP_STUDIO_EXPRESSION_H

#include <fap/bank.h>
#include <fap/studio/registration.h>
#include <fap/studio/surface.h>
#include <fap/studio/take.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the head of one scan is brought over that of another. */
typedef enum fap_head_alignment {
    FAP_ALIGN_ICP,         /**< six pairs, then iterative closest points, the farthest left out: Yano 4.1 */
    FAP_ALIGN_ORIENTATION, /**< three turns by eyes and nose: Zhu 4.7 */
    FAP_ALIGN_COUNT
} fap_head_alignment;

/** Start from fap_expression_config_init(). */
typedef struct fap_expression_config {
    size_t struct_size;
    fap_registration_config fit; /**< how the scan is laid; size and unit are those of the scan at rest */
    fap_head_alignment alignment;
    double keep;         /**< share of the nearest points that ICP believes, 0 to 1; 0.7 */
    double mask_mm;      /**< radius of the stencil mask's spheres; 20 */
    int masked;          /**< 1: the upper face keeps still, as for visemes; 0 */
    double smooth_share; /**< a step's share of the neighbours' mean, 0 to 1; 0.1 */
    int smooth_steps;    /**< -1: 30 with method yano, 3 else; -1 */
} fap_expression_config;
FAP_API void fap_expression_config_init(fap_expression_config *cfg);

typedef struct fap_expression_report {
    fap_registration_report fit; /**< of the laid face; lengths in millimetres */
    uint32_t pairs;              /**< of the six that were there to begin with; 0: all landmarks together */
    uint32_t anchored;           /**< landmarks that the scan at rest has too */
    uint32_t icp_rounds;
    double icp_before_mm,
        icp_after_mm;  /**< rms of what ICP believed, before its first and after its last round */
    uint32_t masked;   /**< vertices under the stencil mask */
    double head[3][4]; /**< the scan in head axes and millimetres: head * (x, y, z, 1) */
    double moves_mm;   /**< farthest any vertex goes */
} fap_expression_report;

/** A person at rest: what every expression starts from. All borrowed. */
typedef struct fap_person {
    const fap_bank *bank;         /**< whose structure the face has */
    const fap_registration *rest; /**< its neutral face, laid onto the scan at rest */
    const fap_take *landmarks;    /**< on that scan */
} fap_person;

/**
 * The motion from a person's face at rest to what was scanned. A landmark draws the place that the same landmark had on the
 * scan at rest, wherever the bank's face has its point. Upper teeth and eyeballs keep still; lower teeth and tongue go with the
 * jaw, lashes with the lids.
 * @param motion     [vertex_count of the bank's mesh] millimetres, head axes
 * @param scan       of the expression; its own pose, the unit of the scan at rest
 * @param landmarks  on it, from fap_landmarks_read()
 * @param cfg        NULL: defaults
 * @param report     may be NULL
 * @return FAP_OK; FAP_E_NOT_FOUND too few landmarks; FAP_E_DATA the scan is not where they are; as fap_register() otherwise.
 *         @p where (may be NULL, FAP_ERROR_TEXT_SIZE bytes) says what to do.
 */
FAP_API FAP_NODISCARD fap_err fap_expression_lay(float (*motion)[3], const fap_person *person,
                                                 const fap_surface *scan, const fap_take *landmarks,
                                                 const fap_expression_config *cfg,
                                                 fap_expression_report *report, char *where);

/**
 * Turn a face so that it looks as another of its structure does: about x by the line of the nose's ridge, about y and z by the
 * line of the eyes, then move the middle of the eyes there (Zhu 2006 section 4.7, the three steps).
 * @param position  [vertex_count] changed in place
 * @param like      [vertex_count]
 * @return FAP_OK; FAP_E_DATA the bank lacks the corners of the eyes or the ridge of the nose (9.12, 9.3)
 */
FAP_API FAP_NODISCARD fap_err fap_face_orient(float (*position)[3], const fap_bank *bank,
                                              const float (*like)[3]);

/**
 * What no scan shows of a motion: lower teeth and tongue go as chin and jaw line do where those move as a body, lashes as the
 * skin they stand on; eyeballs and upper teeth keep still.
 * @param rest    [vertex_count] the face the motion starts from
 * @param motion  [vertex_count] of the skin; the rest is written
 * @return FAP_OK, FAP_E_NOMEM, FAP_E_UNSUPPORTED a build without Embree
 */
FAP_API FAP_NODISCARD fap_err fap_motion_carry(const fap_bank *bank, const float (*rest)[3],
                                               float (*motion)[3]);

#ifdef __cplusplus
}
#endif
#endif
