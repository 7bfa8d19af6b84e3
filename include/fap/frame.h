/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * One decoded instant of face animation: the 68 FAPs. A plain struct, copied freely.
 * Source: ISO/IEC 14496-2, Annex C, Table C-1; viseme and expression parameters of FAPs 1 and 2.
 */
#ifndef FAP_FRAME_H
#define FAP_FRAME_H

#include <stdint.h>

#include <fap/api.h>

#ifdef __cplusplus
extern "C" {
#endif

/** FAPs are indexed by the standard's own number, 1..FAP_COUNT; slot 0 of every array is unused. */
#define FAP_COUNT  68
#define FAP_GROUPS 10

/** Where a FAP's value of this frame comes from. */
typedef enum fap_state {
    FAP_ABSENT = 0,    /**< never sent: the value is 0 and must not pull on the face */
    FAP_CODED = 1,     /**< carried by this frame */
    FAP_HELD = 2,      /**< masked out: the last value sent, kept */
    FAP_DERIVED = 3,   /**< interpolated from other FAPs by the decoder */
    FAP_CONCEALED = 4, /**< predicted: the unit that carries it was lost */
} fap_state;

/** FAP 1: shown = viseme1 * blend/63 + viseme2 * (1 - blend/63). */
typedef struct fap_viseme {
    uint8_t select1, select2; /**< 0 (none) to 14 */
    uint8_t blend;            /**< 0 to 63 */
    uint8_t def;              /**< viseme_def: this frame's mouth FAPs may define the viseme */
} fap_viseme;

/** FAP 2: shown = expression1 * intensity1/63 + expression2 * intensity2/63. */
typedef struct fap_expression {
    uint8_t select1, intensity1; /**< 0 (none) to 6; 0 to 63 */
    uint8_t select2, intensity2;
    uint8_t init_face, def;
} fap_expression;

/** One instant. */
typedef struct fap_frame {
    int64_t number;               /**< frame number, as counted or written by the stream */
    int64_t pts_us;               /**< media time, microseconds since the first frame */
    uint8_t state[FAP_COUNT + 1]; /**< a ::fap_state each */
    int32_t value[FAP_COUNT + 1]; /**< in the FAP's own unit (FAPU/1024, or 1e-5 rad); 0 where absent */
    fap_viseme viseme;            /**< meaningful where state[1] is not FAP_ABSENT; value[1] is unused */
    fap_expression expression;    /**< meaningful where state[2] is not FAP_ABSENT; value[2] is unused */
} fap_frame;

#ifdef __cplusplus
}
#endif
#endif
