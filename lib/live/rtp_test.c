/* SPDX-License-Identifier: BSD-2-Clause */
/* Packets are sent by one side and heard by the other, over a network that the test makes up. */
#include "tests/test.h"

#include <string.h>

#include "live/rtp.h"

enum { FRAME_US = 40000, FROM = 7 };

/* --- one packet --- */

TEST(rtp, a_packet_is_what_it_was)
{
    const uint8_t plane[] = "plane";
    const fap_rtp_packet in = { 96, 1, 65535, 0x12345678, 0xdeadbeef, plane, 5 };
    fap_rtp_packet out;
    uint8_t bytes[32];

    assert_int_equal(fap_rtp_write(&in, bytes, sizeof bytes), 17);
    assert_int_equal(fap_rtp_parse(&out, bytes, 17), FAP_OK);
    assert_true(out.payload_type == 96 && out.marker == 1 && out.sequence == 65535);
    assert_true(out.timestamp == 0x12345678 && out.ssrc == 0xdeadbeef && out.size == 5);
    assert_memory_equal(out.payload, plane, 5);
    assert_int_equal(fap_rtp_write(&in, bytes, 16), 0);
}

TEST(rtp, contributors_extension_and_padding_are_stepped_over)
{
    uint8_t bytes[12 + 4 + 4 + 4 + 3 + 2] = { 0x80 | 0x20 | 0x10 | 1, 96 };
    fap_rtp_packet out;

    bytes[12 + 4 + 3] = 1; /* a word of extension */
    memcpy(bytes + 24, "abc", 3);
    bytes[28] = 2; /* of padding */
    assert_int_equal(fap_rtp_parse(&out, bytes, sizeof bytes), FAP_OK);
    assert_int_equal(out.size, 3);
    assert_memory_equal(out.payload, "abc", 3);
}

TEST(rtp, what_is_shorter_than_it_says_is_no_packet)
{
    uint8_t bytes[40] = { 0x80, 96 };
    fap_rtp_packet out;

    for (size_t n = 0; n < 12; n++)
        assert_int_equal(fap_rtp_parse(&out, bytes, n), FAP_E_DATA);
    bytes[0] = 0x80 | 15;
    assert_int_equal(fap_rtp_parse(&out, bytes, 40), FAP_E_DATA);
    bytes[0] = 0x80 | 0x10;
    bytes[14] = 0xff;
    assert_int_equal(fap_rtp_parse(&out, bytes, 40), FAP_E_DATA);
    bytes[0] = 0x80 | 0x20;
    bytes[39] = 29;
    assert_int_equal(fap_rtp_parse(&out, bytes, 40), FAP_E_DATA);
    bytes[39] = 0;
    assert_int_equal(fap_rtp_parse(&out, bytes, 40), FAP_E_DATA);
    bytes[0] = 0x40;
    assert_int_equal(fap_rtp_parse(&out, bytes, 40), FAP_E_DATA);
}

TEST(rtp, a_redundant_payload_that_is_cut_is_refused)
{
    const uint8_t a[] = "before", b[] = "now";
    const rtp_redundant in = { a, b, 6, 3, 3600 };
    rtp_redundant out;
    uint8_t bytes[32];

    assert_int_equal(rtp_redundant_write(&in, bytes, sizeof bytes), 14);
    assert_true(rtp_redundant_parse(&out, bytes, 14, 96));
    assert_true(out.offset == 3600 && out.before_size == 6 && out.now_size == 3);
    assert_memory_equal(out.now, b, 3);
    for (size_t n = 0; n < 11; n++)
        assert_false(rtp_redundant_parse(&out, bytes, n, 96));
    assert_int_equal(rtp_redundant_write(&(rtp_redundant){ a, b, 6, 3, 16384 }, bytes, sizeof bytes), 0);
}

/* --- both sides --- */

typedef struct wire {
    fap_rtp_sender *sender;
    fap_rtp_receiver *receiver;
    int frame;
} wire;

static void open_wire(wire *w, int aggregate, int redundancy, uint16_t first)
{
    fap_rtp_sender_config s;
    fap_rtp_receiver_config r;

    memset(w, 0, sizeof *w);
    fap_rtp_sender_config_init(&s);
    s.ssrc = 42;
    s.first_sequence = first;
    s.first_timestamp = 0xffffff00;
    s.aggregate = aggregate;
    s.redundancy = redundancy;
    assert_int_equal(fap_rtp_sender_open(&w->sender, &s), FAP_OK);
    fap_rtp_receiver_config_init(&r);
    r.ssrc = 43;
    assert_int_equal(fap_rtp_receiver_open(&w->receiver, &r), FAP_OK);
}

static void close_wire(wire *w)
{
    fap_rtp_sender_close(&w->sender);
    fap_rtp_receiver_close(&w->receiver);
}

/* The next frame's packet; its plane says its number. */
static size_t next_packet(wire *w, uint8_t *out)
{
    const uint8_t plane[3] = { 'p', (uint8_t)(w->frame >> 8), (uint8_t)w->frame }, *data;
    size_t size;

    assert_int_equal(fap_rtp_sender_put(w->sender, plane, 3, (int64_t)w->frame * FRAME_US, w->frame == 0),
                     FAP_OK);
    w->frame++;
    assert_int_equal(fap_rtp_sender_get(w->sender, 0, &data, &size), FAP_OK);
    memcpy(out, data, size);
    return size;
}

static fap_err hear(wire *w, const uint8_t *data, size_t size, int64_t now_us)
{
    return fap_rtp_receiver_put(w->receiver, FROM, data, size, now_us);
}

/* Frames sent in time until one of that number has been heard. */
static void run_until(wire *w, int frame)
{
    while (w->frame < frame) {
        uint8_t p[64];
        const int64_t now = (int64_t)w->frame * FRAME_US;
        hear(w, p, next_packet(w, p), now);
    }
}

/* Everything that is due: numbers of planes, -1 for each that is lost. */
static int collect(wire *w, int64_t now_us, int *out, int room)
{
    fap_rtp_unit u;
    int count = 0;

    while (count < room && fap_rtp_receiver_get(w->receiver, now_us, &u) == FAP_OK)
        out[count++] = u.data ? u.data[1] << 8 | u.data[2] : -1;
    return count;
}

TEST(rtp, planes_come_out_in_order_and_in_time)
{
    wire w;
    int got[64];

    open_wire(&w, 1, 0, 10);
    run_until(&w, 12);
    /* The first two were on trial; the third is due 60 ms after it came. */
    assert_int_equal(collect(&w, 2 * FRAME_US + 59000, got, 64), 0);
    assert_int_equal(collect(&w, 2 * FRAME_US + 61000, got, 64), 1);
    assert_int_equal(got[0], 2);
    assert_int_equal(collect(&w, 11 * FRAME_US + 61000, got, 64), 9);
    for (int i = 0; i < 9; i++)
        assert_int_equal(got[i], 3 + i);
    close_wire(&w);
}

TEST(rtp, what_overtakes_waits_what_comes_twice_is_dropped)
{
    wire w;
    uint8_t a[64], b[64];
    int got[64];

    open_wire(&w, 1, 0, 65530);
    run_until(&w, 9); /* the numbers have begun again from 0 */
    const size_t an = next_packet(&w, a), bn = next_packet(&w, b);
    assert_int_equal(hear(&w, b, bn, 9 * FRAME_US + 1000), FAP_OK);
    assert_int_equal(hear(&w, a, an, 9 * FRAME_US + 2000), FAP_OK);
    assert_int_equal(hear(&w, a, an, 9 * FRAME_US + 3000), FAP_E_LIMIT);
    assert_int_equal(collect(&w, 20 * FRAME_US, got, 9), 9);
    for (int i = 0; i < 9; i++)
        assert_int_equal(got[i], 2 + i);
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).duplicate, 1);
    close_wire(&w);
}

TEST(rtp, a_loss_is_told_in_time_and_the_next_plane_is_not_held_up)
{
    wire w;
    uint8_t p[64];
    int got[64];

    open_wire(&w, 1, 0, 1);
    run_until(&w, 8);
    const size_t lost = next_packet(&w, p);
    run_until(&w, 12);
    const int count = collect(&w, 11 * FRAME_US + 100000, got, 64);
    assert_true(count >= 10 && got[5] == 7 && got[6] == -1 && got[7] == 9);
    assert_int_equal(hear(&w, p, lost, 11 * FRAME_US + 100000), FAP_E_LIMIT);
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).lost, 1);
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).late, 1);
    close_wire(&w);
}

TEST(rtp, silence_is_a_loss_each_frame)
{
    wire w;
    int got[64];

    open_wire(&w, 1, 0, 1);
    run_until(&w, 6);
    const int count = collect(&w, 5 * FRAME_US + 61000 + 10 * FRAME_US, got, 64);
    assert_true(count >= 13 && count <= 15);
    for (int i = 4; i < count; i++)
        assert_int_equal(got[i], -1);
    close_wire(&w);
}

TEST(rtp, a_repeated_plane_makes_up_for_a_lost_packet)
{
    wire w;
    uint8_t p[64];
    int got[64];

    open_wire(&w, 1, 1, 1);
    run_until(&w, 8);
    next_packet(&w, p); /* never arrives */
    run_until(&w, 12);
    const int count = collect(&w, 12 * FRAME_US, got, 64);
    for (int i = 0; i < count; i++)
        assert_int_equal(got[i], 2 + i);
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).restored, 1);
    close_wire(&w);
}

TEST(rtp, reported_loss_switches_repeating_on_and_off)
{
    wire w;
    uint8_t p[64], report[FAP_RTP_REPORT_SIZE];

    open_wire(&w, 1, -1, 1);
    run_until(&w, 30);
    fap_rtp_sender_heard(w.sender, report, fap_rtp_receiver_report(w.receiver, 30 * FRAME_US, report),
                         30 * FRAME_US);
    for (int i = 0; i < 40; i++) {
        const size_t n = next_packet(&w, p);
        assert_int_equal(p[1] & 0x7f, FAP_RTP_PAYLOAD);
        if (i % 8)
            hear(&w, p, n, (int64_t)w.frame * FRAME_US);
    }
    fap_rtp_sender_heard(w.sender, report, fap_rtp_receiver_report(w.receiver, 70 * FRAME_US, report),
                         70 * FRAME_US);
    assert_true(fap_rtp_sender_get_stats(w.sender).reported_loss > 0.08);
    next_packet(&w, p);
    assert_int_equal(p[1] & 0x7f, FAP_RTP_REDUNDANT);
    run_until(&w, 100);
    fap_rtp_receiver_report(w.receiver, 100 * FRAME_US, report);
    run_until(&w, 140);
    fap_rtp_sender_heard(w.sender, report, fap_rtp_receiver_report(w.receiver, 140 * FRAME_US, report),
                         140 * FRAME_US);
    next_packet(&w, p);
    assert_int_equal(p[1] & 0x7f, FAP_RTP_PAYLOAD);
    close_wire(&w);
}

TEST(rtp, a_round_trip_is_measured_by_two_reports)
{
    wire w;
    uint8_t report[FAP_RTP_REPORT_SIZE];

    open_wire(&w, 1, -1, 1);
    run_until(&w, 10);
    const size_t n = fap_rtp_sender_report(w.sender, 1000000, 0x0123456789abcdef, report);
    fap_rtp_receiver_heard(w.receiver, report, n, 5020000); /* 20 ms later, by another clock */
    const size_t back = fap_rtp_receiver_report(w.receiver, 5320000, report);
    fap_rtp_sender_heard(w.sender, report, back, 1350000);
    assert_float_equal(fap_rtp_sender_get_stats(w.sender).round_trip_ms, 50, 0.1);
    close_wire(&w);
}

TEST(rtp, others_are_not_heard_and_noise_does_not_keep_the_source_out)
{
    wire w;
    uint8_t p[64], other[64];
    wire stranger;

    open_wire(&w, 1, 0, 1);
    open_wire(&stranger, 1, 0, 500);
    for (int i = 0; i < 4; i++) {
        const size_t n = next_packet(&w, p), m = next_packet(&stranger, other);
        assert_int_equal(fap_rtp_receiver_put(w.receiver, (uint64_t)(100 + i), other, m, i * FRAME_US),
                         FAP_E_LIMIT);
        hear(&w, p, n, i * FRAME_US);
    }
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).locked, 1);
    const size_t m = next_packet(&stranger, other);
    for (int i = 0; i < 1000; i++)
        assert_int_equal(fap_rtp_receiver_put(w.receiver, 9, other, m, 5 * FRAME_US), FAP_E_LIMIT);
    run_until(&w, 10);
    assert_true(fap_rtp_receiver_get_stats(w.receiver).packets >= 8);
    assert_int_equal(fap_rtp_receiver_get_stats(w.receiver).flooded, 0);
    close_wire(&w);
    close_wire(&stranger);
}

TEST(rtp, a_source_that_floods_is_held_to_its_rate)
{
    wire w;
    uint8_t p[64];

    open_wire(&w, 1, 0, 1);
    run_until(&w, 5);
    for (int i = 0; i < 600; i++)
        hear(&w, p, next_packet(&w, p), 5 * FRAME_US);
    assert_true(fap_rtp_receiver_get_stats(w.receiver).flooded > 300);
    close_wire(&w);
}

TEST(rtp, planes_are_gathered_and_an_intra_plane_begins_a_packet)
{
    wire w;
    const uint8_t plane[4] = { 1, 2, 3, 4 }, *data;
    size_t size;

    open_wire(&w, 4, 0, 1);
    for (int i = 0; i < 3; i++)
        assert_int_equal(fap_rtp_sender_put(w.sender, plane, 4, i * FRAME_US, i == 0), FAP_OK);
    assert_int_equal(fap_rtp_sender_get(w.sender, 0, &data, &size), FAP_E_AGAIN);
    assert_int_equal(fap_rtp_sender_put(w.sender, plane, 4, 3 * FRAME_US, 1), FAP_E_AGAIN);
    assert_int_equal(fap_rtp_sender_get(w.sender, 0, &data, &size), FAP_OK);
    assert_int_equal(size, FAP_RTP_HEADER + 12);
    assert_int_equal(fap_rtp_sender_put(w.sender, plane, 4, 3 * FRAME_US, 1), FAP_OK);
    assert_int_equal(fap_rtp_sender_get(w.sender, 1, &data, &size), FAP_OK);
    assert_int_equal(size, FAP_RTP_HEADER + 4);
    close_wire(&w);
}

TEST(rtp, a_clock_that_drifts_is_followed)
{
    wire w;
    int got[4], late = 0;

    open_wire(&w, 1, 0, 1);
    for (int i = 0; i < 3000; i++) { /* two minutes, 200 ppm slow */
        uint8_t p[64];
        const int64_t now = (int64_t)w.frame * FRAME_US * 10002 / 10000;
        hear(&w, p, next_packet(&w, p), now);
        const int n = collect(&w, now, got, 4);
        for (int k = 0; k < n; k++)
            late += got[k] < 0;
    }
    assert_int_equal(late, 0);
    assert_float_equal(fap_rtp_receiver_get_stats(w.receiver).drift_ppm, 200, 20);
    close_wire(&w);
}

TEST(rtp, a_jittery_network_makes_the_delay_longer_and_a_calm_one_shorter)
{
    wire w;
    uint32_t seed = 5;
    double rough = 0;

    open_wire(&w, 1, 0, 1);
    for (int i = 0; i < 800; i++) {
        uint8_t p[64];
        int got[8];
        seed = seed * 1664525u + 1013904223u;
        const int64_t jitter = i < 400 ? (int64_t)(seed >> 8) % 80000 : 0,
                      now = (int64_t)w.frame * FRAME_US + jitter;
        hear(&w, p, next_packet(&w, p), now);
        collect(&w, now, got, 8);
        if (i == 399)
            rough = fap_rtp_receiver_get_stats(w.receiver).delay_ms;
    }
    assert_true(rough > 70);
    assert_true(fap_rtp_receiver_get_stats(w.receiver).delay_ms < 30);
    close_wire(&w);
}
