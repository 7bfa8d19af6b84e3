/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Where every feature point is in every frame: a header row, then frame, time and x, y, z of the 84 points,
 * millimetres in head axes of the room. Points that the face cannot carry have empty cells.
 */
#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/sinks/sink.h"

typedef struct csv_state {
    out_file file;
    const sink_setup *setup;
} csv_state;

static void put_header(FILE *out)
{
    fputs("frame,time_s", out);
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const char *name = fap_point_get(i)->name;
        fprintf(out, ",%s.x,%s.y,%s.z", name, name, name);
    }
    fputc('\n', out);
}

static int failed(const csv_state *s, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: %s", s->setup->output, strerror(errno));
}

static int csv_open(void *state, const sink_setup *setup, fault *f)
{
    csv_state *s = state;

    s->setup = setup;
    if (out_file_open(&s->file, setup->output))
        return failed(s, f);
    put_header(s->file.stream);
    return 1;
}

static int csv_show(void *state, const shown_frame *shown, fault *f)
{
    csv_state *s = state;
    FILE *out = s->file.stream;

    fprintf(out, "%" PRId64 ",%.6f", shown->number, shown->time_s);
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const float *p = shown->point[i];
        if (fap_bank_point_get(s->setup->bank, i)->present)
            fprintf(out, ",%.4f,%.4f,%.4f", p[0], p[1], p[2]);
        else
            fputs(",,,", out);
    }
    fputc('\n', out);
    return ferror(out) ? failed(s, f) : 1;
}

static int csv_finish(void *state, sink_result *result, fault *f)
{
    csv_state *s = state;

    (void)result;
    return out_file_commit(&s->file) ? failed(s, f) : 1;
}

static void csv_close(void *state)
{
    out_file_abandon(&((csv_state *)state)->file);
}

const play_sink sink_csv = {
    .name = "csv",
    .summary = "NAME.csv, -         the feature points of every frame, millimetres",
    .state_size = sizeof(csv_state),
    .open = csv_open,
    .show = csv_show,
    .finish = csv_finish,
    .close = csv_close,
};
