/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * live_send(): the stream's frames are coded anew with no look-ahead and leave when they are due. Reports go out every five
 * seconds, to the port above (RFC 3550 section 11), and what listeners answer there switches repeating on and off.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include <fap/encoder.h>
#include <fap/rtp.h>
#include <fap/sdp.h>

#include "common/file.h"
#include "common/json.h"
#include "common/net/udp.h"
#include "common/tool.h"
#include "player/live/live.h"
#include "player/scene.h"

enum { REPORT_US = 5000000, HEADERS_UDP_IP = 28, SIMPLE_FACE_LEVEL_1 = 0x61 };

typedef struct sending {
    const live_options *o;
    fault *f;
    scene scene;
    play_report report;
    fap_encoder *encoder;
    fap_rtp_sender *rtp;
    uint8_t *plane;
    size_t room;
    udp_address to, reports_to;
    int socket;
    uint32_t ssrc;
    int64_t begin_us, reported_us;
    int64_t frames;
} sending;

static uint64_t ntp_now(void)
{
    const uint64_t from_1900 = 2208988800U;
    struct timespec t;

    clock_gettime(CLOCK_REALTIME, &t);
    return ((uint64_t)t.tv_sec + from_1900) << 32 | (uint64_t)((double)t.tv_nsec * 4.294967296);
}

/* --- to begin with --- */

static int open_encoder(sending *s)
{
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    cfg.rate_hz = s->scene.line.rate_hz;
    cfg.mode = FAP_ENCODE_ERROR;
    cfg.max_error_mm = s->o->max_error_mm;
    cfg.look_ahead = 0;
    cfg.intra = s->o->intra ? s->o->intra : (int)fmax(1, fmin(10000, s->scene.line.rate_hz + 0.5));
    cfg.skip = 0; /* a packet a frame: silence is loss */
    cfg.plane_codes = s->o->aggregate > 1;
    const fap_err err = fap_encoder_open(&s->encoder, &cfg);
    if (err != FAP_OK)
        return fault_set(s->f, EXIT_DATA, "%s: cannot be coded live: %s", s->o->stream, fap_strerror(err));
    s->room = fap_encoder_bound(s->encoder);
    s->plane = malloc(s->room);
    return s->plane || fault_set(s->f, EXIT_DATA, "out of memory");
}

static int open_rtp(sending *s)
{
    fap_rtp_sender_config cfg;
    uint32_t dice[3];

    if (getrandom(dice, sizeof dice, 0) != (ssize_t)sizeof dice)
        return fault_set(s->f, EXIT_DATA, "no random numbers from the system");
    fap_rtp_sender_config_init(&cfg);
    cfg.ssrc = s->ssrc = dice[0];
    cfg.first_timestamp = dice[1];
    cfg.first_sequence = (uint16_t)dice[2];
    cfg.aggregate = s->o->aggregate;
    cfg.redundancy = s->o->redundancy;
    return fap_rtp_sender_open(&s->rtp, &cfg) == FAP_OK || fault_set(s->f, EXIT_DATA, "out of memory");
}

/* The description is there before the first packet, whole or not at all. */
static int write_sdp(sending *s)
{
    fap_sdp sdp = { .port = (uint16_t)udp_address_port(&s->to),
                    .session = s->ssrc,
                    .payload_type = FAP_RTP_PAYLOAD,
                    .redundant_type = s->o->redundancy ? FAP_RTP_REDUNDANT : 0,
                    .clock_hz = FAP_RTP_CLOCK_HZ,
                    .profile_level = SIMPLE_FACE_LEVEL_1 };
    char text[FAP_SDP_MAX_SIZE];
    out_file out;

    if (!s->o->sdp)
        return 1;
    udp_address_host(&s->to, sdp.host, sizeof sdp.host);
    const size_t size = fap_sdp_write(&sdp, text, sizeof text);
    if (!size)
        return fault_set(s->f, EXIT_DATA, "%s: its address cannot be described", s->o->send);
    errno = 0;
    fap_err err = out_file_open(&out, s->o->sdp);
    if (err == FAP_OK) {
        err = fwrite(text, 1, size, out.stream) == size ? FAP_OK : FAP_E_IO;
        if (err == FAP_OK)
            err = out_file_commit(&out);
        else
            out_file_abandon(&out);
    }
    return err == FAP_OK ||
           fault_set(s->f, EXIT_DATA, "%s: %s", s->o->sdp, errno ? strerror(errno) : fap_strerror(err));
}

static int open_all(sending *s)
{
    s->socket = -1;
    if (!udp_address_parse(&s->to, s->o->send, "rtp", s->f))
        return 0;
    s->reports_to = s->to;
    udp_address_set_port(&s->reports_to, udp_address_port(&s->to) + 1);
    if (!scene_load_stream(&s->scene, s->o->stream, NULL, &s->report)) {
        *s->f = s->report.fault;
        return 0;
    }
    s->socket = udp_open_sending(&s->to, s->o->send, s->f);
    return s->socket >= 0 && open_encoder(s) && open_rtp(s) && write_sdp(s);
}

/* --- on the way --- */

static void hear_reports(sending *s)
{
    uint8_t data[FAP_RTP_MAX_PACKET];
    udp_address from;

    for (long n; (n = udp_receive(s->socket, data, sizeof data, &from)) >= 0;)
        if ((size_t)n <= sizeof data && udp_address_number(&from) == udp_address_number(&s->reports_to))
            fap_rtp_sender_heard(s->rtp, data, (size_t)n, udp_now_us());
}

static void report(sending *s, int64_t now_us)
{
    uint8_t data[FAP_RTP_REPORT_SIZE];

    if (s->reported_us && now_us - s->reported_us < REPORT_US)
        return;
    s->reported_us = now_us;
    udp_send(s->socket, &s->reports_to, data, fap_rtp_sender_report(s->rtp, now_us, ntp_now(), data));
}

static void wait_until(sending *s, int64_t then_us)
{
    for (int64_t now; (now = udp_now_us()) < then_us;) {
        udp_wait(s->socket, -1, then_us - now);
        hear_reports(s);
    }
}

static void flush(sending *s, int whatever)
{
    const uint8_t *data;
    size_t size;

    while (fap_rtp_sender_get(s->rtp, whatever, &data, &size) == FAP_OK)
        udp_send(s->socket, &s->to, data, size);
}

static int is_intra(const uint8_t *plane, size_t size)
{
    return size > 4 && !plane[0] && !plane[1] && plane[2] == 1;
}

static int send_plane(sending *s, size_t size, int64_t pts_us)
{
    fap_err err =
        fap_rtp_sender_put(s->rtp, s->plane, size, pts_us, is_intra(s->plane, size) && s->o->aggregate == 1);

    if (err == FAP_E_AGAIN) {
        flush(s, 1);
        err = fap_rtp_sender_put(s->rtp, s->plane, size, pts_us, 0);
    }
    flush(s, 0);
    return err == FAP_OK || fault_set(s->f, EXIT_DATA, "a plane of %zu bytes is larger than a packet", size);
}

static int send_frame(sending *s, const fap_frame *frame)
{
    size_t size;

    if (fap_encoder_send(s->encoder, frame) != FAP_OK)
        return fault_set(s->f, EXIT_DATA, "%s: a frame cannot be coded", s->o->stream);
    if (fap_encoder_receive(s->encoder, s->plane, s->room, &size) != FAP_OK || !size)
        return 1;
    s->frames++;
    return send_plane(s, size, frame->pts_us);
}

static int is_over(const sending *s)
{
    return s->o->seconds > 0 && (double)(udp_now_us() - s->begin_us) > s->o->seconds * 1e6;
}

static int send_all(sending *s)
{
    const timeline *line = &s->scene.line;
    const double frame_us = 1e6 / line->rate_hz;
    int64_t number = 0;

    s->begin_us = udp_now_us();
    do
        for (int64_t k = 0; k < timeline_frame_count(line, line->rate_hz) && !is_over(s); k++, number++) {
            fap_frame frame;
            const int64_t pts_us = (int64_t)((double)number * frame_us + 0.5);
            timeline_sample(line, timeline_time_us(k, line->rate_hz), &frame);
            frame.pts_us = pts_us;
            wait_until(s, s->begin_us + pts_us);
            report(s, udp_now_us());
            if (!send_frame(s, &frame))
                return 0;
        }
    while (s->o->loop && !is_over(s));
    flush(s, 1);
    return 1;
}

/* --- told --- */

static void say(const sending *s)
{
    const fap_rtp_sender_stats st = fap_rtp_sender_get_stats(s->rtp);
    const double seconds = fmax(1e-3, (double)s->frames / s->scene.line.rate_hz);
    const double kbps = 8e-3 * (double)(st.bytes + HEADERS_UDP_IP * st.packets) / seconds;

    tool_note("%s: %lld frames in %llu packets, %.2f kbit/s on the wire (%.2f of it FAPs)", s->o->send,
              (long long)s->frames, (unsigned long long)st.packets, kbps,
              8e-3 * (double)st.payload_bytes / seconds);
    if (s->reported_us && st.reported_loss > 0)
        tool_note("  a listener lost %.1f %%, %llu packets repeated a plane", 100 * st.reported_loss,
                  (unsigned long long)st.repeated);
    if (!s->o->json)
        return;
    json j = { .out = stdout };
    json_open(&j, NULL, '{');
    json_string(&j, "to", s->o->send);
    json_integer(&j, "frames", s->frames);
    json_integer(&j, "packets", (int64_t)st.packets);
    json_number(&j, "kbps_on_wire", kbps);
    json_number(&j, "kbps_of_faps", 8e-3 * (double)st.payload_bytes / seconds);
    json_integer(&j, "repeated", (int64_t)st.repeated);
    json_number(&j, "reported_loss", st.reported_loss);
    json_number(&j, "round_trip_ms", st.round_trip_ms);
    json_close(&j, '}');
    fputc('\n', stdout);
}

int live_send(const live_options *o, fault *f)
{
    sending *s = calloc(1, sizeof *s);

    if (!s)
        return fault_set(f, EXIT_DATA, "out of memory");
    s->o = o;
    s->f = f;
    const int ok = open_all(s) && send_all(s);
    if (ok)
        say(s);
    if (s->socket >= 0)
        close(s->socket);
    fap_rtp_sender_close(&s->rtp);
    fap_encoder_close(&s->encoder);
    scene_free(&s->scene);
    free(s->plane);
    free(s);
    return ok;
}
