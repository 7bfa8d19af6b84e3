/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The encoder of FBA elementary streams (.fba), predictive mode. Frames are gathered into groups, an I plane and the
 * P planes behind it; all four range tables are sent in every I plane, which leaves no decoder a choice and lets one
 * join there. Everything is decided in integers: the same frames and options give the same bytes on every machine.
 * Source: ISO/IEC 14496-2, face object plane syntax, arithmetic coding of FAPs.
 *
 * What is promised, in each mode:
 * - FAP_ENCODE_QUANT: every value that is shown is within half a step of the quantiser, and exact with quant 0. What no
 *   plane can carry (I planes reach 1860 levels from 0, P planes 1860 levels from where they are, both divided by
 *   fap_quant) is clipped, counted, and caught up with by the planes that follow; nothing wraps. Visemes and
 *   expressions are sent to the letter, their strengths within half a step; but the second intensity is sent as 0
 *   where there is no second expression and a decoder could take the slots for swapped (docs/codec.md).
 * - FAP_ENCODE_BITRATE: the bits of all planes shown in any half-open 2 seconds of media time, start codes, stuffing,
 *   headers and end code included, are at most 2 * bitrate_bps. Frames are left out where it cannot be otherwise, at
 *   the very end too; FAPs of least effect are not sent at all where an I plane would take more than 3/4 of a window.
 * - FAP_ENCODE_ERROR: no place (feature point, eyeball, pupil, head, mix, as fap_sensitivity_compare() measures them) is
 *   farther than max_error_mm from where it should be, as far as fap_quant 1 permits: half of its steps are the least
 *   bound (for the head 0.13 mm an axis on a typical face), and clipped values are counted as above. The axes commanded
 *   at a place share the budget evenly; the head's three angles share it by their sum.
 * In the last two modes a mix of visemes or expressions may be said in another way that looks the same, and a FAP that
 * stops being sent stays coded at its last value as long as that saves an I plane.
 */
#ifndef FAP_ENCODER_H
#define FAP_ENCODER_H

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/fit.h>
#include <fap/frame.h>
#include <fap/sensitivity.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_encoder fap_encoder;

/** What is kept constant. */
typedef enum fap_encoder_mode {
    FAP_ENCODE_QUANT,   /**< the quantiser: every value within half a step of the original */
    FAP_ENCODE_BITRATE, /**< bits: never more than bitrate_bps * 2 s in any 2 seconds of media time */
    FAP_ENCODE_ERROR, /**< millimetres: no feature point farther than max_error_mm from where it should be */
} fap_encoder_mode;

/** Options; start from fap_encoder_config_init(). */
typedef struct fap_encoder_config {
    size_t struct_size;    /**< sizeof of this struct, set by init */
    double rate_hz;        /**< 25; sent as the nearest of n/16 and n/16 * 1000/1001, up to 255.9375 */
    fap_encoder_mode mode; /**< FAP_ENCODE_QUANT */
    int quant;           /**< 1; fap_quant, 0 to 31. 0: values are sent as they are. Other modes choose it */
    int bitrate_bps;     /**< 2000; FAP_ENCODE_BITRATE */
    double max_error_mm; /**< 0.5; FAP_ENCODE_ERROR */
    const fap_sensitivity *sensitivity; /**< NULL: a typical face. Read by open only */
    const fap_fit *fit; /**< NULL; otherwise what the decoder will have too. Kept until close */
    int intra;          /**< 250; at least one I plane in so many frames, 1 to 10000 */
    int look_ahead; /**< 250; frames held back to choose by, up to intra. 0: for live use, every frame comes
                             out at once as a packet of its own, and ranges are guessed with room */
    int derive;     /**< -1: not with FAP_ENCODE_QUANT. 1: FAPs that the decoder derives well enough from
                             others (fit, lips, sides) are left to it, fap_mask_type 2. 0: never */
    int skip;   /**< -1: not with FAP_ENCODE_QUANT. 1: frames that change nothing are left out. 0: never */
    int gender; /**< 0; 1: male */
    int plane_codes; /**< 0: start codes in front of I planes; 1: in front of every plane */
    int time_codes;  /**< 0; 1: I planes on a full second carry a time code */
    fap_allocator alloc;
} fap_encoder_config;

/** Sets every default. */
FAP_API void fap_encoder_config_init(fap_encoder_config *cfg);

/** What was done so far. */
typedef struct fap_encoder_stats {
    int64_t frames, intra_frames, bytes;
    int64_t
        clipped; /**< values beyond what a plane can carry (1860 levels / fap_quant, or its symbol range): later
                      planes catch up */
    int64_t skipped;             /**< of frames: left out, the decoder shows the one before */
    int64_t derived;             /**< values left to the decoder */
    int64_t largest_window_bits; /**< of any 2 s of media time, start codes, stuffing and end code included */
    double mean_error_mm; /**< over all places commanded in all frames, see fap_sensitivity_compare() */
    double max_error_mm;
} fap_encoder_stats;

/** @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM. @p cfg NULL: defaults. *encoder is NULL unless FAP_OK. */
FAP_API FAP_NODISCARD fap_err fap_encoder_open(fap_encoder **encoder, const fap_encoder_config *cfg);

/**
 * One frame, copied. FAPs of state FAP_CODED are sent; the frame's place in time is that of @c pts_us,
 * rounded to a frame.
 * @return FAP_OK       taken
 *         FAP_E_AGAIN  not taken: receive a packet first, then send it again
 *         FAP_E_ARG    a viseme or expression out of its range; sent after flush
 *         FAP_E_LIMIT  more than 4096 frames are left out between it and the one before
 */
FAP_API FAP_NODISCARD fap_err fap_encoder_send(fap_encoder *encoder, const fap_frame *frame);
/** No more frames will come: the rest and the end code can be received. */
FAP_API void fap_encoder_flush(fap_encoder *encoder);
/** Bytes that every packet fits into. */
FAP_API size_t fap_encoder_bound(const fap_encoder *encoder);
/**
 * The next packet: an I plane and its P planes, ending on a byte boundary. All packets in a row are the
 * stream; with look_ahead 0 only where plane_codes is set, else whoever decodes must be given them one by one.
 * @param room  at least fap_encoder_bound()
 * @param size  0 where there is nothing to send: with look_ahead 0, a frame that is left out
 * @return FAP_OK; FAP_E_AGAIN send more frames; FAP_E_END the end code was given; FAP_E_ARG
 */
FAP_API FAP_NODISCARD fap_err fap_encoder_receive(fap_encoder *encoder, uint8_t *data, size_t room,
                                                  size_t *size);
/**
 * The frames of the last packet as a decoder will show them, states included; those that were left out hold what was
 * before, with no FAP of state FAP_CODED. The packet with the end code repeats the last frame if that one had been left
 * out. Lives until the next call.
 */
FAP_API const fap_frame *fap_encoder_reconstruction(const fap_encoder *encoder, int *count);
FAP_API fap_encoder_stats fap_encoder_get_stats(const fap_encoder *encoder);
/** Sets @p *encoder to NULL; accepts NULL. */
FAP_API void fap_encoder_close(fap_encoder **encoder);

#ifdef __cplusplus
}
#endif
#endif
