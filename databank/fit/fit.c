/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit.h. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/fit/fit.h"
#include "databank/fit/fit_dress.h"
#include "databank/fit/fit_pictures.h"
#include "databank/fit/fit_report.h"
#include "databank/inputs.h"

/* --- what is given --- */

static int read_bank(fit_work *w, fault *f)
{
    return inputs_bank(&w->bank, w->opt->bank, f) &&
           fap_generic_of_bank(&w->generic, w->bank, NULL) == FAP_OK;
}

/* The thesis deforms its generic model by 172 points: the minor ones follow those that are given. */
static fap_err follow_landmarks(fit_work *w)
{
    fap_label_place *place = calloc(FAP_LABELS, sizeof *place);
    fap_labels labels;
    fap_err err = place ? fap_labels_of_bank(&labels, w->bank) : FAP_E_NOMEM;

    for (uint32_t i = 0; err == FAP_OK && i < labels.count; i++)
        for (uint32_t k = 0; k < w->pin_count; k++)
            if (w->pin[k].vertex[0] == labels.vertex[i]) {
                memcpy(place[i].at, w->pin[k].at, sizeof place[i].at);
                place[i].state = FAP_LABEL_PLACED;
            }
    if (err == FAP_OK)
        err = fap_labels_follow(&labels, w->bank, w->scan, place);
    for (uint32_t i = 0; err == FAP_OK && i < labels.count; i++) {
        const uint32_t v = labels.vertex[i];
        if (place[i].state != FAP_LABEL_MET || (w->generic.mask && w->generic.mask[v]))
            continue; /* of a lip or a lid: a ray cannot tell which one it has met */
        fap_pin *pin = &w->pin[w->pin_count++];
        *pin = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        memcpy(pin->at, place[i].at, sizeof pin->at);
        w->followed++;
    }
    free(place);
    return err == FAP_E_NOT_FOUND ? FAP_OK : err;
}

static int read_landmarks(fit_work *w, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";

    if (!inputs_landmarks(&w->landmarks, w->opt->landmarks, w->scan, f))
        return 0;
    fap_err err = fap_landmarks_pin(w->landmarks, w->bank, w->pin, &w->pin_count, where);
    if (err == FAP_OK && w->opt->minor)
        err = follow_landmarks(w);
    return err == FAP_OK || inputs_blame(f, w->opt->landmarks, err, where);
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
    return err == FAP_OK || inputs_blame(f, w->opt->scan, err, where);
}

static int carry_motions(fit_work *w, fault *f)
{
    const char *slash = strrchr(w->opt->scan, '/');
    fap_err err = fap_bank_retarget(&w->face, w->bank, fap_registration_positions(w->registration),
                                    slash ? slash + 1 : w->opt->scan, &w->scale);

    if (err == FAP_OK)
        err = fit_dress(w);
    if (err == FAP_OK)
        err = fit_dress_bank(w);

    return err == FAP_OK ||
           fault_set(f, EXIT_DATA, "%s: the face that came out is none: %s", w->opt->scan, fap_strerror(err));
}

/* --- what comes out --- */

static int ends_with(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ending);
}

/* Triangles of the front, and the vertices that they have, moved up in their order. */
static void keep_front(fap_surface *s, const uint8_t *front, uint32_t *place)
{
    uint32_t vertices = 0, triangles = 0;

    for (uint32_t i = 0; i < s->vertex_count; i++) {
        if (!front[i])
            continue;
        memmove(s->position[vertices], s->position[i], sizeof *s->position);
        if (s->uv)
            memmove(s->uv[vertices], s->uv[i], sizeof *s->uv);
        if (s->colour)
            memmove(s->colour[vertices], s->colour[i], sizeof *s->colour);
        place[i] = vertices++;
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *v = s->triangle[t];
        if (!front[v[0]] || !front[v[1]] || !front[v[2]])
            continue;
        const uint32_t moved[3] = { place[v[0]], place[v[1]], place[v[2]] };
        memcpy(s->triangle[triangles++], moved, sizeof moved);
    }
    s->vertex_count = vertices;
    s->triangle_count = triangles;
}

static fap_err write_front(const fit_work *w, const fap_surface *face, const fap_writer *out)
{
    uint32_t *place = calloc(face->vertex_count, sizeof *place);
    fap_surface *s = NULL;

    fap_err err =
        place ? fap_surface_create(&s, face->vertex_count, face->triangle_count, NULL) : FAP_E_NOMEM;
    if (err == FAP_OK) {
        memcpy(s->position, face->position, face->vertex_count * sizeof *s->position);
        memcpy(s->triangle, face->triangle, face->triangle_count * sizeof *s->triangle);
        s->uv = face->uv ? malloc(face->vertex_count * sizeof *s->uv) : NULL;
        s->colour = face->colour ? malloc(face->vertex_count * sizeof *s->colour) : NULL;
        if (s->uv)
            memcpy(s->uv, face->uv, face->vertex_count * sizeof *s->uv);
        if (s->colour)
            memcpy(s->colour, face->colour, face->vertex_count * sizeof *s->colour);
        keep_front(s, fap_registration_front(w->registration), place);
        err =
            ends_with(w->opt->output, ".ply") ? fap_surface_write_ply(s, out) : fap_surface_write_obj(s, out);
    }
    fap_surface_close(&s);
    free(place);
    return err;
}

/* The face as a surface: the generic face's vertices in their order, with the scan's texture coordinates, else the generic face's
 * where it is no finer. */
static fap_err write_surface(const fit_work *w, const fap_writer *out)
{
    const fap_mesh *mesh = fap_bank_mesh(w->bank);
    fap_surface s = *fap_registration_surface(w->registration);

    s.uv = w->uv                                              ? w->uv
           : mesh->uv && s.vertex_count == mesh->vertex_count ? (float(*)[2])(uintptr_t)mesh->uv
                                                              : NULL;
    s.colour = w->colour;
    if (w->opt->face_only)
        return write_front(w, &s, out);
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
    return err == FAP_OK || inputs_blame(f, w->opt->output, err, "");
}

/* --- the whole --- */

static void tidy(fit_work *w)
{
    fit_undress(w);
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
    const int ok = read_bank(&w, &f) && inputs_scan(&w.scan, opt.scan, &f) && read_landmarks(&w, &f) &&
                   register_face(&w, &f) && carry_motions(&w, &f) && write_output(&w, &f) &&
                   (!opt.pictures || fit_pictures_write(&w, &f));
    if (ok)
        (opt.json ? fit_report_json : fit_report_say)(&w);
    else
        tool_error("%s", *f.text ? f.text : "out of memory");
    tidy(&w);
    return ok ? EXIT_OK : f.exit_status ? f.exit_status : EXIT_DATA;
}
