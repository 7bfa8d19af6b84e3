/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * make bench: prints one figure a line, "NAME VALUE UNIT # remark", and writes the same to the JSON file it
 * is given. Names are stable: people compare them across versions.
 */
#include <stdio.h>
#include <time.h>

#include "bench.h"
#include "common/file.h"
#include "common/json.h"

double bench_now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv)
{
    out_file file;

    if (argc != 2 || out_file_open(&file, argv[1]) != FAP_OK) {
        fprintf(stderr, "usage: bench OUT.json\n");
        return 2;
    }
    json j = { .out = file.stream };
    json_open(&j, NULL, '{');
    for (const bench_figure *f = bench_figures; f->name; f++) {
        const double value = f->measure();
        if (value < 0)
            printf("%s - %s # not measured here: %s\n", f->name, f->unit, f->needs);
        else
            printf("%s %.6g %s # %s\n", f->name, value, f->unit, f->remark);
        fflush(stdout);
        if (value >= 0)
            json_number(&j, f->name, value);
    }
    json_close(&j, '}');
    return out_file_commit(&file) == FAP_OK ? 0 : 1;
}
