/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The standard's tables: FAPs, feature points, groups, pairs, visemes, expressions. Constant data, made from
 * fap_tables/NAME.csv at build time; nobody types a number of the standard into a C file.
 * Source: ISO/IEC 14496-2, Annex C.
 */
#ifndef FAP_TABLES_H
#define FAP_TABLES_H

#include <stddef.h>
#include <stdint.h>

#include <fap/api.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_POINT_COUNT      84 /**< feature points 2.1 to 11.6 */
#define FAP_VISEME_COUNT     14 /**< visemes 1..14; 0 is none */
#define FAP_EXPRESSION_COUNT 6  /**< expressions 1..6; 0 is none */

/** What a FAP's integer counts. All but AU are 1/1024 of a distance on the neutral face. */
typedef enum fap_unit {
    FAP_UNIT_NONE,
    FAP_UNIT_IRISD,
    FAP_UNIT_ES,
    FAP_UNIT_ENS,
    FAP_UNIT_MNS,
    FAP_UNIT_MW,
    FAP_UNIT_AU
} fap_unit;

/** What a FAP moves. Axes are the head's: x to the face's left, y up, z forward. */
typedef enum fap_motion {
    FAP_MOTION_NONE, /**< FAPs 1 and 2 */
    FAP_MOTION_X,    /**< translation of its feature point */
    FAP_MOTION_Y,
    FAP_MOTION_Z,
    FAP_MOTION_YAW,   /**< rotation about y, positive to the face's left */
    FAP_MOTION_PITCH, /**< rotation about x, positive down */
    FAP_MOTION_ROLL,  /**< rotation about z, positive to the face's right */
    FAP_MOTION_SIZE,  /**< pupil diameter */
    FAP_MOTION_CURL,  /**< tongue borders rolled up to a U */
} fap_motion;

/** One row of Table C-1. */
typedef struct fap_info {
    const char *name; /**< e.g. "open_jaw" */
    const char *description;
    uint8_t unit;          /**< a ::fap_unit */
    uint8_t motion;        /**< a ::fap_motion */
    int8_t sign;           /**< +1: a positive value moves along +axis; -1: against it */
    uint8_t bidirectional; /**< 0: only one direction has a meaning */
    int8_t point, point2;  /**< feature point index (see fap_point_index()), -1: none; point2 only FAP 47 */
    uint8_t group;         /**< 1..10 */
    uint16_t quant_step;   /**< QP: quantiser step at fap_quant 1 */
    int16_t i_min, i_max;  /**< default range of I planes, before scaling by fap_quant */
    int16_t p_min, p_max;  /**< default range of P planes */
} fap_info;

/** @param fap 1..68 @return the row, NULL for another number. */
FAP_API const fap_info *fap_info_get(int fap);
/** @return the number of the FAP of that name (as in Table C-1), 0 if there is none. */
FAP_API int fap_by_name(const char *name);
/** First FAP of @p group (1..10), and how many it has; 0 for another group. */
FAP_API int fap_group_first(int group);
FAP_API int fap_group_count(int group);
/** The FAP on the other side of the face (6 <-> 7 ...), 0: none. @c 23/24 are parallel, the others mirror. */
FAP_API int fap_mirror(int fap);
/** The same lip point on the other contour (4 <-> 51 ...), 0: none. */
FAP_API int fap_lip_pair(int fap);

/** One of the 84 feature points. */
typedef struct fap_point_info {
    const char *name; /**< "2.1" */
    const char *description;
    uint8_t group, index; /**< 2, 1 */
    uint8_t moved;        /**< 1: FAPs move it */
    int8_t mirror;        /**< index of the point on the other side of the face; itself when on the midline */
} fap_point_info;

/** @param point 0..83 @return the row, NULL for another number. */
FAP_API const fap_point_info *fap_point_get(int point);
/** Index 0..83 of feature point @p group.@p index; -1: no such point. */
FAP_API int fap_point_index(int group, int index);
/** Index of the point called @p name ("8.4"); -1: no such point. */
FAP_API int fap_point_by_name(const char *name);

/** Name of viseme 0..14 ("none", "PP", ...), NULL for another number. Its phonemes, in SAMPA, blank separated. */
FAP_API const char *fap_viseme_name(int viseme);
FAP_API const char *fap_viseme_phonemes(int viseme);
/** Name of expression 0..6 ("none", "joy", ...), NULL for another number. */
FAP_API const char *fap_expression_name(int expression);
/** Typical FAP value at full intensity, in the FAP's own unit; 0 where the expression leaves the FAP alone. */
FAP_API int fap_expression_profile(int expression, int fap);

#ifdef __cplusplus
}
#endif
#endif
