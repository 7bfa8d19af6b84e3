/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes through the .fap reader, in pieces of any size; what it reads is written, read again and written
 * again: the frames must be equal, and the texts the same to the byte. Every open is tried without memory first.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>

#include "tests/fuzz/alloc.h"

enum { OUT_MAX = 1 << 18, MAX_FRAMES = 128 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct memory {
    const uint8_t *data;
    size_t size, at, step; /* step: bytes a read gives at most */
} memory;

static size_t read_memory(void *user, void *buf, size_t size)
{
    memory *m = user;
    size_t n = m->size - m->at < size ? m->size - m->at : size;

    n = n < m->step ? n : m->step;
    if (n)
        memcpy(buf, m->data + m->at, n);
    m->at += n;
    return n;
}

typedef struct sink {
    size_t size;
    uint8_t data[OUT_MAX];
} sink;

static int write_sink(void *user, const void *data, size_t size)
{
    sink *s = user;

    if (size > OUT_MAX - s->size)
        return 1;
    memcpy(s->data + s->size, data, size);
    s->size += size;
    return 0;
}

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

/* What a file says. */
typedef struct take {
    fap_ascii_header header;
    fap_frame frame[MAX_FRAMES];
    int count, vanishes; /* vanishes: a value became absent, which no text that we write can say */
} take;

static void listen(void *user, int64_t line, const char *text)
{
    take *t = user;

    check(line >= 1);
    t->vanishes |= strstr(text, "absent") != NULL;
}

static fap_err open_reader(fap_ascii_reader **r, memory *m, take *t, int strict, fuzz_memory *alloc)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_ascii_reader_config cfg;

    fap_ascii_reader_config_init(&cfg);
    cfg.strict = strict;
    cfg.notice = listen;
    cfg.notice_user = t;
    cfg.alloc = fuzz_allocator(alloc);
    const fap_err err = fap_ascii_reader_open(r, &(fap_reader){ read_memory, m }, &cfg, where);
    check((err == FAP_OK) == (*r != NULL));
    check(err != FAP_E_SYNTAX || !strncmp(where, "line ", 5));
    return err;
}

static void read_frames(fap_ascii_reader *r, take *t)
{
    int64_t last_us = 0;
    fap_frame f;
    fap_err err;

    while ((err = fap_ascii_reader_next(r, &f)) == FAP_OK) {
        check(f.pts_us >= last_us);
        last_us = f.pts_us;
        if (t->count < MAX_FRAMES)
            t->frame[t->count++] = f;
    }
    check(err == FAP_E_END || (err == FAP_E_SYNTAX && !strncmp(fap_ascii_reader_last_error(r), "line ", 5)));
    check(fap_ascii_reader_next(r, &f) == err);
}

/* The first allocation of a reader is its last: without memory nothing is read. */
static int read_take(take *t, const uint8_t *data, size_t size, size_t step, int strict)
{
    fuzz_memory none = { .fail_at = 1 }, all = { 0 };
    memory m = { data, size, 0, step };
    fap_ascii_reader *r;

    t->count = t->vanishes = 0;
    check(open_reader(&r, &m, t, strict, &none) == FAP_E_NOMEM && !m.at);
    const fap_err err = open_reader(&r, &m, t, strict, &all);
    if (err == FAP_OK) {
        t->header = *fap_ascii_reader_header(r);
        read_frames(r, t);
    }
    fap_ascii_reader_close(&r);
    check(all.asked == 1);
    fuzz_memory_check(&all);
    return err == FAP_OK;
}

static void write_take(const take *t, sink *out)
{
    fuzz_memory none = { .fail_at = 1 }, all = { 0 };
    const fap_allocator no_alloc = fuzz_allocator(&none), alloc = fuzz_allocator(&all);
    const fap_writer writer = { write_sink, out };
    fap_ascii_header header = t->header;
    fap_ascii_writer *w;

    header.frame_count = t->count;
    out->size = 0;
    check(fap_ascii_writer_open(&w, &writer, &header, &no_alloc) == FAP_E_NOMEM && !w && !out->size);
    check(fap_ascii_writer_open(&w, &writer, &header, &alloc) == FAP_OK);
    for (int i = 0; i < t->count; i++)
        check(fap_ascii_writer_put(w, &t->frame[i]) == FAP_OK);
    check(fap_ascii_writer_close(&w) == FAP_OK);
    fuzz_memory_check(&all);
}

/* What has become absent is a digit 0 in the text, which is read as held. */
static void compare(const fap_frame *a, const fap_frame *b, int vanishes)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const int vanished = vanishes && a->state[fap] == FAP_ABSENT && b->state[fap] == FAP_HELD;
        check(vanished || (a->state[fap] == b->state[fap] && a->value[fap] == b->value[fap]));
        check(vanished || fap != 1 || !memcmp(&a->viseme, &b->viseme, sizeof a->viseme));
        check(vanished || fap != 2 || !memcmp(&a->expression, &b->expression, sizeof a->expression));
    }
}

static void round_trip(const take *t)
{
    static sink first, second;
    static take again;

    write_take(t, &first);
    check(read_take(&again, first.data, first.size, SIZE_MAX, 0));
    check(again.count == t->count);
    for (int i = 0; i < t->count; i++)
        compare(&t->frame[i], &again.frame[i], t->vanishes);
    write_take(&again, &second);
    check(first.size == second.size && !memcmp(first.data, second.data, first.size));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static take t, strict;

    if (!size)
        return 0;
    const size_t step = data[size - 1] % 8 ? SIZE_MAX : 1 + size / 3;
    if (read_take(&t, data, size, step, 0))
        round_trip(&t);
    if (read_take(&strict, data, size, SIZE_MAX, 1))
        check(strict.count <= t.count);
    return 0;
}
