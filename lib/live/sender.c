/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From planes to packets. A packet holds whole planes only, and an I plane is the first of its packet: who loses others can begin
 * with it. While receivers report loss, each packet repeats the last plane of the one before (RFC 2198): a single loss then costs
 * nothing but the bytes.
 */
#include <string.h>

#include "base/mem.h"
#include "live/rtp.h"

enum { MOST_AGGREGATE = 16, MOST_PAYLOAD = FAP_RTP_MAX_PACKET - FAP_RTP_HEADER };
/* Loss that is worth repeating planes for, and that is not any more: apart, so that it does not flicker. */
static const double begin_repeating = 0.01, stop_repeating = 0.002;

typedef struct gathered {
    uint8_t data[MOST_PAYLOAD];
    size_t size, last; /* last: where its last plane begins */
    int count;
    uint32_t timestamp, last_timestamp;
} gathered;

struct fap_rtp_sender {
    fap_rtp_sender_config cfg;
    gathered filling, before; /* before: the packet sent last */
    int ready;                /* filling is full */
    uint16_t sequence;
    int repeating;
    uint8_t out[FAP_RTP_MAX_PACKET];
    int64_t media_us, reported_us; /* of the last plane; when we reported last, and ... */
    uint32_t reported;             /* ... the middle of the NTP time that this was */
    fap_rtp_sender_stats stats;
    fap_allocator alloc;
};

void fap_rtp_sender_config_init(fap_rtp_sender_config *cfg)
{
    *cfg = (fap_rtp_sender_config){ .struct_size = sizeof *cfg, .aggregate = 1, .redundancy = -1 };
}

fap_err fap_rtp_sender_open(fap_rtp_sender **sender, const fap_rtp_sender_config *cfg)
{
    const fap_allocator alloc = fap_mem_allocator(&cfg->alloc);

    *sender = NULL;
    if (cfg->aggregate < 1 || cfg->aggregate > MOST_AGGREGATE || cfg->redundancy < -1 || cfg->redundancy > 1)
        return FAP_E_ARG;
    fap_rtp_sender *s = fap_mem_calloc(&alloc, 1, sizeof *s);
    if (!s)
        return FAP_E_NOMEM;
    s->cfg = *cfg;
    s->alloc = alloc;
    s->sequence = cfg->first_sequence;
    s->repeating = cfg->redundancy == 1;
    *sender = s;
    return FAP_OK;
}

void fap_rtp_sender_close(fap_rtp_sender **sender)
{
    if (!*sender)
        return;
    const fap_allocator alloc = (*sender)->alloc;
    fap_mem_free(&alloc, *sender);
    *sender = NULL;
}

static uint32_t ticks(const fap_rtp_sender *s, int64_t pts_us)
{
    return s->cfg.first_timestamp + (uint32_t)(uint64_t)(pts_us * (FAP_RTP_CLOCK_HZ / 10000) / 100);
}

fap_err fap_rtp_sender_put(fap_rtp_sender *s, const uint8_t *plane, size_t size, int64_t pts_us, int intra)
{
    gathered *g = &s->filling;

    if (size > MOST_PAYLOAD - REDUNDANT_HEADER)
        return FAP_E_LIMIT;
    if (s->ready || (g->count && (intra || size > MOST_PAYLOAD - REDUNDANT_HEADER - g->size))) {
        s->ready = 1;
        return FAP_E_AGAIN;
    }
    if (!g->count)
        g->timestamp = ticks(s, pts_us);
    g->last = g->size;
    g->last_timestamp = ticks(s, pts_us);
    memcpy(g->data + g->size, plane, size);
    g->size += size;
    s->media_us = pts_us;
    s->stats.payload_bytes += size;
    s->ready = ++g->count == s->cfg.aggregate;
    return FAP_OK;
}

/* The payload with the last plane of the packet before, where that is wanted and has room. */
static size_t repeat(const fap_rtp_sender *s, uint8_t *out)
{
    const gathered *g = &s->filling, *b = &s->before;
    const rtp_redundant r = { .before = b->data + b->last,
                              .before_size = b->size - b->last,
                              .now = g->data,
                              .now_size = g->size,
                              .offset = g->timestamp - b->last_timestamp };

    return s->repeating && b->count ? rtp_redundant_write(&r, out, MOST_PAYLOAD) : 0;
}

fap_err fap_rtp_sender_get(fap_rtp_sender *s, int flush, const uint8_t **data, size_t *size)
{
    gathered *g = &s->filling;
    uint8_t both[MOST_PAYLOAD];

    if (!g->count || (!s->ready && !flush))
        return FAP_E_AGAIN;
    const size_t repeated = repeat(s, both);
    const fap_rtp_packet packet = { .payload_type = repeated ? FAP_RTP_REDUNDANT : FAP_RTP_PAYLOAD,
                                    .marker = 1, /* every packet ends an access unit */
                                    .sequence = s->sequence++,
                                    .timestamp = g->timestamp,
                                    .ssrc = s->cfg.ssrc,
                                    .payload = repeated ? both : g->data,
                                    .size = repeated ? repeated : g->size };
    *size = fap_rtp_write(&packet, s->out, sizeof s->out);
    *data = s->out;
    s->stats.packets++;
    s->stats.bytes += *size;
    s->stats.repeated += repeated > 0;
    s->before = *g;
    g->count = 0;
    g->size = 0;
    s->ready = 0;
    return FAP_OK;
}

/* --- reports --- */

size_t fap_rtp_sender_report(fap_rtp_sender *s, int64_t now_us, uint64_t ntp,
                             uint8_t out[FAP_RTP_REPORT_SIZE])
{
    out[0] = 2 << 6;
    out[1] = RTCP_SENDER_REPORT;
    put16(out + 2, 6);
    put32(out + 4, s->cfg.ssrc);
    put32(out + 8, (uint32_t)(ntp >> 32));
    put32(out + 12, (uint32_t)ntp);
    put32(out + 16, ticks(s, s->media_us));
    put32(out + 20, (uint32_t)s->stats.packets);
    put32(out + 24, (uint32_t)s->stats.payload_bytes);
    s->reported_us = now_us;
    s->reported = (uint32_t)(ntp >> 16);
    return 28;
}

/* "Last report" is the middle of our NTP time; of another report than the last we know no instant. */
static void take_block(fap_rtp_sender *s, const uint8_t *block, int64_t now_us)
{
    if (get32(block) != s->cfg.ssrc)
        return;
    s->stats.reported_loss = block[4] / 256.0;
    if (s->cfg.redundancy < 0)
        s->repeating = s->stats.reported_loss > (s->repeating ? stop_repeating : begin_repeating);
    const double held_ms = get32(block + 20) / 65.536, whole_ms = (double)(now_us - s->reported_us) / 1000;
    if (s->reported && get32(block + 16) == s->reported && whole_ms >= held_ms)
        s->stats.round_trip_ms = whole_ms - held_ms;
}

void fap_rtp_sender_heard(fap_rtp_sender *s, const void *data, size_t size, int64_t now_us)
{
    const uint8_t *p = data;

    if (size < 8 || p[0] >> 6 != 2 || p[1] != RTCP_RECEIVER_REPORT)
        return;
    for (size_t i = 0; i < (size_t)(p[0] & 31) && 8 + 24 * (i + 1) <= size; i++)
        take_block(s, p + 8 + 24 * i, now_us);
}

fap_rtp_sender_stats fap_rtp_sender_get_stats(const fap_rtp_sender *s)
{
    return s->stats;
}
