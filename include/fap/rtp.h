/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * FBA planes in RTP packets, without sockets, clocks or allocation past open: bytes and times come in, bytes and times go out. RTP is
 * RFC 3550; the payload is that of MPEG-4 visual streams, RFC 6416, with one run of whole planes a packet; a repeated plane is RFC
 * 2198's redundant block.
 *
 * Why not a library: oRTP and ccRTP are under the GPL, and those that are free for anybody bring sockets, an event loop or an
 * allocation a packet; of a client that decodes faces in 64 KiB, RTP's twelve bytes are not what should need them.
 */
#ifndef FAP_RTP_H
#define FAP_RTP_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/api.h>
#include <fap/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_RTP_HEADER      12   /**< bytes in front of a payload that we write */
#define FAP_RTP_MAX_PACKET  1400 /**< bytes of a packet, header included: nothing on the way splits that */
#define FAP_RTP_CLOCK_HZ    90000
#define FAP_RTP_PAYLOAD     96 /**< type of plain packets unless told otherwise */
#define FAP_RTP_REDUNDANT   97 /**< type of packets with a repeated plane */
#define FAP_RTP_REPORT_SIZE 64 /**< bytes that any of our RTCP packets fits into */

/* --- one packet --- */

/** A packet taken apart; @c payload points into it. */
typedef struct fap_rtp_packet {
    uint8_t payload_type, marker;
    uint16_t sequence;
    uint32_t timestamp, ssrc;
    const uint8_t *payload;
    size_t size; /**< of the payload */
} fap_rtp_packet;

/** @return FAP_OK; FAP_E_DATA it is no RTP packet, or shorter than its own header says */
FAP_API FAP_NODISCARD fap_err fap_rtp_parse(fap_rtp_packet *out, const void *data, size_t size);
/** Header and payload. @return bytes written; 0: more than @p room. */
FAP_API size_t fap_rtp_write(const fap_rtp_packet *packet, void *out, size_t room);

/* --- sending --- */

typedef struct fap_rtp_sender fap_rtp_sender;

/** Start from fap_rtp_sender_config_init(). The three random numbers are the caller's, as RFC 3550 wants them. */
typedef struct fap_rtp_sender_config {
    size_t struct_size;
    uint32_t ssrc, first_timestamp;
    uint16_t first_sequence;
    int aggregate; /**< 1; planes a packet, up to 16. More than one: planes need start codes (fap_encoder_config.plane_codes) */
    int redundancy; /**< -1: the plane before is repeated while receivers report loss. 0: never; 1: always */
    fap_allocator alloc;
} fap_rtp_sender_config;
FAP_API void fap_rtp_sender_config_init(fap_rtp_sender_config *cfg);

/** @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM */
FAP_API FAP_NODISCARD fap_err fap_rtp_sender_open(fap_rtp_sender **sender, const fap_rtp_sender_config *cfg);
/**
 * One plane, as fap_encoder_receive() gives it with look_ahead 0.
 * @param pts_us  media time
 * @param intra   1: an I plane, which begins a packet
 * @return FAP_OK taken; FAP_E_AGAIN not taken: a packet is to be fetched first; FAP_E_LIMIT larger than a packet
 */
FAP_API FAP_NODISCARD fap_err fap_rtp_sender_put(fap_rtp_sender *sender, const uint8_t *plane, size_t size,
                                                 int64_t pts_us, int intra);
/**
 * The next packet to be sent.
 * @param flush  1: though it has room for more planes
 * @return FAP_OK; FAP_E_AGAIN there is none. @p data lives until the next call.
 */
FAP_API FAP_NODISCARD fap_err fap_rtp_sender_get(fap_rtp_sender *sender, int flush, const uint8_t **data,
                                                 size_t *size);
/**
 * What a receiver says of us (an RTCP receiver report); anything else is passed over.
 * @param now_us  as given to fap_rtp_sender_report()
 */
FAP_API void fap_rtp_sender_heard(fap_rtp_sender *sender, const void *data, size_t size, int64_t now_us);
/** A sender report. @param now_us of a clock that only goes on @param ntp the same instant as an NTP time stamp */
FAP_API size_t fap_rtp_sender_report(fap_rtp_sender *sender, int64_t now_us, uint64_t ntp,
                                     uint8_t out[FAP_RTP_REPORT_SIZE]);

typedef struct fap_rtp_sender_stats {
    uint64_t packets, bytes, payload_bytes, repeated; /**< bytes: of RTP packets, without IP and UDP */
    double reported_loss;                             /**< share of packets, of the last receiver report; 0 */
    double round_trip_ms;                             /**< 0: not known */
} fap_rtp_sender_stats;
FAP_API fap_rtp_sender_stats fap_rtp_sender_get_stats(const fap_rtp_sender *sender);
/** Sets @p *sender to NULL; accepts NULL. */
FAP_API void fap_rtp_sender_close(fap_rtp_sender **sender);

/* --- receiving --- */

typedef struct fap_rtp_receiver fap_rtp_receiver;

/** Start from fap_rtp_receiver_config_init(). */
typedef struct fap_rtp_receiver_config {
    size_t struct_size;
    uint32_t ssrc; /**< our own, in reports */
    uint8_t payload_type,
        redundant_type; /**< FAP_RTP_PAYLOAD, FAP_RTP_REDUNDANT: what an SDP may say otherwise */
    int delay_ms;       /**< 60; how long packets wait for those that are late, to begin with */
    int least_delay_ms; /**< 20; it follows the jitter, ... */
    int most_delay_ms;  /**< 400; ... between these */
    int any_source;     /**< 0; 1: whoever sends is heard, and a new source takes over */
    int most_packets_s; /**< 250; what is more in any second is dropped unseen */
    fap_allocator alloc;
} fap_rtp_receiver_config;
FAP_API void fap_rtp_receiver_config_init(fap_rtp_receiver_config *cfg);

/** @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM. About 100 kB, once. */
FAP_API FAP_NODISCARD fap_err fap_rtp_receiver_open(fap_rtp_receiver **receiver,
                                                    const fap_rtp_receiver_config *cfg);
/**
 * A packet came. Anything may be in it.
 * @param source  the sender's address as a number of the caller's making; the first to send three good packets in a row is listened to
 * @param now_us  of a clock that only goes on
 * @return FAP_OK kept; FAP_E_DATA no packet of ours; FAP_E_LIMIT too many, from another source, too late, or twice
 */
FAP_API FAP_NODISCARD fap_err fap_rtp_receiver_put(fap_rtp_receiver *receiver, uint64_t source,
                                                   const void *data, size_t size, int64_t now_us);

/** What is due. */
typedef struct fap_rtp_unit {
    const uint8_t *data; /**< planes for fap_decoder_send(), NULL: lost; lives until the next call */
    size_t size;
    int64_t pts_us;  /**< media time since the first packet */
    int64_t lost_us; /**< how much media time was lost with it; 0 where data is */
    uint8_t marker;
} fap_rtp_unit;
/** @return FAP_OK; FAP_E_AGAIN nothing is due before fap_rtp_receiver_next_us() */
FAP_API FAP_NODISCARD fap_err fap_rtp_receiver_get(fap_rtp_receiver *receiver, int64_t now_us,
                                                   fap_rtp_unit *unit);
/** When the next call of get may have something, as of now; INT64_MAX: not before another packet comes. */
FAP_API int64_t fap_rtp_receiver_next_us(const fap_rtp_receiver *receiver);
/** A receiver report. @return its bytes; 0: nobody is heard yet */
FAP_API size_t fap_rtp_receiver_report(fap_rtp_receiver *receiver, int64_t now_us,
                                       uint8_t out[FAP_RTP_REPORT_SIZE]);
/** An RTCP packet of the sender's; anything else is passed over. */
FAP_API void fap_rtp_receiver_heard(fap_rtp_receiver *receiver, const void *data, size_t size,
                                    int64_t now_us);

typedef struct fap_rtp_receiver_stats {
    uint64_t packets, lost, late, duplicate, foreign, malformed, flooded,
        restored;               /**< restored: by a repeated plane */
    double jitter_ms, delay_ms; /**< as RFC 3550 counts it; how long packets wait now */
    double drift_ppm;           /**< the sender's clock against ours */
    int locked;                 /**< 1: a source was settled on */
} fap_rtp_receiver_stats;
FAP_API fap_rtp_receiver_stats fap_rtp_receiver_get_stats(const fap_rtp_receiver *receiver);
/** Sets @p *receiver to NULL; accepts NULL. */
FAP_API void fap_rtp_receiver_close(fap_rtp_receiver **receiver);

#ifdef __cplusplus
}
#endif
#endif
