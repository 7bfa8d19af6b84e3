/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast .fap text is read and written: from memory to memory, so that no disk takes part. */
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>

#include "bench.h"

enum { FRAMES = 60000, FIRST_FAP = 3, ACTIVE = 58, RATE_HZ = 25, RUNS = 15 };

typedef struct memory {
    char *data;
    size_t size, room, at;
} memory;

static int grow(void *user, const void *data, size_t size)
{
    memory *m = user;

    if (m->size + size > m->room) {
        m->room = 2 * (m->room + size);
        char *larger = realloc(m->data, m->room);
        if (!larger)
            return 1;
        m->data = larger;
    }
    memcpy(m->data + m->size, data, size);
    m->size += size;
    return 0;
}

static size_t take(void *user, void *buf, size_t size)
{
    memory *m = user;
    const size_t n = m->size - m->at < size ? m->size - m->at : size;

    memcpy(buf, m->data + m->at, n);
    m->at += n;
    return n;
}

/* Values of one to four digits and both signs, like a talking head's. */
static void invent(fap_frame *f, uint32_t *seed, int64_t number)
{
    f->pts_us = number * 1000000 / RATE_HZ;
    for (int fap = FIRST_FAP; fap < FIRST_FAP + ACTIVE; fap++) {
        *seed = *seed * 1664525u + 1013904223u;
        f->state[fap] = FAP_CODED;
        f->value[fap] = (int32_t)(*seed >> 20) % 2001 - 1000;
    }
}

static fap_frame *invent_all(void)
{
    fap_frame *frame = calloc(FRAMES, sizeof *frame);
    uint32_t seed = 1;

    for (int i = 0; frame && i < FRAMES; i++)
        invent(&frame[i], &seed, i);
    return frame;
}

/* Frames written; the caller times it. */
static int write_file(memory *m, const fap_frame *frame)
{
    const fap_ascii_header header = { .name = "bench", .rate_hz = RATE_HZ, .frame_count = FRAMES };
    fap_ascii_writer *w;

    m->size = 0;
    if (fap_ascii_writer_open(&w, &(fap_writer){ grow, m }, &header, NULL) != FAP_OK)
        return 0;
    int i = 0;
    while (i < FRAMES && fap_ascii_writer_put(w, &frame[i]) == FAP_OK)
        i++;
    return fap_ascii_writer_close(&w) == FAP_OK ? i : 0;
}

/* Frames read; the caller times it. */
static int read_file(memory *m)
{
    fap_ascii_reader *r;
    fap_frame f;
    int count = 0;

    m->at = 0;
    if (fap_ascii_reader_open(&r, &(fap_reader){ take, m }, NULL, NULL) != FAP_OK)
        return 0;
    while (fap_ascii_reader_next(r, &f) == FAP_OK)
        count++;
    fap_ascii_reader_close(&r);
    return count;
}

static int read_again(memory *m, const fap_frame *frame)
{
    (void)frame;
    return read_file(m);
}

/* The best of a few runs: the others measure what else the machine does. The first write makes the memory grow. */
static double best_fps(int (*work)(memory *, const fap_frame *))
{
    fap_frame *frame = invent_all();
    memory m = { 0 };
    double best = -1;

    const int written = frame && write_file(&m, frame);
    for (int run = 0; run < RUNS && written; run++) {
        const double start = bench_now_s();
        const int frames = work(&m, frame);
        const double fps = frames / (bench_now_s() - start);
        if (frames == FRAMES && fps > best)
            best = fps;
    }
    free(m.data);
    free(frame);
    return best;
}

double bench_ascii_parse_fps(void)
{
    return best_fps(read_again);
}

double bench_ascii_write_fps(void)
{
    return best_fps(write_file);
}
