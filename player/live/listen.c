/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * live_listen(): packets come in, wait their time, are decoded and posed. What is lost is a call of the decoder without data: the
 * face goes on as it moved, eases to rest, and is exact again with the next I plane.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <unistd.h>

#include <fap/decoder.h>
#include <fap/derive.h>
#include <fap/rtp.h>
#include <fap/sdp.h>

#include "common/file.h"
#include "common/json.h"
#include "common/net/udp.h"
#include "common/tool.h"
#include "player/live/live.h"
#include "player/scene.h"

enum { REPORT_US = 5000000, QUIET_US = 1000000, MOST_SDP = 1 << 16 };
static const double usual_rate_hz = 25;

typedef struct listening {
    const live_options *o;
    fault *f;
    scene scene;
    play_report report;
    fap_decoder *decoder;
    fap_rtp_receiver *rtp;
    void *sink;
    sink_setup setup;
    int socket, report_socket;
    udp_address at;
    fap_sdp sdp; /* all 0: there is none */
    int64_t begin_us, reported_us, packet_us, number, concealed;
    double rate_hz;
    int no_signal; /* that has been said */
} listening;

/* --- to begin with --- */

/* An URL, or a description's file: what it says of the stream is kept. */
static int find_address(listening *l)
{
    char where[FAP_ERROR_TEXT_SIZE] = "", url[FAP_SDP_HOST_SIZE + 32];
    const char *dot = strrchr(l->o->listen, '.');
    uint8_t *data;
    size_t size;

    if (!dot || strcmp(dot, ".sdp") != 0)
        return udp_address_parse(&l->at, l->o->listen, "rtp", l->f);
    errno = 0;
    fap_err err = file_read(l->o->listen, MOST_SDP, &data, &size);
    if (err == FAP_OK) {
        err = fap_sdp_read(&l->sdp, data, size, where);
        free(data);
    }
    if (err != FAP_OK)
        return fault_set(l->f, EXIT_DATA, "%s: %s", l->o->listen,
                         *where                     ? where
                         : err == FAP_E_IO && errno ? strerror(errno)
                                                    : fap_strerror(err));
    snprintf(url, sizeof url, strchr(l->sdp.host, ':') ? "rtp://[%s]:%u" : "rtp://%s:%u", l->sdp.host,
             l->sdp.port);
    return udp_address_parse(&l->at, url, "rtp", l->f);
}

static int open_sockets(listening *l)
{
    udp_address reports;

    if (!find_address(l))
        return 0;
    reports = l->at;
    udp_address_set_port(&reports, udp_address_port(&l->at) + 1);
    l->socket = udp_open_listening(&l->at, l->o->listen, l->f);
    if (l->socket >= 0)
        l->report_socket = udp_open_listening(&reports, "the port above, for reports", l->f);
    return l->report_socket >= 0;
}

static int open_rtp(listening *l)
{
    fap_rtp_receiver_config cfg;

    fap_rtp_receiver_config_init(&cfg);
    if (getrandom(&cfg.ssrc, sizeof cfg.ssrc, 0) != (ssize_t)sizeof cfg.ssrc)
        return fault_set(l->f, EXIT_DATA, "no random numbers from the system");
    cfg.delay_ms = l->o->delay_ms;
    cfg.any_source = l->o->any_source;
    if (l->sdp.payload_type) {
        cfg.payload_type = l->sdp.payload_type;
        cfg.redundant_type = l->sdp.redundant_type ? l->sdp.redundant_type : l->sdp.payload_type;
    }
    return (fap_rtp_receiver_open(&l->rtp, &cfg) == FAP_OK &&
            fap_decoder_open(&l->decoder, NULL) == FAP_OK) ||
           fault_set(l->f, EXIT_DATA, "out of memory");
}

static int open_face(listening *l)
{
    fap_face_config face;

    fap_face_config_init(&face);
    if (scene_load_bank(&l->scene, l->o->bank, &face, 0, &l->report))
        return 1;
    *l->f = l->report.fault;
    return 0;
}

static int open_sink(listening *l)
{
    const live_options *o = l->o;

    l->setup = (sink_setup){ .output = o->output ? o->output : "null",
                             .rate_hz = l->rate_hz,
                             .count = (int64_t)fmax(1, (o->seconds > 0 ? o->seconds : 3600) * usual_rate_hz),
                             .bank = l->scene.bank,
                             .csv = o->csv };
    l->sink = calloc(1, o->sink->state_size);
    if (!l->sink)
        return fault_set(l->f, EXIT_DATA, "out of memory");
    return o->sink->open(l->sink, &l->setup, l->f);
}

/* --- in --- */

static void hear_packets(listening *l)
{
    uint8_t data[FAP_RTP_MAX_PACKET];
    udp_address from;

    for (long n; (n = udp_receive(l->socket, data, sizeof data, &from)) >= 0;)
        if ((size_t)n <= sizeof data &&
            fap_rtp_receiver_put(l->rtp, udp_address_number(&from), data, (size_t)n, udp_now_us()) == FAP_OK)
            l->packet_us = udp_now_us();
}

/* Whoever sends a sender report gets ours. */
static void hear_reports(listening *l)
{
    uint8_t data[FAP_RTP_MAX_PACKET], answer[FAP_RTP_REPORT_SIZE];
    udp_address from;

    for (long n; (n = udp_receive(l->report_socket, data, sizeof data, &from)) >= 0;) {
        const int64_t now_us = udp_now_us();
        if ((size_t)n > sizeof data)
            continue;
        fap_rtp_receiver_heard(l->rtp, data, (size_t)n, now_us);
        if (now_us - l->reported_us < REPORT_US / 2)
            continue; /* reports are not answered faster than they are due, whoever asks */
        const size_t size = fap_rtp_receiver_report(l->rtp, now_us, answer);
        if (!size)
            continue;
        udp_send(l->report_socket, &from, answer, size);
        l->reported_us = now_us;
    }
}

/* --- out --- */

static int show(listening *l, fap_frame *frame)
{
    fap_derive(frame);
    l->scene.frame = *frame;
    fap_face_pose(l->scene.face, frame, l->scene.position, NULL);
    fap_face_points(l->scene.face, l->scene.point);
    const shown_frame shown = { .number = l->number,
                                .time_s = (double)l->number / l->rate_hz,
                                .point = (const float(*)[3])l->scene.point,
                                .frame = &l->scene.frame,
                                .position = l->scene.position,
                                .weight = fap_face_weights(l->scene.face) };
    l->number++;
    return l->o->sink->show(l->sink, &shown, l->f);
}

/* All frames of what was sent to the decoder. What is broken has been concealed. */
static int show_decoded(listening *l)
{
    fap_frame frame;

    for (int broken = 0; broken < 64;) {
        const fap_err err = fap_decoder_receive(l->decoder, &frame);
        if (err == FAP_E_AGAIN || err == FAP_E_END)
            break;
        if (err != FAP_OK) {
            broken++;
            continue;
        }
        const fap_plane_info *plane = fap_decoder_plane(l->decoder);
        l->rate_hz = plane->rate_hz > 0 ? plane->rate_hz : l->rate_hz;
        l->concealed += plane->concealed;
        if (!show(l, &frame))
            return 0;
    }
    return 1;
}

static int show_lost(listening *l, int64_t lost_us)
{
    const int64_t frames = (int64_t)((double)lost_us * l->rate_hz / 1e6 + 0.5);

    for (int64_t i = 0; i < frames && i < 1000; i++)
        if (fap_decoder_send(l->decoder, NULL, 0) != FAP_OK || !show_decoded(l))
            return 0;
    return 1;
}

static void say_signal(listening *l, int64_t now_us)
{
    const int quiet = l->packet_us && now_us - l->packet_us > QUIET_US;

    if (quiet != l->no_signal)
        tool_note(quiet ? "no signal" : "signal again");
    l->no_signal = quiet;
}

static int show_due(listening *l)
{
    fap_rtp_unit u;

    say_signal(l, udp_now_us());
    while (fap_rtp_receiver_get(l->rtp, udp_now_us(), &u) == FAP_OK) {
        if (!u.data) {
            if (!show_lost(l, u.lost_us))
                return 0;
            continue;
        }
        if (fap_decoder_send(l->decoder, u.data, u.size) != FAP_OK || !show_decoded(l))
            return 0;
    }
    return 1;
}

static int listen_all(listening *l)
{
    l->begin_us = udp_now_us();
    for (;;) {
        const int64_t now_us = udp_now_us(), next_us = fap_rtp_receiver_next_us(l->rtp);
        const int64_t end_us = l->o->seconds > 0 ? l->begin_us + (int64_t)(l->o->seconds * 1e6) : INT64_MAX;
        if (now_us >= end_us)
            return 1;
        const int64_t then_us = next_us < end_us ? next_us : end_us;
        udp_wait(l->socket, l->report_socket, then_us == INT64_MAX ? QUIET_US : then_us - now_us);
        hear_packets(l);
        hear_reports(l);
        if (!show_due(l))
            return 0;
    }
}

/* --- told --- */

static void say(const listening *l)
{
    const fap_rtp_receiver_stats st = fap_rtp_receiver_get_stats(l->rtp);

    tool_note("%s: %lld frames, %lld of them concealed; %llu packets, %llu lost, %llu late, %llu twice, %llu "
              "from others, %llu "
              "that are none",
              l->o->listen, (long long)l->number, (long long)l->concealed, (unsigned long long)st.packets,
              (unsigned long long)st.lost, (unsigned long long)st.late, (unsigned long long)st.duplicate,
              (unsigned long long)st.foreign, (unsigned long long)st.malformed);
    tool_note("  jitter %.2f ms, packets wait %.0f ms, the sender's clock is off by %.0f ppm", st.jitter_ms,
              st.delay_ms, st.drift_ppm);
    if (!l->o->json)
        return;
    json j = { .out = stdout };
    json_open(&j, NULL, '{');
    json_string(&j, "at", l->o->listen);
    json_string(&j, "face", fap_bank_name(l->scene.bank));
    json_integer(&j, "frames", l->number);
    json_integer(&j, "concealed", l->concealed);
    json_integer(&j, "packets", (int64_t)st.packets);
    json_integer(&j, "lost", (int64_t)st.lost);
    json_integer(&j, "late", (int64_t)st.late);
    json_integer(&j, "duplicate", (int64_t)st.duplicate);
    json_integer(&j, "foreign", (int64_t)st.foreign);
    json_integer(&j, "malformed", (int64_t)st.malformed);
    json_integer(&j, "flooded", (int64_t)st.flooded);
    json_integer(&j, "restored", (int64_t)st.restored);
    json_number(&j, "jitter_ms", st.jitter_ms);
    json_number(&j, "delay_ms", st.delay_ms);
    json_number(&j, "drift_ppm", st.drift_ppm);
    json_close(&j, '}');
    fputc('\n', stdout);
}

int live_listen(const live_options *o, fault *f)
{
    listening *l = calloc(1, sizeof *l);

    if (!l)
        return fault_set(f, EXIT_DATA, "out of memory");
    l->o = o;
    l->f = f;
    l->socket = l->report_socket = -1;
    l->rate_hz = usual_rate_hz;
    sink_result result = { 0 };
    const int ok = open_face(l) && open_sockets(l) && open_rtp(l) && open_sink(l) && listen_all(l) &&
                   o->sink->finish(l->sink, &result, f);
    if (ok)
        say(l);
    if (l->sink)
        o->sink->close(l->sink);
    free(l->sink);
    if (l->socket >= 0)
        close(l->socket);
    if (l->report_socket >= 0)
        close(l->report_socket);
    fap_rtp_receiver_close(&l->rtp);
    fap_decoder_close(&l->decoder);
    scene_free(&l->scene);
    free(l);
    return ok;
}
