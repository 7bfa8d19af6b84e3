/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Markers in video: coloured dots followed from picture to picture, each by a Kalman filter of constant velocity whose measurement
 * counts the less the worse it looks like the dot. Source: I-C. Lin, J-S. Yeh, M. Ouhyoung 2001, section 3, eq. 1 to 3.
 */
#ifndef FAP_STUDIO_TRACK_H
#define FAP_STUDIO_TRACK_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/api.h>
#include <fap/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_TRACK_MAX_POINTS 1024

/** RGB, 8 bits, rows from the top; borrowed for the call. */
typedef struct fap_picture {
    const uint8_t *rgb;
    int width_px, height_px;
    size_t stride; /**< bytes from row to row */
} fap_picture;

/** Start from fap_tracker_config_init(). */
typedef struct fap_tracker_config {
    size_t struct_size;
    double radius_px;         /**< 0: of each dot as found in the first picture */
    double search_px;         /**< 24: never looked for farther than this from where it should be */
    double base_variance_px2; /**< 0.04: sigma_base^2 of a measurement that looks just like the dot */
    double cost_weight_px2;   /**< 4: alpha; the cost is 0 for the same, 1 for a dot that is not there */
    double velocity_variance; /**< 1.5: sigma_v^2, pixels^2 a frame^2, by which velocity changes a frame */
    double lost_cost;         /**< 0.5: what costs more was not seen */
    int lost_frames; /**< 15: unseen longer than this, a dot stays where it is until it is found again */
    fap_allocator alloc;
} fap_tracker_config;
FAP_API void fap_tracker_config_init(fap_tracker_config *cfg);

/** How a position was come by. */
typedef enum fap_track_state {
    FAP_TRACK_SEEN,      /**< measured in this picture */
    FAP_TRACK_PREDICTED, /**< hidden: where it should be */
    FAP_TRACK_LOST       /**< hidden for long: the position is a guess */
} fap_track_state;

typedef struct fap_track_point {
    double x_px, y_px;   /**< filtered; 0 is the middle of the first pixel */
    double variance_px2; /**< of either coordinate, as the filter has it */
    double cost;         /**< of the best place in this picture: 0 the same, 1 not there */
    fap_track_state state;
} fap_track_point;

typedef struct fap_tracker fap_tracker;

/**
 * Learn the dots from the first picture.
 * @param at     where they are, about: each is moved to the middle of its dot where there is one
 * @param count  1 to FAP_TRACK_MAX_POINTS
 * @return FAP_OK; FAP_E_ARG a dot lies outside the picture; FAP_E_LIMIT; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_tracker_open(fap_tracker **t, const fap_tracker_config *cfg,
                                               const fap_picture *first, const double (*at)[2], int count);
/** Sets @p *t to NULL; accepts NULL. */
FAP_API void fap_tracker_close(fap_tracker **t);
/**
 * The next picture, of the first one's size.
 * @param frames  since the one before: 1; 0.5 for a field; more where pictures are missing
 * @return FAP_OK; FAP_E_ARG another size
 */
FAP_API FAP_NODISCARD fap_err fap_tracker_step(fap_tracker *t, const fap_picture *picture, double frames);
/** Points in the order they were given. */
FAP_API const fap_track_point *fap_tracker_points(const fap_tracker *t);
/** Radius of a dot in the first picture, pixels. */
FAP_API double fap_tracker_radius(const fap_tracker *t, int point);

#ifdef __cplusplus
}
#endif
#endif
