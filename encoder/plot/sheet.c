/* SPDX-License-Identifier: BSD-2-Clause */
/* See sheet.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "encoder/plot/plot.h"
#include "encoder/plot/sheet.h"
#include "encoder/setup.h"

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
    else if (rep->spoken.speech)
        snprintf(out, SUBTITLE_SIZE, "%s, %u sounds, %.2f s; %zu FAP frames at %g Hz",
                 rep->spoken.speech->format, (unsigned)rep->spoken.mouth.sounds, rep->spoken.speech->length_s,
                 p->frame_count, p->rate_hz);
    else
        snprintf(out, SUBTITLE_SIZE, "%zu FAP frames at %g Hz", p->frame_count, p->rate_hz);
}

/* Whatever the cameras did not see. */
static int is_filled(const void *capture, size_t frame, int fap)
{
    return fap_capture_fill_of(capture, (uint32_t)frame, fap) > FAP_SAMPLE_MEASURED;
}

/* --- where the markers are --- */

static int carries_fap(const fap_capture_report *r, int point)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (r->fap[fap].point == point && !r->fap[fap].reason)
            return 1;
    return 0;
}

/* A marker on a point that moves wins over one that only stands near another. */
static plot_role role_of(const fap_capture_report *r, uint32_t marker)
{
    plot_role role = r->markers.role[marker] & FAP_MARKER_RIGID ? PLOT_RIGID : PLOT_IDLE;

    for (int point = 0; point < FAP_POINT_COUNT; point++) {
        const fap_marker_source *s = &r->markers.point[point];
        for (int k = 0; k < s->count; k++) {
            if (s->index[k] != (int16_t)marker || !carries_fap(r, point))
                continue;
            if (!s->near)
                return PLOT_MOVES;
            role = PLOT_NEAR;
        }
    }
    return role;
}

static int place_markers(const run_report *rep, plot_marker *out)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);
    fap_capture_spot spot;
    int count = 0;

    for (uint32_t i = 0; i < rep->take->point_count; i++) {
        if (!fap_capture_marker_on_face(rep->capture, i, &spot))
            continue;
        plot_marker *k = &out[count++];
        snprintf(k->label, sizeof k->label, "%s", rep->take->name[i]);
        memcpy(k->place_mm, spot.mm, sizeof k->place_mm);
        k->role = role_of(r, i);
    }
    return count;
}

/* The map's face and markers; a take whose markers have no place on it gets curves alone. */
typedef struct face_map {
    fap_bank *bank;
    plot_marker *marker;
} face_map;

/* The face is the one that the markers were placed on. */
static fap_err open_map(face_map *m, plot_content *p, const options *opt, const run_report *rep, char *where)
{
    *m = (face_map){ .marker = calloc((size_t)rep->take->point_count + 1, sizeof *m->marker) };
    if (!m->marker)
        return FAP_E_NOMEM;
    p->marker_count = place_markers(rep, m->marker);
    if (!p->marker_count)
        return FAP_OK;
    p->marker = m->marker;
    const fap_err err = encoder_bank_read(&m->bank, opt->bank_path ? opt->bank_path : "builtin", where);
    p->bank = m->bank;
    return err;
}

static void close_map(face_map *m)
{
    fap_bank_close(&m->bank);
    free(m->marker);
}

static fap_err write_capture(const options *opt, const run_report *rep, plot_content *p, char *where)
{
    face_map map;

    p->filled = is_filled;
    p->user = rep->capture;
    fap_err err = open_map(&map, p, opt, rep, where);
    if (err == FAP_OK)
        err = plot_write(opt->plot_path, p, where);
    close_map(&map);
    return err;
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
    err = rep->capture ? write_capture(opt, rep, &p, where) : plot_write(opt->plot_path, &p, where);
    free(frames);
    return err;
}
