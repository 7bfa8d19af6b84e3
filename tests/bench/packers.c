/* SPDX-License-Identifier: BSD-2-Clause */
/* What general packers make of the same streams as text: what an .fba is up against. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

#include <fap/ascii.h>

#include "bench.h"
#include "takes.h"

/* The take as .fap text, into its bytes. */
static int write_text(bench_take *t)
{
    const fap_ascii_header header = { .name = "bench", .rate_hz = t->rate_hz, .frame_count = t->count };
    fap_ascii_writer *w;

    t->size = 0;
    fap_err err = fap_ascii_writer_open(&w, &(fap_writer){ bench_take_write, t }, &header, NULL);
    for (int i = 0; err == FAP_OK && i < t->count; i++)
        err = fap_ascii_writer_put(w, &t->frame[i]);
    return fap_ascii_writer_close(&w) == FAP_OK && err == FAP_OK;
}

/* @p pack gives the packed size of the take's bytes, 0 where it cannot. */
static double measure(size_t (*pack)(const bench_take *))
{
    double value[BENCH_MAX_TAKES], median = -1;
    bench_takes t = { 0 };
    int i = 0;

    bench_takes_add(&t);
    for (; i < t.count; i++) {
        const size_t size = write_text(&t.take[i]) ? pack(&t.take[i]) : 0;
        if (!size)
            break;
        value[i] = 8e-3 * (double)size / bench_take_length_s(&t.take[i]);
    }
    if (i == t.count && i) {
        for (i = 0; i < t.count; i++)
            bench_note(t.take[i].name, value[i], "kbit/s");
        median = bench_median(value, t.count);
    }
    bench_takes_free(&t);
    return median;
}

/* --- gzip --- */

#ifdef HAVE_ZLIB
static size_t gzip(const bench_take *t)
{
    enum { GZIP_WINDOW = 15 + 16, DEFAULT_MEMORY = 8 };
    z_stream z = { .next_in = t->data, .avail_in = (uInt)t->size };

    if (deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, GZIP_WINDOW, DEFAULT_MEMORY, Z_DEFAULT_STRATEGY) !=
        Z_OK)
        return 0;
    const uLong room = deflateBound(&z, (uLong)t->size);
    unsigned char *out = malloc(room);
    z.next_out = out;
    z.avail_out = (uInt)room;
    const size_t size = out && deflate(&z, Z_FINISH) == Z_STREAM_END ? (size_t)z.total_out : 0;
    deflateEnd(&z);
    free(out);
    return size;
}
#else
static size_t gzip(const bench_take *t)
{
    (void)t;
    return 0;
}
#endif

double bench_gzip_kbps(void)
{
    return measure(gzip);
}

/* --- xz --- */

static int save(const bench_take *t, char *path)
{
    const int handle = mkstemp(path);
    FILE *f = handle < 0 ? NULL : fdopen(handle, "wb");

    if (!f)
        return 0;
    const int ok = fwrite(t->data, 1, t->size, f) == t->size;
    return !fclose(f) && ok;
}

/* How many bytes a command prints; 0 where it fails. */
static size_t count_output(const char *command)
{
    unsigned char chunk[4096];
    size_t size = 0;
    FILE *pipe = popen(command, "r");

    if (!pipe)
        return 0;
    for (size_t n; (n = fread(chunk, 1, sizeof chunk, pipe)) > 0;)
        size += n;
    return pclose(pipe) == 0 ? size : 0;
}

static size_t xz(const bench_take *t)
{
    char path[] = "/tmp/fap_bench_XXXXXX", command[128];
    size_t size = 0;

    if (save(t, path)) {
        snprintf(command, sizeof command, "xz -9e -c %s 2>/dev/null", path);
        size = count_output(command);
    }
    unlink(path);
    return size;
}

double bench_xz_kbps(void)
{
    return measure(xz);
}
