/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Landmarks of a scan: places that somebody clicked or some program found, and which feature points they are. Part of
 * libfap-studio.
 */
#ifndef FAP_STUDIO_LANDMARKS_H
#define FAP_STUDIO_LANDMARKS_H

#include <fap/bank.h>
#include <fap/studio/registration.h>
#include <fap/studio/surface.h>
#include <fap/studio/take.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Read lines of NAME, x, y, z in the scan's unit and axes, of NAME, number of a vertex (0 is the first), or of NAME, column, row,
 * "px" in a range image. Commas, semicolons,
 * tabs or blanks between; a first line of words and lines behind # are passed over.
 * @param scan  whose vertices are meant; NULL: numbers of vertices are refused
 * @param out   a take of one frame: fap_take_close()
 * @return FAP_OK; FAP_E_SYNTAX, with the line; FAP_E_DATA no such vertex; FAP_E_NOT_FOUND nothing in it; FAP_E_LIMIT; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_landmarks_read(fap_take **out, const void *data, size_t size,
                                                 const fap_surface *scan, const fap_allocator *alloc,
                                                 char *where);
/**
 * Landmarks to pins on a bank's face: names are feature points ("8.3"), numbers of the 68-point scheme ("48"), or labels of any
 * marker set that fap_markers_map() knows. Points that are not on the skin, and points that only come near, are left out.
 * @param pin    [FAP_POINT_COUNT]
 * @param count  how many were set
 * @return FAP_OK; FAP_E_NOT_FOUND fewer than three are known, and @p where lists what there is
 */
FAP_API FAP_NODISCARD fap_err fap_landmarks_pin(const fap_take *landmarks, const fap_bank *bank, fap_pin *pin,
                                                uint32_t *count, char *where);

/**
 * A bank's face as a generic one; all but the positions is the bank's own.
 * @return FAP_OK, FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_generic_of_bank(fap_generic *out, const fap_bank *bank,
                                                  const fap_allocator *alloc);
FAP_API void fap_generic_free(fap_generic *g, const fap_allocator *alloc);

#ifdef __cplusplus
}
#endif
#endif
