/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See livelink.h. Every frame is posed on a face first, so that visemes, expressions and what follows from commanded points
 * are in the coefficients, as they are in what a player shows.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/studio/coefficients.h>

#include "common/bank_file.h"
#include "common/file.h"
#include "common/tool.h"
#include "encoder/livelink.h"

typedef struct work {
    fap_bank *bank;
    fap_face *face;
    fap_arkit_fit *fit;
    float *pose;
    fap_coefficients *take;
    progress bar;
    uint32_t done;
} work;

/* The face of --bank, the one that fapplay would show, or the built-in one. */
static fap_err open_bank(work *w, const options *opt, livelink_report *report, const char **path, char *where)
{
    char found[BANK_PATH_SIZE];
    fap_err err = FAP_E_NOT_FOUND;

    if (opt->bank_path && strcmp(opt->bank_path, "builtin")) {
        *path = opt->bank_path;
        err = bank_file_read(&w->bank, opt->bank_path, where);
        if (err != FAP_OK)
            return err;
    } else if (!opt->bank_path && bank_file_default(found)) {
        err = bank_file_read(&w->bank, found, where);
    }
    *where = '\0';
    if (err != FAP_OK)
        err = fap_bank_builtin(&w->bank, NULL);
    if (err == FAP_OK)
        snprintf(report->face, sizeof report->face, "%s", fap_bank_name(w->bank));
    return err;
}

static fap_err open_face(work *w)
{
    const fap_err err = fap_face_open(&w->face, w->bank, NULL);

    if (err != FAP_OK)
        return err;
    w->pose = aligned_alloc(32, 3 * fap_face_stride(w->face) * sizeof *w->pose);
    return w->pose ? fap_arkit_fit_open(&w->fit, NULL) : FAP_E_NOMEM;
}

static void close_work(work *w)
{
    fap_coefficients_close(&w->take);
    fap_arkit_fit_close(&w->fit);
    free(w->pose);
    fap_face_close(&w->face);
    fap_bank_close(&w->bank);
}

static fap_err put_frame(void *user, const fap_frame *frame)
{
    work *w = user;
    float points[FAP_POINT_COUNT][3];
    fap_frame shown = *frame;
    fap_arkit arkit;

    if (w->done == w->take->frame_count)
        return FAP_OK;
    fap_face_pose(w->face, frame, w->pose, NULL);
    fap_face_points(w->face, points);
    fap_face_complete(w->bank, (const float(*)[3])points, &shown);
    fap_arkit_from_faps(w->fit, &shown, &arkit);
    float *value = w->take->value + (size_t)w->done * w->take->channel_count;
    memcpy(value, arkit.shape, sizeof arkit.shape);
    memcpy(value + FAP_CHANNEL_ANGLE, arkit.angle, sizeof arkit.angle);
    memset(w->take->valid + (size_t)w->done * w->take->channel_count, 1, w->take->channel_count);
    progress_step(&w->bar, ++w->done);
    return FAP_OK;
}

static fap_err convert(work *w, const frame_source *src, char *where)
{
    int64_t count;
    fap_err err = frame_source_count(src, &count);

    if (err == FAP_OK && count > FAP_COEFFICIENTS_MAX_FRAMES) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%lld frames; at most %d fit", (long long)count,
                 FAP_COEFFICIENTS_MAX_FRAMES);
        return FAP_E_LIMIT;
    }
    if (err == FAP_OK)
        err = fap_coefficients_create(&w->take, FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT, (uint32_t)count,
                                      NULL);
    if (err != FAP_OK)
        return err;
    for (uint32_t c = 0; c < w->take->channel_count; c++)
        w->take->channel[c] = (uint8_t)c;
    w->take->rate_hz = src->rate_hz;
    progress_start(&w->bar, "converting", count);
    err = frame_source_each(src, put_frame, w);
    progress_end(&w->bar);
    return err;
}

static fap_err write_table(const work *w, const options *opt)
{
    out_file out = { 0 };

    errno = 0;
    if (out_file_open(&out, opt->output) != FAP_OK)
        return FAP_E_IO;
    const fap_writer writer = file_writer(out.stream);
    fap_err err = fap_coefficients_write_livelink(w->take, &writer);
    if (err == FAP_OK)
        err = out_file_commit(&out);
    const int why = errno;
    out_file_abandon(&out);
    errno = why;
    return err;
}

fap_err livelink_write(const options *opt, const frame_source *src, livelink_report *report,
                       const char **path, char *where)
{
    work w = { 0 };

    *where = '\0';
    *path = opt->input;
    *report = (livelink_report){ .rate_hz = src->rate_hz };
    fap_err err = open_bank(&w, opt, report, path, where);
    if (err == FAP_OK)
        err = open_face(&w);
    if (err == FAP_OK)
        err = convert(&w, src, where);
    if (err == FAP_OK) {
        *path = opt->output;
        err = write_table(&w, opt);
        report->frames = w.done;
    }
    close_work(&w);
    return err;
}
