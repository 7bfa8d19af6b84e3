/* SPDX-License-Identifier: BSD-2-Clause */
/* Interpolation tables learnt from takes: made ones, whose rules are known, and real ones. */
#include "tests/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/fit.h>
#include <fap/sensitivity.h>
#include <fap/tables.h>

enum { FRAMES = 300 };

static fap_frame take[FRAMES];

/* --- takes --- */

static int32_t wave(int i, int period, int32_t size)
{
    const int32_t phase = i % period, half = period / 2;
    return (phase < half ? phase : period - phase) * size / half;
}

static void set(int fap, int i, int32_t value)
{
    take[i].state[fap] = FAP_CODED;
    take[i].value[fap] = value;
}

/* FAPs 3, 4 and 31 move by themselves; the others follow. */
static void make_take(void)
{
    memset(take, 0, sizeof take);
    for (int i = 0; i < FRAMES; i++) {
        const int32_t jaw = wave(i, 50, 400), lip = wave(i, 34, 300) - 150;
        set(3, i, jaw);
        set(4, i, lip);
        set(31, i, wave(i, 120, 200));
        set(32, i, take[i].value[31]);
        set(5, i, -jaw - lip / 2 + 12);
        set(16, i, (int32_t)((int64_t)jaw * jaw / 1000) - 40);
        set(18, i, 77);
        set(63, i, 0);
    }
}

static fap_fit_learn_config exact(const uint32_t error[FAP_COUNT + 1])
{
    fap_fit_learn_config cfg;

    fap_fit_learn_config_init(&cfg);
    cfg.error = error;
    cfg.quant = 0;
    return cfg;
}

static int given(const fap_fit *fit)
{
    int count = 0;
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        count += fap_fit_gives(fit, fap);
    return count;
}

static int32_t nearest(int32_t v, int step)
{
    const int32_t size = v < 0 ? -v : v, level = step > 1 ? (size + step / 2) / step * step : size;
    return v < 0 ? -level : level;
}

/* Drops what the table gives, applies it to what a quantiser leaves of the rest: how many frames miss by more. */
static int misses(const fap_fit *fit, const fap_frame *frame, int quant, int fap, uint32_t bound)
{
    fap_frame f = *frame;

    for (int i = 3; i <= FAP_COUNT; i++)
        if (fap_fit_gives(fit, i))
            f.state[i] = FAP_ABSENT, f.value[i] = 0;
        else
            f.value[i] = nearest(f.value[i], quant * fap_info_get(i)->quant_step);
    fap_fit_apply(fit, &f);
    const int64_t miss = (int64_t)f.value[fap] - frame->value[fap];
    return f.state[fap] != FAP_DERIVED || miss > bound || -miss > bound;
}

/* --- made takes --- */

TEST(fit_learn, finds_the_rules_that_a_take_was_made_by)
{
    static const uint32_t error[FAP_COUNT + 1] = { [3] = 1, [4] = 1, [5] = 1, [16] = 1 };
    const fap_fit_learn_config cfg = exact(error);
    fap_fit *fit;

    make_take();
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_int_equal(given(fit), 5); /* one of 3 4 5, one of 31 32, 16 18 63 */
    assert_true(fap_fit_gives(fit, 18) && fap_fit_gives(fit, 63) && fap_fit_gives(fit, 16));
    assert_int_equal(fap_fit_gives(fit, 31) + fap_fit_gives(fit, 32), 1);
    for (int i = 0; i < FRAMES; i++)
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            if (fap_fit_gives(fit, fap))
                assert_false(misses(fit, &take[i], 0, fap, error[fap]));
    fap_fit_close(&fit);
}

static void make_noise(uint32_t state, int faps)
{
    memset(take, 0, sizeof take);
    for (int i = 0; i < FRAMES; i++)
        for (int fap = 3; fap < 3 + faps; fap++) {
            state = state * 1664525 + 1013904223;
            set(fap, i, (int32_t)(state >> 20) - 2048);
        }
}

TEST(fit_learn, learns_nothing_from_noise)
{
    fap_fit *fit;

    make_noise(7, FAP_COUNT - 2);
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, NULL), FAP_OK);
    assert_int_equal(given(fit), 0);
    fap_fit_close(&fit);
}

TEST(fit_learn, an_empty_take_gives_an_empty_table)
{
    fap_fit *fit;

    assert_int_equal(fap_fit_learn(&fit, NULL, 0, NULL), FAP_OK);
    assert_int_equal(given(fit), 0);
    fap_fit_close(&fit);
    memset(take, 0, sizeof take);
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, NULL), FAP_OK);
    assert_int_equal(given(fit), 0);
    fap_fit_close(&fit);
}

TEST(fit_learn, faps_that_are_absent_somewhere_take_no_part)
{
    fap_fit *fit;

    make_take();
    take[FRAMES - 1].state[63] = FAP_ABSENT;
    take[0].state[18] = FAP_ABSENT;
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, NULL), FAP_OK);
    assert_true(!fap_fit_gives(fit, 63) && !fap_fit_gives(fit, 18) && fap_fit_gives(fit, 16));
    fap_fit_close(&fit);
}

TEST(fit_learn, exceptions_are_counted)
{
    static const uint32_t error[FAP_COUNT + 1] = { 0 };
    fap_fit_learn_config cfg = exact(error);
    fap_fit *fit;

    make_take();
    for (int i = 0; i < 3; i++)
        take[100 * i].value[63] = 500;
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_false(fap_fit_gives(fit, 63));
    fap_fit_close(&fit);
    cfg.exceptions = 10; /* 3 of 300 */
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_true(fap_fit_gives(fit, 63));
    fap_fit_close(&fit);
    cfg.exceptions = 9;
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_false(fap_fit_gives(fit, 63));
    fap_fit_close(&fit);
}

/* FAP 5 is the small difference of two big FAPs: from coarse sources it cannot be had. */
TEST(fit_learn, formulas_that_blow_up_the_rounding_of_their_sources_are_not_found)
{
    static const uint32_t error[FAP_COUNT + 1] = { [5] = 3 };
    fap_fit_learn_config cfg = exact(error);
    fap_fit *fit;

    memset(take, 0, sizeof take);
    for (int i = 0; i < FRAMES; i++) {
        const int32_t a = wave(i, 50, 2000), b = wave(i, 34, 37);
        set(3, i, a);
        set(4, i, a + b);
        set(5, i, 3 * b);
    }
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_int_equal(given(fit), 1);
    fap_fit_close(&fit);
    cfg.quant = 4;
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, &cfg), FAP_OK);
    assert_int_equal(given(fit), 0);
    fap_fit_close(&fit);
}

TEST(fit_learn, any_values_do)
{
    fap_fit *fit;

    make_noise(3, 12);
    for (int i = 0; i < FRAMES; i++)
        for (int fap = 3; fap < 15; fap++)
            take[i].value[fap] = i % 3 ? INT32_MAX : INT32_MIN;
    assert_int_equal(fap_fit_learn(&fit, take, FRAMES, NULL), FAP_OK);
    fap_fit_close(&fit);
}

TEST(fit_learn, options_out_of_range_are_refused)
{
    fap_fit_learn_config cfg;
    fap_fit *fit;

    fap_fit_learn_config_init(&cfg);
    assert_int_equal(fap_fit_learn(NULL, take, 1, &cfg), FAP_E_ARG);
    assert_int_equal(fap_fit_learn(&fit, NULL, 1, &cfg), FAP_E_ARG);
    cfg.terms = 9;
    assert_int_equal(fap_fit_learn(&fit, take, 1, &cfg), FAP_E_ARG);
    cfg.terms = 1, cfg.quant = 32;
    assert_int_equal(fap_fit_learn(&fit, take, 1, &cfg), FAP_E_ARG);
    cfg.quant = 1, cfg.exceptions = 1001;
    assert_int_equal(fap_fit_learn(&fit, take, 1, &cfg), FAP_E_ARG);
    cfg.exceptions = 0, cfg.struct_size = 8;
    assert_int_equal(fap_fit_learn(&fit, take, 1, &cfg), FAP_E_ARG);
    assert_null(fit);
}

/* --- memory --- */

typedef struct budget {
    int left, live;
} budget;

static void *alloc_some(void *user, size_t size)
{
    budget *b = user;
    if (!b->left)
        return NULL;
    b->left--, b->live++;
    return malloc(size);
}

static void free_some(void *user, void *ptr)
{
    budget *b = user;
    b->live--;
    free(ptr);
}

TEST(fit_learn, no_memory_is_an_error_and_leaks_nothing)
{
    fap_fit_learn_config cfg;
    fap_fit *fit;
    int left = 0;
    fap_err err = FAP_E_NOMEM;

    make_take();
    fap_fit_learn_config_init(&cfg);
    for (; err != FAP_OK; left++) {
        budget b = { left, 0 };
        cfg.alloc = (fap_allocator){ alloc_some, free_some, &b };
        err = fap_fit_learn(&fit, take, FRAMES, &cfg);
        assert_true(err == FAP_OK || (err == FAP_E_NOMEM && !fit));
        fap_fit_close(&fit);
        assert_int_equal(b.live, 0);
    }
    assert_true(left > 2);
}

/* --- real takes --- */

enum { REAL_MAX = 2000 };

static size_t read_file(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

static size_t load(const char *path, fap_frame *frames)
{
    FILE *file = fopen(path, "rb");
    fap_ascii_reader *reader;
    size_t count = 0;

    assert_non_null(file);
    assert_int_equal(fap_ascii_reader_open(&reader, &(fap_reader){ read_file, file }, NULL, NULL), FAP_OK);
    while (count < REAL_MAX && fap_ascii_reader_next(reader, &frames[count]) == FAP_OK)
        count++;
    fap_ascii_reader_close(&reader);
    fclose(file);
    return count;
}

typedef struct sink {
    size_t size;
    char text[8192];
} sink;

static int write_sink(void *user, const void *data, size_t size)
{
    sink *s = user;
    if (size > sizeof s->text - s->size)
        return 1;
    memcpy(s->text + s->size, data, size);
    s->size += size;
    return 0;
}

/* Learnt, written, read back, applied: still within the bound in every frame. */
static void learn_real(const char *path, uint32_t error_nm, int at_least)
{
    static fap_frame frames[REAL_MAX];
    static sink s;
    fap_fit_learn_config cfg;
    fap_sensitivity typical;
    fap_fit *fit, *again;
    const char *const file = test_shared(path);
    const size_t count = load(file, frames);

    fap_sensitivity_typical(&typical);
    fap_fit_learn_config_init(&cfg);
    cfg.error_nm = error_nm;
    assert_int_equal(fap_fit_learn(&fit, frames, count, &cfg), FAP_OK);
    s.size = 0;
    assert_int_equal(fap_fit_write(fit, &(fap_writer){ write_sink, &s }), FAP_OK);
    assert_int_equal(fap_fit_parse(&again, s.text, s.size, NULL, NULL), FAP_OK);
    assert_true(given(again) >= at_least);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        for (size_t i = 0; fap_fit_gives(again, fap) && i < count; i++)
            assert_false(
                misses(again, &frames[i], cfg.quant, fap,
                       typical.nm[fap] ? error_nm / typical.nm[fap] : fap_info_get(fap)->quant_step));
    fap_fit_close(&fit);
    fap_fit_close(&again);
}

TEST(fit_learn, leaves_out_most_faps_of_a_real_take)
{
    learn_real("data/fap/metaface_th-example-plain.fap", 200000, 8);
    learn_real("data/fap/metaface_th-example-plain.fap", 500000, 9);
    learn_real("data/fap/xface_joy.fap", 200000, 30);
    learn_real("data/fap/xface_joy.fap", 500000, 33);
    learn_real("data/fap/vreng_jag.fap", 200000, 52);
    learn_real("data/fap/vreng_jag.fap", 500000, 54);
}
