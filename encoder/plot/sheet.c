/* SPDX-License-Identifier: BSD-2-Clause */
/* See sheet.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "encoder/plot/plot.h"
#include "encoder/plot/sheet.h"

/* Room for a path's last part. */
enum { TITLE_SIZE = 256, SUBTITLE_SIZE = 512 };

static const char *last_part(const char *path)
{
    const char *slash = strrchr(path, '/');

    if (!strcmp(path, "-"))
        return "standard input";
    return slash ? slash + 1 : path;
}

static void describe_capture(const fap_capture_report *r, char *out)
{
    snprintf(out, SUBTITLE_SIZE, "%s, %u points, %u frames at %g Hz, %.2f s; %u FAP frames at %g Hz",
             r->format, (unsigned)r->take_points, (unsigned)r->take_frames, r->take_rate_hz, r->take_length_s,
             (unsigned)r->frames, r->rate_hz);
}

static void describe_coefficients(const fap_coefficients_report *r, char *out)
{
    snprintf(out, SUBTITLE_SIZE, "%s, %u frames at %g Hz, %.2f s; %u FAP frames at %g Hz", r->format,
             (unsigned)r->take_frames, r->take_rate_hz, r->take_length_s, (unsigned)r->frames, r->rate_hz);
}

static void describe(const run_report *rep, const plot_content *p, char *out)
{
    if (rep->capture)
        describe_capture(fap_capture_report_get(rep->capture), out);
    else if (rep->performance)
        describe_coefficients(fap_performance_report(rep->performance), out);
    else
        snprintf(out, SUBTITLE_SIZE, "%zu FAP frames at %g Hz", p->frame_count, p->rate_hz);
}

/* Whatever the cameras did not see. */
static int is_filled(const void *capture, size_t frame, int fap)
{
    return fap_capture_fill_of(capture, (uint32_t)frame, fap) > FAP_SAMPLE_MEASURED;
}

static void add_capture(plot_content *p, const fap_capture *c)
{
    p->filled = is_filled;
    p->user = c;
}

fap_err sheet_write(const options *opt, const run_report *rep, const frame_source *src, char *where)
{
    char subtitle[SUBTITLE_SIZE];
    fap_frame *frames;
    plot_content p = { .title = last_part(opt->input), .subtitle = subtitle, .rate_hz = src->rate_hz };

    *where = '\0';
    fap_err err = frame_source_load(src, &frames, &p.frame_count);
    if (err != FAP_OK)
        return err;
    p.frame = frames;
    describe(rep, &p, subtitle);
    if (rep->capture)
        add_capture(&p, rep->capture);
    err = plot_write(opt->plot_path, &p, where);
    free(frames);
    return err;
}
