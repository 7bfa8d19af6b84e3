/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How fast FBA streams are written and read, from memory to memory, and how small a decoder is. Every run does all
 * takes of takes.h.
 */
#include <stdio.h>
#include <stdlib.h>

#include <fap/decoder.h>

#include "bench.h"
#include "gen/decoder_size.h"
#include "takes.h"

enum { RUNS = 7 };

static const double run_s = 0.1;

/* Frames encoded. */
static int encode(bench_take *t)
{
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    return bench_take_encode(t, &cfg, NULL) ? t->count : 0;
}

/* Frames decoded. */
static int decode(bench_take *t)
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
static int run_all(bench_takes *t, int (*code)(bench_take *))
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
static double best_fps(bench_takes *t, int (*code)(bench_take *))
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

/* --- figures --- */

static double measure(void (*add)(bench_takes *), int (*code)(bench_take *))
{
    bench_takes t = { 0 };

    add(&t);
    for (int i = 0; code == decode && i < t.count; i++) /* once is enough */
        bench_note(t.take[i].name, t.take[i].count, "frames");
    const double fps = t.count && run_all(&t, encode) ? best_fps(&t, code) : -1;
    bench_takes_free(&t);
    return fps;
}

double bench_fba_decode_fps(void)
{
    return measure(bench_takes_add, decode);
}

double bench_fba_encode_fps(void)
{
    return measure(bench_takes_add, encode);
}

double bench_fba_decode_fps_58(void)
{
    return measure(bench_takes_add_waves, decode);
}

double bench_fba_encode_fps_58(void)
{
    return measure(bench_takes_add_waves, encode);
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
