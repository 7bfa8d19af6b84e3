/* SPDX-License-Identifier: BSD-2-Clause */
/* See result.h. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "encoder/batch/result.h"
#include "encoder/report_inspect.h"

const char result_encoded[] = "encoded", result_failed[] = "failed", result_no_take[] = "no take",
           result_ended[] = "ended";

static const char *const names[RESULT_FIELD_COUNT] = {
#define X(name, heading) #name,
    RESULT_FIELDS(X)
#undef X
        [RESULT_made_of] = "made_of",
};

const char *result_field_name(result_field field)
{
    return names[field];
}

const char *result_heading(result_field field)
{
    static const char *const headings[] = {
#define X(name, heading) heading,
        RESULT_FIELDS(X)
#undef X
    };
    return headings[field];
}

/* A line of the file each: what would end it becomes a blank. */
void result_set(result *r, result_field field, const char *fmt, ...)
{
    char *const value = r->value[field];
    va_list args;

    va_start(args, fmt);
    vsnprintf(value, RESULT_VALUE_SIZE, fmt, args);
    va_end(args);
    for (char *c = value; *c; c++)
        if ((unsigned char)*c < ' ')
            *c = ' ';
}

/* --- filling --- */

static int coded_faps(const fap_capture_fap *faps)
{
    int count = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        count += faps[fap].coded > 0;
    return count;
}

static void fill_capture(result *r, const run_report *rep)
{
    const fap_capture_report *c = fap_capture_report_get(rep->capture);

    result_set(r, RESULT_format, "%s", c->format);
    result_set(r, RESULT_points, "%" PRIu32, c->take_points);
    result_set(r, RESULT_take_frames, "%" PRIu32, c->take_frames);
    result_set(r, RESULT_take_rate_hz, "%.6g", c->take_rate_hz);
    result_set(r, RESULT_length_s, "%.3f", c->take_length_s);
    result_set(r, RESULT_frames, "%" PRIu32, c->frames);
    result_set(r, RESULT_rate_hz, "%g", c->rate_hz);
    result_set(r, RESULT_faps, "%d", coded_faps(c->fap));
    result_set(r, RESULT_samples_filled, "%" PRIu32, c->clean.samples_filled);
    result_set(r, RESULT_gaps_left, "%" PRIu32, c->clean.gaps_left);
    if (c->rigid_count)
        result_set(r, RESULT_head_rms_mm, "%.3f", c->rigid_rms_mm);
    result_set(r, RESULT_neutral_s, "%.2f", c->neutral_s);
    result_set(r, RESULT_notes, "%" PRIu32, rep->take->note_count + c->note_count);
}

static void fill_coefficients(result *r, const run_report *rep)
{
    const fap_coefficients_report *c = fap_performance_report(rep->performance);

    result_set(r, RESULT_format, "%s", c->format);
    result_set(r, RESULT_take_frames, "%" PRIu32, c->take_frames);
    result_set(r, RESULT_take_rate_hz, "%.6g", c->take_rate_hz);
    result_set(r, RESULT_length_s, "%.3f", c->take_length_s);
    result_set(r, RESULT_frames, "%" PRIu32, c->frames);
    result_set(r, RESULT_rate_hz, "%g", c->rate_hz);
    result_set(r, RESULT_faps, "%d", coded_faps(c->fap));
    result_set(r, RESULT_notes, "%" PRIu32, rep->coefficients->note_count + c->note_count);
}

static void fill_stream(result *r, const run_report *rep)
{
    const stream_summary *s = &rep->stream;

    result_set(r, RESULT_format, "%s", s->format);
    result_set(r, RESULT_frames, "%" PRIu64, s->frames);
    result_set(r, RESULT_rate_hz, "%g", s->header.rate_hz);
    result_set(r, RESULT_faps, "%d", stream_coded_faps(s));
}

void result_fill(result *r, const run_report *rep, fap_err err)
{
    const written_report *w = &rep->written;

    result_set(r, RESULT_status, "%s",
               err == FAP_OK                 ? result_encoded
               : err == FAP_E_UNKNOWN_FORMAT ? result_no_take
                                             : result_failed);
    if (rep->capture)
        fill_capture(r, rep);
    else if (rep->performance)
        fill_coefficients(r, rep);
    else if (rep->is_stream)
        fill_stream(r, rep);
    if (w->bits && w->length_s > 0)
        result_set(r, RESULT_kbit_s, "%.3f", (double)w->stats.bytes * 0.008 / w->length_s);
    if (err != FAP_OK)
        result_set(r, RESULT_error, "%s", rep->where);
}

/* --- files --- */

int result_write(const result *r, const char *path)
{
    out_file f;

    if (out_file_open(&f, path) != FAP_OK)
        return 0;
    for (int i = 0; i < RESULT_FIELD_COUNT; i++)
        fprintf(f.stream, "%s\t%s\n", names[i], r->value[i]);
    return out_file_commit(&f) == FAP_OK;
}

static void read_line(result *r, const char *line, size_t length)
{
    const char *const tab = memchr(line, '\t', length);

    for (int i = 0; tab && i < RESULT_FIELD_COUNT; i++)
        if (strlen(names[i]) == (size_t)(tab - line) && !memcmp(names[i], line, (size_t)(tab - line)))
            result_set(r, (result_field)i, "%.*s", (int)(length - (size_t)(tab - line) - 1), tab + 1);
}

int result_read(result *r, const char *path)
{
    enum { MAX_SIZE = 64 << 10 };
    uint8_t *data;
    size_t size;

    *r = (result){ { "" } };
    if (file_read(path, MAX_SIZE, &data, &size) != FAP_OK)
        return 0;
    for (const char *line = (const char *)data; *line;) {
        const size_t length = strcspn(line, "\n");
        read_line(r, line, length);
        line += length + (line[length] == '\n');
    }
    free(data);
    return *r->value[RESULT_status] && *r->value[RESULT_made_of];
}
