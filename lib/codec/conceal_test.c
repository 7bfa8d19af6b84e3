/* SPDX-License-Identifier: BSD-2-Clause */
/* Lost units: what is shown moves no faster than the face did, comes to rest, and is exact at the next I plane. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/decoder.h>
#include <fap/encoder.h>

enum { RATE = 25, INTRA = RATE, FRAMES_MAX = 1200, STREAM_MAX = 1 << 20 };

/* A stream whose planes can be lost one by one. */
typedef struct lossy {
    uint8_t *data;
    size_t size, start[FRAMES_MAX + 1]; /* of each plane; the end behind the last */
    int count;
    fap_frame frame[FRAMES_MAX]; /* as decoded without loss */
} lossy;

static void encode(lossy *l, const fap_frame *frame, int count)
{
    fap_encoder_config cfg;
    fap_encoder *e;
    size_t n;

    fap_encoder_config_init(&cfg);
    cfg.intra = INTRA;
    cfg.plane_codes = 1;
    assert_int_equal(fap_encoder_open(&e, &cfg), FAP_OK);
    l->data = malloc(STREAM_MAX);
    assert_non_null(l->data);
    for (int i = 0; i < count;) {
        const fap_err err = fap_encoder_send(e, &frame[i]);
        i += err == FAP_OK;
        while (err == FAP_E_AGAIN &&
               fap_encoder_receive(e, l->data + l->size, STREAM_MAX - l->size, &n) == FAP_OK)
            l->size += n;
    }
    fap_encoder_flush(e);
    while (fap_encoder_receive(e, l->data + l->size, STREAM_MAX - l->size, &n) == FAP_OK)
        l->size += n;
    fap_encoder_close(&e);
}

static int is_code(const uint8_t *p)
{
    return !memcmp(p, "\0\0\1", 3) && (p[3] == 0xBA || p[3] == 0xBB || p[3] == 0xB1);
}

/* Units are what lies between start codes. The end code is left away. */
static void cut(lossy *l)
{
    for (size_t i = 0; i + 4 <= l->size; i++) {
        if (!is_code(l->data + i))
            continue;
        assert_true(l->count <= FRAMES_MAX);
        l->start[l->count] = i;
        l->count += l->data[i + 3] != 0xB1;
    }
}

static fap_frame receive(fap_decoder *d, lossy *l, int plane, int is_lost)
{
    fap_frame f, more;
    const uint8_t *data = is_lost ? NULL : l->data + l->start[plane];
    const size_t size = is_lost ? 0 : l->start[plane + 1] - l->start[plane];

    assert_int_equal(fap_decoder_send(d, data, size), FAP_OK);
    assert_int_equal(fap_decoder_send(d, data, size), FAP_E_AGAIN);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &more), FAP_E_AGAIN);
    return f;
}

static fap_decoder *open_decoder(void)
{
    fap_decoder *d;

    assert_int_equal(fap_decoder_open(&d, NULL), FAP_OK);
    return d;
}

static lossy *make(const fap_frame *frame, int count)
{
    lossy *l = calloc(1, sizeof *l);
    fap_decoder *d = open_decoder();

    assert_non_null(l);
    encode(l, frame, count);
    cut(l);
    assert_int_equal(l->count, count);
    for (int i = 0; i < count; i++)
        l->frame[i] = receive(d, l, i, 0);
    fap_decoder_close(&d);
    return l;
}

static void drop(lossy *l)
{
    free(l->data);
    free(l);
}

/* A head that shakes, a jaw that opens and shuts, a smile that stays. */
static lossy *make_talker(void)
{
    static fap_frame frame[200];

    for (int i = 0; i < 200; i++) {
        fap_frame *f = &frame[i];
        *f = (fap_frame){ .number = i, .pts_us = (int64_t)i * 1000000 / RATE };
        f->state[1] = f->state[2] = f->state[3] = f->state[12] = f->state[49] = FAP_CODED;
        f->viseme = (fap_viseme){ 1 + i / 20 % 14, 0, 40, 0 };
        f->expression = (fap_expression){ 1, 50, 0, 0, 0, 0 };
        f->value[3] = abs(i % 20 - 10) * 30;
        f->value[12] = 100;
        f->value[49] = (abs(i % 50 - 25) - 12) * 1200;
    }
    return make(frame, 200);
}

/* The largest step of each FAP between neighbours. */
static void largest_steps(const fap_frame *f, int count, int32_t most[FAP_COUNT + 1])
{
    memset(most, 0, (FAP_COUNT + 1) * sizeof *most);
    for (int i = 1; i < count; i++)
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            const int32_t step = abs(f[i].value[fap] - f[i - 1].value[fap]);
            most[fap] = step > most[fap] ? step : most[fap];
        }
}

/* Errors of concealed values, summed, in largest steps: as shown, and had the face stood still. */
typedef struct errors {
    double shown, still;
    int count;
} errors;

static void add_errors(errors *e, const fap_frame *shown, const fap_frame *held, const fap_frame *want,
                       const int32_t most[FAP_COUNT + 1])
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        if (!most[fap])
            continue;
        e->shown += fabs((double)shown->value[fap] - want->value[fap]) / most[fap];
        e->still += fabs((double)held->value[fap] - want->value[fap]) / most[fap];
        e->count++;
    }
}

static void check_steps(const fap_frame *f, const fap_frame *before, const int32_t most[FAP_COUNT + 1])
{
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->state[fap] != FAP_ABSENT) {
            assert_int_equal(f->state[fap], FAP_CONCEALED);
            assert_true(abs(f->value[fap] - before->value[fap]) <= most[fap]);
        }
}

/* Loses the units for which @p is_lost, checks steps and recovery. */
static errors check_losses(lossy *l, int (*is_lost)(int plane))
{
    int32_t most[FAP_COUNT + 1];
    fap_decoder *d = open_decoder();
    fap_frame before = { 0 }, good = { 0 };
    errors e = { 0 };
    int waits = 0;

    largest_steps(l->frame, l->count, most);
    for (int i = 0; i < l->count; i++) {
        const int lost = i && is_lost(i);
        const fap_frame f = receive(d, l, i, lost);
        waits = lost || (waits && i % INTRA != 0);
        assert_int_equal(fap_decoder_plane(d)->concealed, waits);
        assert_int_equal(f.number, l->frame[i].number);
        assert_int_equal(f.pts_us, l->frame[i].pts_us);
        if (waits) {
            check_steps(&f, &before, most);
            add_errors(&e, &f, &good, &l->frame[i], most);
        } else {
            assert_memory_equal(f.value, l->frame[i].value, sizeof f.value);
            good = f;
        }
        before = f;
    }
    fap_decoder_close(&d);
    return e;
}

static int is_in_second(int plane)
{
    return plane >= 30 && plane < 45;
}

TEST(conceal, never_moves_faster_than_the_face_did_and_is_exact_at_the_next_i_plane)
{
    lossy *l = make_talker();

    assert_true(check_losses(l, is_in_second).count > 0);
    drop(l);
}

TEST(conceal, a_lasting_loss_ends_at_rest)
{
    lossy *l = make_talker();
    fap_decoder *d = open_decoder();
    fap_frame f = { 0 };

    for (int i = 0; i < 40; i++)
        f = receive(d, l, i, 0);
    assert_true(f.value[3] != 0 && f.value[49] != 0);
    for (int i = 0; i < 40 * RATE; i++)
        f = receive(d, l, 0, 1);
    assert_int_equal(f.value[3], 0);
    assert_int_equal(f.value[49], 0);
    assert_int_equal(f.value[12], 100); /* what never moved stays */
    assert_int_equal(f.viseme.select1, 0);
    assert_int_equal(f.viseme.select2, 0);
    assert_int_equal(f.expression.intensity1, 0);
    assert_int_equal(f.number, 40 - 1 + 40 * RATE);
    fap_decoder_close(&d);
    drop(l);
}

TEST(conceal, a_loss_before_anything_came_shows_no_face)
{
    fap_decoder *d = open_decoder();
    fap_frame f;

    assert_int_equal(fap_decoder_send(d, NULL, 0), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        assert_int_equal(f.state[fap], FAP_ABSENT);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_AGAIN);
    assert_int_equal(fap_decoder_send(d, NULL, 1), FAP_E_ARG);
    assert_int_equal(fap_decoder_send(d, (const uint8_t *)"", 0), FAP_E_ARG);
    fap_decoder_close(&d);
}

/* What an I plane does not code is held at what was decoded, not at what was guessed. */
TEST(conceal, guesses_are_forgotten_when_the_stream_is_back)
{
    fap_frame frame[2 * INTRA];

    for (int i = 0; i < 2 * INTRA; i++) {
        frame[i] = (fap_frame){ .number = i, .pts_us = (int64_t)i * 1000000 / RATE };
        frame[i].state[3] = FAP_CODED;
        frame[i].state[48] = i < INTRA ? FAP_CODED : FAP_ABSENT;
        frame[i].value[3] = 10 * i;
        frame[i].value[48] = 1700 * i;
    }
    lossy *l = make(frame, 2 * INTRA);
    fap_decoder *d = open_decoder();
    fap_frame f = { 0 };
    for (int i = 0; i < INTRA; i++)
        f = receive(d, l, i, i >= 10);
    assert_true(f.value[48] > 9 * 1700);
    f = receive(d, l, INTRA, 0);
    assert_int_equal(f.state[48], FAP_HELD);
    assert_int_equal(f.value[48], 9 * 1700);
    fap_decoder_close(&d);
    drop(l);
}

TEST(conceal, the_parts_of_a_plane_add_up)
{
    lossy *l = make_talker();
    fap_decoder *d = open_decoder();

    for (int i = 0; i < l->count; i++) {
        receive(d, l, i, 0);
        const fap_plane_info *p = fap_decoder_plane(d);
        uint32_t sum = p->header_bits + p->setup_bits + p->range_bits + p->run_bits + p->body_bits;
        for (int fap = 1; fap <= FAP_COUNT; fap++)
            sum += p->fap_bits[fap];
        assert_int_equal(sum, p->bit_count);
        assert_true(p->run_bits >= 3 * 2 + 3); /* three runs, three flags */
        assert_int_equal(p->intra, i % INTRA == 0);
        assert_int_equal(p->setup_bits > 0, p->intra);
        assert_int_equal(p->range_bits > 0, p->intra);
    }
    fap_decoder_close(&d);
    drop(l);
}

static size_t read_file(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

static lossy *make_real(const char *name)
{
    static fap_frame frame[FRAMES_MAX];
    FILE *file = fopen(test_shared(name), "rb");
    fap_ascii_reader *r;
    int count = 0;

    assert_non_null(file);
    assert_int_equal(fap_ascii_reader_open(&r, &(fap_reader){ read_file, file }, NULL, NULL), FAP_OK);
    while (count < FRAMES_MAX && fap_ascii_reader_next(r, &frame[count]) == FAP_OK) {
        for (int fap = 1; fap <= FAP_COUNT && count;
             fap++) /* one mask, so that every INTRA planes is an I plane */
            frame[count].state[fap] = frame[0].state[fap];
        frame[count].number = count;
        frame[count].pts_us = (int64_t)count * 1000000 / RATE;
        count++;
    }
    fap_ascii_reader_close(&r);
    fclose(file);
    return make(frame, count);
}

static uint32_t loss_state;
static int percent;

static int is_unlucky(int plane)
{
    (void)plane;
    loss_state = loss_state * 1664525u + 1013904223u;
    return (int)(loss_state >> 8) % 100 < percent;
}

/* Over all streams and rates of loss, guessing must be worth more than standing still. */
TEST(conceal, real_streams_survive_any_loss)
{
    static const char *const names[] = { "data/fap/metaface_th-example-plain.fap", "data/fap/xface_anger.fap",
                                         "data/fap/xface_joy.fap", "data/fap/vreng_jag.fap" };
    double ratio = 0;
    int n = 0;

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        lossy *l = make_real(names[i]);
        loss_state = 7;
        for (percent = 5; percent <= 20; percent += 5, n++) {
            const errors e = check_losses(l, is_unlucky);
            ratio += e.shown / e.still;
        }
        drop(l);
    }
    assert_true(ratio / n < 0.98);
}
