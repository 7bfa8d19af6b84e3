/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What RTP costs, and what a bad network does to a face: takes are coded frame by frame as fapplay --send does, sent through a
 * network that loses packets by lot and holds each up for 20 to 50 ms, so that some overtake others, and heard as fapplay --listen
 * does. Time is counted, not waited for. A report goes back every second.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>
#include <fap/rtp.h>
#include <fap/sensitivity.h>

#include "bench.h"
#include "takes.h"

enum {
    SEEDS = 5,
    STEP_US = 5000,
    ON_THE_WAY = 64,
    HEADERS_UDP_IP = 28,
    REPORT_US = 1000000,
    TAIL_US = 500000
};

typedef struct letter {
    int64_t arrives_us;
    int first_frame;
    size_t size;
    uint8_t data[FAP_RTP_MAX_PACKET];
} letter;

typedef struct network {
    bench_take *take;
    const fap_sensitivity *face;
    int percent, aggregate;
    uint32_t seed;
    fap_encoder *encoder;
    fap_decoder *decoder;
    fap_rtp_sender *sender;
    fap_rtp_receiver *receiver;
    uint8_t *plane;
    size_t room;
    letter way[ON_THE_WAY];
    int sent, gathered,
        base; /* frames sent; in the packet to come; which one the receiver counts from, -1: none yet */
    uint64_t sum_nm, items;
} network;

static uint32_t draw(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static int open_network(network *n)
{
    fap_encoder_config e;
    fap_rtp_sender_config s;
    fap_rtp_receiver_config r;

    fap_encoder_config_init(&e);
    e.rate_hz = n->take->rate_hz;
    e.mode = FAP_ENCODE_ERROR;
    e.look_ahead = 0;
    e.skip = 0;
    e.intra = (int)lrint(fmax(1, n->take->rate_hz));
    e.plane_codes = n->aggregate > 1;
    fap_rtp_sender_config_init(&s);
    s.aggregate = n->aggregate;
    fap_rtp_receiver_config_init(&r);
    n->base = -1;
    if (fap_encoder_open(&n->encoder, &e) != FAP_OK || fap_decoder_open(&n->decoder, NULL) != FAP_OK ||
        fap_rtp_sender_open(&n->sender, &s) != FAP_OK || fap_rtp_receiver_open(&n->receiver, &r) != FAP_OK)
        return 0;
    n->room = fap_encoder_bound(n->encoder);
    n->plane = malloc(n->room);
    return n->plane != NULL;
}

static void close_network(network *n)
{
    fap_encoder_close(&n->encoder);
    fap_decoder_close(&n->decoder);
    fap_rtp_sender_close(&n->sender);
    fap_rtp_receiver_close(&n->receiver);
    free(n->plane);
}

static void post(network *n, int64_t now_us, int flush)
{
    const uint8_t *data;
    size_t size;

    while (fap_rtp_sender_get(n->sender, flush, &data, &size) == FAP_OK) {
        const int lost = draw(&n->seed) % 100 < (uint32_t)n->percent;
        const int64_t arrives = now_us + 20000 + (n->percent ? draw(&n->seed) % 30000 : 0);
        const int first = n->sent - n->gathered;
        n->gathered = 0;
        for (int i = 0; i < ON_THE_WAY && !lost; i++)
            if (!n->way[i].size) {
                n->way[i] = (letter){ .arrives_us = arrives, .first_frame = first, .size = size };
                memcpy(n->way[i].data, data, size);
                break;
            }
    }
}

static int send_frame(network *n, int64_t now_us)
{
    fap_frame f = n->take->frame[n->sent];
    size_t size;

    f.pts_us = (int64_t)(n->sent * 1e6 / n->take->rate_hz + 0.5);
    if (fap_encoder_send(n->encoder, &f) != FAP_OK ||
        fap_encoder_receive(n->encoder, n->plane, n->room, &size) != FAP_OK ||
        fap_rtp_sender_put(n->sender, n->plane, size, f.pts_us, 0) != FAP_OK)
        return 0;
    n->sent++;
    n->gathered++;
    post(n, now_us, 0);
    return 1;
}

static void deliver(network *n, int64_t now_us)
{
    for (;;) {
        letter *next = NULL;
        for (int i = 0; i < ON_THE_WAY; i++)
            if (n->way[i].size && n->way[i].arrives_us <= now_us &&
                (!next || n->way[i].arrives_us < next->arrives_us))
                next = &n->way[i];
        if (!next)
            return;
        const fap_err err = fap_rtp_receiver_put(n->receiver, 1, next->data, next->size, next->arrives_us);
        if (n->base < 0 && err == FAP_OK)
            n->base = next->first_frame;
        next->size = 0;
    }
}

static void show(network *n, int *number)
{
    fap_frame f;

    while (fap_decoder_receive(n->decoder, &f) == FAP_OK) {
        fap_frame_error e;
        if (*number < n->take->count) {
            fap_sensitivity_compare(n->face, &n->take->frame[*number], &f, &e);
            n->sum_nm += e.sum_nm;
            n->items += (uint64_t)e.items;
        }
        (*number)++;
    }
}

static void hear(network *n, int64_t now_us)
{
    fap_rtp_unit u;

    while (fap_rtp_receiver_get(n->receiver, now_us, &u) == FAP_OK) {
        int number = n->base + (int)lrint((double)u.pts_us * n->take->rate_hz / 1e6);
        const int lost = u.data ? 1 : (int)lrint((double)u.lost_us * n->take->rate_hz / 1e6);
        for (int i = 0; i < lost; i++)
            if (fap_decoder_send(n->decoder, u.data, u.size) == FAP_OK)
                show(n, &number);
    }
}

static void report(network *n, int64_t now_us)
{
    uint8_t data[FAP_RTP_REPORT_SIZE];
    const size_t size = now_us % REPORT_US ? 0 : fap_rtp_receiver_report(n->receiver, now_us, data);

    if (size)
        fap_rtp_sender_heard(n->sender, data, size, now_us);
}

static int run(network *n)
{
    const double frame_us = 1e6 / n->take->rate_hz;
    int64_t now_us = 0;

    for (; n->sent < n->take->count; now_us += STEP_US) {
        while (n->sent < n->take->count && n->sent * frame_us <= (double)now_us)
            if (!send_frame(n, now_us))
                return 0;
        deliver(n, now_us);
        hear(n, now_us);
        report(n, now_us);
    }
    post(n, now_us, 1);
    for (const int64_t end_us = now_us + TAIL_US; now_us < end_us; now_us += STEP_US)
        deliver(n, now_us);
    hear(n, (int64_t)(n->sent * frame_us));
    return 1;
}

/* --- at 25 frames a second --- */

static const double rate_hz = 25;

static void between(const fap_frame *a, const fap_frame *b, double t, fap_frame *out)
{
    *out = *a;
    for (int f = 3; f <= FAP_COUNT; f++)
        if (a->state[f] == FAP_CODED && b->state[f] == FAP_CODED)
            out->value[f] = (int32_t)lrint(a->value[f] + t * (b->value[f] - a->value[f]));
}

/* 0: no memory. */
static int resample(const bench_take *t, bench_take *out)
{
    *out = (bench_take){ .rate_hz = rate_hz };
    const int count = (int)(t->count * rate_hz / t->rate_hz);
    for (int k = 0; k < count; k++) {
        const double at = k * t->rate_hz / rate_hz;
        const int i = (int)at, j = i + 1 < t->count ? i + 1 : i;
        fap_frame f;
        between(&t->frame[i], &t->frame[j], at - i, &f);
        if (!bench_take_add_frame(out, &f))
            return 0;
    }
    return count > 0;
}

/* --- figures --- */

typedef struct asked {
    int percent, aggregate;
} asked;

/* Mean error, or kbit/s where nothing is lost; below 0: it failed. */
static double measure_frames(bench_take *t, const fap_sensitivity *face, asked a)
{
    double sum = 0;
    const int seeds = a.percent ? SEEDS : 1;

    for (uint32_t seed = 1; seed <= (uint32_t)seeds; seed++) {
        network *n = calloc(1, sizeof *n);
        if (!n)
            return -1;
        *n = (network){
            .take = t, .face = face, .percent = a.percent, .aggregate = a.aggregate, .seed = seed
        };
        const int ok = open_network(n) && run(n);
        const fap_rtp_sender_stats st =
            ok ? fap_rtp_sender_get_stats(n->sender) : (fap_rtp_sender_stats){ 0 };
        sum += !ok         ? -1e9
               : a.percent ? 1e-6 * (double)n->sum_nm / (double)(n->items ? n->items : 1)
                           : 8e-3 * (double)(st.bytes + HEADERS_UDP_IP * st.packets) / bench_take_length_s(t);
        close_network(n);
        free(n);
    }
    return sum / seeds;
}

static double measure_take(const bench_take *t, const fap_sensitivity *face, asked a)
{
    bench_take even;
    const double value = resample(t, &even) ? measure_frames(&even, face, a) : -1;

    free(even.frame);
    free(even.data);
    return value;
}

static double measure(asked a)
{
    double value[BENCH_MAX_TAKES], median = -1;
    fap_sensitivity face;
    bench_takes t = { 0 };
    fap_bank *bank = bench_bank();
    int i = 0;

    if (!bank)
        return -1;
    fap_sensitivity_of_bank(bank, &face);
    fap_bank_close(&bank);
    bench_takes_add(&t);
    for (; i < t.count && (value[i] = measure_take(&t.take[i], &face, a)) >= 0; i++)
        bench_note(t.take[i].name, value[i], a.percent ? "mm" : "kbit/s");
    if (i && i == t.count)
        median = bench_median(value, t.count);
    bench_takes_free(&t);
    return median;
}

double bench_rtp_kbps_on_wire(void)
{
    return measure((asked){ 0, 1 });
}

double bench_rtp_kbps_on_wire_aggregate_4(void)
{
    return measure((asked){ 0, 4 });
}

double bench_net_loss_error_mm_1(void)
{
    return measure((asked){ 1, 1 });
}

double bench_net_loss_error_mm_5(void)
{
    return measure((asked){ 5, 1 });
}

double bench_net_loss_error_mm_10(void)
{
    return measure((asked){ 10, 1 });
}

double bench_net_loss_error_mm_20(void)
{
    return measure((asked){ 20, 1 });
}
