/* SPDX-License-Identifier: BSD-2-Clause */
/* A table: a row of names, then frame after frame. What stands in it is the kind's business, csv_kinds.c. */
#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/sinks/csv.h"
#include "player/sinks/export_limit.h"

typedef struct csv_state {
    out_file file;
    const sink_setup *setup;
    const csv_kind *kind;
    void *own; /* the kind's */
} csv_state;

static int failed(const csv_state *s, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: %s", s->setup->output, strerror(errno));
}

static int csv_open(void *state, const sink_setup *setup, fault *f)
{
    csv_state *s = state;

    s->setup = setup;
    s->kind = setup->csv ? setup->csv : csv_kinds[0];
    if (!export_fits(setup, s->kind->frame_size(setup->bank) * (double)setup->count, f))
        return 0;
    if (s->kind->open && !s->kind->open(&s->own))
        return fault_set(f, EXIT_DATA, "out of memory");
    if (out_file_open(&s->file, setup->output))
        return failed(s, f);
    s->kind->put_names(s->file.stream, setup->bank);
    fputc('\n', s->file.stream);
    return 1;
}

static int csv_show(void *state, const shown_frame *shown, fault *f)
{
    csv_state *s = state;
    char head[64];

    snprintf(head, sizeof head, "%" PRId64 ",%.6f", shown->number, shown->time_s);
    s->kind->put_frame(s->file.stream, head, shown, s->setup->bank, s->own);
    return ferror(s->file.stream) ? failed(s, f) : 1;
}

static int csv_finish(void *state, sink_result *result, fault *f)
{
    csv_state *s = state;

    (void)result;
    return out_file_commit(&s->file) ? failed(s, f) : 1;
}

static void csv_close(void *state)
{
    csv_state *s = state;

    out_file_abandon(&s->file);
    if (s->own)
        s->kind->close(s->own);
}

const play_sink sink_csv = {
    .name = "csv",
    .summary = "NAME.csv, -         points, vertices, weights, FAPs or ARKit of every frame: --csv",
    .state_size = sizeof(csv_state),
    .open = csv_open,
    .show = csv_show,
    .finish = csv_finish,
    .close = csv_close,
};
