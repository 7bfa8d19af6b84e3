/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick_run.h. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/inputs.h"
#include "databank/pick/pick_options.h"
#include "databank/pick/pick_run.h"
#include "databank/pick/pick_window.h"

typedef struct work {
    const pick_options *opt;
    fap_bank *bank;
    fap_generic generic;
    fap_surface *surface;
    fap_take *landmarks;
    surface_index *scan_index, *guide_index;
    pick_scene scan, guide;
    pick pick;
} work;

static int read_inputs(work *w, fault *f)
{
    return inputs_bank(&w->bank, w->opt->bank, f) && inputs_scan(&w->surface, w->opt->scan, f) &&
           (!w->opt->landmarks || inputs_landmarks(&w->landmarks, w->opt->landmarks, w->surface, f));
}

static fap_err open_scene(pick_scene *s, surface_index **index)
{
    const fap_err err =
        surface_index_open(index, s->position, s->vertex_count, s->triangle, s->triangle_count);

    s->index = *index;
    return err != FAP_OK ? err : pick_scene_open(s) ? FAP_OK : FAP_E_NOMEM;
}

static int open_scenes(work *w, fault *f)
{
    const fap_surface *s = w->surface;

    fap_err err = fap_generic_of_bank(&w->generic, w->bank, NULL);
    w->scan = (pick_scene){ .position = (const float(*)[3])s->position,
                            .triangle = (const uint32_t(*)[3])s->triangle,
                            .vertex_count = s->vertex_count,
                            .triangle_count = s->triangle_count,
                            .colour = (const uint8_t(*)[4])s->colour };
    w->guide = (pick_scene){ .position = w->generic.position,
                             .triangle = w->generic.triangle,
                             .vertex_count = w->generic.vertex_count,
                             .triangle_count = w->generic.triangle_count,
                             .colour = (const uint8_t(*)[4])fap_bank_mesh(w->bank)->colour };
    if (err == FAP_OK)
        err = open_scene(&w->scan, &w->scan_index);
    if (err == FAP_OK)
        err = open_scene(&w->guide, &w->guide_index);
    if (err == FAP_OK)
        err = pick_open(&w->pick, w->bank, w->scan_index);
    if (err == FAP_E_UNSUPPORTED)
        return fault_set(f, EXIT_MISSING,
                         "built without Embree (libembree-dev), which finds what is under the mouse");
    return err == FAP_OK || inputs_blame(f, w->opt->scan, err, "");
}

static int write_output(const work *w, fault *f)
{
    out_file out;

    errno = 0;
    fap_err err = out_file_open(&out, w->opt->output);
    if (err == FAP_OK) {
        pick_write(&w->pick, w->opt->minor, out.stream);
        err = out_file_commit(&out);
    }
    return err == FAP_OK || inputs_blame(f, w->opt->output, err, "");
}

static int run(work *w, fault *f)
{
    if (!read_inputs(w, f) || !open_scenes(w, f))
        return 0;
    if (w->landmarks)
        pick_take(&w->pick, w->landmarks);
    return pick_window_run(&w->pick, &w->scan, &w->guide, f) && write_output(w, f);
}

static void tidy(work *w)
{
    pick_scene_close(&w->scan);
    pick_scene_close(&w->guide);
    surface_index_close(&w->scan_index);
    surface_index_close(&w->guide_index);
    fap_take_close(&w->landmarks);
    fap_surface_close(&w->surface);
    fap_generic_free(&w->generic, NULL);
    fap_bank_close(&w->bank);
}

int pick_run(int argc, char **argv)
{
    pick_options opt;
    fault f = { 0 };

    if (!pick_options_parse(&opt, argc, argv))
        return opt.exit_status;
    work w = { .opt = &opt };
    const int ok = run(&w, &f);
    if (ok)
        tool_note("%s: %u of %d places", opt.output, (unsigned)pick_placed(&w.pick), FAP_LABELS_MAJOR);
    else
        tool_error("%s", *f.text ? f.text : "out of memory");
    tidy(&w);
    return ok ? EXIT_OK : f.exit_status ? f.exit_status : EXIT_DATA;
}
