/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * From the tracks of one video to a take in space: mirrors from all frames, sizes from a ruler, places from all views, and an
 * account of how well they agree. Source: I-C. Lin, J-S. Yeh, M. Ouhyoung 2001, section 4.1.
 */
#ifndef FAP_STUDIO_TRACKS_H
#define FAP_STUDIO_TRACKS_H

#include <fap/studio/mirror.h>
#include <fap/studio/take.h>
#include <fap/studio/track.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_TRACKS_VIEWS (1 + FAP_MIRROR_MAX)

/** A dot of the first picture, in every view it was seen in. */
typedef struct fap_track_dot {
    char name[FAP_TAKE_NAME_SIZE];
    uint8_t has[FAP_TRACKS_VIEWS]; /**< directly, in the first mirror, in the second */
    double at_px[FAP_TRACKS_VIEWS][2];
} fap_track_dot;

/** Where to begin. */
typedef struct fap_track_dots {
    int count, mirrors;
    fap_track_dot *dot; /**< [count], names are unique */
    fap_allocator alloc;
} fap_track_dots;

/**
 * Dots from a table: label, x, y, and two columns more for every mirror; empty where a dot is not seen. A first row that is not
 * numbers is a heading.
 * @param where  FAP_ERROR_TEXT_SIZE bytes: the line and what is wrong with it
 * @return FAP_OK; FAP_E_SYNTAX; FAP_E_DATA a label twice, or a dot that is seen nowhere; FAP_E_NOT_FOUND no dot; FAP_E_LIMIT more than
 * FAP_TRACK_MAX_POINTS in all views; FAP_E_NOMEM. Nothing is to be freed on error.
 */
FAP_API FAP_NODISCARD fap_err fap_track_dots_read(fap_track_dots *dots, const void *data, size_t size,
                                                  const fap_allocator *alloc, char *where);
/** Frees what they hold. */
FAP_API void fap_track_dots_close(fap_track_dots *dots);

/** Where labels appeared. Borrowed. */
typedef struct fap_tracks {
    int labels, mirrors; /**< mirrors 0: the video is all there is, places are flat */
    uint32_t frames;
    double rate_hz;
    const char *const *name; /**< [labels] */
    const uint8_t
        *has; /**< [labels * FAP_TRACKS_VIEWS], 1: followed in that view: directly, first mirror, second */
    const fap_track_point *point; /**< [frames][labels * FAP_TRACKS_VIEWS] */
} fap_tracks;

/** Start from fap_tracks_config_init(). */
typedef struct fap_tracks_config {
    size_t struct_size;
    fap_camera camera;
    int ruler[2];        /**< labels at its ends; -1: none, sizes are guessed */
    double ruler_mm;     /**< from one to the other */
    double tolerance_px; /**< 2.5: a right pair is off by no more */
    fap_allocator alloc;
} fap_tracks_config;
FAP_API void fap_tracks_config_init(fap_tracks_config *cfg);

typedef struct fap_tracks_label {
    uint32_t seen, placed; /**< frames with a direct view; with a place */
    uint32_t strays;       /**< frames whose place was dropped: skin does not stretch so */
    double rms_px;         /**< of its pictures against those of its places */
} fap_tracks_label;

/** What was found; @c label is the caller's, [labels], may be NULL. */
typedef struct fap_tracks_report {
    fap_mirror_plane mirror[FAP_MIRROR_MAX]; /**< millimetres, camera coordinates */
    fap_mirror_fit fit[FAP_MIRROR_MAX];      /**< residual in pixels */
    double rms_px;                           /**< of all views of all places */
    double mm_per_unit;                      /**< what the ruler made of sizes; 0: there was none */
    uint32_t ruler_frames;                   /**< in which it was seen */
    double distance_mm;                      /**< of the points from the lens, in the mean */
    fap_tracks_label *label;
} fap_tracks_report;

/**
 * Places of all labels but the ruler's, millimetres, x to the picture's right, y up, z towards the camera: what sits on a face before
 * the camera has MPEG-4's axes. What is seen in fewer than two views is missing.
 * @param where  FAP_ERROR_TEXT_SIZE bytes
 * @return FAP_OK; FAP_E_ARG; FAP_E_DATA a mirror is not determined, or nothing ties the two together; FAP_E_LIMIT; FAP_E_NOMEM.
 * *take is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_tracks_place(fap_take **take, const fap_tracks *tracks,
                                               const fap_tracks_config *cfg, fap_tracks_report *report,
                                               char *where);

#ifdef __cplusplus
}
#endif
#endif
