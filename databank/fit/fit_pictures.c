/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit_pictures.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "databank/drawing.h"
#include "databank/fit/fit_pictures.h"
#include "databank/rewrite.h"
#include "surface/nearest.h"

/* The warmest colour of the heat map. */
static const double hot_mm = 2;
static const uint8_t mark_rgb[3] = { 20, 90, 220 };

typedef struct pictures {
    drawing to;
    const fit_work *w;
    fap_bank *scan, *face;
    float (*in_head)[3]; /* [scan vertices] */
} pictures;

static int draw_points(const pictures *p)
{
    render_mark mark[FAP_POINT_COUNT + FAP_LABELS];

    for (uint32_t i = 0; i < p->w->pin_count; i++) {
        fap_registration_to_head(p->w->registration, p->w->pin[i].at, mark[i].place_mm);
        memcpy(mark[i].rgb, mark_rgb, sizeof mark_rgb);
    }
    return drawing_save(&p->to, p->scan, "points", 0, mark, (int)p->w->pin_count);
}

/* --- how far it is off --- */

/* Blue where it lies on the scan, through green and yellow to red. */
static void warm(double mm, uint8_t out[4])
{
    const double t = fmin(1, mm / hot_mm);
    const double r = fmin(1, fmax(0, 2 * t - 0.5)), g = fmin(1, fmax(0, 1.6 - fabs(2.6 * t - 1.0))),
                 b = fmax(0, 1 - 2.2 * t);

    out[0] = (uint8_t)lround(40 + 210 * r);
    out[1] = (uint8_t)lround(40 + 190 * g);
    out[2] = (uint8_t)lround(40 + 210 * b);
    out[3] = 20;
}

static void paint_distances(const pictures *p, const surface_index *index, uint8_t (*colour)[4])
{
    static const uint8_t unseen[4] = { 120, 120, 120, 20 };
    const fap_mesh *mesh = fap_bank_mesh(p->w->bank);
    const float(*at)[3] = fap_registration_positions(p->w->registration);

    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        surface_hit h;
        memcpy(colour[i], unseen, sizeof unseen);
        if (mesh->part[i] == FAP_PART_SKIN &&
            surface_index_nearest(index, at[i], (float)p->w->opt->fit.reach_mm, NULL, NULL, &h))
            warm((double)h.distance, colour[i]);
    }
}

static int draw_distances(const pictures *p)
{
    const fap_surface *scan = p->w->scan;
    uint8_t(*colour)[4] = malloc(fap_bank_mesh(p->w->bank)->vertex_count * sizeof *colour);
    surface_index *index = NULL;
    fap_bank *painted = NULL;

    const fap_err err = colour
                            ? surface_index_open(&index, (const float(*)[3])p->in_head, scan->vertex_count,
                                                 (const uint32_t(*)[3])scan->triangle, scan->triangle_count)
                            : FAP_E_NOMEM;
    if (err == FAP_OK)
        paint_distances(p, index, colour);
    const int ok = err == FAP_OK ? drawing_of_face(&p->to, &painted, p->w->bank,
                                                   fap_registration_positions(p->w->registration),
                                                   (const uint8_t(*)[4])colour) &&
                                       drawing_save(&p->to, painted, "distances", 0, NULL, 0)
                                 : fault_set(p->to.f, EXIT_DATA, "%s: %s", p->to.folder, fap_strerror(err));
    fap_bank_close(&painted);
    surface_index_close(&index);
    free(colour);
    return ok;
}

/* --- the whole --- */

static int open(pictures *p)
{
    const fap_surface *scan = p->w->scan;

    p->in_head = malloc(scan->vertex_count * sizeof *p->in_head);
    if (!p->in_head)
        return fault_set(p->to.f, EXIT_DATA, "out of memory");
    for (uint32_t i = 0; i < scan->vertex_count; i++)
        fap_registration_to_head(p->w->registration, scan->position[i], p->in_head[i]);
    const fap_err err = bank_rewrite(&p->face, p->w->face);
    if (err != FAP_OK)
        return fault_set(p->to.f, EXIT_DATA, "%s: %s", p->to.folder, fap_strerror(err));
    return drawing_open_folder(&p->to) &&
           drawing_of_scan(&p->to, &p->scan, p->face, scan, (const float(*)[3])p->in_head);
}

int fit_pictures_write(fit_work *w, fault *f)
{
    pictures p = { .to = { w->opt->pictures, w->opt->gl, f }, .w = w };

    const int ok = open(&p) && drawing_save(&p.to, p.scan, "before", 0, NULL, 0) && draw_points(&p) &&
                   drawing_save(&p.to, p.face, "after", 0, NULL, 0) &&
                   drawing_save(&p.to, p.face, "wireframe", 1, NULL, 0) && draw_distances(&p);
    fap_bank_close(&p.scan);
    fap_bank_close(&p.face);
    free(p.in_head);
    return ok;
}
