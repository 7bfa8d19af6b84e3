/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Face animation parameter units: the only bridge between FAP integers and millimetres.
 * Source: ISO/IEC 14496-2, Annex C, FAPU definition; head rotation FAPs 48 to 50.
 */
#ifndef FAP_FAPU_H
#define FAP_FAPU_H

#include <fap/api.h>
#include <fap/error.h>
#include <fap/tables.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The five key distances of a neutral face, millimetres. A FAP unit is 1/1024 of its distance. */
typedef struct fap_fapu {
    float irisd_mm; /**< IRISD0 = 3.1.y - 3.3.y */
    float es_mm;    /**< ES0  = 3.5.x - 3.6.x */
    float ens_mm;   /**< ENS0 = 3.5.y - 9.15.y */
    float mns_mm;   /**< MNS0 = 9.15.y - 2.2.y */
    float mw_mm;    /**< MW0  = 8.3.x - 8.4.x */
} fap_fapu;

/**
 * Measure a neutral face.
 * @param points  the 84 feature points, millimetres, head axes (x left, y up, z forward)
 * @return FAP_OK, or FAP_E_DATA when a distance is not positive (the points are not a face)
 */
FAP_API FAP_NODISCARD fap_err fap_fapu_measure(const float points[FAP_POINT_COUNT][3], fap_fapu *out);

/** Millimetres (radians for AU) that one count of @p unit stands for; 0 for FAP_UNIT_NONE. */
FAP_API float fap_fapu_step(const fap_fapu *fapu, fap_unit unit);

/**
 * The head's orientation from FAPs 48, 49, 50: R = yaw * pitch * roll, so that yaw is about the vertical of the
 * room and roll about the face's own axis. The order is this library's; the standard leaves it open.
 * @param rotation  row-major 3x3, turns neutral head coordinates into posed ones
 */
FAP_API void fap_head_rotation(int32_t pitch_au, int32_t yaw_au, int32_t roll_au, float rotation[3][3]);
/** The inverse: angles in AU (1e-5 rad) of a rotation matrix. */
FAP_API void fap_head_angles(const float rotation[3][3], int32_t *pitch_au, int32_t *yaw_au,
                             int32_t *roll_au);

#ifdef __cplusplus
}
#endif
#endif
