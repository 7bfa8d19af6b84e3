/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * What a listener has to know of an RTP stream of FBA planes, as a session description: RFC 8866, with the media type of RFC 6416 and
 * the redundant one of RFC 2198.
 */
#ifndef FAP_SDP_H
#define FAP_SDP_H

#include <stddef.h>
#include <stdint.h>

#include <fap/api.h>
#include <fap/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_SDP_HOST_SIZE 64  /**< bytes of an address as text, its NUL included */
#define FAP_SDP_MAX_SIZE  640 /**< bytes that any description we write fits into, its NUL included */

typedef struct fap_sdp {
    char host[FAP_SDP_HOST_SIZE]; /**< a numeric address, IPv4 or IPv6: where packets are sent to */
    uint16_t port;                /**< even: reports are one above */
    uint32_t session;             /**< a number of the sender's; our SSRC does */
    uint8_t payload_type;         /**< of plain packets, 96 to 127 */
    uint8_t redundant_type;       /**< of packets with a repeated plane; 0: there are none */
    uint32_t clock_hz;
    uint8_t profile_level; /**< profile_and_level_indication: 0x61 is Simple Face Animation at level 1 */
} fap_sdp;

/** @return the text's length without its NUL; 0: an address that is none, or more than @p room */
FAP_API size_t fap_sdp_write(const fap_sdp *sdp, char *out, size_t room);
/**
 * The first medium of MPEG-4 visual planes in a description; everything else in it is passed over.
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT no session description; FAP_E_UNSUPPORTED it has no such medium, or another clock;
 *         FAP_E_SYNTAX
 */
FAP_API FAP_NODISCARD fap_err fap_sdp_read(fap_sdp *out, const void *data, size_t size, char *where);

#ifdef __cplusplus
}
#endif
#endif
