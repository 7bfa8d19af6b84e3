/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Discontinuity masks, which vertices are of which lip and lid, on a face of any structure: brought over from a face that has
 * them, and kept as a table. Source: Sanchez Lorenzo et al. 2003, section 6.1. Part of libfap-studio.
 */
#ifndef FAP_STUDIO_MASKS_H
#define FAP_STUDIO_MASKS_H

#include <fap/studio/registration.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Of ::fap_mask bit 1 << @p i: "lip_upper", "lip_lower", "lid_upper_left" ...; NULL for another number. Static. */
FAP_API const char *fap_mask_side_name(int i);

/**
 * The generic face's masks on the face that it was laid onto, by cylindrical projection: what a ray from the head's axis through a
 * vertex meets nearest on the laid face, and faces as the vertex does, says which side the vertex is of. Where no ray
 * helps, the nearest place does. A vertex that disagrees with most of its neighbours gives in.
 * @param r        the generic face laid onto @p face; it was not subdivided
 * @param generic  what was laid; it has masks
 * @param face     any structure, in the unit and axes of the scan
 * @param mask     [face->vertex_count] of ::fap_mask bits
 * @return FAP_OK; FAP_E_ARG no masks, or another generic face; FAP_E_UNSUPPORTED a build without Embree; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_masks_retarget(const fap_registration *r, const fap_generic *generic,
                                                 const fap_surface *face, uint8_t *mask);

/**
 * A table: "vertex,side", then a line for each side a vertex is of, "1207,lip_upper"; 0 is the first vertex.
 * @return FAP_OK, FAP_E_IO
 */
FAP_API FAP_NODISCARD fap_err fap_masks_write(const uint8_t *mask, uint32_t vertex_count,
                                              const fap_writer *out);
/**
 * Such a table; lines behind # are passed over.
 * @param mask   [vertex_count]; set as a whole
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL: the line, and what is wrong with it
 * @return FAP_OK; FAP_E_SYNTAX; FAP_E_DATA no such vertex
 */
FAP_API FAP_NODISCARD fap_err fap_masks_read(uint8_t *mask, uint32_t vertex_count, const void *data,
                                             size_t size, char *where);

#ifdef __cplusplus
}
#endif
#endif
