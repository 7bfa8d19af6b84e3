/* SPDX-License-Identifier: BSD-2-Clause */
/* See takes.h. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"
#include "common/streams.h"
#include "takes.h"

enum { WAVE_FRAMES = 6000, WAVE_FAPS = 58, FIRST_FAP = 3 };

static const double shortest_s = 10;
static const char streams_dir[] = "../shared/data/fap";

int bench_take_add_frame(bench_take *t, const fap_frame *f)
{
    if (t->count == t->room) {
        t->room = 2 * t->room + 256;
        fap_frame *larger = realloc(t->frame, (size_t)t->room * sizeof *larger);
        if (!larger)
            return 0;
        t->frame = larger;
    }
    t->frame[t->count++] = *f;
    return 1;
}

int bench_take_reserve(bench_take *t, size_t more)
{
    if (t->size + more > t->data_room) {
        t->data_room = 2 * (t->size + more);
        uint8_t *larger = realloc(t->data, t->data_room);
        if (!larger)
            return 0;
        t->data = larger;
    }
    return 1;
}

int bench_take_write(void *user, const void *data, size_t size)
{
    bench_take *t = user;

    if (!bench_take_reserve(t, size))
        return 1;
    memcpy(t->data + t->size, data, size);
    t->size += size;
    return 0;
}

double bench_take_length_s(const bench_take *t)
{
    return 1e-6 * (double)(t->frame[t->count - 1].pts_us - t->frame[0].pts_us) + 1 / t->rate_hz;
}

static void free_take(bench_take *t)
{
    free(t->frame);
    free(t->data);
    *t = (bench_take){ 0 };
}

void bench_takes_free(bench_takes *t)
{
    while (t->count)
        free_take(&t->take[--t->count]);
}

/* --- streams --- */

static fap_err sink_frame(void *user, const fap_frame *f)
{
    return bench_take_add_frame(user, f) ? FAP_OK : FAP_E_NOMEM;
}

static int read_fap(bench_take *t, const char *path, double least_s)
{
    const frame_sink sink = { .put = sink_frame, .user = t };
    char where[FAP_ERROR_TEXT_SIZE];
    stream_summary summary;
    uint8_t *data;
    size_t size;

    if (file_read(path, 1 << 26, &data, &size) != FAP_OK)
        return 0;
    const fap_err err = stream_read(data, size, NULL, &summary, &sink, where);
    free(data);
    t->rate_hz = summary.header.rate_hz;
    return err == FAP_OK && t->count && bench_take_length_s(t) >= least_s;
}

static void add_stream(bench_takes *t, const char *name, double least_s)
{
    char path[512];
    bench_take *next = &t->take[t->count];

    snprintf(path, sizeof path, "%s/%s", streams_dir, name);
    if (!read_fap(next, path, least_s)) {
        free_take(next);
        return;
    }
    snprintf(next->name, sizeof next->name, "%s", name);
    t->count++;
}

static int is_fap(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && !strcmp(dot, ".fap");
}

static void add_streams(bench_takes *t, double least_s)
{
    struct dirent **entry;
    const int count = scandir(streams_dir, &entry, is_fap, alphasort);

    for (int i = 0; i < count; i++) {
        if (t->count < BENCH_MAX_TAKES - 1) /* waves may come behind them */
            add_stream(t, entry[i]->d_name, least_s);
        free(entry[i]);
    }
    if (count >= 0)
        free(entry);
}

/* --- the demo take --- */

static void capture_demo(bench_take *t, const uint8_t *c3d, size_t c3d_size, const uint8_t *map,
                         size_t map_size)
{
    fap_capture_config cfg;
    fap_capture *capture = NULL;
    fap_take *markers = NULL;

    fap_capture_config_init(&cfg);
    cfg.markers = (const char *)map;
    cfg.markers_size = map_size;
    *t = (bench_take){ .name = "demo_take", .rate_hz = 25 };
    if (fap_take_read(&markers, c3d, c3d_size, NULL, NULL) == FAP_OK &&
        fap_capture_encode(&capture, markers, &cfg, NULL) == FAP_OK)
        for (uint32_t i = 0; i < fap_capture_report_get(capture)->frames; i++)
            bench_take_add_frame(t, fap_capture_frames(capture) + i);
    fap_capture_close(&capture);
    fap_take_close(&markers);
}

static void add_demo(bench_takes *t)
{
    bench_take *next = &t->take[t->count];
    uint8_t *c3d = NULL, *map = NULL;
    size_t c3d_size, map_size;

    if (file_read("tests/assets/demo_take.c3d", 1 << 26, &c3d, &c3d_size) == FAP_OK &&
        file_read("tests/assets/demo_markers.csv", 1 << 20, &map, &map_size) == FAP_OK)
        capture_demo(next, c3d, c3d_size, map, map_size);
    t->count += next->count > 0;
    free(map);
    free(c3d);
}

void bench_takes_add(bench_takes *t)
{
    add_streams(t, shortest_s);
    if (!t->count)
        add_demo(t);
}

void bench_takes_add_every(bench_takes *t)
{
    add_streams(t, 0);
    add_demo(t);
}

/* --- what is hardest to code --- */

void bench_takes_add_waves(bench_takes *t)
{
    bench_take *next = &t->take[t->count++];

    *next = (bench_take){ .name = "sines", .rate_hz = 25 };
    for (int i = 0; i < WAVE_FRAMES; i++) {
        fap_frame f = { .number = i, .pts_us = 40000 * (int64_t)i };
        for (int fap = FIRST_FAP; fap < FIRST_FAP + WAVE_FAPS; fap++) {
            f.state[fap] = FAP_CODED;
            f.value[fap] = (int32_t)lrint(150 * sin(0.05 * i * (1 + fap % 5) + fap));
        }
        if (!bench_take_add_frame(next, &f))
            break;
    }
}

/* --- coding --- */

static fap_err receive_all(bench_take *t, fap_encoder *e, const bench_packet_sink *packet)
{
    const size_t room = fap_encoder_bound(e);
    fap_err err;

    do {
        size_t size = 0;
        int frames;
        err = bench_take_reserve(t, room) ? fap_encoder_receive(e, t->data + t->size, room, &size)
                                          : FAP_E_NOMEM;
        t->size += size;
        if (err == FAP_OK && packet) {
            fap_encoder_reconstruction(e, &frames);
            packet->put(packet->user, size, frames);
        }
    } while (err == FAP_OK);
    return err;
}

static int send_all(bench_take *t, fap_encoder *e, const bench_packet_sink *packet)
{
    for (int sent = 0; sent < t->count;) {
        const fap_err err = fap_encoder_send(e, &t->frame[sent]);
        if (err != FAP_OK && (err != FAP_E_AGAIN || receive_all(t, e, packet) != FAP_E_AGAIN))
            return 0;
        sent += err == FAP_OK;
    }
    return 1;
}

int bench_take_encode(bench_take *t, const fap_encoder_config *cfg, const bench_packet_sink *packet)
{
    fap_encoder_config own = *cfg;
    fap_encoder *e;

    own.rate_hz = t->rate_hz;
    t->size = 0;
    if (fap_encoder_open(&e, &own) != FAP_OK)
        return 0;
    int ok = send_all(t, e, packet);
    fap_encoder_flush(e);
    ok = ok && receive_all(t, e, packet) == FAP_E_END;
    fap_encoder_close(&e);
    return ok;
}

/* --- the face --- */

fap_bank *bench_bank(void)
{
    fap_bank *bank = NULL;
    uint8_t *data;
    size_t size;

    if (file_read("build/default.fbank", 1 << 28, &data, &size) == FAP_OK) {
        if (fap_bank_load(&bank, data, size, NULL) != FAP_OK)
            bank = NULL;
        free(data);
    }
    if (!bank && fap_bank_builtin(&bank, NULL) != FAP_OK)
        return NULL;
    return bank;
}
