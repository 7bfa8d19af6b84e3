/* SPDX-License-Identifier: BSD-2-Clause */
/* See retarget.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/expression.h>
#include <fap/studio/landmarks.h>
#include <fap/studio/retarget.h>

#include "common/file.h"
#include "common/json.h"
#include "common/tool.h"
#include "databank/build/marked.h"
#include "databank/drawing.h"
#include "databank/inputs.h"
#include "databank/retarget/retarget.h"
#include "databank/retarget/retarget_options.h"
#include "databank/shapes.h"

typedef struct work {
    const retarget_options *opt;
    fap_bank *bank;
    fap_generic generic;
    fap_surface *face; /* of --to */
    shapes shapes;     /* of --from */
    fap_registration *laid;
    fap_bank_builder *out;
    fap_retarget_scale scale;
    int keys;
} work;

static int read_bank(work *w, fault *f)
{
    return inputs_bank(&w->bank, w->opt->bank, f) &&
           fap_generic_of_bank(&w->generic, w->bank, NULL) == FAP_OK;
}

static int open_folder(const work *w, fault *f)
{
    return !w->opt->pictures || drawing_open_folder(&(drawing){ w->opt->pictures, NULL, f });
}

/* --- the same structure --- */

/* The bank's face, and the one that its motions come to. */
static int draw_faces(const work *w, fault *f)
{
    const drawing d = { w->opt->pictures, NULL, f };
    fap_bank *left = NULL, *right = NULL;

    const int ok = drawing_of_face(&d, &left, w->bank, w->generic.position, NULL) &&
                   drawing_of_face(&d, &right, w->bank, (const float(*)[3])w->face->position, NULL) &&
                   drawing_save_pair(&d, left, right, "faces");
    fap_bank_close(&left);
    fap_bank_close(&right);
    return ok;
}

static int retarget_to(work *w, fault *f)
{
    const uint32_t n = fap_bank_mesh(w->bank)->vertex_count;

    if (!inputs_surface(&w->face, w->opt->to, f))
        return 0;
    if (w->face->vertex_count != n)
        return fault_set(
            f, EXIT_DATA,
            "%s: %u vertices, the bank's face has %u: not of one structure; fapbank fit gives it that",
            w->opt->to, (unsigned)w->face->vertex_count, (unsigned)n);
    const char *slash = strrchr(w->opt->to, '/');
    const fap_err err = fap_bank_retarget(&w->out, w->bank, (const float(*)[3])w->face->position,
                                          slash ? slash + 1 : w->opt->to, &w->scale);
    w->keys = fap_bank_key_count(w->bank);
    if (err != FAP_OK)
        return inputs_blame(f, w->opt->to, err, "");
    return !w->opt->pictures || draw_faces(w, f);
}

/* --- another structure --- */

static int lay_face(work *w, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_registration_config cfg;
    fap_pin pin[FAP_POINT_COUNT];
    fap_take *landmarks = NULL;
    uint32_t pins;

    if (!inputs_landmarks(&landmarks, w->opt->landmarks, w->shapes.neutral, f))
        return 0;
    fap_err err = fap_landmarks_pin(landmarks, w->bank, pin, &pins, where);
    fap_take_close(&landmarks);
    if (err != FAP_OK)
        return inputs_blame(f, w->opt->landmarks, err, where);
    fap_registration_config_init(&cfg);
    cfg.mm_per_unit = w->opt->mm_per_unit;
    err = fap_register(&w->laid, &w->generic, w->shapes.neutral, pin, pins, &cfg, where);
    return err == FAP_OK || inputs_blame(f, w->opt->from, err, where);
}

/* The source in the head's axes and millimetres, its motions too. */
static void turn_source(work *w)
{
    fap_surface *n = w->shapes.neutral;

    for (uint32_t i = 0; i < n->vertex_count; i++) {
        float rest[3];
        fap_registration_to_head(w->laid, n->position[i], rest);
        for (int s = 0; s < w->shapes.count; s++) {
            float *d = w->shapes.delta[s][i], moved[3];
            for (int a = 0; a < 3; a++)
                moved[a] = n->position[i][a] + d[a];
            fap_registration_to_head(w->laid, moved, moved);
            for (int a = 0; a < 3; a++)
                d[a] = moved[a] - rest[a];
        }
        memcpy(n->position[i], rest, sizeof rest);
    }
}

/* --- pictures --- */

/* @n places at rest, and moved. */
static float (*moved(const float (*rest)[3], const float (*delta)[3], uint32_t n))[3]
{
    float(*out)[3] = malloc(n * sizeof *out);

    for (uint32_t i = 0; out && i < 3 * n; i++)
        out[i / 3][i % 3] = rest[i / 3][i % 3] + delta[i / 3][i % 3];
    return out;
}

/* The source with its shape, and the bank's face with the motion that came of it. */
static int draw_shape(const work *w, int shape, const float (*delta)[3], fault *f)
{
    const drawing d = { w->opt->pictures, NULL, f };
    const fap_surface *n = w->shapes.neutral;
    float(*source)[3] =
        moved((const float(*)[3])n->position, (const float(*)[3])w->shapes.delta[shape], n->vertex_count);
    float(*own)[3] = moved(w->generic.position, delta, w->generic.vertex_count);
    fap_bank *left = NULL, *right = NULL;

    const int ok = (source && own) || fault_set(f, EXIT_DATA, "out of memory");
    const int drawn = ok && drawing_of_scan(&d, &left, w->bank, n, (const float(*)[3])source) &&
                      drawing_of_face(&d, &right, w->bank, (const float(*)[3])own, NULL) &&
                      drawing_save_pair(&d, left, right, w->shapes.name[shape]);
    fap_bank_close(&left);
    fap_bank_close(&right);
    free(source);
    free(own);
    return drawn;
}

static int add_motions(work *w, fault *f)
{
    const uint32_t n = w->generic.vertex_count;
    const float factor = (float)(1 / w->scale.scale); /* from the source's size to the bank's face */
    uint8_t *use = malloc(n);
    float(*delta)[3] = malloc(n * sizeof *delta);
    fap_err err = use && delta ? FAP_OK : FAP_E_NOMEM;

    for (uint32_t i = 0; use && i < n; i++)
        use[i] = w->generic.part[i] == FAP_PART_SKIN;
    for (int s = 0; err == FAP_OK && s < w->shapes.count; s++) {
        err = fap_motion_resample(fap_registration_positions(w->laid), n, w->generic.triangle,
                                  w->generic.triangle_count, use, 8, w->shapes.neutral,
                                  (const float(*)[3])w->shapes.delta[s], delta);
        for (uint32_t i = 0; err == FAP_OK && i < n; i++)
            for (int a = 0; a < 3; a++)
                delta[i][a] *= factor;
        if (err == FAP_OK)
            err = fap_motion_carry(w->bank, w->generic.position, delta);
        if (err == FAP_OK)
            err = marked_add_shape(w->out, w->shapes.name[s], (const float(*)[3])delta);
        if (err == FAP_OK && w->opt->pictures && !draw_shape(w, s, (const float(*)[3])delta, f))
            err = FAP_E_IO;
        w->keys++;
    }
    free(use);
    free(delta);
    return err == FAP_OK || inputs_blame(f, w->opt->from, err, "");
}

/* The bank's face without its motions: those come from the other one. */
static int retarget_from(work *w, fault *f)
{
    if (!shapes_read(&w->shapes, w->opt->from, f) || !lay_face(w, f))
        return 0;
    turn_source(w);
    /* How much larger the source's person is than the bank's. */
    fap_err err = fap_bank_retarget(&w->out, w->bank, fap_registration_positions(w->laid), "", &w->scale);
    fap_bank_builder_close(&w->out);
    if (err == FAP_OK)
        err = fap_bank_builder_still(&w->out, w->bank);
    if (err != FAP_OK)
        return inputs_blame(f, w->opt->from, err, "");
    return add_motions(w, f);
}

/* --- out --- */

static int write_bank(const work *w, fault *f)
{
    out_file out;

    errno = 0;
    fap_err err = out_file_open(&out, w->opt->output);
    if (err == FAP_OK) {
        const fap_writer writer = file_writer(out.stream);
        err = fap_bank_builder_write(w->out, &writer);
        if (err == FAP_OK)
            err = out_file_commit(&out);
        else
            out_file_abandon(&out);
    }
    return err == FAP_OK || inputs_blame(f, w->opt->output, err, "");
}

static void say(const work *w)
{
    const fap_retarget_scale *s = &w->scale;

    tool_note("%s: %d motions of %s on %s", w->opt->output, w->keys, w->opt->to ? w->opt->bank : w->opt->from,
              w->opt->to ? w->opt->to : w->opt->bank);
    tool_note("  times %.3f: the one is %.3f of the other by the eyes, %.3f by the mouth, %.3f by the nose, "
              "%.3f by the lips",
              w->opt->to ? s->scale : 1 / s->scale, s->eyes, s->mouth, s->nose, s->lips);
    if (w->laid)
        tool_note("  the bank's face lies %.3f mm rms off the source's, %u of %u vertices on it",
                  fap_registration_report_get(w->laid)->surface_rms_mm,
                  (unsigned)fap_registration_report_get(w->laid)->seen,
                  (unsigned)fap_registration_report_get(w->laid)->skin);
}

static void say_json(const work *w)
{
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "output", w->opt->output);
    json_integer(&j, "motions", w->keys);
    json_number(&j, "scale", w->opt->to ? w->scale.scale : 1 / w->scale.scale);
    json_number(&j, "eyes", w->scale.eyes);
    json_number(&j, "mouth", w->scale.mouth);
    json_number(&j, "nose", w->scale.nose);
    json_number(&j, "lips", w->scale.lips);
    if (w->laid)
        json_number(&j, "surface_rms_mm", fap_registration_report_get(w->laid)->surface_rms_mm);
    json_close(&j, '}');
    fputc('\n', stdout);
}

static void tidy(work *w)
{
    fap_bank_builder_close(&w->out);
    fap_registration_close(&w->laid);
    fap_surface_close(&w->face);
    shapes_free(&w->shapes);
    fap_generic_free(&w->generic, NULL);
    fap_bank_close(&w->bank);
}

int retarget_run(int argc, char **argv)
{
    retarget_options opt;
    fault f = { 0 };
    work *w = calloc(1, sizeof *w);

    if (!retarget_options_parse(&opt, argc, argv) || !w) {
        free(w);
        return opt.exit_status;
    }
    w->opt = &opt;
    const int ok = read_bank(w, &f) && open_folder(w, &f) && (opt.to ? retarget_to : retarget_from)(w, &f) &&
                   write_bank(w, &f);
    if (ok)
        (opt.json ? say_json : say)(w);
    else
        tool_error("%s", *f.text ? f.text : "out of memory");
    tidy(w);
    free(w);
    return ok ? EXIT_OK : f.exit_status ? f.exit_status : EXIT_DATA;
}
