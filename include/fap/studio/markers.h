/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Which point of a take stands for which feature point of the face. Names decide: the feature points' own, a
 * user's table, and the built-in sets of fap_tables/markers.csv.
 */
#ifndef FAP_STUDIO_MARKERS_H
#define FAP_STUDIO_MARKERS_H

#include <fap/studio/take.h>
#include <fap/tables.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_MARKER_SOURCES 4 /**< a feature point may be the mean of this many markers */

/** What is known about a point of the take; several may hold. */
enum {
    FAP_MARKER_POINT = 1,      /**< stands for a feature point */
    FAP_MARKER_RIGID = 2,      /**< follows the head */
    FAP_MARKER_IDLE = 4,       /**< known, carries no FAP */
    FAP_MARKER_MOUTH = 8,      /**< of a ring around the mouth, place unknown until geometry says */
    FAP_MARKER_BROW_LEFT = 16, /**< of a brow, place unknown until geometry says */
    FAP_MARKER_BROW_RIGHT = 32,
    FAP_MARKER_INSIDE =
        64, /**< in the mouth: a coil on the gums or the tongue's root; says nothing about skin */
};

/** The points of the take behind one feature point. */
typedef struct fap_marker_source {
    uint8_t count; /**< 0: the take has nothing for it; the mean of all otherwise */
    uint8_t near;  /**< 1: close to the point, not on it: not for measuring */
    int16_t index[FAP_MARKER_SOURCES];
} fap_marker_source;

typedef struct fap_markers {
    const char *set;                   /**< the built-in set that fits best; "" none. Static */
    uint32_t used;                     /**< points of the take that got a role */
    uint8_t role[FAP_TAKE_MAX_POINTS]; /**< FAP_MARKER_ flags of each point of the take */
    fap_marker_source point[FAP_POINT_COUNT];
} fap_markers;

/**
 * Find the role of every point.
 * @param csv  the user's table, "LABEL,8.4" or "LABEL,~8.4" (near) or "LABEL,rigid" or "LABEL,none" a line, #
 * comments; NULL: none. Its labels win over the built-in ones.
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL
 * @return FAP_OK; FAP_E_SYNTAX a line of the table makes no sense; FAP_E_NOT_FOUND no point of the take is
 * known, and
 *         @p where lists what there is
 */
FAP_API FAP_NODISCARD fap_err fap_markers_map(fap_markers *out, const fap_take *take, const char *csv,
                                              size_t csv_size, char *where);
/** Give points of the take the role FAP_MARKER_RIGID and take it from all others. @p names: "A,B,C". */
FAP_API FAP_NODISCARD fap_err fap_markers_set_rigid(fap_markers *map, const fap_take *take, const char *names,
                                                    char *where);

#ifdef __cplusplus
}
#endif
#endif
