/* SPDX-License-Identifier: BSD-2-Clause */
/* See scene.h. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "common/fit_file.h"
#include "common/tool.h"
#include "player/find_bank.h"
#include "player/scene.h"

static const size_t max_stream = (size_t)1 << 30;

/* --- the stream --- */

/* Lines of a .fap, bits of an .fba; and planes that were lost. */
static void note_deviations(const char *path, const stream_summary *s, const char *where, play_report *r)
{
    const char *const place = strcmp(s->format, "fba") ? "line" : "bit";

    for (int i = 0; i < s->notice_count; i++)
        play_report_note(r, "%s: %s %" PRId64 ": %s", path, place, s->notice[i].where, s->notice[i].text);
    if (s->broken_planes)
        play_report_note(r, "%s: %" PRIu64 " planes are broken: %s", path, s->broken_planes, where);
}

/* The table that was asked for; for an .fba, else the one beside it. */
static int find_fit(fap_fit **fit, const char *path, const char *fit_path, int reads_bits, play_report *r)
{
    char where[FAP_ERROR_TEXT_SIZE], beside[REPORT_TEXT_SIZE];

    *fit = NULL;
    if (!fit_path && reads_bits && fit_file_beside(path, beside, sizeof beside)) {
        fit_path = beside;
        play_report_note(r, "interpolates by %s", fit_path);
    }
    if (fit_path && fit_file_read(fit, fit_path, where))
        return fault_set(&r->fault, EXIT_DATA, "%s: %s", fit_path, where);
    return 1;
}

static void find_farthest(scene *s)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        s->farthest[fap] = 0;
        for (size_t i = 0; i < s->line.count; i++) {
            const int64_t value = s->line.frame[i].value[fap];
            const int64_t far = value < 0 ? -value : value;
            if (far > s->farthest[fap])
                s->farthest[fap] = far < INT32_MAX ? (int32_t)far : INT32_MAX;
        }
    }
}

static int read_timeline(scene *s, const char *path, const uint8_t *data, size_t size, play_report *r)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    const stream_options reading = { .fit = s->fit };
    stream_summary summary;
    const fap_err err = timeline_load(&s->line, data, size, &reading, &summary, where);

    if (err)
        return fault_set(&r->fault, EXIT_DATA, "%s: %s", path, where[0] ? where : fap_strerror(err));
    note_deviations(path, &summary, where, r);
    s->kbit_s = (double)size * 8e3 / (double)s->line.end_us;
    find_farthest(s);
    r->stream_frames = (int64_t)summary.frames;
    r->stream_rate_hz = s->line.rate_hz;
    r->stream_s = (double)s->line.end_us * 1e-6;
    return 1;
}

static void free_stream(scene *s)
{
    timeline_free(&s->line);
    fap_fit_close(&s->fit);
}

int scene_load_stream(scene *s, const char *path, const char *fit_path, play_report *r)
{
    uint8_t *data;
    size_t size;
    scene new = *s;
    const fap_err err = file_read(path, max_stream, &data, &size);

    if (err)
        return fault_set(&r->fault, EXIT_DATA, "%s: %s", path,
                         err == FAP_E_IO ? strerror(errno) : fap_strerror(err));
    new.line = (timeline){ 0 };
    const int ok = find_fit(&new.fit, path, fit_path, stream_is_bits(data, size), r) &&
                   read_timeline(&new, path, data, size, r);
    free(data);
    free_stream(ok ? s : &new);
    if (ok)
        *s = new;
    return ok;
}

/* --- the face --- */

int scene_open_face(scene *s, const fap_face_config *config, play_report *r)
{
    fap_face *face;
    const char *name = fap_bank_name(s->bank);
    const fap_err err = fap_face_open(&face, s->bank, config);

    if (err)
        return fault_set(&r->fault, EXIT_DATA, "%s: this face cannot be posed by %s: %s", name,
                         fap_blend_name(config->blend), fap_strerror(err));
    fap_face_close(&s->face);
    s->face = face;
    snprintf(r->face, sizeof r->face, "%s", name);
    return 1;
}

static int make_arrays(scene *s, int with_normals, play_report *r)
{
    const size_t floats = 3 * fap_face_stride(s->face);

    s->position = aligned_alloc(32, 2 * floats * sizeof(float)); /* one block */
    if (!s->position)
        return fault_set(&r->fault, EXIT_DATA, "out of memory");
    s->normal = with_normals ? s->position + floats : NULL;
    return 1;
}

static void free_face(scene *s)
{
    free(s->position);
    fap_face_close(&s->face);
    fap_bank_close(&s->bank);
}

int scene_load_bank(scene *s, const char *name, const fap_face_config *config, int with_normals,
                    play_report *r)
{
    scene new = *s;

    new.bank = NULL;
    new.face = NULL;
    new.position = NULL;
    const int ok = find_bank(&new.bank, name, r) && scene_open_face(&new, config, r) &&
                   make_arrays(&new, with_normals, r);
    free_face(ok ? s : &new);
    if (ok)
        *s = new;
    return ok;
}

void scene_free(scene *s)
{
    free_face(s);
    free_stream(s);
    *s = (scene){ 0 };
}

/* --- a moment --- */

static void put_on(fap_frame *frame, int expression)
{
    enum { CLEARLY = 48 };

    frame->state[2] = FAP_CODED;
    frame->expression = (fap_expression){ .select1 = (uint8_t)expression, .intensity1 = CLEARLY };
}

void scene_pose(scene *s, int64_t time_us, int expression, play_report *r)
{
    fap_face_stats stats;

    timeline_sample(&s->line, time_us, &s->frame);
    if (expression)
        put_on(&s->frame, expression);
    fap_face_pose(s->face, &s->frame, s->position, s->normal);
    fap_face_points(s->face, s->point);
    fap_face_last_stats(s->face, &stats);
    r->error_mm = fmax(r->error_mm, stats.target_error_mm);
    r->residual_mm = fmax(r->residual_mm, stats.residual_error_mm);
}
