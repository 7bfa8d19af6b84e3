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
#include "common/gpio/trigger.h"
#include "common/fit_file.h"
#include "common/tool.h"
#include "encoder/plot/sheet.h"
#include "encoder/run.h"
#include "encoder/setup.h"

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

/* --- what comes out --- */

/* The stream is written by now and stays. */
static fap_err plot(const options *opt, run_report *rep, const fap_ascii_header *header,
                    const frame_source *src)
{
    char where[FAP_ERROR_TEXT_SIZE];
    frame_source timed = *src;

    timed.rate_hz = header->rate_hz;
    const fap_err err = sheet_write(opt, rep, &timed, where);
    rep->no_device = err == FAP_E_UNSUPPORTED;
    if (err == FAP_OK)
        return FAP_OK;
    return *where ? fail(rep, err, opt->plot_path, where) : fail_errno(rep, err, opt->plot_path);
}

static fap_err write_output(const options *opt, run_report *rep, const fap_ascii_header *header,
                            const frame_source *src)
{
    char where[FAP_ERROR_TEXT_SIZE];
    const char *path;
    const fap_err err =
        output_write(opt, header, src, opt->fit_path ? rep->fit : NULL, &rep->written, &path, where);

    if (err == FAP_OK)
        return opt->plot_path ? plot(opt, rep, header, src) : FAP_OK;
    if (err == FAP_E_LIMIT && !*where)
        return fail(rep, err, path,
                    "longer than can be written: too many frames, or over 4096 are left out in a row");
    return *where ? fail(rep, err, path, where) : fail_errno(rep, err, path);
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

/* --- streams --- */

/* The table of --fit; for an .fba that is read, else the one beside it. */
static fap_err find_fit(const options *opt, run_report *rep, int reads_bits)
{
    char where[FAP_ERROR_TEXT_SIZE];
    const char *path = opt->fit_path;

    if (!path && reads_bits && fit_file_beside(opt->input, rep->fit_found, sizeof rep->fit_found))
        path = rep->fit_found;
    if (!path)
        return FAP_OK;
    const fap_err err = fit_file_read(&rep->fit, path, where);
    return err == FAP_OK ? FAP_OK : fail(rep, err, path, where);
}

static fap_err read_stream(const options *opt, run_report *rep, const uint8_t *data, size_t size,
                           const frame_sink *sink)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";

    rep->is_stream = 1;
    rep->reading = (stream_options){ opt->strict, rep->fit };
    const fap_err err = stream_read(data, size, &rep->reading, &rep->stream, sink, where);
    snprintf(rep->first_broken, sizeof rep->first_broken, "%s", where);
    return err == FAP_OK ? FAP_OK : fail(rep, err, opt->input, where);
}

static fap_err transcode(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    fap_ascii_header header = rep->stream.header;

    snprintf(header.version, sizeof header.version, "2.1");
    if (!header.present)
        sequence_name(opt->input, header.name, sizeof header.name);
    const frame_source src = { .data = data, .size = size, .options = &rep->reading };
    return write_output(opt, rep, &header, &src);
}

static fap_err write_livelink(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];
    const char *path;
    const frame_source src = {
        .data = data, .size = size, .options = &rep->reading, .rate_hz = rep->stream.header.rate_hz, .fill = 1
    };
    const fap_err err = livelink_write(opt, &src, &rep->livelink, &path, where);

    if (err == FAP_OK)
        return FAP_OK;
    return *where ? fail(rep, err, path, where) : fail_errno(rep, err, path);
}

static fap_err inspect(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    const int bits = stream_is_bits(data, size);

    if (find_fit(opt, rep, bits) != FAP_OK)
        return FAP_E_DATA;
    if (!bits)
        return read_stream(opt, rep, data, size, NULL);
    rep->inspection = calloc(1, sizeof *rep->inspection);
    if (!rep->inspection)
        return fail(rep, FAP_E_NOMEM, opt->input, NULL);
    *rep->inspection = (inspection){ .keep_planes = opt->planes, .data = data, .size = size };
    const frame_sink sink = inspection_sink(rep->inspection);
    const fap_err err = read_stream(opt, rep, data, size, &sink);
    inspection_end(rep->inspection);
    return err;
}

/* --- captures --- */

/* --visemes, --expressions: in a copy, as the capture's own frames are read only. */
static fap_err name_frames(const options *opt, run_report *rep, frame_source *src, double rate_hz)
{
    fap_naming_config cfg;

    if (!opt->visemes && !opt->expressions)
        return FAP_OK;
    fap_naming_config_init(&cfg);
    cfg.visemes = opt->visemes;
    cfg.expressions = opt->expressions;
    cfg.rate_hz = rate_hz;
    rep->named = calloc(src->count + 1, sizeof *rep->named);
    if (!rep->named)
        return FAP_E_NOMEM;
    memcpy(rep->named, src->frames, src->count * sizeof *rep->named);
    src->frames = rep->named;
    return fap_name_frames(rep->named, src->count, &cfg, &rep->naming);
}

/* What captures of both kinds become. */
static fap_err write_frames(const options *opt, run_report *rep, const fap_frame *frames, size_t count,
                            double rate_hz)
{
    fap_ascii_header header = { .version = "2.1", .rate_hz = rate_hz, .present = 1 };
    frame_source src = { .frames = frames, .count = count };

    sequence_name(opt->input, header.name, sizeof header.name);
    const fap_err err = name_frames(opt, rep, &src, rate_hz);
    return err == FAP_OK ? write_output(opt, rep, &header, &src) : fail(rep, err, opt->input, NULL);
}

static fap_err write_capture(const options *opt, run_report *rep)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);
    return write_frames(opt, rep, fap_capture_frames(rep->capture), r->frames, r->rate_hz);
}

/* What an encoding is given besides the take. */
typedef struct given_files {
    uint8_t *markers;
    fap_bank *bank;
    fap_fapu fapu;
} given_files;

/* *path is the file that is wrong; *where is empty where it could not be read. */
static fap_err read_given(const options *opt, fap_capture_config *cfg, given_files *g, const char **path,
                          char *where)
{
    fap_err err = FAP_OK;

    if ((*path = opt->fapu_path)) {
        err = fapu_file_read(*path, &g->fapu, where);
        cfg->fapu = &g->fapu;
    }
    if (err == FAP_OK && (*path = opt->markers_path)) {
        err = file_read(*path, max_table, &g->markers, &cfg->markers_size);
        cfg->markers = (const char *)g->markers;
    }
    if (err == FAP_OK && (*path = opt->bank_path)) {
        err = encoder_bank_read(&g->bank, *path, where);
        cfg->bank = g->bank;
    }
    return err;
}

static fap_err encode_with(const options *opt, run_report *rep, fap_capture_config *cfg, given_files *g)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    const char *path;
    fap_err err = read_given(opt, cfg, g, &path, where);

    if (err != FAP_OK)
        return *where ? fail(rep, err, path, where) : fail_errno(rep, err, path);
    err = fap_capture_encode(&rep->capture, rep->take, cfg, where);
    if (err != FAP_OK)
        return fail(rep, err, err == FAP_E_SYNTAX && opt->markers_path ? opt->markers_path : opt->input,
                    where);
    return write_capture(opt, rep);
}

static fap_err encode(const options *opt, run_report *rep)
{
    fap_capture_config cfg = opt->capture;
    given_files given = { NULL, NULL, { 0 } };

    if (!(rep->take->rate_hz > 0) && opt->rate_given) {
        rep->take->rate_hz = cfg.rate_hz;
        rep->rate_assumed = 1;
    }
    if (!(rep->take->rate_hz > 0))
        return fail(rep, FAP_E_ARG, opt->input,
                    "the take does not say its frame rate; give it with --take-rate");
    neutral_option_frames(&opt->neutral, rep->take->rate_hz, &cfg.neutral_frame, &cfg.neutral_last);
    const fap_err err = encode_with(opt, rep, &cfg, &given);
    free(given.markers);
    fap_bank_close(&given.bank);
    return err;
}

static fap_err write_performance(const options *opt, run_report *rep)
{
    const fap_coefficients_report *r = fap_performance_report(rep->performance);
    return write_frames(opt, rep, fap_performance_frames(rep->performance), r->frames, r->rate_hz);
}

static fap_err encode_coefficients(const options *opt, run_report *rep)
{
    fap_coefficients_config cfg;
    char where[FAP_ERROR_TEXT_SIZE] = "";

    fap_coefficients_config_init(&cfg);
    cfg.rate_hz = opt->capture.rate_hz;
    cfg.start_s = opt->capture.start_s;
    cfg.end_s = opt->capture.end_s;
    cfg.smooth_hz = opt->capture.smooth_hz;
    cfg.fill = opt->capture.fill;
    if (!(rep->coefficients->rate_hz > 0) && opt->rate_given) {
        rep->coefficients->rate_hz = cfg.rate_hz;
        rep->rate_assumed = 1;
    }
    neutral_option_frames(&opt->neutral, rep->coefficients->rate_hz, &cfg.neutral_frame, &cfg.neutral_last);
    if (opt->neutral.given) /* they have a rest of their own otherwise */
        cfg.rest = cfg.neutral_frame >= 0 ? FAP_REST_FRAME : FAP_REST_FOUND;
    const fap_err err = fap_coefficients_encode(&rep->performance, rep->coefficients, &cfg, where);
    return err == FAP_OK ? write_performance(opt, rep) : fail(rep, err, opt->input, where);
}

static fap_err encode_speech(const options *opt, run_report *rep)
{
    char where[FAP_ERROR_TEXT_SIZE];
    const char *path = opt->input;
    fap_ascii_header header = { .version = "2.1", .rate_hz = opt->capture.rate_hz, .present = 1 };

    const fap_err err = spoken_make(&rep->spoken, opt, &path, &rep->no_device, where);
    if (err != FAP_OK)
        return *where ? fail(rep, err, path, where) : fail_errno(rep, err, path);
    sequence_name(opt->input, header.name, sizeof header.name);
    const frame_source src = { .frames = rep->spoken.frame, .count = rep->spoken.frame_count };
    return write_output(opt, rep, &header, &src);
}

/* @p where: why it is no capture. A text that has no frame is taken for one. */
static fap_err encode_stream(const options *opt, run_report *rep, const uint8_t *data, size_t size,
                             const char *where)
{
    const fap_err err = read_stream(opt, rep, data, size, NULL);

    if (err == FAP_OK && rep->stream.frames)
        return options_want_livelink(opt) ? write_livelink(opt, rep, data, size)
                                          : transcode(opt, rep, data, size);
    rep->is_stream = 0;
    if (stream_is_bits(data, size) || opt->strict)
        return err;
    return fail(rep, FAP_E_UNKNOWN_FORMAT, opt->input, where);
}

/* Not a capture? A FAP file has nothing to sniff by, so it is what is left to try. */
static fap_err encode_bytes(const options *opt, run_report *rep, const uint8_t *data, size_t size)
{
    fap_take_config cfg;
    char where[FAP_ERROR_TEXT_SIZE];

    fap_take_config_init(&cfg);
    cfg.rate_hz = opt->take_rate_hz;
    cfg.mm_per_unit = opt->mm_per_unit;
    const int bits = stream_is_bits(data, size);
    if (find_fit(opt, rep, bits) != FAP_OK)
        return FAP_E_DATA;
    const fap_err err = bits ? FAP_E_UNKNOWN_FORMAT : fap_take_read(&rep->take, data, size, &cfg, where);
    if (err == FAP_OK)
        return encode(opt, rep);
    if (err != FAP_E_UNKNOWN_FORMAT && err != FAP_E_UNSUPPORTED)
        return fail(rep, err, opt->input, where);
    char why[FAP_ERROR_TEXT_SIZE];
    const fap_err other =
        bits ? FAP_E_UNKNOWN_FORMAT : fap_coefficients_read(&rep->coefficients, data, size, &cfg, why);
    if (other == FAP_OK)
        return encode_coefficients(opt, rep);
    if (other != FAP_E_UNKNOWN_FORMAT)
        return fail(rep, other, opt->input, why);
    return encode_stream(opt, rep, data, size, where);
}

/* Nothing is read before the edge, so that the program behind a pipe may begin with it. */
static fap_err await_trigger(const options *opt, run_report *rep)
{
    char where[FAP_ERROR_TEXT_SIZE];
    gpio_input in;
    gpio_event edge;

    if (!gpio_spec_given(&opt->trigger))
        return FAP_OK;
    const int opened = gpio_input_open(&in, &gpio_system, &opt->trigger, tool_name, where);
    const int got = opened ? gpio_trigger_wait(&in, &opt->trigger, &edge, where) : -1;
    gpio_input_close(&in);
    rep->no_device = got < 0;
    return got > 0 ? FAP_OK : fail(rep, FAP_E_IO, "--trigger", where);
}

fap_err run(const options *opt, run_report *rep)
{
    uint8_t *data;
    size_t size;

    const fap_err waited = await_trigger(opt, rep);
    if (waited != FAP_OK)
        return waited;
    if (opt->command == COMMAND_SPEECH)
        return encode_speech(opt, rep);
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
    free(rep->named);
    spoken_close(&rep->spoken);
    fap_take_close(&rep->take);
    fap_capture_close(&rep->capture);
    fap_coefficients_close(&rep->coefficients);
    fap_performance_close(&rep->performance);
    if (rep->inspection)
        inspection_free(rep->inspection);
    free(rep->inspection);
    fap_fit_close(&rep->fit);
}
