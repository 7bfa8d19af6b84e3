/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes through the .fap reader; what it accepts goes through the writer and must read back the same. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>

enum { OUT_MAX = 1 << 16 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct memory {
    const uint8_t *data;
    size_t size, at;
} memory;

static size_t read_memory(void *user, void *buf, size_t size)
{
    memory *m = user;
    const size_t n = m->size - m->at < size ? m->size - m->at : size;

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

/* Only what was coded is written, and only that must come back. */
static void compare(const fap_frame *a, const fap_frame *b)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        check((a->state[fap] == FAP_CODED) == (b->state[fap] == FAP_CODED));
        check(a->state[fap] != FAP_CODED || a->value[fap] == b->value[fap]);
    }
    check(a->state[1] != FAP_CODED || !memcmp(&a->viseme, &b->viseme, sizeof a->viseme));
    check(a->state[2] != FAP_CODED || !memcmp(&a->expression, &b->expression, sizeof a->expression));
}

static void round_trip(const fap_frame *frame)
{
    static sink out;
    const fap_ascii_header header = { .name = "fuzz", .rate_hz = 25, .frame_count = 1 };
    fap_ascii_writer *writer;
    fap_ascii_reader *reader;
    fap_frame again;

    out.size = 0;
    check(fap_ascii_writer_open(&writer, &(fap_writer){ write_sink, &out }, &header, NULL) == FAP_OK);
    check(fap_ascii_writer_put(writer, frame) == FAP_OK);
    check(fap_ascii_writer_close(&writer) == FAP_OK);
    memory m = { out.data, out.size, 0 };
    check(fap_ascii_reader_open(&reader, &(fap_reader){ read_memory, &m }, NULL, NULL) == FAP_OK);
    check(fap_ascii_reader_next(reader, &again) == FAP_OK);
    compare(frame, &again);
    fap_ascii_reader_close(&reader);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    memory m = { data, size, 0 };
    fap_ascii_reader *reader;
    fap_frame frame;
    int64_t last_us = 0;
    char where[FAP_ERROR_TEXT_SIZE];

    if (fap_ascii_reader_open(&reader, &(fap_reader){ read_memory, &m }, NULL, where) != FAP_OK)
        return 0;
    while (fap_ascii_reader_next(reader, &frame) == FAP_OK) {
        check(frame.pts_us >= last_us);
        last_us = frame.pts_us;
        round_trip(&frame);
    }
    fap_ascii_reader_close(&reader);
    return 0;
}
