/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes as a take for the learner of interpolation tables, with any options and an allocator that may fail.
 * What it learns must keep its promise in every frame: given from what remains, within the bound.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/fit.h>
#include <fap/tables.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAX_FRAMES = 128, OPTIONS = 6 };

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

static void *alloc_some(void *user, size_t size)
{
    int *left = user;
    return *left > 0 ? (--*left, malloc(size)) : NULL;
}

static void free_some(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

/* Columns drift by the bytes, some of them scaled, squared or copied from the one before; 255 is a wild value. */
static size_t make_take(fap_frame *frame, const uint8_t *data, size_t size, int columns)
{
    size_t count = 0;
    int32_t at[FAP_COUNT + 1] = { 0 };

    for (; count < MAX_FRAMES && (count + 1) * (size_t)columns <= size; count++) {
        fap_frame *f = &frame[count];
        *f = (fap_frame){ 0 };
        for (int i = 0; i < columns; i++) {
            const uint8_t byte = data[count * (size_t)columns + (size_t)i];
            const int fap = 3 + i * 5 % (FAP_COUNT - 2),
                      before = 3 + (i + FAP_COUNT - 3) * 5 % (FAP_COUNT - 2);
            at[fap] = i % 3 == 1 ? 2 * (at[before] % 1000) + byte % 4 : at[fap] % 100000 + (int8_t)byte;
            f->state[fap] = byte == 254 ? FAP_ABSENT : FAP_CODED;
            f->value[fap] = byte == 255 ? (int32_t)(0x7fffffffu * count) : at[fap];
        }
    }
    return count;
}

static int32_t nearest(int32_t v, int step)
{
    const int64_t size = v < 0 ? -(int64_t)v : v, level = step > 1 ? (size + step / 2) / step * step : size;
    return (int32_t)(v < 0 ? -level : level);
}

static fap_frame decoded(const fap_fit *fit, const fap_frame *frame, int quant)
{
    fap_frame f = *frame;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (fap_fit_gives(fit, fap))
            f.state[fap] = FAP_ABSENT, f.value[fap] = 0;
        else if (f.value[fap] > -(1 << 28) && f.value[fap] < 1 << 28)
            f.value[fap] = nearest(f.value[fap], quant * fap_info_get(fap)->quant_step);
    fap_fit_apply(fit, &f);
    return f;
}

/* Takes with values that no face has are learnt from as well, but clamped: nothing is promised then. */
static int is_tame(const fap_frame *frame, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            if (frame[i].value[fap] >= 1 << 28 || frame[i].value[fap] <= -(1 << 28))
                return 0;
    return 1;
}

static void check_promise(const fap_fit *fit, const fap_frame *frame, size_t count,
                          const fap_fit_learn_config *cfg)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        size_t misses = 0;
        for (size_t i = 0; i < count && fap_fit_gives(fit, fap); i++) {
            const fap_frame f = decoded(fit, &frame[i], cfg->quant);
            const int64_t miss = (int64_t)f.value[fap] - frame[i].value[fap];
            check(f.state[fap] == FAP_DERIVED || cfg->exceptions);
            misses += f.state[fap] != FAP_DERIVED || miss > cfg->error[fap] || -miss > cfg->error[fap];
        }
        check(misses <= count * (size_t)cfg->exceptions / 1000);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static fap_frame frame[MAX_FRAMES];
    uint32_t error[FAP_COUNT + 1];
    fap_fit_learn_config cfg;
    fap_fit *fit;

    if (size < OPTIONS)
        return 0;
    int left = data[0] % 8 ? 100 : data[0] / 8 % 4;
    for (int fap = 0; fap <= FAP_COUNT; fap++)
        error[fap] = data[1] % 16;
    fap_fit_learn_config_init(&cfg);
    cfg.error = error;
    cfg.exceptions = data[2] % 4 ? 0 : data[2];
    cfg.quant = data[3] % 32;
    cfg.terms = 1 + data[4] % 8;
    cfg.alloc = (fap_allocator){ alloc_some, free_some, &left };
    const size_t count = make_take(frame, data + OPTIONS, size - OPTIONS, 1 + data[5] % 20);
    const fap_err err = fap_fit_learn(&fit, frame, count, &cfg);
    check((err == FAP_OK) == (fit != NULL) && (err == FAP_OK || err == FAP_E_NOMEM));
    if (err == FAP_OK && is_tame(frame, count))
        check_promise(fit, frame, count, &cfg);
    fap_fit_close(&fit);
    return 0;
}
