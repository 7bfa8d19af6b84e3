/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers in network order, and the redundant payload of RFC 2198. */
#ifndef LIB_LIVE_RTP_H
#define LIB_LIVE_RTP_H

#include <fap/rtp.h>

enum { RTCP_SENDER_REPORT = 200, RTCP_RECEIVER_REPORT = 201, REDUNDANT_HEADER = 5 };

static inline void put16(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v >> 8);
    p[1] = (uint8_t)v;
}

static inline void put32(uint8_t *p, uint32_t v)
{
    put16(p, v >> 16);
    put16(p + 2, v);
}

static inline uint32_t get16(const uint8_t *p)
{
    return (uint32_t)p[0] << 8 | p[1];
}

static inline uint32_t get32(const uint8_t *p)
{
    return get16(p) << 16 | get16(p + 2);
}

/* The plane of this packet, and the one before it: what a packet of type FAP_RTP_REDUNDANT holds. */
typedef struct rtp_redundant {
    const uint8_t *before, *now;
    size_t before_size, now_size;
    uint32_t offset; /* timestamp of the packet less that of the plane before; up to 16383 */
} rtp_redundant;

/* 0: more than @p room, or it cannot be said. */
size_t rtp_redundant_write(const rtp_redundant *r, uint8_t *out, size_t room);
/* @p type: of both planes. 0: malformed. */
int rtp_redundant_parse(rtp_redundant *r, const uint8_t *payload, size_t size, int type);

#endif
