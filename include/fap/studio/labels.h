/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The 172 labelled points of a generic face: 28 major ones that somebody places on a scan, and 144 minor ones that follow.
 * Source: Zhu 2006 sections 4.1 and 4.2. Part of libfap-studio.
 */
#ifndef FAP_STUDIO_LABELS_H
#define FAP_STUDIO_LABELS_H

#include <fap/bank.h>
#include <fap/studio/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_LABELS_MAJOR 28
#define FAP_LABELS       172

/** Labels of one bank's face; the major ones come first. */
typedef struct fap_labels {
    uint32_t count; /**< 172, or fewer on a face of few vertices */
    uint32_t vertex[FAP_LABELS];
    int16_t point[FAP_LABELS]; /**< the feature point it is, -1: none */
} fap_labels;

/** How a label's place was found. */
typedef enum fap_label_state {
    FAP_LABEL_UNKNOWN,
    FAP_LABEL_PLACED,  /**< somebody said so */
    FAP_LABEL_MET,     /**< it followed, and a ray met the scan there */
    FAP_LABEL_GUESSED, /**< it followed, where there is no scan */
} fap_label_state;

typedef struct fap_label_place {
    float at[3];   /**< unit and axes of the scan */
    uint8_t state; /**< a ::fap_label_state */
} fap_label_place;

/**
 * Choose the labels: 28 feature points as majors (corners and lids of the eyes, brows, nose, mouth, chin, jaw, ears, hair line),
 * the other feature points of the skin, then vertices far from all that were chosen before.
 * @return FAP_OK; FAP_E_DATA the face has none of the major points; FAP_E_UNSUPPORTED a build without Embree; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_labels_of_bank(fap_labels *out, const fap_bank *bank);

/**
 * Where the labels that nobody placed are: each goes by the affine map of the placed ones around it, then along the axis it is
 * best seen from (front, side, top, back) to the scan.
 * @param place  [labels->count] in: FAP_LABEL_PLACED or anything else; out: all known
 * @return FAP_OK; FAP_E_NOT_FOUND fewer than four are placed, or they are on one line; FAP_E_UNSUPPORTED; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_labels_follow(const fap_labels *labels, const fap_bank *bank,
                                                const fap_surface *scan, fap_label_place *place);

#ifdef __cplusplus
}
#endif
#endif
