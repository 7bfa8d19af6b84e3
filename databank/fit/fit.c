/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit.h. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "common/bank_file.h"
#include "common/file.h"
#include "common/tool.h"
#include "databank/fit/fit.h"
#include "databank/fit/fit_pictures.h"
#include "databank/fit/fit_report.h"

static const size_t most_scan = (size_t)4 << 30, most_landmarks = (size_t)1 << 22;

/* --- what is given --- */

static int blame(fault *f, const char *path, fap_err err, const char *where)
{
    return fault_set(f, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : tool_exit_code(err), "%s: %s", path,
                     *where                     ? where
                     : err == FAP_E_IO && errno ? strerror(errno)
                                                : fap_strerror(err));
}

static int read_bank(fit_work *w, fault *f)
{
    char found[BANK_PATH_SIZE], where[FAP_ERROR_TEXT_SIZE] = "";
    const char *path = w->opt->bank;

    if (!path && bank_file_default(found))
        path = found;
    const fap_err err = !path || !strcmp(path, "builtin") ? fap_bank_builtin(&w->bank, NULL)
                                                          : bank_file_read(&w->bank, path, where);
    return err == FAP_OK ? fap_generic_of_bank(&w->generic, w->bank, NULL) == FAP_OK
                         : blame(f, path ? path : "builtin", err, where);
}

static int read_scan(fit_work *w, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = file_read(w->opt->scan, most_scan, &data, &size);
    if (err == FAP_OK) {
        err = fap_surface_read(&w->scan, data, size, NULL, where);
        free(data);
    }
    if (err == FAP_OK && !w->scan->triangle_count)
        return fault_set(f, EXIT_DATA, "%s: points without triangles; mesh them first", w->opt->scan);
    return err == FAP_OK || blame(f, w->opt->scan, err == FAP_E_UNSUPPORTED ? FAP_E_DATA : err, where);
}

static int read_landmarks(fit_work *w, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = file_read(w->opt->landmarks, most_landmarks, &data, &size);
    if (err == FAP_OK) {
        err = fap_landmarks_read(&w->landmarks, data, size, w->scan, NULL, where);
        free(data);
    }
    if (err == FAP_OK)
        err = fap_landmarks_pin(w->landmarks, w->bank, w->pin, &w->pin_count, where);
    return err == FAP_OK || blame(f, w->opt->landmarks, err, where);
}

/* --- the fit --- */

static double now_s(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

static int show_progress(void *user, double done)
{
    progress_step(user, (int64_t)(1000 * done));
    return 0;
}

static int register_face(fit_work *w, fault *f)
{
    fap_registration_config cfg = w->opt->fit;
    char where[FAP_ERROR_TEXT_SIZE] = "";
    progress bar;

    progress_start(&bar, "fitting", 1000);
    cfg.progress = show_progress;
    cfg.user = &bar;
    const double begin = now_s();
    const fap_err err =
        fap_register(&w->registration, &w->generic, w->scan, w->pin, w->pin_count, &cfg, where);
    w->seconds = now_s() - begin;
    progress_end(&bar);
    return err == FAP_OK || blame(f, w->opt->scan, err, where);
}

static int carry_motions(fit_work *w, fault *f)
{
    const char *slash = strrchr(w->opt->scan, '/');
    const fap_err err = fap_bank_retarget(&w->face, w->bank, fap_registration_positions(w->registration),
                                          slash ? slash + 1 : w->opt->scan, &w->scale);

    return err == FAP_OK ||
           fault_set(f, EXIT_DATA, "%s: the face that came out is none: %s", w->opt->scan, fap_strerror(err));
}

/* --- what comes out --- */

static int ends_with(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ending);
}

/* The face as a surface: the generic face's vertices in their order, with its texture coordinates where it is no finer. */
static fap_err write_surface(const fit_work *w, const fap_writer *out)
{
    const fap_mesh *mesh = fap_bank_mesh(w->bank);
    fap_surface s = *fap_registration_surface(w->registration);

    s.uv = mesh->uv && s.vertex_count == mesh->vertex_count ? (float(*)[2])(uintptr_t)mesh->uv : NULL;
    return ends_with(w->opt->output, ".ply") ? fap_surface_write_ply(&s, out)
                                             : fap_surface_write_obj(&s, out);
}

static fap_err write_face(const fit_work *w, const fap_writer *out)
{
    return ends_with(w->opt->output, ".fbank") ? fap_bank_builder_write(w->face, out) : write_surface(w, out);
}

static int write_output(const fit_work *w, fault *f)
{
    out_file out;

    errno = 0;
    fap_err err = out_file_open(&out, w->opt->output);
    if (err == FAP_OK) {
        const fap_writer writer = file_writer(out.stream);
        err = write_face(w, &writer);
        if (err == FAP_OK)
            err = out_file_commit(&out);
        else
            out_file_abandon(&out);
    }
    return err == FAP_OK || blame(f, w->opt->output, err, "");
}

/* --- the whole --- */

static void tidy(fit_work *w)
{
    fap_bank_builder_close(&w->face);
    fap_registration_close(&w->registration);
    fap_take_close(&w->landmarks);
    fap_surface_close(&w->scan);
    fap_generic_free(&w->generic, NULL);
    fap_bank_close(&w->bank);
}

int fit_run(int argc, char **argv)
{
    fit_options opt;
    fault f = { 0 };

    if (!fit_options_parse(&opt, argc, argv))
        return opt.exit_status;
    fit_work w = { .opt = &opt };
    const int ok = read_bank(&w, &f) && read_scan(&w, &f) && read_landmarks(&w, &f) &&
                   register_face(&w, &f) && carry_motions(&w, &f) && write_output(&w, &f) &&
                   (!opt.pictures || fit_pictures_write(&w, &f));
    if (ok)
        (opt.json ? fit_report_json : fit_report_say)(&w);
    else
        tool_error("%s", *f.text ? f.text : "out of memory");
    tidy(&w);
    return ok ? EXIT_OK : f.exit_status ? f.exit_status : EXIT_DATA;
}
