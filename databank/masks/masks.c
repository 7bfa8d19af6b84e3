/* SPDX-License-Identifier: BSD-2-Clause */
/* See masks.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/landmarks.h>
#include <fap/studio/masks.h>

#include "common/file.h"
#include "common/json.h"
#include "common/tool.h"
#include "databank/drawing.h"
#include "databank/inputs.h"
#include "databank/masks/masks.h"
#include "databank/masks/masks_options.h"
#include "databank/paint.h"

typedef struct work {
    const masks_options *opt;
    fap_bank *bank;
    fap_generic generic;
    fap_surface *face;
    fap_take *landmarks;
    fap_registration *laid;
    uint8_t *mask; /* [face vertices] */
} work;

/* --- found --- */

static int read_bank(work *w, fault *f)
{
    if (!inputs_bank(&w->bank, w->opt->bank, f))
        return 0;
    fap_err err = paint_find_maps(&w->bank);
    if (err == FAP_OK)
        err = fap_generic_of_bank(&w->generic, w->bank, NULL);
    return err == FAP_OK || inputs_blame(f, fap_bank_name(w->bank), err, "");
}

static int show_progress(void *user, double done)
{
    progress_step(user, (int64_t)(1000 * done));
    return 0;
}

static fap_err lay(work *w, const fap_pin *pin, uint32_t pins, char *where)
{
    fap_registration_config cfg = w->opt->fit;
    progress bar;

    progress_start(&bar, "fitting", 1000);
    cfg.progress = show_progress;
    cfg.user = &bar;
    const fap_err err = fap_register(&w->laid, &w->generic, w->face, pin, pins, &cfg, where);
    progress_end(&bar);
    return err;
}

static int find_masks(work *w, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t pins;

    fap_err err = fap_landmarks_pin(w->landmarks, w->bank, pin, &pins, where);
    if (err)
        return inputs_blame(f, w->opt->landmarks, err, where);
    err = lay(w, pin, pins, where);
    w->mask = calloc(w->face->vertex_count, 1);
    if (err == FAP_OK)
        err = w->mask ? fap_masks_retarget(w->laid, &w->generic, w->face, w->mask) : FAP_E_NOMEM;
    return err == FAP_OK || inputs_blame(f, w->opt->face, err, where);
}

/* --- written --- */

static int write_masks(const work *w, fault *f)
{
    out_file out;

    errno = 0;
    fap_err err = out_file_open(&out, w->opt->output);
    if (err == FAP_OK) {
        const fap_writer writer = file_writer(out.stream);
        err = fap_masks_write(w->mask, w->face->vertex_count, &writer);
        if (err == FAP_OK)
            err = out_file_commit(&out);
        else
            out_file_abandon(&out);
    }
    return err == FAP_OK || inputs_blame(f, w->opt->output, err, "");
}

/* --- drawn --- */

static const uint8_t plaster[4] = { 205, 195, 185, 40 };

static int paint_masks(uint8_t (**colour)[4], const uint8_t *mask, uint32_t count, fault *f)
{
    *colour = malloc(count * sizeof **colour);
    for (uint32_t v = 0; *colour && v < count; v++) {
        memcpy((*colour)[v], plaster, sizeof plaster);
        paint_mask_colour(mask[v], (*colour)[v]);
    }
    return *colour || fault_set(f, EXIT_DATA, "out of memory");
}

static int draw_face(const drawing *to, work *w, const fap_bank *like)
{
    const uint32_t n = w->face->vertex_count;
    float(*in_head)[3] = malloc(n * sizeof *in_head);
    fap_surface painted = *w->face;
    fap_bank *drawn = NULL;

    painted.colour = NULL;
    for (uint32_t v = 0; in_head && v < n; v++)
        fap_registration_to_head(w->laid, w->face->position[v], in_head[v]);
    const int ok = in_head && paint_masks(&painted.colour, w->mask, n, to->f) &&
                   drawing_of_scan(to, &drawn, like, &painted, (const float(*)[3])in_head) &&
                   drawing_save(to, drawn, "masks", 0, NULL, 0);
    fap_bank_close(&drawn);
    free(painted.colour);
    free(in_head);
    return ok;
}

static int draw(work *w, fault *f)
{
    const drawing to = { w->opt->pictures, w->opt->gl, f };
    uint8_t(*colour)[4] = NULL;
    fap_bank *laid = NULL;

    const int ok = drawing_open_folder(&to) &&
                   paint_masks(&colour, w->generic.mask, w->generic.vertex_count, f) &&
                   drawing_of_face(&to, &laid, w->bank, fap_registration_positions(w->laid),
                                   (const uint8_t(*)[4])colour) &&
                   drawing_save(&to, laid, "laid", 0, NULL, 0) && draw_face(&to, w, laid);
    fap_bank_close(&laid);
    free(colour);
    return ok;
}

/* --- told --- */

static uint32_t count_side(const work *w, int bit)
{
    uint32_t count = 0;

    for (uint32_t v = 0; v < w->face->vertex_count; v++)
        count += w->mask[v] >> bit & 1;
    return count;
}

static void say(const work *w)
{
    const fap_registration_report *r = fap_registration_report_get(w->laid);

    tool_note("%s: %s laid by %s, %.3f mm rms off", w->opt->output, fap_bank_name(w->bank),
              fap_registration_name(w->opt->fit.method), r->surface_rms_mm);
    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        tool_note("  %-16s %u of %u vertices", fap_mask_side_name(bit), (unsigned)count_side(w, bit),
                  (unsigned)w->face->vertex_count);
    if (!count_side(w, 0) || !count_side(w, 1))
        tool_note("warning: a lip was not found; are the landmarks of the mouth right?");
}

static void say_json(const work *w)
{
    const fap_registration_report *r = fap_registration_report_get(w->laid);
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "face", w->opt->face);
    json_string(&j, "generic", fap_bank_name(w->bank));
    json_string(&j, "method", fap_registration_name(w->opt->fit.method));
    json_integer(&j, "vertices", w->face->vertex_count);
    json_number(&j, "surface_rms_mm", r->surface_rms_mm);
    json_open(&j, "masks", '{');
    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        json_integer(&j, fap_mask_side_name(bit), count_side(w, bit));
    json_close(&j, '}');
    json_close(&j, '}');
    fputc('\n', stdout);
}

static void tidy(work *w)
{
    free(w->mask);
    fap_registration_close(&w->laid);
    fap_take_close(&w->landmarks);
    fap_surface_close(&w->face);
    fap_generic_free(&w->generic, NULL);
    fap_bank_close(&w->bank);
}

int masks_run(int argc, char **argv)
{
    masks_options opt;
    fault f = { 0 };

    if (!masks_options_parse(&opt, argc, argv))
        return opt.exit_status;
    work w = { .opt = &opt };
    const int ok = read_bank(&w, &f) && inputs_scan(&w.face, opt.face, &f) &&
                   inputs_landmarks(&w.landmarks, opt.landmarks, w.face, &f) && find_masks(&w, &f) &&
                   write_masks(&w, &f) && (!opt.pictures || draw(&w, &f));
    if (ok)
        (opt.json ? say_json : say)(&w);
    else
        tool_error("%s", *f.text ? f.text : "out of memory");
    tidy(&w);
    return ok ? EXIT_OK : f.exit_status ? f.exit_status : EXIT_DATA;
}
