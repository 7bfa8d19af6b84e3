/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast the .fap reader is: text in memory, so that no disk takes part. */
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>

#include "bench.h"

enum { FRAMES = 60000, FIRST_FAP = 3, ACTIVE = 58, RATE_HZ = 25, RUNS = 5 };

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

static int write_file(memory *m)
{
    const fap_ascii_header header = { .name = "bench", .rate_hz = RATE_HZ, .frame_count = FRAMES };
    fap_ascii_writer *w;
    fap_frame f = { 0 };
    uint32_t seed = 1;
    fap_err err = fap_ascii_writer_open(&w, &(fap_writer){ grow, m }, &header, NULL);

    for (int64_t i = 0; err == FAP_OK && i < FRAMES; i++) {
        invent(&f, &seed, i);
        err = fap_ascii_writer_put(w, &f);
    }
    return fap_ascii_writer_close(&w) == FAP_OK && err == FAP_OK;
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

/* The best of a few runs: the others measure what else the machine does. */
double bench_ascii_parse_fps(void)
{
    memory m = { 0 };
    double best = -1;

    for (int run = 0; run < RUNS && write_file(&m); run++) {
        const double start = bench_now_s();
        const int frames = read_file(&m);
        const double fps = frames / (bench_now_s() - start);
        if (frames == FRAMES && fps > best)
            best = fps;
        m.size = 0;
    }
    free(m.data);
    return best;
}
