/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * make bench: prints one figure a line, "NAME VALUE UNIT # remark", behind it a line "# stream NAME VALUE UNIT" for
 * each stream that is part of it, and writes the figures to the JSON file it is given. Names are stable: people
 * compare them across versions.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

/* --- notes of the figure being measured --- */

enum { MAX_NOTES = 128 };

static struct {
    int count;
    struct {
        char stream[64];
        double value;
        const char *unit;
    } note[MAX_NOTES];
} notes;

void bench_note(const char *stream, double value, const char *unit)
{
    if (notes.count == MAX_NOTES)
        return;
    snprintf(notes.note[notes.count].stream, sizeof notes.note->stream, "%s", stream);
    notes.note[notes.count].value = value;
    notes.note[notes.count++].unit = unit;
}

static void print_notes(void)
{
    for (int i = 0; i < notes.count; i++)
        printf("# stream %s %.6g %s\n", notes.note[i].stream, notes.note[i].value, notes.note[i].unit);
    notes.count = 0;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median(double *value, int count)
{
    qsort(value, (size_t)count, sizeof *value, ascending);
    return count ? (value[(count - 1) / 2] + value[count / 2]) / 2 : -1;
}

int main(int argc, char **argv)
{
    out_file file;

    if (argc < 2 || argc > 3 || out_file_open(&file, argv[1]) != FAP_OK) {
        fprintf(stderr, "usage: bench OUT.json [FIRST LETTERS OF FIGURES]\n");
        return 2;
    }
    json j = { .out = file.stream };
    json_open(&j, NULL, '{');
    for (const bench_figure *f = bench_figures; f->name; f++) {
        if (argc == 3 && strncmp(f->name, argv[2], strlen(argv[2])) != 0)
            continue;
        const double value = f->measure();
        if (value < 0)
            printf("%s - %s # not measured here: %s\n", f->name, f->unit, f->needs);
        else
            printf("%s %.6g %s # %s\n", f->name, value, f->unit, f->remark);
        print_notes();
        fflush(stdout);
        if (value >= 0)
            json_number(&j, f->name, value);
    }
    json_close(&j, '}');
    return out_file_commit(&file) == FAP_OK ? 0 : 1;
}
