/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Captures to FAPs, FAP files to FAP files, and looking into FAP files. What the bytes are decides which.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* --- FAP files
 * ----------------------------------------------------------------------------------------------------------
 */

typedef struct memory {
    const uint8_t *at;
    size_t left;
} memory;

static size_t read_memory(void *user, void *buf, size_t size)
{
    memory *m = user;
    const size_t n = size < m->left ? size : m->left;

    if (n)
        memcpy(buf, m->at, n);
    m->at += n;
    m->left -= n;
    return n;
}

static void take_notice(void *user, int64_t line, const char *text)
{
    stream_summary *s = user;

    if (s->notice_count == RUN_MAX_NOTICES)
        return;
    s->notice[s->notice_count].line = line;
    s->notice[s->notice_count++].text = text;
}

static void count_frame(stream_summary *s, const fap_frame *f)
{
    s->frames++;
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        stream_fap *c = &s->fap[fap];
        const int32_t v = f->value[fap];
        if (f->state[fap] != FAP_CODED)
            continue;
        c->min = c->coded && c->min < v ? c->min : v;
        c->max = c->coded && c->max > v ? c->max : v;
        c->sum += v;
        c->coded++;
    }
}

/* Reads a whole stream; hands every frame to @p writer when there is one, otherwise counts into @p s. */
static fap_err read_stream(memory bytes, stream_summary *s, fap_ascii_writer *writer, char *where)
{
    const fap_reader in = { read_memory, &bytes };
    fap_ascii_reader_config cfg;
    fap_ascii_reader *reader;
    fap_frame frame;

    fap_ascii_reader_config_init(&cfg);
    cfg.notice = writer ? NULL : take_notice;
    cfg.notice_user = s;
    fap_err err = fap_ascii_reader_open(&reader, &in, &cfg, where);
    if (err != FAP_OK)
        return err;
    s->header = *fap_ascii_reader_header(reader);
    while (err == FAP_OK && (err = fap_ascii_reader_next(reader, &frame)) == FAP_OK) {
        if (writer)
            err = fap_ascii_writer_put(writer, &frame);
        else
            count_frame(s, &frame);
    }
    if (err != FAP_E_END)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", fap_ascii_reader_last_error(reader));
    fap_ascii_reader_close(&reader);
    return err == FAP_E_END ? FAP_OK : err;
}

/* --- writing
 * ------------------------------------------------------------------------------------------------------------
 */

/* Gives frames to a writer. */
typedef struct frame_source {
    const fap_frame *frames; /* NULL: the stream in @c bytes */
    memory bytes;
    stream_summary *summary;
} frame_source;

static fap_err write_frames(const fap_writer *out, const fap_ascii_header *header, frame_source *src)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_ascii_writer *writer;

    fap_err err = fap_ascii_writer_open(&writer, out, header, NULL);
    if (err != FAP_OK)
        return err;
    for (int64_t i = 0; src->frames && i < header->frame_count && err == FAP_OK; i++)
        err = fap_ascii_writer_put(writer, &src->frames[i]);
    if (!src->frames)
        err = read_stream(src->bytes, src->summary, writer, where);
    const fap_err closed = fap_ascii_writer_close(&writer);
    return err != FAP_OK ? err : closed;
}

static fap_err write_output(const options *opt, run_report *rep, const fap_ascii_header *header,
                            frame_source *src)
{
    out_file out;

    errno = 0;
    if (out_file_open(&out, opt->output) != FAP_OK)
        return fail_errno(rep, FAP_E_IO, opt->output);
    const fap_writer w = file_writer(out.stream);
    const fap_err err = write_frames(&w, header, src);
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

/* --- commands
 * ------------------------------------------------------------------------------------------------------------
 */

static fap_err transcode(const options *opt, run_report *rep, memory bytes)
{
    fap_ascii_header header = rep->stream.header;

    header.frame_count = (int64_t)rep->stream.frames;
    snprintf(header.version, sizeof header.version, "2.1");
    if (!header.present)
        sequence_name(opt->input, header.name, sizeof header.name);
    frame_source src = { NULL, bytes, &rep->stream };
    return write_output(opt, rep, &header, &src);
}

static fap_err summarise(const options *opt, run_report *rep, memory bytes)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";

    rep->is_stream = 1;
    const fap_err err = read_stream(bytes, &rep->stream, NULL, where);
    return err == FAP_OK ? FAP_OK : fail(rep, err, opt->input, where);
}

static fap_err write_capture(const options *opt, run_report *rep)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);
    fap_ascii_header header = {
        .version = "2.1", .rate_hz = r->rate_hz, .frame_count = r->frames, .present = 1
    };
    frame_source src = { .frames = fap_capture_frames(rep->capture) };

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
static fap_err encode_bytes(const options *opt, run_report *rep, memory bytes)
{
    fap_take_config cfg;
    char where[FAP_ERROR_TEXT_SIZE];

    fap_take_config_init(&cfg);
    cfg.rate_hz = opt->take_rate_hz;
    cfg.mm_per_unit = opt->mm_per_unit;
    const fap_err err = fap_take_read(&rep->take, bytes.at, bytes.left, &cfg, where);
    if (err == FAP_OK)
        return encode(opt, rep);
    if (err != FAP_E_UNKNOWN_FORMAT)
        return fail(rep, err, opt->input, where);
    if (summarise(opt, rep, bytes) != FAP_OK || !rep->stream.frames) {
        rep->is_stream = 0;
        return fail(rep, err, opt->input, where);
    }
    return transcode(opt, rep, bytes);
}

fap_err run(const options *opt, run_report *rep)
{
    uint8_t *data;
    size_t size;

    errno = 0;
    const fap_err read = file_read(opt->input, max_input, &data, &size);
    if (read != FAP_OK)
        return fail_errno(rep, read, opt->input);
    const memory bytes = { data, size };
    const fap_err err =
        opt->command == COMMAND_INSPECT ? summarise(opt, rep, bytes) : encode_bytes(opt, rep, bytes);
    free(data);
    return err;
}

void run_close(run_report *rep)
{
    fap_take_close(&rep->take);
    fap_capture_close(&rep->capture);
}
