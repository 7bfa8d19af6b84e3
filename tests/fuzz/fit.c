/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any text through the reader of interpolation tables, with an allocator that may fail (first byte); what it
 * accepts is written, must read back the same, and must be idempotent on frames. The text's bytes, taken as the
 * fields of a FIT node, go through fap_fit_open() as well.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/fit.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { OUT_MAX = 1 << 20, FIELDS = 9, NODE_INTS = 64, FRAMES = 8 };

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

/* --- memory --- */

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

/* --- text --- */

typedef struct sink {
    size_t size;
    char text[OUT_MAX];
} sink;

static int write_sink(void *user, const void *data, size_t size)
{
    sink *s = user;

    if (size > OUT_MAX - s->size)
        return 1;
    memcpy(s->text + s->size, data, size);
    s->size += size;
    return 0;
}

/* --- frames --- */

static uint32_t next_random(uint32_t *state)
{
    return *state = *state * 1664525 + 1013904223;
}

static fap_frame random_frame(uint32_t *state)
{
    fap_frame f = { 0 };

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const uint32_t r = next_random(state);
        f.state[fap] = (uint8_t)((r >> 28) % 5);
        if (f.state[fap] != FAP_ABSENT && fap > 2)
            f.value[fap] = (r >> 20) % 16 ? (int32_t)(r >> 8 & 0x7ff) - 1024 : (int32_t)next_random(state);
    }
    f.viseme = (fap_viseme){ next_random(state) >> 29, 1, next_random(state) >> 26, 0 };
    f.expression = (fap_expression){ 1, 20, next_random(state) >> 30, 63, 0, 0 };
    return f;
}

static void check_applied(const fap_fit *fit, const fap_frame *before, const fap_frame *after)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const int same = before->state[fap] == after->state[fap] && before->value[fap] == after->value[fap];
        check(same || (before->state[fap] == FAP_ABSENT && after->state[fap] == FAP_DERIVED &&
                       fap_fit_gives(fit, fap)));
        check(same || (after->value[fap] <= 1 << 30 && after->value[fap] >= -(1 << 30)));
    }
}

static void apply(const fap_fit *fit, const fap_fit *again)
{
    uint32_t state = 1;

    for (int i = 0; i < FRAMES; i++) {
        const fap_frame f = random_frame(&state);
        fap_frame a = f, b = f;
        fap_fit_apply(fit, &a);
        check_applied(fit, &f, &a);
        fap_fit_apply(again, &b);
        check(!memcmp(&a, &b, sizeof a));
        fap_fit_apply(fit, &b);
        check(!memcmp(&a, &b, sizeof a));
    }
}

/* A table of a node makes a node that makes the same table. */
static void node_again(const fap_fit *fit, const sink *want)
{
    static sink got;
    fap_fit_node *node;
    fap_fit *again;

    got.size = 0;
    check(fap_fit_to_node(fit, &node, NULL) == FAP_OK);
    check(fap_fit_open(&again, node, NULL, NULL) == FAP_OK);
    fap_fit_node_close(&node);
    check(fap_fit_write(again, &(fap_writer){ write_sink, &got }) == FAP_OK);
    check(got.size == want->size && !memcmp(got.text, want->text, got.size));
    fap_fit_close(&again);
}

static void round_trip(const fap_fit *fit, int of_node)
{
    static sink first, second;
    fap_fit *again;

    first.size = second.size = 0;
    if (fap_fit_write(fit, &(fap_writer){ write_sink, &first }) != FAP_OK)
        return; /* it is longer than we hold */
    check(fap_fit_parse(&again, first.text, first.size, NULL, NULL) == FAP_OK);
    check(fap_fit_write(again, &(fap_writer){ write_sink, &second }) == FAP_OK);
    check(first.size == second.size && !memcmp(first.text, second.text, first.size));
    apply(fit, again);
    fap_fit_close(&again);
    if (of_node)
        node_again(fit, &first);
}

/* --- node --- */

/* Bytes are small numbers, 255 is -1; a byte of lengths for each field, then what is in them. */
static void open_node(const uint8_t *data, size_t size)
{
    static int32_t ints[FIELDS][NODE_INTS];
    static float floats[2][NODE_INTS];
    size_t count[FIELDS] = { 0 }, at = FIELDS;
    fap_fit *fit;

    if (size < FIELDS)
        return;
    for (int field = 0; field < FIELDS; field++)
        for (int i = 0; i < data[field] % NODE_INTS && at < size; i++, at++) {
            ints[field][count[field]++] = (int8_t)data[at];
            floats[field & 1][i] = (float)(int8_t)data[at] / 7;
        }
    const fap_fit_node node = {
        ints[0],  count[0], ints[1],  count[1], ints[2],  count[2],  ints[3],  count[3],  ints[4],
        count[4], ints[5],  count[5], ints[6],  count[6], floats[1], count[7], floats[0], count[8],
    };
    if (fap_fit_open(&fit, &node, NULL, NULL) == FAP_OK)
        round_trip(fit, 1);
    fap_fit_close(&fit);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_fit *fit;

    if (!size)
        return 0;
    int left = data[0] & 1 ? (data[0] >> 1) % 3 : 1000;
    const fap_allocator alloc = { alloc_some, free_some, &left };
    const fap_err err = fap_fit_parse(&fit, (const char *)data + 1, size - 1, &alloc, where);
    check((err == FAP_OK) == (fit != NULL));
    check(memchr(where, '\0', sizeof where) != NULL);
    if (err == FAP_OK)
        round_trip(fit, 0);
    fap_fit_close(&fit);
    open_node(data + 1, size - 1);
    return 0;
}
