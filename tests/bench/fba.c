/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How fast FBA streams are written and read, from memory to memory, and how small a decoder is. The takes are the
 * real streams of 10 seconds or more beside the project, else the demo take; every run does all of them.
 */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>
#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"
#include "common/streams.h"
#include "gen/decoder_size.h"

enum { MAX_TAKES = 32, RUNS = 7, WAVE_FRAMES = 6000, WAVE_FAPS = 58, FIRST_FAP = 3 };

static const double shortest_s = 10, run_s = 0.1;
static const char streams_dir[] = "../shared/data/fap";

/* Frames, and the stream that they make. */
typedef struct take {
    char name[64];
    fap_frame *frame;
    int count, room;
    double rate_hz;
    uint8_t *data;
    size_t size, data_room;
} take;

typedef struct takes {
    take take[MAX_TAKES];
    int count;
} takes;

static void free_takes(takes *t)
{
    for (int i = 0; i < t->count; i++) {
        free(t->take[i].frame);
        free(t->take[i].data);
    }
    *t = (takes){ 0 };
}

static int add_frame(take *t, const fap_frame *f)
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

/* --- coding --- */

static fap_encoder *open_encoder(const take *t)
{
    fap_encoder_config cfg;
    fap_encoder *e = NULL;

    fap_encoder_config_init(&cfg);
    cfg.rate_hz = t->rate_hz;
    return fap_encoder_open(&e, &cfg) == FAP_OK ? e : NULL;
}

static int make_room(take *t, size_t size)
{
    if (t->size + size > t->data_room) {
        t->data_room = 2 * (t->size + size);
        uint8_t *larger = realloc(t->data, t->data_room);
        if (!larger)
            return 0;
        t->data = larger;
    }
    return 1;
}

static fap_err receive_all(take *t, fap_encoder *e)
{
    const size_t room = fap_encoder_bound(e);
    fap_err err;
    size_t size;

    do {
        size = 0;
        err = make_room(t, room) ? fap_encoder_receive(e, t->data + t->size, room, &size) : FAP_E_NOMEM;
        t->size += size;
    } while (err == FAP_OK);
    return err;
}

/* Frames encoded. */
static int encode(take *t)
{
    fap_encoder *e = open_encoder(t);
    int sent = 0;

    t->size = 0;
    if (!e)
        return 0;
    while (sent < t->count) {
        const fap_err err = fap_encoder_send(e, &t->frame[sent]);
        if (err != FAP_OK && (err != FAP_E_AGAIN || receive_all(t, e) != FAP_E_AGAIN))
            break;
        sent += err == FAP_OK;
    }
    fap_encoder_flush(e);
    const fap_err err = receive_all(t, e);
    fap_encoder_close(&e);
    return err == FAP_E_END ? sent : 0;
}

/* Frames decoded. */
static int decode(take *t)
{
    fap_decoder *d;
    fap_frame f;
    int count = 0;

    if (fap_decoder_open(&d, NULL) != FAP_OK)
        return 0;
    if (fap_decoder_send(d, t->data, t->size) == FAP_OK)
        while (fap_decoder_receive(d, &f) == FAP_OK)
            count++;
    fap_decoder_close(&d);
    return count;
}

/* Frames of all takes, coded once; 0 when one of them failed. */
static int run_all(takes *t, int (*code)(take *))
{
    int frames = 0;

    for (int i = 0; i < t->count; i++) {
        if (code(&t->take[i]) != t->take[i].count)
            return 0;
        frames += t->take[i].count;
    }
    return frames;
}

/* The best of a few runs: the others measure what else the machine does. */
static double best_fps(takes *t, int (*code)(take *))
{
    double best = -1;

    for (int run = 0; run < RUNS; run++) {
        const double start = bench_now_s();
        int frames = 0, more;
        do
            frames += more = run_all(t, code);
        while (more && bench_now_s() - start < run_s);
        const double fps = frames / (bench_now_s() - start);
        if (more && fps > best)
            best = fps;
    }
    return best;
}

/* --- takes --- */

static fap_err sink_frame(void *user, const fap_frame *f)
{
    return add_frame(user, f) ? FAP_OK : FAP_E_NOMEM;
}

static int read_fap(take *t, const char *path)
{
    char where[FAP_ERROR_TEXT_SIZE];
    const frame_sink sink = { .put = sink_frame, .user = t };
    stream_summary summary;
    uint8_t *data;
    size_t size;

    *t = (take){ 0 };
    if (file_read(path, 1 << 26, &data, &size) != FAP_OK)
        return 0;
    const fap_err err = stream_read(data, size, NULL, &summary, &sink, where);
    free(data);
    t->rate_hz = summary.header.rate_hz;
    return err == FAP_OK && t->count && t->count >= shortest_s * t->rate_hz;
}

static void add_stream(takes *t, const char *name)
{
    char path[512];
    take *next = &t->take[t->count];

    snprintf(path, sizeof path, "%s/%s", streams_dir, name);
    if (!read_fap(next, path)) {
        free(next->frame);
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

static void add_streams(takes *t)
{
    struct dirent **entry;
    const int count = scandir(streams_dir, &entry, is_fap, alphasort);

    for (int i = 0; i < count; i++) {
        if (t->count < MAX_TAKES)
            add_stream(t, entry[i]->d_name);
        free(entry[i]);
    }
    if (count >= 0)
        free(entry);
}

static void capture_demo(take *t, const uint8_t *c3d, size_t c3d_size, const uint8_t *map, size_t map_size)
{
    fap_capture_config cfg;
    fap_capture *capture = NULL;
    fap_take *markers = NULL;

    fap_capture_config_init(&cfg);
    cfg.markers = (const char *)map;
    cfg.markers_size = map_size;
    *t = (take){ .name = "demo take", .rate_hz = 25 };
    if (fap_take_read(&markers, c3d, c3d_size, NULL, NULL) == FAP_OK &&
        fap_capture_encode(&capture, markers, &cfg, NULL) == FAP_OK)
        for (uint32_t i = 0; i < fap_capture_report_get(capture)->frames; i++)
            add_frame(t, fap_capture_frames(capture) + i);
    fap_capture_close(&capture);
    fap_take_close(&markers);
}

static void add_demo(takes *t)
{
    uint8_t *c3d = NULL, *map = NULL;
    size_t c3d_size, map_size;

    if (file_read("tests/assets/demo_take.c3d", 1 << 26, &c3d, &c3d_size) == FAP_OK &&
        file_read("tests/assets/demo_markers.csv", 1 << 20, &map, &map_size) == FAP_OK)
        capture_demo(&t->take[t->count++], c3d, c3d_size, map, map_size);
    free(map);
    free(c3d);
}

/* 58 FAPs that never rest. */
static void add_waves(takes *t)
{
    take *next = &t->take[t->count++];

    *next = (take){ .name = "sines", .rate_hz = 25 };
    for (int i = 0; i < WAVE_FRAMES; i++) {
        fap_frame f = { .number = i, .pts_us = 40000 * (int64_t)i };
        for (int fap = FIRST_FAP; fap < FIRST_FAP + WAVE_FAPS; fap++) {
            f.state[fap] = FAP_CODED;
            f.value[fap] = (int32_t)lrint(150 * sin(0.05 * i * (1 + fap % 5) + fap));
        }
        if (!add_frame(next, &f))
            break;
    }
}

/* --- figures --- */

static void add_real(takes *t)
{
    add_streams(t);
    if (!t->count)
        add_demo(t);
}

static void name_takes(const takes *t)
{
    for (const take *k = t->take; k < t->take + t->count; k++)
        printf("# fba: %s, %d frames at %g Hz\n", k->name, k->count, k->rate_hz);
}

static double measure(void (*add)(takes *), int (*code)(take *))
{
    takes t = { 0 };

    add(&t);
    if (code == decode) /* once is enough */
        name_takes(&t);
    const double fps = t.count && run_all(&t, encode) ? best_fps(&t, code) : -1;
    free_takes(&t);
    return fps;
}

double bench_fba_decode_fps(void)
{
    return measure(add_real, decode);
}

double bench_fba_encode_fps(void)
{
    return measure(add_real, encode);
}

double bench_fba_decode_fps_58(void)
{
    return measure(add_waves, decode);
}

double bench_fba_encode_fps_58(void)
{
    return measure(add_waves, encode);
}

static void *count_alloc(void *user, size_t size)
{
    *(size_t *)user += size;
    return malloc(size);
}

static void plain_free(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

double bench_decoder_state_bytes(void)
{
    fap_decoder_config cfg;
    fap_decoder *d;
    size_t bytes = 0;

    fap_decoder_config_init(&cfg);
    cfg.alloc = (fap_allocator){ .alloc = count_alloc, .free = plain_free, .user = &bytes };
    if (fap_decoder_open(&d, &cfg) != FAP_OK)
        return -1;
    fap_decoder_close(&d);
    return (double)bytes;
}

double bench_libfap_text_bytes(void)
{
    if (DECODER_SIZE_ARM64 > 0)
        printf("# libfap: %d text bytes of the decoder alone on AArch64\n", DECODER_SIZE_ARM64);
    return DECODER_SIZE;
}
