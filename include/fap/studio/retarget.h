/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Motions of one face on another. Source: Zhu 2006 chapter 5: between faces of one structure (5.1), and from faces of another
 * structure (5.2). Part of libfap-studio.
 */
#ifndef FAP_STUDIO_RETARGET_H
#define FAP_STUDIO_RETARGET_H

#include <fap/bank.h>
#include <fap/studio/bank_build.h>
#include <fap/studio/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How much larger the other face is, four times (eq. 5.2). */
typedef struct fap_retarget_scale {
    double eyes, mouth; /**< x: between the middles of the eyes; between the corners of the mouth */
    double nose, lips;  /**< y: from the line of the eyes to the tip of the nose; from there to the mouth */
    double scale;       /**< their mean: what motions are multiplied with */
} fap_retarget_scale;

/**
 * The bank's motions on another neutral face of the same structure (section 5.1). Feature points, masks and the region map stay
 * where they are on the surface; eyes turn about where they have come to be.
 * @param position  [vertex_count of the bank's mesh] millimetres, head axes
 * @param name      of the other face
 * @param scale     may be NULL
 * @return FAP_OK; FAP_E_DATA a place that is none, or the face lacks the points to measure by; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_bank_retarget(fap_bank_builder **out, const fap_bank *bank,
                                                const float (*position)[3], const char *name,
                                                fap_retarget_scale *scale);

/**
 * Motions of a face of another structure, sampled for ours where it lies on that one (section 5.2): along each normal, mixed of
 * the three vertices it meets, smoothed once over neighbours. Vertices that meet nothing move as those around them do.
 * @param laid      [vertex_count] our face on the source's neutral one, in the source's unit and axes
 * @param triangle  ours
 * @param use       [vertex_count] 0: no skin, does not move; NULL: all
 * @param reach     how far off the source may be, its unit
 * @param delta     [source->vertex_count] a motion of the source
 * @param out       [vertex_count] its motion on our face, in the source's unit and axes
 * @return FAP_OK; FAP_E_NOT_FOUND our face lies nowhere on it; FAP_E_UNSUPPORTED a build without Embree; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_motion_resample(const float (*laid)[3], uint32_t vertex_count,
                                                  const uint32_t (*triangle)[3], uint32_t triangle_count,
                                                  const uint8_t *use, double reach, const fap_surface *source,
                                                  const float (*delta)[3], float (*out)[3]);

#ifdef __cplusplus
}
#endif
#endif
