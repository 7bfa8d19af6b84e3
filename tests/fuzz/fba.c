/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes through the FBA decoder, as one unit or cut into units of which some are lost, with a table or without, with
 * an allocator that fails. The first four bytes choose. What comes out must be a face, in order, and its bits must add up.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/tables.h>

#include "tests/fuzz/alloc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { OPTION_BYTES = 4, MAX_CALLS = 100000, STRENGTH_MAX = 63 };

static const char table_text[] = "fap-fit 1\nfrom f51\n    f52 = 0.5*f51\n";

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

static void check_high_level(const fap_frame *f)
{
    check(f->viseme.select1 <= FAP_VISEME_COUNT && f->viseme.select2 <= FAP_VISEME_COUNT);
    check(f->viseme.blend <= STRENGTH_MAX && f->viseme.def <= 1);
    check(f->expression.select1 <= FAP_EXPRESSION_COUNT && f->expression.select2 <= FAP_EXPRESSION_COUNT);
    check(f->expression.intensity1 <= STRENGTH_MAX && f->expression.intensity2 <= STRENGTH_MAX);
    check(f->expression.def <= 1 && f->expression.init_face <= 1);
}

static void check_frame(const fap_frame *f, const fap_plane_info *p)
{
    uint32_t sum = p->header_bits + p->setup_bits + p->range_bits + p->run_bits + p->body_bits;

    check_high_level(f);
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        check(f->state[fap] <= FAP_CONCEALED);
        check(f->state[fap] != FAP_ABSENT || !f->value[fap]);
        check(p->concealed ? f->state[fap] != FAP_CODED : f->state[fap] != FAP_CONCEALED);
        sum += p->fap_bits[fap];
    }
    check(sum == p->bit_count && p->quant <= 31 && p->rate_hz > 0);
}

/* Everything that is to be had from what was sent. */
static void drain(fap_decoder *d, int strict, int64_t *number, int64_t *pts_us)
{
    fap_frame f;

    for (int i = 0; i < MAX_CALLS; i++) {
        const fap_err err = fap_decoder_receive(d, &f);
        if (err == FAP_E_AGAIN)
            return;
        if (err == FAP_E_END || (err != FAP_OK && strict)) /* data behind the end is an error of its own */
            *number = *pts_us = 0;
        if (err != FAP_OK) {
            check(err == FAP_E_END || *fap_decoder_last_error(d));
            continue;
        }
        check_frame(&f, fap_decoder_plane(d));
        check(f.number >= *number && f.pts_us >= *pts_us);
        *number = f.number;
        *pts_us = f.pts_us;
    }
}

static void decode(fap_decoder *d, int strict, const uint8_t *data, size_t size, size_t unit, uint8_t losses)
{
    int64_t number = 0, pts_us = 0;

    for (size_t at = 0, i = 0; at < size; at += unit, i++) {
        const size_t n = size - at < unit ? size - at : unit;
        const int lost = losses >> i % 8 & 1;
        check(fap_decoder_send(d, lost ? NULL : data + at, lost ? 0 : n) == FAP_OK);
        if (i % 64 == 63)
            fap_decoder_flush(d);
        drain(d, strict, &number, &pts_us);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fap_decoder_config cfg;
    fap_decoder *d;
    fap_fit *fit = NULL;

    if (size <= OPTION_BYTES)
        return 0;
    fuzz_memory memory = { .fail_at = data[1] >> 6 };
    fap_decoder_config_init(&cfg);
    cfg.strict = data[0] >> 7;
    cfg.default_bound = data[0] >> 6 & 1 ? 1020 : 0;
    cfg.symbol_memory = data[0] >> 5 & 1 ? 50 : 0;
    cfg.alloc = fuzz_allocator(&memory);
    if (data[0] >> 4 & 1)
        check(fap_fit_parse(&fit, table_text, sizeof table_text - 1, NULL, NULL) == FAP_OK);
    cfg.fit = fit;
    const size_t unit = data[2] ? 4u * data[2] : size;
    const fap_err err = fap_decoder_open(&d, &cfg);
    check(err == (fuzz_memory_failed(&memory) ? FAP_E_NOMEM : FAP_OK));
    if (err == FAP_OK)
        decode(d, cfg.strict, data + OPTION_BYTES, size - OPTION_BYTES, unit, data[2] ? data[3] : 0);
    fap_decoder_close(&d);
    fap_fit_close(&fit);
    fuzz_memory_check(&memory);
    return 0;
}
