/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Captures to FAPs, FAP files to FAP files, and looking into FAP files. What the bytes are decides which.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/fapu_file.h"
#include "common/file.h"
#include "encoder/run.h"

static const size_t max_input = (size_t)1 << 30, max_table = (size_t)1 << 20;

static fap_err fail(run_report *rep, fap_err err, const char *path, const char *text)
{
    rep->path = path;
    snprintf(rep->where, sizeof rep->where, "%s", text && *text ? text : fap_strerror(err));
    return err;
}

static fap_err fail_errno(run_report *rep, fap_err err, const char *path)
{
    return fail(rep, err, path, err == FAP_E_IO && errno ? strerror(errno) : NULL);
}

/* --- writing --- */

/* Gives frames to a writer. */
typedef struct frame_source {
    const fap_frame *frames; /* NULL: the stream in @c data */
    const uint8_t *data;
    size_t size;
} frame_source;

static fap_err put_frame(void *user, const fap_frame *frame)
{
    return stream_writer_put(user, frame);
}

static int wants_bits(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ".fba");
}

static fap_err put_all(stream_writer *w, const fap_ascii_header *header, const frame_source *src)
{
    char where[FAP_ERROR_TEXT_SIZE];
    stream_summary again;
    const frame_sink sink = { .put = put_frame, .user = w };
    fap_err err = FAP_OK;

    if (!src->frames)
        return stream_read(src->data, src->size, NULL, &again, &sink, where);
    for (int64_t i = 0; i < header->frame_count && err == FAP_OK; i++)
        err = stream_writer_put(w, &src->frames[i]);
    return err;
}

static fap_err write_frames(const options *opt, run_report *rep, const fap_writer *out,
                            const fap_ascii_header *header, const frame_source *src)
{
    fap_encoder_config bits = opt->bits;
    stream_writer w;

    bits.rate_hz = header->rate_hz;
    fap_err err = stream_writer_open(&w, out, header, wants_bits(opt->output) ? &bits : NULL);
    if (err == FAP_OK)
        err = put_all(&w, header, src);
    const fap_err closed = stream_writer_close(&w, &rep->written);
    return err != FAP_OK ? err : closed;
}

static fap_err write_output(const options *opt, run_report *rep, const fap_ascii_header *header,
                            const frame_source *src)
{
    out_file out;

    errno = 0;
    if (out_file_open(&out, opt->output) != FAP_OK)
        return fail_errno(rep, FAP_E_IO, opt->output);
    const fap_writer w = file_writer(out.stream);
    const fap_err err = write_frames(opt, rep, &w, header, src);
    if (err != FAP_OK) {
        out_file_abandon(&out);
        return fail_errno(rep, err, opt->output);
    }
    return out_file_commit(&out) == FAP_OK ? FAP_OK : fail_errno(rep, FAP_E_IO, opt->output);
}

/* The file's own name, without folders and ending; the format's header holds one word. */
static void sequence_name(const char *path, char *out, size_t room)
{
    const char *slash = strrchr(path, '/'), *start = slash ? slash + 1 : path;
    const size_t length = strcspn(start, ".");

    snprintf(out, room, "%.*s", (int)(length < room ? length : room - 1), length ? start : "take");
    if (!*out || !strcmp(out, "-"))
        snprintf(out, room, "take");
}

/* --- commands --- */

static fap_err transcode(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    fap_ascii_header header = rep->stream.header;

    header.frame_count = (int64_t)rep->stream.frames;
    snprintf(header.version, sizeof header.version, "2.1");
    if (!header.present)
        sequence_name(opt->input, header.name, sizeof header.name);
    const frame_source src = { NULL, data, size };
    return write_output(opt, rep, &header, &src);
}

static fap_err summarise(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";

    rep->is_stream = 1;
    const fap_err err = stream_read(data, size, NULL, &rep->stream, NULL, where);
    return err == FAP_OK ? FAP_OK : fail(rep, err, opt->input, where);
}

static fap_err inspect(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    frame_sink sink;

    rep->is_stream = 1;
    if (!stream_is_bits(data, size))
        return summarise(opt, rep, data, size);
    rep->inspection = calloc(1, sizeof *rep->inspection);
    if (!rep->inspection)
        return fail(rep, FAP_E_NOMEM, opt->input, NULL);
    rep->inspection->keep_planes = opt->planes;
    sink = inspection_sink(rep->inspection);
    const fap_err err = stream_read(data, size, NULL, &rep->stream, &sink, where);
    inspection_end(rep->inspection, size);
    return err == FAP_OK ? FAP_OK : fail(rep, err, opt->input, where);
}

static fap_err write_capture(const options *opt, run_report *rep)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);
    fap_ascii_header header = {
        .version = "2.1", .rate_hz = r->rate_hz, .frame_count = r->frames, .present = 1
    };
    const frame_source src = { .frames = fap_capture_frames(rep->capture) };

    sequence_name(opt->input, header.name, sizeof header.name);
    return write_output(opt, rep, &header, &src);
}

static fap_err encode(const options *opt, run_report *rep)
{
    fap_capture_config cfg = opt->capture;
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *markers = NULL;
    fap_fapu fapu;

    if (!(rep->take->rate_hz > 0) && opt->rate_given) {
        rep->take->rate_hz = cfg.rate_hz;
        rep->rate_assumed = 1;
    }
    if (!(rep->take->rate_hz > 0))
        return fail(rep, FAP_E_ARG, opt->input,
                    "the take does not say its frame rate; give it with --take-rate");
    if (opt->fapu_path) {
        const fap_err err = fapu_file_read(opt->fapu_path, &fapu, where);
        if (err != FAP_OK)
            return fail(rep, err, opt->fapu_path, where);
        cfg.fapu = &fapu;
    }
    if (opt->markers_path) {
        const fap_err err = file_read(opt->markers_path, max_table, &markers, &cfg.markers_size);
        if (err != FAP_OK)
            return fail_errno(rep, err, opt->markers_path);
        cfg.markers = (const char *)markers;
    }
    const fap_err err = fap_capture_encode(&rep->capture, rep->take, &cfg, where);
    free(markers);
    if (err != FAP_OK)
        return fail(rep, err, err == FAP_E_SYNTAX && opt->markers_path ? opt->markers_path : opt->input,
                    where);
    return write_capture(opt, rep);
}

/* Not a capture? A FAP file has nothing to sniff by, so it is what is left to try. */
static fap_err encode_bytes(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    fap_take_config cfg;
    char where[FAP_ERROR_TEXT_SIZE];

    fap_take_config_init(&cfg);
    cfg.rate_hz = opt->take_rate_hz;
    cfg.mm_per_unit = opt->mm_per_unit;
    const fap_err err = fap_take_read(&rep->take, data, size, &cfg, where);
    if (err == FAP_OK)
        return encode(opt, rep);
    if (err != FAP_E_UNKNOWN_FORMAT)
        return fail(rep, err, opt->input, where);
    if (summarise(opt, rep, data, size) != FAP_OK || !rep->stream.frames) {
        rep->is_stream = 0;
        return fail(rep, err, opt->input, where);
    }
    return transcode(opt, rep, data, size);
}

fap_err run(const options *opt, run_report *rep)
{
    uint8_t *data;
    size_t size;

    errno = 0;
    const fap_err read = file_read(opt->input, max_input, &data, &size);
    if (read != FAP_OK)
        return fail_errno(rep, read, opt->input);
    const fap_err err = (opt->command == COMMAND_INSPECT ? inspect : encode_bytes)(opt, rep, data, size);
    free(data);
    return err;
}

void run_close(run_report *rep)
{
    fap_take_close(&rep->take);
    fap_capture_close(&rep->capture);
    if (rep->inspection)
        inspection_free(rep->inspection);
    free(rep->inspection);
}
