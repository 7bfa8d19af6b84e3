/* SPDX-License-Identifier: BSD-2-Clause */
/* See output.h. */
#include <errno.h>
#include <stdio.h>

#include "common/file.h"
#include "common/tool.h"
#include "encoder/output.h"
#include "encoder/setup.h"

/* Everything of one output. */
typedef struct output {
    const options *opt;
    fap_ascii_header header;
    frame_source src;
    encoder_setup setup;
    out_file stream, table;
    stream_writer writer;
    progress bar;
    int64_t done, last_us;
    written_report *report;
} output;

static fap_err put_frame(void *user, const fap_frame *frame)
{
    output *o = user;

    progress_step(&o->bar, ++o->done);
    o->last_us = frame->pts_us;
    return stream_writer_put(&o->writer, frame);
}

static fap_err put_all(output *o)
{
    const fap_writer out = file_writer(o->stream.stream);

    fap_err err = stream_writer_open(&o->writer, &out, &o->header, o->report->bits ? &o->setup.bits : NULL);
    if (err == FAP_OK) {
        progress_start(&o->bar, "encoding", o->header.frame_count);
        err = frame_source_each(&o->src, put_frame, o);
        progress_end(&o->bar);
    }
    const fap_err closed = stream_writer_close(&o->writer, &o->report->stats);
    o->report->length_s = (double)o->last_us * 1e-6 + 1 / o->header.rate_hz;
    return err != FAP_OK ? err : closed;
}

/* Into the temporary: it gets its name when the stream is whole. */
static fap_err write_table(output *o, const char **path)
{
    *path = o->opt->learn_path;
    if (out_file_open(&o->table, o->opt->learn_path) != FAP_OK)
        return FAP_E_IO;
    const fap_writer out = file_writer(o->table.stream);
    return fap_fit_write(o->setup.learnt, &out);
}

static fap_err set_up_bits(output *o, const fap_fit *fit, const char **path, char *where)
{
    const fap_err err = encoder_setup_open(&o->setup, o->opt, fit, &o->src, path, where);

    if (err != FAP_OK)
        return err;
    snprintf(o->report->face, sizeof o->report->face, "%s", o->setup.face);
    o->report->fit_gives = o->setup.learnt_gives;
    return o->setup.learnt ? write_table(o, path) : FAP_OK;
}

/* The table first: a table without its stream harms nobody. */
static fap_err commit(output *o, const char **path)
{
    *path = o->opt->learn_path;
    if (o->setup.learnt && out_file_commit(&o->table) != FAP_OK)
        return FAP_E_IO;
    *path = o->opt->output;
    return out_file_commit(&o->stream);
}

static fap_err write_all(output *o, const fap_fit *fit, const char **path, char *where)
{
    fap_err err = frame_source_count(&o->src, &o->header.frame_count);

    if (err == FAP_OK && o->report->bits)
        err = set_up_bits(o, fit, path, where);
    if (err != FAP_OK)
        return err;
    *path = o->opt->output;
    if (out_file_open(&o->stream, o->opt->output) != FAP_OK)
        return FAP_E_IO;
    err = put_all(o);
    return err == FAP_OK ? commit(o, path) : err;
}

fap_err output_write(const options *opt, const fap_ascii_header *header, const frame_source *src,
                     const fap_fit *fit, written_report *written, const char **path, char *where)
{
    output o = { .opt = opt, .header = *header, .src = *src, .report = written };

    errno = 0;
    *where = '\0';
    *path = opt->output;
    *written = (written_report){ .bits = options_want_bits(opt) };
    o.src.rate_hz = header->rate_hz;
    o.src.fill = !written->bits && !src->frames && stream_is_bits(src->data, src->size);
    const fap_err err = write_all(&o, fit, path, where);
    if (err != FAP_OK) {
        const int why = errno;
        out_file_abandon(&o.stream);
        out_file_abandon(&o.table);
        errno = why;
    }
    encoder_setup_close(&o.setup);
    return err;
}
