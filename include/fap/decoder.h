/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The decoder of FBA elementary streams (.fba): predictive mode in full; body data is parsed past. A decoder
 * takes its memory in open, 64 KiB by default, and none afterwards; all its decisions are made in integers.
 * Source: ISO/IEC 14496-2, face object and face object plane syntax, arithmetic decoding of FAPs.
 */
#ifndef FAP_DECODER_H
#define FAP_DECODER_H

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/fit.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_decoder fap_decoder;

/** A tolerated deviation: told once per kind. @p bit counts from the first bit ever sent. @p text is static.
 */
typedef void (*fap_decoder_notice)(void *user, int64_t bit, const char *text);

/** Options; start from fap_decoder_config_init(). */
typedef struct fap_decoder_config {
    size_t struct_size;        /**< sizeof of this struct, set by init */
    int strict;                /**< 0; 1: every deviation is an error */
    fap_decoder_notice notice; /**< NULL */
    void *notice_user;
    /** 0: FAPs without a range in the stream have the standard's. 1..1860: this bound on both sides for all
     * of them; 1020 reads what one old encoder wrote. */
    int default_bound;
    /** 0: what fits into 64 KiB. Otherwise how many different symbols the P planes between two I planes may
     * use, over all FAPs, up to 65534; 6 bytes each. */
    int symbol_memory;
    /** NULL; otherwise how FAPs that the stream leaves to the decoder (fap_mask_type 2) are found first, before
     * the other lip contour and the other side. Kept until close. */
    const fap_fit *fit;
    fap_allocator alloc;
} fap_decoder_config;

/** Sets every default. */
FAP_API void fap_decoder_config_init(fap_decoder_config *cfg);

/** What the plane of the last frame was made of. */
typedef struct fap_plane_info {
    int64_t bit_position; /**< of its first bit, start code included, since open */
    uint32_t bit_count;
    uint8_t intra;      /**< 1: I plane */
    uint8_t start_code; /**< 1: a plane start code stands in front */
    uint8_t has_face, has_body;
    uint8_t concealed;                 /**< 1: there was no plane; what follows is of the last one */
    uint8_t quant;                     /**< fap_quant in force */
    uint8_t gender;                    /**< fba_suggested_gender in force; 1: male */
    uint8_t mask_type[FAP_GROUPS + 1]; /**< fap_mask_type of groups 1..10 in force */
    uint32_t skipped;                  /**< frames between the one before and this one */
    uint32_t header_bits;              /**< start code, stuffing in front of it, plane header */
    uint32_t setup_bits;               /**< quantiser, masks, gender: I planes */
    uint32_t range_bits;               /**< new range tables: I planes */
    uint32_t run_bits; /**< what ends arithmetic runs, start code protection, flags between them */
    uint32_t body_bits;
    double rate_hz;                                     /**< in force */
    uint16_t fap_bits[FAP_COUNT + 1];                   /**< bits that the FAP's symbols took, to the bit */
    int16_t i_min[FAP_COUNT + 1], i_max[FAP_COUNT + 1]; /**< symbol ranges in force, in levels; FAPs 3..68 */
    int16_t p_min[FAP_COUNT + 1], p_max[FAP_COUNT + 1];
} fap_plane_info;

/**
 * @param cfg  NULL: defaults
 * @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM. *decoder is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_decoder_open(fap_decoder **decoder, const fap_decoder_config *cfg);

/**
 * Hand over one unit: a whole stream, or any run of whole planes that ends on a byte boundary (a packet).
 *
 * @param data  not copied: keep it until fap_decoder_receive() has given FAP_E_AGAIN or FAP_E_END, flush or
 *              close. NULL with size 0: the unit was lost; one frame is received for it, in which known FAPs are
 *              FAP_CONCEALED
 * @param size  bytes, at least 1
 * @return FAP_OK taken; FAP_E_AGAIN not taken, frames of the unit before are waiting; FAP_E_ARG
 */
FAP_API FAP_NODISCARD fap_err fap_decoder_send(fap_decoder *decoder, const uint8_t *data, size_t size);

/**
 * The next frame. FAPs that the plane carries are FAP_CODED. Others are FAP_HELD with the last value decoded,
 * FAP_ABSENT when there is none; where the stream asks for it (fap_mask_type 2) they are FAP_DERIVED if
 * another FAP gives them.
 *
 * @return FAP_OK             one frame
 *         FAP_E_AGAIN        the unit is used up: send the next
 *         FAP_E_END          the end code was read; what may be sent after it is a new stream
 *         FAP_E_BITSTREAM    the plane breaks the standard
 *         FAP_E_UNSUPPORTED  the plane is coded in DCT segments
 *         FAP_E_LIMIT        the P planes since the last I plane used up symbol_memory
 * After an error @p out is untouched, and the next calls go on behind the next start code that can be found, or
 * at the start of the next unit. Until an I plane comes, each P plane or lost unit gives a frame in which known FAPs
 * are FAP_CONCEALED: they go on as they moved, slow down, and after half a second ease to rest, never by more a
 * frame than the stream itself did. The I plane is exact at once; what it does not code is held as last decoded.
 */
FAP_API FAP_NODISCARD fap_err fap_decoder_receive(fap_decoder *decoder, fap_frame *out);

/** The plane of the last frame received. Never NULL; changes with the next receive. */
FAP_API const fap_plane_info *fap_decoder_plane(const fap_decoder *decoder);
/** Bit position, syntax element and what is wrong with it. Never NULL; "" when nothing went wrong. */
FAP_API const char *fap_decoder_last_error(const fap_decoder *decoder);
/** After a seek: drop the unit, wait for an I plane. Ranges, rate, frame count and values stay. */
FAP_API void fap_decoder_flush(fap_decoder *decoder);
/** Sets @p *decoder to NULL; accepts NULL. */
FAP_API void fap_decoder_close(fap_decoder **decoder);

#ifdef __cplusplus
}
#endif
#endif
