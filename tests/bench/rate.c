/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How many bits streams take, and how far from the original they are at a bitrate. What a stream spends is counted
 * in the planes that a decoder finds, not taken from the encoder's own books.
 */
#include <math.h>
#include <stdlib.h>

#include <fap/decoder.h>
#include <fap/encoder.h>
#include <fap/sensitivity.h>

#include "bench.h"
#include "takes.h"

enum { BITRATE_BPS = 2000, WINDOW_S = 2 };

/* What a decoder makes of a stream, beside the frames it was made of. */
typedef struct outcome {
    double error_mm, kbps;
    int64_t window_bits; /* most in any 2 s */
} outcome;

/* A plane that came: its frame, from 0, and where it begins. */
typedef struct plane {
    int64_t frame, bit;
} plane;

typedef struct playback {
    const bench_take *take;
    const fap_sensitivity *face;
    fap_frame shown;
    int next; /* frame of the take that is to be compared next */
    uint64_t sum_nm, items;
    plane *plane;
    int plane_count;
} playback;

static int64_t frame_at(const bench_take *t, int64_t pts_us)
{
    return llround(1e-6 * (double)pts_us * t->rate_hz);
}

/* What is shown until frame @p end, which a plane has brought: frames that were left out show the one before. */
static void compare_until(playback *p, int64_t end)
{
    const bench_take *t = p->take;

    for (; p->next < t->count && frame_at(t, t->frame[p->next].pts_us - t->frame[0].pts_us) < end;
         p->next++) {
        fap_frame_error e;
        fap_sensitivity_compare(p->face, &t->frame[p->next], &p->shown, &e);
        p->sum_nm += e.sum_nm;
        p->items += (uint64_t)e.items;
    }
}

static int64_t most_bits(const playback *p)
{
    const double window = WINDOW_S * p->take->rate_hz;
    const int64_t end_bit = 8 * (int64_t)p->take->size;
    int64_t most = 0;

    for (int first = 0, end = 0; first < p->plane_count; first++) {
        while (end < p->plane_count && (double)(p->plane[end].frame - p->plane[first].frame) < window)
            end++;
        const int64_t bits = (end < p->plane_count ? p->plane[end].bit : end_bit) - p->plane[first].bit;
        most = bits > most ? bits : most;
    }
    return most;
}

/* 0: a plane did not decode. */
static int play(playback *p, fap_decoder *d)
{
    const bench_take *t = p->take;
    fap_frame f;
    fap_err err = fap_decoder_send(d, t->data, t->size);

    while (err == FAP_OK && (err = fap_decoder_receive(d, &f)) == FAP_OK && p->plane_count < t->count) {
        const int64_t frame = frame_at(t, f.pts_us);
        compare_until(p, frame);
        p->shown = f;
        p->plane[p->plane_count++] = (plane){ frame, fap_decoder_plane(d)->bit_position };
    }
    compare_until(p, INT64_MAX);
    return err == FAP_E_END;
}

static int measure_take(const bench_take *t, const fap_sensitivity *face, outcome *out)
{
    playback p = { .take = t, .face = face, .plane = calloc((size_t)t->count, sizeof *p.plane) };
    fap_decoder *d = NULL;

    const int ok = p.plane && fap_decoder_open(&d, NULL) == FAP_OK && play(&p, d);
    if (ok)
        *out = (outcome){ .error_mm = p.items ? 1e-6 * (double)p.sum_nm / (double)p.items : 0,
                          .kbps = 8e-3 * (double)t->size / bench_take_length_s(t),
                          .window_bits = most_bits(&p) };
    fap_decoder_close(&d);
    free(p.plane);
    return ok;
}

/* Outcomes of all takes; 0 where one of them failed. */
static int measure_all(bench_takes *t, const fap_encoder_config *options, outcome *out)
{
    fap_encoder_config cfg = *options;
    fap_sensitivity face;
    fap_bank *bank = bench_bank();
    int ok = 1;

    if (!bank)
        return 0;
    fap_sensitivity_of_bank(bank, &face);
    fap_bank_close(&bank);
    cfg.sensitivity = &face;
    for (int i = 0; ok && i < t->count; i++)
        ok = bench_take_encode(&t->take[i], &cfg, NULL) && measure_take(&t->take[i], &face, &out[i]);
    return ok && t->count;
}

/* --- fixed quantisers --- */

static double kbps(int quant)
{
    outcome out[BENCH_MAX_TAKES];
    double value[BENCH_MAX_TAKES], median = -1;
    bench_takes t = { 0 };
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    cfg.quant = quant;
    bench_takes_add(&t);
    if (measure_all(&t, &cfg, out)) {
        for (int i = 0; i < t.count; i++)
            bench_note(t.take[i].name, value[i] = out[i].kbps, "kbit/s");
        median = bench_median(value, t.count);
    }
    bench_takes_free(&t);
    return median;
}

double bench_fba_kbps_q1(void)
{
    return kbps(1);
}

double bench_fba_kbps_q4(void)
{
    return kbps(4);
}

double bench_fba_kbps_q8(void)
{
    return kbps(8);
}

/* --- a bitrate --- */

static int measure_bitrate(bench_takes *t, outcome *out)
{
    fap_encoder_config cfg;

    fap_encoder_config_init(&cfg);
    cfg.mode = FAP_ENCODE_BITRATE;
    cfg.bitrate_bps = BITRATE_BPS;
    return measure_all(t, &cfg, out);
}

double bench_fba_kbps_2k_error_mm(void)
{
    outcome out[BENCH_MAX_TAKES];
    double value[BENCH_MAX_TAKES], median = -1;
    bench_takes t = { 0 };

    bench_takes_add(&t);
    if (measure_bitrate(&t, out)) {
        for (int i = 0; i < t.count; i++)
            bench_note(t.take[i].name, value[i] = out[i].error_mm, "mm");
        for (int i = 0; i < t.count; i++)
            bench_note(t.take[i].name, out[i].kbps, "kbit/s");
        median = bench_median(value, t.count);
    }
    bench_takes_free(&t);
    return median;
}

double bench_fba_2k_window_bits(void)
{
    outcome out[BENCH_MAX_TAKES];
    int64_t most = -1;
    bench_takes t = { 0 };

    bench_takes_add(&t);
    bench_takes_add_waves(&t);
    if (measure_bitrate(&t, out))
        for (int i = 0; i < t.count; i++) {
            bench_note(t.take[i].name, (double)out[i].window_bits, "bits");
            most = out[i].window_bits > most ? out[i].window_bits : most;
        }
    bench_takes_free(&t);
    return (double)most;
}
