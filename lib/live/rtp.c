/* SPDX-License-Identifier: BSD-2-Clause */
/* Packets put together and taken apart. Sources: RFC 3550 section 5.1, RFC 2198 section 3. */
#include <string.h>

#include "live/rtp.h"

enum { VERSION = 2, MOST_OFFSET = (1 << 14) - 1, MOST_REPEATED = (1 << 10) - 1 };

/* Where the payload begins, behind contributors and the extension; 0: beyond the end. */
static size_t header_size(const uint8_t *p, size_t size)
{
    size_t at = FAP_RTP_HEADER + 4 * (size_t)(p[0] & 15);

    if (p[0] & 0x10) {
        if (at + 4 > size)
            return 0;
        at += 4 + 4 * (size_t)get16(p + at + 2);
    }
    return at <= size ? at : 0;
}

fap_err fap_rtp_parse(fap_rtp_packet *out, const void *data, size_t size)
{
    const uint8_t *p = data;

    if (size < FAP_RTP_HEADER || p[0] >> 6 != VERSION)
        return FAP_E_DATA;
    const size_t at = header_size(p, size);
    const size_t padding = p[0] & 0x20 ? p[size - 1] : 0;
    if (!at || padding > size - at || (p[0] & 0x20 && !padding))
        return FAP_E_DATA;
    *out = (fap_rtp_packet){ .payload_type = p[1] & 0x7f,
                             .marker = p[1] >> 7,
                             .sequence = (uint16_t)get16(p + 2),
                             .timestamp = get32(p + 4),
                             .ssrc = get32(p + 8),
                             .payload = p + at,
                             .size = size - at - padding };
    return FAP_OK;
}

size_t fap_rtp_write(const fap_rtp_packet *packet, void *out, size_t room)
{
    uint8_t *p = out;

    if (room < FAP_RTP_HEADER || packet->size > room - FAP_RTP_HEADER)
        return 0;
    p[0] = VERSION << 6;
    p[1] = (uint8_t)(packet->marker << 7 | (packet->payload_type & 0x7f));
    put16(p + 2, packet->sequence);
    put32(p + 4, packet->timestamp);
    put32(p + 8, packet->ssrc);
    memcpy(p + FAP_RTP_HEADER, packet->payload, packet->size);
    return FAP_RTP_HEADER + packet->size;
}

/* "F | type | offset 14 | length 10", then "0 | type", then both planes, the older one first. */
size_t rtp_redundant_write(const rtp_redundant *r, uint8_t *out, size_t room)
{
    const size_t size = REDUNDANT_HEADER + r->before_size + r->now_size;

    if (size > room || r->offset > MOST_OFFSET || r->before_size > MOST_REPEATED || !r->before_size)
        return 0;
    out[0] = 0x80 | FAP_RTP_PAYLOAD;
    out[1] = (uint8_t)(r->offset >> 6);
    out[2] = (uint8_t)((r->offset & 63) << 2 | r->before_size >> 8);
    out[3] = (uint8_t)r->before_size;
    out[4] = FAP_RTP_PAYLOAD;
    memcpy(out + REDUNDANT_HEADER, r->before, r->before_size);
    memcpy(out + REDUNDANT_HEADER + r->before_size, r->now, r->now_size);
    return size;
}

int rtp_redundant_parse(rtp_redundant *r, const uint8_t *payload, size_t size, int type)
{
    if (size < REDUNDANT_HEADER || payload[0] != (0x80 | type) || payload[4] != type)
        return 0;
    *r = (rtp_redundant){ .before = payload + REDUNDANT_HEADER,
                          .before_size = (size_t)(payload[2] & 3) << 8 | payload[3],
                          .offset = (uint32_t)payload[1] << 6 | payload[2] >> 2 };
    if (r->before_size > size - REDUNDANT_HEADER)
        return 0;
    r->now = r->before + r->before_size;
    r->now_size = size - REDUNDANT_HEADER - r->before_size;
    return 1;
}
