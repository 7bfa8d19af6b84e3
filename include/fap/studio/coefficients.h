/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Captures that are no points but numbers per muscle: ARKit's coefficients (Live Link Face and its kin), FACS action
 * units (OpenFace). A take in memory, the readers and the writer of its files, and the way to FAPs. What the numbers
 * mean is in fap/arkit.h and fap/facs.h; docs/coefficients.md lists what the readers tolerate.
 */
#ifndef FAP_STUDIO_COEFFICIENTS_H
#define FAP_STUDIO_COEFFICIENTS_H

#include <fap/arkit.h>
#include <fap/facs.h>
#include <fap/frame.h>
#include <fap/studio/capture.h>
#include <fap/studio/take.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * What a column says: an ARKit shape (its number), a fap_arkit_angle behind FAP_CHANNEL_ANGLE, an action unit (its FACS
 * number) behind FAP_CHANNEL_AU. Shapes and units are shares, 0 to 1; angles are radians in the senses of fap/arkit.h.
 */
enum {
    FAP_CHANNEL_SHAPE = 0,
    FAP_CHANNEL_ANGLE = FAP_ARKIT_COUNT,
    FAP_CHANNEL_AU = 64,
    FAP_CHANNEL_COUNT = FAP_CHANNEL_AU + FAP_FACS_MAX_NUMBER + 1
};
/** "JawOpen", "HeadYaw", "AU12"; NULL for a number that means nothing. Static. */
FAP_API const char *fap_channel_name(int channel);

#define FAP_COEFFICIENTS_MAX_FRAMES (1 << 19) /**< more than this are refused with FAP_E_LIMIT */

/** A take. Plain data, free to change in place. Samples are indexed [frame * channel_count + column]. */
typedef struct fap_coefficients {
    const char *format; /**< "livelink", "livelink packets", "openface units" ...; static */
    double rate_hz;     /**< 0: the file does not say */
    double start_s;     /**< time of day of the first frame, from its time code; 0 without */
    uint32_t frame_count, channel_count;
    uint8_t channel[FAP_CHANNEL_COUNT]; /**< what each column is; no channel twice */
    float *value;                       /**< as in the file, beyond 0 and 1 too; 0 where missing */
    uint8_t *valid;                     /**< 1: the file has it */
    uint32_t note_count;
    char note[FAP_TAKE_MAX_NOTES][FAP_TAKE_NOTE_SIZE]; /**< what was tolerated or left out, in words */
    fap_allocator alloc;
} fap_coefficients;

/**
 * An empty take, every sample missing.
 * @return FAP_OK, FAP_E_ARG (no channels or no frames), FAP_E_LIMIT, FAP_E_NOMEM. @p *take is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_coefficients_create(fap_coefficients **take, uint32_t channel_count,
                                                      uint32_t frame_count, const fap_allocator *alloc);
/** Sets @p *take to NULL; accepts NULL. */
FAP_API void fap_coefficients_close(fap_coefficients **take);
/** Column of a channel, -1: none. */
FAP_API int fap_coefficients_find(const fap_coefficients *take, int channel);

/**
 * Read a file of any known format, found by its content.
 * @param cfg    NULL: defaults; only its rate and allocator count
 * @param where  may be NULL; FAP_ERROR_TEXT_SIZE bytes: what is wrong, and what to do
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_UNSUPPORTED a relative of a known format that means other things;
 *         FAP_E_NOT_FOUND nothing usable in it; FAP_E_SYNTAX, FAP_E_DATA, FAP_E_LIMIT, FAP_E_NOMEM. @p *take is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_coefficients_read(fap_coefficients **take, const void *data, size_t size,
                                                    const fap_take_config *cfg, char *where);
/**
 * Write the table that Live Link Face writes: 63 columns, absent ones 0. Missing frames are left out.
 * @return FAP_OK, FAP_E_ARG (no rate), FAP_E_IO
 */
FAP_API FAP_NODISCARD fap_err fap_coefficients_write_livelink(const fap_coefficients *take,
                                                              const fap_writer *out);

/** What is taken for the face at rest. */
typedef enum fap_coefficients_rest {
    FAP_REST_ZERO,  /**< all coefficients 0, as the format means it */
    FAP_REST_FRAME, /**< a frame of the take, see fap_coefficients_config.neutral_frame */
    FAP_REST_FOUND, /**< the stillest stretch of the take, its eyes open and mouth shut */
} fap_coefficients_rest;

/** Start from fap_coefficients_config_init(). */
typedef struct fap_coefficients_config {
    size_t struct_size;
    double rate_hz;        /**< 25: frames a second of the FAPs */
    double start_s, end_s; /**< 0, 0: the whole take; seconds from its first frame */
    fap_coefficients_rest rest;
    int64_t neutral_frame; /**< of the take, the first one is 0 */
    int64_t neutral_last;  /**< -1: that frame alone; otherwise the last of a stretch */
    double smooth_hz;      /**< as fap_capture_config has it */
    fap_fill fill;         /**< FAP_FILL_ALL */
} fap_coefficients_config;
FAP_API void fap_coefficients_config_init(fap_coefficients_config *cfg);

/** One column over the whole take, as read. */
typedef struct fap_channel_report {
    uint8_t present; /**< the file has the column */
    uint8_t moved;   /**< it was not 0 throughout */
    float min, max, rest;
} fap_channel_report;

typedef struct fap_coefficients_report {
    const char *format;
    double take_rate_hz, rate_hz, take_length_s;
    uint32_t take_frames, frames;
    uint32_t frames_missing; /**< of the take: not in the file, or marked as not seen */
    uint32_t frames_filled;  /**< of those: closed */
    uint32_t spikes;         /**< samples of one frame's length that were no motion */
    uint32_t clamped;        /**< output samples that were beyond 0 or 1 */
    double neutral_s;        /**< middle of the stretch at rest; -1: none was asked for */
    fap_channel_report channel[FAP_CHANNEL_COUNT];
    fap_capture_fap fap[FAP_COUNT + 1]; /**< point and near are unused */
    uint32_t note_count;
    char note[FAP_TAKE_MAX_NOTES][FAP_TAKE_NOTE_SIZE];
} fap_coefficients_report;

typedef struct fap_performance fap_performance;

/**
 * Encode a take. FAPs that no column of it moves are not sent.
 * @param cfg  NULL: defaults
 * @return FAP_OK; FAP_E_ARG an option does not fit the take, or it has no rate; FAP_E_NOT_FOUND no column means anything;
 *         FAP_E_LIMIT; FAP_E_NOMEM. @p *out is NULL on error and @p where (may be NULL) says what to do.
 */
FAP_API FAP_NODISCARD fap_err fap_coefficients_encode(fap_performance **out, const fap_coefficients *take,
                                                      const fap_coefficients_config *cfg, char *where);
/** fap_performance_report()->frames of them, numbered from 0. */
FAP_API const fap_frame *fap_performance_frames(const fap_performance *p);
/** The coefficients behind them, cleaned, at their rate; angles with the rest taken off. */
FAP_API const fap_arkit *fap_performance_arkit(const fap_performance *p);
FAP_API const fap_coefficients_report *fap_performance_report(const fap_performance *p);
/** Sets @p *p to NULL; accepts NULL. */
FAP_API void fap_performance_close(fap_performance **p);

#ifdef __cplusplus
}
#endif
#endif
