/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * From packets to planes in time. A packet is due at its media time plus an offset between the sender's clock and ours, plus a
 * delay. The offset is that of the fastest packet of late, let up a little with each packet, so that it follows a sender whose
 * clock is slow; the delay follows the jitter. Sources: RFC 3550 sections 6.4.1, A.1, A.3, A.8; RFC 2198.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "live/rtp.h"

enum {
    SLOTS = 64, /* packets that may be ahead of the one that is due */
    PROBATION = 3,
    TRIALS = 8, /* sources that may be on trial at once: noise in between is no reason to miss one */
    MOST_PAYLOAD = FAP_RTP_MAX_PACKET - FAP_RTP_HEADER,
    SECOND_US = 1000000,
    FRAME_US = 40000, /* until two packets in a row tell it */
    SLOWEST_US = 1000000,
    LET_UP_US = 20 /* a packet: 500 ppm at 25 packets a second */
};
/* Jitters that are waited for, and how fast the delay follows. */
static const double jitters = 4, follow = 1.0 / 32;
/* A packet this much slower than the offset says is of a sender that has paused, or of another route. */
static const int64_t paused_us = 1000000;

typedef struct slot {
    int used;
    int64_t sequence, media_us;
    uint8_t marker;
    uint16_t size;
    uint8_t data[MOST_PAYLOAD];
} slot;

/* Who may become the source. */
typedef struct candidate {
    uint64_t source;
    uint32_t ssrc;
    uint16_t next;
    int count;
} candidate;

struct fap_rtp_receiver {
    fap_rtp_receiver_config cfg;
    slot slot[SLOTS];
    slot out; /* what was given last */
    candidate on_trial[TRIALS];
    unsigned oldest_trial;
    uint64_t source;
    uint32_t ssrc;
    int locked;
    int64_t heard_us; /* the last packet of the source */
    /* Numbers without end: sequence and media time as they go on. */
    int64_t first, highest, played; /* sequence; played: the last that was given or given up */
    uint32_t last_timestamp;
    int64_t last_ticks;
    int64_t played_media_us, unit_us;
    /* Time. */
    int64_t offset_us, first_offset_us, first_us, last_transit_us;
    double jitter_us, delay_us;
    int64_t second_us;
    int in_second;
    /* Reports. */
    uint64_t expected_before, received_before, received;
    uint32_t sender_report; /* middle of its NTP time; 0: none */
    int64_t sender_report_us;
    fap_rtp_receiver_stats stats;
    fap_allocator alloc;
};

void fap_rtp_receiver_config_init(fap_rtp_receiver_config *cfg)
{
    *cfg = (fap_rtp_receiver_config){ .struct_size = sizeof *cfg,
                                      .payload_type = FAP_RTP_PAYLOAD,
                                      .redundant_type = FAP_RTP_REDUNDANT,
                                      .delay_ms = 60,
                                      .least_delay_ms = 20,
                                      .most_delay_ms = 400,
                                      .most_packets_s = 250 };
}

fap_err fap_rtp_receiver_open(fap_rtp_receiver **receiver, const fap_rtp_receiver_config *cfg)
{
    const fap_allocator alloc = fap_mem_allocator(&cfg->alloc);

    *receiver = NULL;
    if (cfg->delay_ms < 0 || cfg->least_delay_ms < 0 || cfg->most_delay_ms < cfg->least_delay_ms ||
        cfg->most_packets_s < 1)
        return FAP_E_ARG;
    fap_rtp_receiver *r = fap_mem_calloc(&alloc, 1, sizeof *r);
    if (!r)
        return FAP_E_NOMEM;
    r->cfg = *cfg;
    r->alloc = alloc;
    *receiver = r;
    return FAP_OK;
}

void fap_rtp_receiver_close(fap_rtp_receiver **receiver)
{
    if (!*receiver)
        return;
    const fap_allocator alloc = (*receiver)->alloc;
    fap_mem_free(&alloc, *receiver);
    *receiver = NULL;
}

/* --- whom to listen to --- */

static void settle(fap_rtp_receiver *r, uint64_t source, const fap_rtp_packet *p, int64_t now_us)
{
    for (int i = 0; i < SLOTS; i++)
        r->slot[i].used = 0;
    r->locked = r->stats.locked = 1;
    r->source = source;
    r->ssrc = p->ssrc;
    r->first = r->highest = p->sequence;
    r->played = (int64_t)p->sequence - 1;
    r->last_timestamp = p->timestamp;
    r->last_ticks = 0;
    r->unit_us = FRAME_US;
    r->played_media_us = -FRAME_US;
    r->offset_us = r->first_offset_us = r->last_transit_us = r->first_us = now_us;
    r->jitter_us = 0;
    r->delay_us = 1000.0 * r->cfg.delay_ms;
    r->expected_before = r->received_before = r->received = 0;
    r->sender_report = 0;
}

/* Three in a row of one source: noise does not come in order. */
static int passes_trial(fap_rtp_receiver *r, uint64_t source, const fap_rtp_packet *p)
{
    candidate *c = NULL;

    for (int i = 0; i < TRIALS && !c; i++)
        if (r->on_trial[i].count && r->on_trial[i].source == source && r->on_trial[i].ssrc == p->ssrc)
            c = &r->on_trial[i];
    const int goes_on = c && c->next == p->sequence;
    if (!c)
        c = &r->on_trial[r->oldest_trial++ % TRIALS];

    *c = (candidate){ source, p->ssrc, (uint16_t)(p->sequence + 1), goes_on ? c->count + 1 : 1 };
    return c->count >= (r->cfg.any_source ? 1 : PROBATION);
}

/* 1: the packet is the source's. */
static int is_heard(fap_rtp_receiver *r, uint64_t source, const fap_rtp_packet *p, int64_t now_us)
{
    const int same = r->locked && r->source == source && r->ssrc == p->ssrc;

    if (same)
        return 1;
    if (r->locked && !r->cfg.any_source)
        return 0;
    if (!passes_trial(r, source, p))
        return 0;
    settle(r, source, p, now_us);
    return 1;
}

/* Of the source, or of all while there is none: others' packets do not use up what the source may send. */
static int floods(fap_rtp_receiver *r, int64_t now_us)
{
    if (now_us - r->second_us >= SECOND_US || now_us < r->second_us) {
        r->second_us = now_us;
        r->in_second = 0;
    }
    return ++r->in_second > r->cfg.most_packets_s;
}

/* --- time --- */

static int64_t us_of(int64_t ticks)
{
    return ticks * 100 / (FAP_RTP_CLOCK_HZ / 10000);
}

static void follow_time(fap_rtp_receiver *r, int64_t media_us, int64_t now_us)
{
    const int64_t transit = now_us - media_us;

    r->jitter_us += (fabs((double)(transit - r->last_transit_us)) - r->jitter_us) / 16;
    r->last_transit_us = transit;
    if (transit < r->offset_us || transit - r->offset_us > paused_us)
        r->offset_us = transit;
    else
        r->offset_us += transit - r->offset_us < LET_UP_US ? transit - r->offset_us : LET_UP_US;
    const double wanted =
        fmax(1000.0 * r->cfg.least_delay_ms, fmin(1000.0 * r->cfg.most_delay_ms, jitters * r->jitter_us));
    if (r->received > 32 || wanted > r->delay_us)
        r->delay_us += follow * (wanted - r->delay_us);
}

static int64_t due_us(const fap_rtp_receiver *r, int64_t media_us)
{
    return r->offset_us + media_us + (int64_t)r->delay_us;
}

/* --- what comes in --- */

static slot *slot_of(fap_rtp_receiver *r, int64_t sequence)
{
    return &r->slot[(uint64_t)sequence % SLOTS];
}

static fap_err keep(fap_rtp_receiver *r, int64_t sequence, int64_t media_us, const uint8_t *data, size_t size,
                    uint8_t marker)
{
    slot *s = slot_of(r, sequence);

    if (!size || size > MOST_PAYLOAD) {
        r->stats.malformed++;
        return FAP_E_DATA;
    }
    if (sequence <= r->played) {
        r->stats.late++;
        return FAP_E_LIMIT;
    }
    if (s->used && s->sequence == sequence) {
        r->stats.duplicate++;
        return FAP_E_LIMIT;
    }
    *s = (slot){
        .used = 1, .sequence = sequence, .media_us = media_us, .marker = marker, .size = (uint16_t)size
    };
    memcpy(s->data, data, size);
    return FAP_OK;
}

/* What is so far ahead that there is no room: the source has jumped, and what it left behind is lost. */
static void jump(fap_rtp_receiver *r, int64_t sequence, int64_t media_us)
{
    for (int i = 0; i < SLOTS; i++)
        r->slot[i].used = 0;
    r->stats.lost += (uint64_t)(sequence - 1 - r->played);
    r->played = sequence - 1;
    r->played_media_us = media_us - r->unit_us;
}

static int64_t go_on(int64_t before, int32_t step)
{
    return before + step;
}

static fap_err take(fap_rtp_receiver *r, const fap_rtp_packet *p, int64_t now_us)
{
    const int64_t sequence = go_on(r->highest, (int16_t)(uint16_t)(p->sequence - (uint16_t)r->highest));
    const int64_t ticks = go_on(r->last_ticks, (int32_t)(p->timestamp - r->last_timestamp)),
                  media = us_of(ticks);
    rtp_redundant both = { .now = p->payload, .now_size = p->size };

    if (p->payload_type == r->cfg.redundant_type &&
        !rtp_redundant_parse(&both, p->payload, p->size, r->cfg.payload_type)) {
        r->stats.malformed++;
        return FAP_E_DATA;
    }
    if (sequence - r->played > SLOTS)
        jump(r, sequence, media);
    if (sequence > r->highest) {
        if (sequence == r->highest + 1 && ticks > r->last_ticks && us_of(ticks - r->last_ticks) < SLOWEST_US)
            r->unit_us = us_of(ticks - r->last_ticks);
        r->highest = sequence;
        r->last_timestamp = p->timestamp;
        r->last_ticks = ticks;
    }
    const slot *before = slot_of(r, sequence - 1);
    if (both.before_size && sequence - 1 > r->played && !(before->used && before->sequence == sequence - 1))
        r->stats.restored +=
            keep(r, sequence - 1, us_of(ticks - both.offset), both.before, both.before_size, 1) == FAP_OK;
    const fap_err err = keep(r, sequence, media, both.now, both.now_size, p->marker);
    if (err == FAP_OK) {
        r->received++;
        r->stats.packets++;
        follow_time(r, media, now_us);
    }
    return err;
}

fap_err fap_rtp_receiver_put(fap_rtp_receiver *r, uint64_t source, const void *data, size_t size,
                             int64_t now_us)
{
    fap_rtp_packet p;

    if (fap_rtp_parse(&p, data, size) != FAP_OK ||
        (p.payload_type != r->cfg.payload_type && p.payload_type != r->cfg.redundant_type)) {
        r->stats.malformed++;
        return FAP_E_DATA;
    }
    if (!is_heard(r, source, &p, now_us)) {
        r->stats.foreign += r->locked;
        return FAP_E_LIMIT;
    }
    if (floods(r, now_us)) {
        r->stats.flooded++;
        return FAP_E_LIMIT;
    }
    r->heard_us = now_us;
    return take(r, &p, now_us);
}

/* --- what goes out --- */

/* The first packet that waits behind the one that is missing; NULL: none does. */
static const slot *next_waiting(const fap_rtp_receiver *r)
{
    const slot *next = NULL;

    for (int i = 0; i < SLOTS; i++)
        if (r->slot[i].used && r->slot[i].sequence > r->played &&
            (!next || r->slot[i].sequence < next->sequence))
            next = &r->slot[i];
    return next;
}

static fap_err give(fap_rtp_receiver *r, const slot *s, fap_rtp_unit *unit)
{
    r->out = *s;
    slot_of(r, s->sequence)->used = 0;
    r->played = r->out.sequence;
    r->played_media_us = r->out.media_us;
    *unit = (fap_rtp_unit){ r->out.data, r->out.size, r->out.media_us, 0, r->out.marker };
    return FAP_OK;
}

/* Up to the packet that waits, or one unit of time where none does. */
static fap_err give_up(fap_rtp_receiver *r, const slot *next, fap_rtp_unit *unit)
{
    const int64_t from = r->played_media_us + r->unit_us;
    const int64_t lost = next && next->media_us > from ? next->media_us - from : r->unit_us;

    *unit = (fap_rtp_unit){ .pts_us = from, .lost_us = lost };
    if (next) {
        r->stats.lost += (uint64_t)(next->sequence - 1 - r->played);
        r->played = next->sequence - 1;
        r->played_media_us = next->media_us - r->unit_us;
    } else
        r->played_media_us += lost;
    return FAP_OK;
}

fap_err fap_rtp_receiver_get(fap_rtp_receiver *r, int64_t now_us, fap_rtp_unit *unit)
{
    const slot *next = r->locked ? next_waiting(r) : NULL;

    if (!r->locked || (!next && !r->received))
        return FAP_E_AGAIN;
    if (next && next->sequence == r->played + 1)
        return now_us < due_us(r, next->media_us) ? FAP_E_AGAIN : give(r, next, unit);
    if (now_us < due_us(r, r->played_media_us + r->unit_us))
        return FAP_E_AGAIN;
    return give_up(r, next, unit);
}

int64_t fap_rtp_receiver_next_us(const fap_rtp_receiver *r)
{
    const slot *next = r->locked ? next_waiting(r) : NULL;

    if (!r->locked || (!next && !r->received))
        return INT64_MAX;
    return next && next->sequence == r->played + 1 ? due_us(r, next->media_us)
                                                   : due_us(r, r->played_media_us + r->unit_us);
}

/* --- reports --- */

void fap_rtp_receiver_heard(fap_rtp_receiver *r, const void *data, size_t size, int64_t now_us)
{
    const uint8_t *p = data;

    if (size < 28 || p[0] >> 6 != 2 || p[1] != RTCP_SENDER_REPORT || !r->locked || get32(p + 4) != r->ssrc)
        return;
    r->sender_report = get32(p + 10);
    r->sender_report_us = now_us;
}

/* Of what was sent since the last report; repeats and stragglers can make it less than none. */
static uint32_t fraction_lost(fap_rtp_receiver *r, uint64_t expected)
{
    const uint64_t sent = expected - r->expected_before, came = r->received - r->received_before;

    r->expected_before = expected;
    r->received_before = r->received;
    return sent > came ? (uint32_t)(((sent - came) << 8) / sent) : 0;
}

size_t fap_rtp_receiver_report(fap_rtp_receiver *r, int64_t now_us, uint8_t out[FAP_RTP_REPORT_SIZE])
{
    if (!r->locked)
        return 0;
    const uint64_t expected = (uint64_t)(r->highest - r->first + 1);
    const uint64_t lost = expected > r->received ? expected - r->received : 0;
    const uint32_t fraction = fraction_lost(r, expected);

    out[0] = 2 << 6 | 1;
    out[1] = RTCP_RECEIVER_REPORT;
    put16(out + 2, 7);
    put32(out + 4, r->cfg.ssrc);
    put32(out + 8, r->ssrc);
    put32(out + 12, (fraction > 255 ? 255 : fraction) << 24 | (uint32_t)(lost < 0x7fffff ? lost : 0x7fffff));
    put32(out + 16, (uint32_t)r->highest);
    put32(out + 20, (uint32_t)(r->jitter_us * FAP_RTP_CLOCK_HZ / 1e6));
    put32(out + 24, r->sender_report);
    put32(out + 28, r->sender_report ? (uint32_t)((double)(now_us - r->sender_report_us) * 0.065536) : 0);
    return 32;
}

fap_rtp_receiver_stats fap_rtp_receiver_get_stats(const fap_rtp_receiver *r)
{
    fap_rtp_receiver_stats s = r->stats;
    const int64_t since = r->heard_us - r->first_us;

    s.jitter_ms = r->jitter_us / 1000;
    s.delay_ms = r->delay_us / 1000;
    s.drift_ppm = since > SECOND_US ? 1e6 * (double)(r->offset_us - r->first_offset_us) / (double)since : 0;
    return s;
}
