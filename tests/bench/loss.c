/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How far feature points are from where they should be when units are lost on the way: every plane travels by
 * itself, an I plane comes every second, and the decoder conceals what does not arrive.
 */
#include <math.h>
#include <stdlib.h>

#include <fap/decoder.h>
#include <fap/encoder.h>
#include <fap/sensitivity.h>

#include "bench.h"
#include "takes.h"

enum { SEEDS = 20 };

/* Units of a stream: the size of each that holds a frame. */
typedef struct units {
    size_t *size;
    int count, room;
} units;

static void put_unit(void *user, size_t size, int frames)
{
    units *u = user;

    if (frames == 1 && u->count < u->room)
        u->size[u->count++] = size;
}

/* The stream of a live source: a unit for every frame, at once. */
static int encode(bench_take *t, units *u)
{
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    cfg.look_ahead = 0;
    cfg.intra = (int)lrint(fmax(1, t->rate_hz));
    return bench_take_encode(t, &cfg, &(bench_packet_sink){ put_unit, u }) && u->count == t->count;
}

static uint32_t draw(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Mean error over the stream; below 0: the decoder could not be used. */
static double play(const bench_take *t, const units *u, const fap_sensitivity *face, int percent,
                   uint32_t seed)
{
    const uint8_t *unit = t->data;
    uint64_t sum_nm = 0, items = 0;
    fap_frame shown = { 0 }, f;
    fap_decoder *d;

    if (fap_decoder_open(&d, NULL) != FAP_OK)
        return -1;
    for (int i = 0; i < t->count; unit += u->size[i++]) {
        fap_frame_error e;
        const int lost = draw(&seed) % 100 < (uint32_t)percent;
        const fap_err err = lost ? fap_decoder_send(d, NULL, 0) : fap_decoder_send(d, unit, u->size[i]);
        while (err == FAP_OK && fap_decoder_receive(d, &f) == FAP_OK)
            shown = f;
        fap_sensitivity_compare(face, &t->frame[i], &shown, &e);
        sum_nm += e.sum_nm;
        items += (uint64_t)e.items;
    }
    fap_decoder_close(&d);
    return items ? 1e-6 * (double)sum_nm / (double)items : 0;
}

static double measure_take(bench_take *t, const fap_sensitivity *face, int percent)
{
    units u = { .size = calloc((size_t)t->count, sizeof *u.size), .room = t->count };
    double sum = 0;
    int ok = u.size && encode(t, &u);

    for (uint32_t seed = 1; ok && seed <= SEEDS; seed++) {
        const double mm = play(t, &u, face, percent, seed);
        ok = mm >= 0;
        sum += mm;
    }
    free(u.size);
    return ok ? sum / SEEDS : -1;
}

static double measure_all(const fap_sensitivity *face, int percent)
{
    double value[BENCH_MAX_TAKES], median = -1;
    bench_takes t = { 0 };
    int i = 0;

    bench_takes_add(&t);
    for (; i < t.count && (value[i] = measure_take(&t.take[i], face, percent)) >= 0; i++)
        bench_note(t.take[i].name, value[i], "mm");
    if (i == t.count)
        median = bench_median(value, t.count);
    bench_takes_free(&t);
    return median;
}

static double measure(int percent)
{
    fap_sensitivity face;
    fap_bank *bank = bench_bank();

    if (!bank)
        return -1;
    fap_sensitivity_of_bank(bank, &face);
    fap_bank_close(&bank);
    return measure_all(&face, percent);
}

double bench_loss_error_mm_0(void)
{
    return measure(0);
}

double bench_loss_error_mm_5(void)
{
    return measure(5);
}

double bench_loss_error_mm_10(void)
{
    return measure(10);
}

double bench_loss_error_mm_20(void)
{
    return measure(20);
}
