/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast a file of points becomes a take, from the disk's cache to the take in memory, and beside another reader of C3D. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <fap/studio/take.h>

#include "bench.h"
#include "common/file.h"

static const char c3d_path[] = "../shared/data/takes/optical_animface/jaw_60hz.c3d";

/* Bytes of the file; 0: it does not read. */
static size_t read_once(const char *path)
{
    fap_take *take = NULL;
    uint8_t *data = NULL;
    size_t size = 0;

    if (file_read(path, 1 << 28, &data, &size) != FAP_OK)
        return 0;
    if (fap_take_read(&take, data, size, NULL, NULL) != FAP_OK)
        size = 0;
    fap_take_close(&take);
    free(data);
    return size;
}

/* The fastest of as many as fit into half a second: what else the machine does only makes it slower. */
static double mb_per_s(const char *path)
{
    const double end = bench_now_s() + 0.5;
    double best = -1;

    do {
        const double start = bench_now_s();
        const size_t size = read_once(path);
        if (!size)
            return -1;
        const double speed = 1e-6 * (double)size / (bench_now_s() - start);
        best = speed > best ? speed : best;
    } while (bench_now_s() < end);
    return best;
}

double bench_read_mb_s_c3d(void)
{
    return mb_per_s(c3d_path);
}

double bench_read_mb_s_trc(void)
{
    return mb_per_s("../shared/data/takes/optical_animface/jaw_60hz.trc");
}

double bench_read_mb_s_csv(void)
{
    return mb_per_s("../shared/data/takes/optical_animface/eyebrows_60hz_nexus.csv");
}

/* ezc3d's library alone, without what its Python side makes of the numbers; measured the same way, in a Python that has it.
 * -1: there is none. */
static double ezc3d_mb_per_s(void)
{
    static const char script[] = "python3 -c 'import ezc3d, os, sys, time\n"
                                 "path, best, end = sys.argv[1], 9e9, time.perf_counter() + 0.5\n"
                                 "while time.perf_counter() < end:\n"
                                 "    start = time.perf_counter()\n"
                                 "    ezc3d.ezc3d.c3d(path)\n"
                                 "    best = min(best, time.perf_counter() - start)\n"
                                 "print(os.path.getsize(path) / best / 1e6)' %s 2>/dev/null";
    char command[sizeof script + sizeof c3d_path];
    double speed = -1;

    snprintf(command, sizeof command, script, c3d_path);
    FILE *pipe = popen(command, "r");
    if (!pipe)
        return -1;
    const int read = fscanf(pipe, "%lf", &speed) == 1;
    return pclose(pipe) == 0 && read ? speed : -1;
}

double bench_read_c3d_x_ezc3d(void)
{
    const double theirs = access(c3d_path, R_OK) ? -1 : ezc3d_mb_per_s();

    if (theirs <= 0)
        return -1;
    const double ours = mb_per_s(c3d_path);
    bench_note("libfap", ours, "MB/s");
    bench_note("ezc3d", theirs, "MB/s");
    return ours / theirs;
}
