/* SPDX-License-Identifier: BSD-2-Clause */
/* See track.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/file.h"
#include "common/tool.h"
#include "encoder/track/pick_window.h"
#include "encoder/track/track.h"
#include "encoder/track/track_report.h"

enum { MOST_INPUT = 1 << 22 };

/* --- what is given --- */

static int read_input(const char *path, uint8_t **data, size_t *size, fault *f)
{
    const fap_err err = file_read(path, MOST_INPUT, data, size);

    return err == FAP_OK || fault_set(f, EXIT_DATA, "%s: %s", path,
                                      err == FAP_E_IO      ? strerror(errno)
                                      : err == FAP_E_LIMIT ? "too large for what it should be"
                                                           : fap_strerror(err));
}

static int bad_input(const char *path, fap_err err, const char *where, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: %s", path, *where ? where : fap_strerror(err));
}

/* Picked ones have been written by then. */
static const char *dots_path(const track_options *opt)
{
    return opt->init_path ? opt->init_path : opt->pick_path;
}

static int read_dots(track_work *w, fault *f)
{
    const char *path = dots_path(w->opt);
    char where[FAP_ERROR_TEXT_SIZE];
    uint8_t *data;
    size_t size;

    if (!read_input(path, &data, &size, f))
        return 0;
    const fap_err err = fap_track_dots_read(&w->dots, data, size, NULL, where);
    free(data);
    return err == FAP_OK || bad_input(path, err, where, f);
}

static int read_camera(track_work *w, fault *f)
{
    const char *path = w->opt->camera_path;
    char where[FAP_ERROR_TEXT_SIZE];
    uint8_t *data;
    size_t size;

    if (!path)
        return 1;
    if (!read_input(path, &data, &size, f))
        return 0;
    const fap_err err = fap_camera_read(&w->camera, data, size, where);
    free(data);
    w->camera_known = err == FAP_OK;
    return w->camera_known || bad_input(path, err, where, f);
}

static int find_dot(const fap_track_dots *dots, const char *name)
{
    for (int i = 0; i < dots->count; i++)
        if (!strcasecmp(dots->dot[i].name, name))
            return i;
    return -1;
}

static int find_ruler(track_work *w, fault *f)
{
    for (int end = 0; end < 2; end++) {
        const char *name = w->opt->ruler[end];
        w->ruler[end] = *name ? find_dot(&w->dots, name) : -1;
        if (*name && w->ruler[end] < 0)
            return fault_set(f, EXIT_DATA, "--ruler: there is no \"%s\" in %s", name, dots_path(w->opt));
    }
    return w->ruler[0] < 0 || w->ruler[0] != w->ruler[1] ||
           fault_set(f, EXIT_USAGE, "--ruler: both ends are %s", w->opt->ruler[0]);
}

/* --- showing the dots --- */

static int open_pick(pick *p, const track_options *opt, fault *f)
{
    uint8_t *list = NULL;
    size_t size;

    if (opt->labels_path && !read_input(opt->labels_path, &list, &size, f))
        return 0;
    const fap_err err = pick_open(p, (const char *)list, opt->mirrors); /* a NUL ends what was read */
    free(list);
    return err == FAP_OK || fault_set(f, EXIT_DATA, "%s: %s", opt->labels_path ? opt->labels_path : "labels",
                                      err == FAP_E_NOT_FOUND ? "no label in it" : fap_strerror(err));
}

static int write_pick(const pick *p, const char *path, fault *f)
{
    out_file file;

    if (out_file_open(&file, path))
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    pick_write(p, file.stream);
    return !out_file_commit(&file) || fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
}

/* In the first picture of a video that is opened for it alone. */
static int show_dots(const track_options *opt, fault *f)
{
    video_in video;
    pick p;

    if (!open_pick(&p, opt, f))
        return 0;
    const int well = video_in_open(&video, opt, f) && video_in_next(&video, f) &&
                     pick_window_run(&p, &video.picture, f) && write_pick(&p, opt->pick_path, f);
    video_in_close(&video);
    pick_close(&p);
    return well;
}

/* --- the take --- */

/* A camera measured at another size of the same shape is scaled; one of another shape saw something else. */
static int fit_camera(track_work *w, fault *f)
{
    enum { USUAL_VIEW_DEG = 50 };
    const int width = w->seen.width_px, height = w->seen.height_px;
    fap_camera *c = &w->camera;

    if (!w->camera_known) {
        fap_camera_guess(c, width, height, w->opt->view_deg > 0 ? w->opt->view_deg : USUAL_VIEW_DEG);
        return 1;
    }
    const double shape = (double)width * c->height_px / ((double)height * c->width_px);
    if (shape < 0.99 || shape > 1.01)
        return fault_set(f, EXIT_DATA,
                         "%s: a camera of %d x %d pixels cannot have filmed %d x %d: measure it as it films",
                         w->opt->camera_path, c->width_px, c->height_px, width, height);
    fap_camera_resize(c, width, height);
    return 1;
}

static int place(track_work *w, fault *f)
{
    const size_t labels = (size_t)w->dots.count;
    const char **name = calloc(labels, sizeof *name);
    uint8_t *has = calloc(labels, FAP_TRACKS_VIEWS);
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_err err = FAP_E_NOMEM;

    w->report.label = calloc(labels, sizeof *w->report.label);
    if (name && has && w->report.label) {
        for (size_t i = 0; i < labels; i++) {
            name[i] = w->dots.dot[i].name;
            memcpy(has + i * FAP_TRACKS_VIEWS, w->dots.dot[i].has, FAP_TRACKS_VIEWS);
        }
        const fap_tracks tracks = { .labels = w->dots.count,
                                    .mirrors = w->dots.mirrors,
                                    .frames = w->seen.frames,
                                    .rate_hz = w->video.rate_hz,
                                    .name = name,
                                    .has = has,
                                    .point = w->seen.point };
        fap_tracks_config cfg;
        fap_tracks_config_init(&cfg);
        cfg.camera = w->camera;
        memcpy(cfg.ruler, w->ruler, sizeof cfg.ruler);
        cfg.ruler_mm = w->opt->ruler_mm;
        err = fap_tracks_place(&w->take, &tracks, &cfg, &w->report, where);
    }
    free(name);
    free(has);
    return err == FAP_OK || bad_input(w->opt->video, err, where, f);
}

static int write_take(const track_work *w, fault *f)
{
    const char *path = w->opt->output, *slash = strrchr(path, '/');
    out_file file;

    if (out_file_open(&file, path))
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    const fap_writer out = file_writer(file.stream);
    fap_err err = track_options_want_c3d(w->opt)
                      ? fap_take_write_c3d(w->take, &out, FAP_C3D_INTEL, 0)
                      : fap_take_write_trc(w->take, slash ? slash + 1 : path, &out);
    if (err == FAP_OK)
        err = out_file_commit(&file);
    if (err == FAP_OK)
        return 1;
    out_file_abandon(&file);
    return fault_set(f, EXIT_DATA, "%s: %s", path, err == FAP_E_IO ? strerror(errno) : fap_strerror(err));
}

static int work(track_work *w, fault *f)
{
    if (!read_dots(w, f) || !read_camera(w, f) || !find_ruler(w, f) || !video_in_open(&w->video, w->opt, f))
        return 0;
    w->over = overlay_of(w->opt->overlay_path, w->video.rate_hz);
    return follow(&w->seen, &w->video, &w->dots, w->opt->radius_px, &w->over, f) && fit_camera(w, f) &&
           place(w, f) && write_take(w, f) && overlay_finish(&w->over, f);
}

static void tidy(track_work *w)
{
    overlay_close(&w->over);
    video_in_close(&w->video);
    followed_free(&w->seen);
    fap_take_close(&w->take);
    free(w->report.label);
    fap_track_dots_close(&w->dots);
}

int track_run(int argc, char **argv)
{
    fault f = { EXIT_OK, "" };
    track_options opt;

    if (!track_options_parse(&opt, argc, argv))
        return opt.exit_status;
    track_work w = { .opt = &opt, .over = overlay_of(NULL, 0) };
    if ((!opt.pick_path || show_dots(&opt, &f)) && opt.output && work(&w, &f))
        (opt.json ? track_report_json : track_report_say)(&w);
    if (f.exit_status != EXIT_OK)
        tool_error("%s", f.text);
    tidy(&w);
    return f.exit_status;
}
