/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Recorded Live Link Face packets, big endian: u8 6, i32 length and device, i32 length and subject, i32 frame, float sub
 * frame, i32 numerator and denominator of the rate, u8 61, 61 floats in the order of the table's columns. They
 * come one behind the other, each behind its u32 length (with a head of u8 and u32 count, or without), in a pcap file as
 * UDP, and any of these in a gzip. Source: packets of the app; pcap: its public description.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shape/inflate.h"
#include "take/coef.h"

enum {
    VERSION = 6,
    NAME_MAX_BYTES = 256,
    SHOWN_VALUES = FAP_ARKIT_COUNT + FAP_ARKIT_ANGLE_COUNT,
    UNPACKED_MAX = 1 << 28
};

/* Bytes that are read once, from front to back. Past the end everything is 0 and bad. */
typedef struct cursor {
    const uint8_t *at;
    size_t left;
    int bad;
} cursor;

static const uint8_t *take_bytes(cursor *c, size_t n)
{
    const uint8_t *at = c->at;

    if (n > c->left) {
        c->bad = 1;
        return NULL;
    }
    c->at += n;
    c->left -= n;
    return at;
}

static uint32_t u8(cursor *c)
{
    const uint8_t *p = take_bytes(c, 1);
    return p ? *p : 0;
}

static uint32_t u32(cursor *c)
{
    const uint8_t *p = take_bytes(c, 4);
    return p ? (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3] : 0;
}

static float real(cursor *c)
{
    const uint32_t bits = u32(c);
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* --- one packet --- */

typedef struct packet {
    const uint8_t *device, *subject;
    uint32_t device_size, subject_size;
    double time_s;
    float value[SHOWN_VALUES];
} packet;

static const uint8_t *read_name(cursor *c, uint32_t *size)
{
    *size = u32(c);
    if (*size > NAME_MAX_BYTES)
        c->bad = 1;
    return c->bad ? NULL : take_bytes(c, *size);
}

/* 1: a packet, and @p c is behind it; 0: none, @p c is where it was. */
static int read_packet(cursor *c, packet *p)
{
    cursor in = *c;

    if (u8(&in) != VERSION)
        return 0;
    p->device = read_name(&in, &p->device_size);
    p->subject = read_name(&in, &p->subject_size);
    const int32_t frame = (int32_t)u32(&in);
    const double sub = real(&in);
    const int32_t numerator = (int32_t)u32(&in), denominator = (int32_t)u32(&in);
    if (u8(&in) != SHOWN_VALUES || numerator <= 0 || denominator <= 0 || !isfinite(sub))
        return 0;
    for (int i = 0; i < SHOWN_VALUES; i++)
        p->value[i] = real(&in);
    p->time_s = ((double)frame + sub) * denominator / numerator;
    if (in.bad)
        return 0;
    *c = in;
    return 1;
}

/* --- packets in files --- */

typedef struct recording {
    coef_rows *rows; /* NULL: only count */
    uint64_t packets, broken;
    packet first; /* whose device and subject it is */
    uint64_t others;
} recording;

static int same_bytes(const uint8_t *a, uint32_t a_size, const uint8_t *b, uint32_t b_size)
{
    return a_size == b_size && (!a_size || !memcmp(a, b, a_size));
}

static void use(recording *r, const packet *p)
{
    if (!r->packets && !r->others)
        r->first = *p;
    if (!same_bytes(p->device, p->device_size, r->first.device, r->first.device_size) ||
        !same_bytes(p->subject, p->subject_size, r->first.subject, r->first.subject_size)) {
        r->others++;
        return;
    }
    r->packets++;
    if (!r->rows)
        return;
    const int64_t row = coef_rows_add(r->rows, p->time_s, 0);
    for (uint32_t i = 0; i < SHOWN_VALUES; i++)
        coef_set(r->rows, row, i, (double)p->value[i]);
}

/* One behind the other; what is no packet is passed over byte by byte. */
static void walk_plain(cursor c, recording *r)
{
    packet p;

    while (c.left) {
        if (read_packet(&c, &p)) {
            use(r, &p);
        } else {
            r->broken++;
            take_bytes(&c, 1);
        }
    }
}

/* Each behind its length. */
static void walk_lengths(cursor c, recording *r)
{
    packet p;

    while (c.left && !c.bad) {
        const uint32_t size = u32(&c);
        cursor one = { c.at, size, 0 };
        if (take_bytes(&c, size) && read_packet(&one, &p))
            use(r, &p);
        else
            r->broken++;
    }
}

/* --- pcap --- */

enum { LINK_NULL = 0, LINK_ETHERNET = 1, LINK_RAW = 101, LINK_LINUX = 113, IP_UDP = 17 };

static uint32_t u32_of(const uint8_t *p, int swapped)
{
    return swapped ? (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]
                   : (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

/* Microseconds or nanoseconds, in the byte order of whoever wrote it; -1: no pcap. */
static int pcap_order(const uint8_t *data, size_t size)
{
    for (int swapped = 0; size >= 24 && swapped < 2; swapped++) {
        const uint32_t magic = u32_of(data, swapped);
        if (magic == 0xa1b2c3d4 || magic == 0xa1b23c4d)
            return swapped;
    }
    return -1;
}

static size_t link_size(uint32_t link)
{
    return link == LINK_ETHERNET ? 14 : link == LINK_LINUX ? 16 : link == LINK_NULL ? 4 : 0;
}

/* What a UDP datagram carries, of IPv4 without fragments. */
static int udp_of(cursor *c, uint32_t link)
{
    if (!take_bytes(c, link_size(link)) || c->left < 20)
        return 0;
    const uint8_t *ip = c->at;
    const size_t head = (size_t)(ip[0] & 15) * 4;
    const int is_udp = ip[0] >> 4 == 4 && ip[9] == IP_UDP && !(ip[6] & 0x3f) && !ip[7];
    return is_udp && head >= 20 && take_bytes(c, head) && take_bytes(c, 8);
}

static void walk_pcap(cursor c, recording *r, int swapped)
{
    const uint32_t link = u32_of(c.at + 20, swapped) & 0xffff;
    packet p;

    take_bytes(&c, 24);
    for (;;) {
        const uint8_t *head = take_bytes(&c, 16);
        if (!head)
            return;
        const uint32_t size = u32_of(head + 8, swapped);
        cursor one = { c.at, size, 0 };
        if (!take_bytes(&c, size))
            return;
        if (udp_of(&one, link) && read_packet(&one, &p))
            use(r, &p);
    }
}

/* --- which of them --- */

typedef enum shape { NO_PACKETS, PLAIN, LENGTHS, COUNTED, PCAP, GZIP } shape;

static int starts_with_packet(const uint8_t *data, size_t size, size_t skip)
{
    cursor c = { data + skip, size > skip ? size - skip : 0, 0 };
    packet p;

    return size > skip && read_packet(&c, &p);
}

static shape shape_of(const uint8_t *data, size_t size)
{
    enum { COUNT_HEAD = 5, LENGTH = 4 };

    if (size >= 18 && data[0] == 0x1f && data[1] == 0x8b)
        return GZIP;
    if (pcap_order(data, size) >= 0)
        return PCAP;
    return starts_with_packet(data, size, 0)                     ? PLAIN
           : starts_with_packet(data, size, LENGTH)              ? LENGTHS
           : starts_with_packet(data, size, COUNT_HEAD + LENGTH) ? COUNTED
                                                                 : NO_PACKETS;
}

static void walk(shape kind, const uint8_t *data, size_t size, recording *r)
{
    cursor c = { data, size, 0 };

    if (kind == PCAP)
        walk_pcap(c, r, pcap_order(data, size));
    else if (kind == PLAIN)
        walk_plain(c, r);
    else {
        if (kind == COUNTED)
            take_bytes(&c, 5);
        walk_lengths(c, r);
    }
}

static int packets_claims(const uint8_t *data, size_t size)
{
    const shape kind = shape_of(data, size);
    return kind == GZIP || kind == PCAP ? 30 : kind != NO_PACKETS ? 90 : 0;
}

static fap_err read_packets(take_source *src, const uint8_t *data, size_t size, coef_rows *rows)
{
    const shape kind = shape_of(data, size);
    recording count = { 0 }, all = { .rows = rows };

    if (kind != NO_PACKETS && kind != GZIP)
        walk(kind, data, size, &count);
    if (!count.packets)
        return take_fail(src, FAP_E_UNKNOWN_FORMAT, "no Live Link packet of version %d in it", VERSION);
    const fap_err err = coef_rows_open(src, rows, SHOWN_VALUES, count.packets);
    if (err != FAP_OK)
        return err;
    for (uint32_t i = 0; i < SHOWN_VALUES; i++)
        rows->take->channel[i] = (uint8_t)i;
    rows->clock = COEF_CLOCK_SECONDS;
    walk(kind, data, size, &all);
    if (all.broken)
        coef_note(rows->take, "%llu %s are no packets of version %d and are passed over",
                  (unsigned long long)all.broken, kind == PLAIN ? "bytes" : "packets", VERSION);
    if (all.others)
        coef_note(rows->take, "%llu packets are of another device or subject and are left out",
                  (unsigned long long)all.others);
    return FAP_OK;
}

static fap_err packets_read(take_source *src, coef_rows *rows)
{
    uint8_t *data;
    size_t size;

    if (shape_of(src->data, src->size) != GZIP)
        return read_packets(src, src->data, src->size, rows);
    const fap_err unpacked = fap_gunzip(src->data, src->size, UNPACKED_MAX, &data, &size);
    if (unpacked != FAP_OK)
        return take_fail(src, unpacked,
                         unpacked == FAP_E_UNSUPPORTED ? "a gzip; built without zlib"
                                                       : "a gzip that cannot be unpacked");
    const fap_err err = read_packets(src, data, size, rows);
    free(data);
    return err;
}

const coef_driver coef_driver_packets = { "livelink packets", packets_claims, packets_read };
