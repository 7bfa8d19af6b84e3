/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fit_pictures.h. A scan is drawn as a face is: a bank is made of it, feature points where the fit has put them, so that one
 * camera sees both alike.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/fit/fit_pictures.h"
#include "databank/rewrite.h"
#include "player/render/renderer.h"
#include "surface/nearest.h"
#include "surface/normals.h"

enum { TILE_PX = 640, PATH_SIZE = 4096, PNG_LEVEL = 6 };

/* The warmest colour of the heat map. */
static const double hot_mm = 2;
static const uint8_t plaster[4] = { 205, 195, 185, 40 }, mark_rgb[3] = { 20, 90, 220 };

/* --- drawing --- */

typedef struct drawing {
    fit_work *w;
    fault *f;
    fap_bank *scan, *face; /* face: in the generic face's colours */
    float (*in_head)[3];   /* [scan vertices] */
} drawing;

static int fail(const drawing *d, fap_err err, const char *where)
{
    return fault_set(d->f, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : EXIT_DATA, "%s: %s", d->w->opt->pictures,
                     *where ? where : fap_strerror(err));
}

static int save(const drawing *d, const image *im, const char *name)
{
    char path[PATH_SIZE];
    out_file out;

    if (snprintf(path, sizeof path, "%s/%s.png", d->w->opt->pictures, name) >= PATH_SIZE)
        return fault_set(d->f, EXIT_USAGE, "--pictures: too long a name");
    errno = 0;
    fap_err err = out_file_open(&out, path);
    if (err == FAP_OK) {
        err = image_write_png(im, out.stream, PNG_LEVEL);
        if (err == FAP_OK)
            err = out_file_commit(&out);
        else
            out_file_abandon(&out);
    }
    return err == FAP_OK || fault_set(d->f, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : EXIT_DATA, "%s: %s",
                                      path, err == FAP_E_IO && errno ? strerror(errno) : fap_strerror(err));
}

/* Normals of a bank at rest, as the renderer wants them: x[stride] y[stride] z[stride], 32-byte aligned. */
static float *make_normals(const fap_bank *bank, void **block)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    float(*position)[3] = malloc(m->vertex_count * sizeof *position),
    (*normal)[3] = malloc(m->vertex_count * sizeof *normal);
    float *out = NULL;

    *block = calloc(3 * (size_t)m->stride * sizeof *out + 32, 1);
    if (position && normal && *block) {
        out = (float *)(((uintptr_t)*block + 31) & ~(uintptr_t)31);
        for (uint32_t i = 0; i < 3 * m->vertex_count; i++)
            position[i / 3][i % 3] = m->position[i % 3 * m->stride + i / 3];
        surface_normals((const float(*)[3])position, m->vertex_count, (const uint32_t(*)[3])m->triangle,
                        m->triangle_count, normal);
        for (uint32_t i = 0; i < 3 * m->vertex_count; i++)
            out[i % 3 * m->stride + i / 3] = normal[i / 3][i % 3];
    }
    free(position);
    free(normal);
    return out;
}

/* From the front and from the side, beside each other. */
static int draw(const drawing *d, const fap_bank *bank, const char *name, int wireframe,
                const render_mark *mark, int marks)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    static const render_camera cameras[2] = { CAMERA_FRONT, CAMERA_THREE_QUARTER };
    image both = { 0 }, one = { 0 };
    renderer *r = NULL;
    void *block;
    const float *normal = make_normals(bank, &block);

    fap_err err = normal ? FAP_OK : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = image_create(&both, 2 * TILE_PX, TILE_PX);
    if (err == FAP_OK)
        err = image_create(&one, TILE_PX, TILE_PX);
    if (err == FAP_OK)
        err = renderer_create(&r, d->w->opt->gl, bank, TILE_PX, TILE_PX, where);
    for (int i = 0; i < 2 && err == FAP_OK; i++) {
        render_view view = render_view_of(cameras[i]);
        view.distance *= 0.85F;
        const render_scene scene = { .position = fap_bank_mesh(bank)->position,
                                     .normal = normal,
                                     .view = view,
                                     .wireframe = wireframe,
                                     .mark = mark,
                                     .mark_count = marks };
        err = renderer_draw(r, &scene, &one);
        if (err == FAP_OK)
            image_blit(&both, &one, i * TILE_PX, 0);
    }
    const int ok = err == FAP_OK ? save(d, &both, name) : fail(d, err, where);
    renderer_destroy(&r);
    image_free(&both);
    image_free(&one);
    free(block);
    return ok;
}

/* --- what is drawn --- */

/* Feature points are places: where the fit has put them. */
static fap_err give_points(const drawing *d, fap_bank_builder *b)
{
    fap_err err = FAP_OK;

    for (int p = 0; p < FAP_POINT_COUNT && err == FAP_OK; p++) {
        const fap_bank_point *point = fap_bank_point_get(d->face, p);
        if (point->present)
            err = fap_bank_builder_place(b, p, point->position_mm);
    }
    return err;
}

static fap_err fill_scan(const drawing *d, fap_build_mesh *mesh, uint8_t **bytes)
{
    const fap_surface *s = d->w->scan;
    const uint32_t n = s->vertex_count;
    uint8_t *block = calloc(n, 1 + 1 + 4), *part = block, *weight = block + n;
    uint8_t(*colour)[4] = (uint8_t(*)[4])(block ? block + 2 * (size_t)n : NULL);

    *bytes = block;
    if (!block)
        return FAP_E_NOMEM;
    memset(weight, 255, n);
    for (uint32_t i = 0; i < n; i++) {
        memcpy(colour[i], plaster, sizeof plaster);
        if (s->colour)
            memcpy(colour[i], s->colour[i], 3);
    }
    *mesh = (fap_build_mesh){ .vertex_count = n,
                              .triangle_count = s->triangle_count,
                              .position = (const float(*)[3])d->in_head,
                              .part = part,
                              .head_weight = weight,
                              .colour = (const uint8_t(*)[4])colour,
                              .triangle = (const uint32_t(*)[3])s->triangle };
    return FAP_OK;
}

static fap_err make_scan(drawing *d)
{
    const fap_surface *s = d->w->scan;
    fap_bank_builder *b = NULL;
    fap_build_mesh mesh;
    uint8_t *bytes = NULL, *mask = calloc(s->vertex_count, 1);
    float *from = calloc(s->vertex_count, 2 * sizeof *from);
    const fap_region_lines lines = { .extent = { 100, 100 }, .from = from };

    d->in_head = malloc(s->vertex_count * sizeof *d->in_head);
    fap_err err = d->in_head && mask && from ? FAP_OK : FAP_E_NOMEM;
    for (uint32_t i = 0; i < s->vertex_count && err == FAP_OK; i++)
        fap_registration_to_head(d->w->registration, s->position[i], d->in_head[i]);
    if (err == FAP_OK)
        err = fill_scan(d, &mesh, &bytes);
    if (err == FAP_OK)
        err = fap_bank_builder_open(&b, "scan", &mesh);
    if (err == FAP_OK)
        err = give_points(d, b);
    if (err == FAP_OK)
        err = fap_bank_builder_masks(b, mask);
    if (err == FAP_OK)
        err = fap_bank_builder_regions(b, &lines, s->vertex_count);
    if (err == FAP_OK)
        err = bank_rewrite(&d->scan, b);
    fap_bank_builder_close(&b);
    free(bytes);
    free(mask);
    free(from);
    return err;
}

static int draw_points(const drawing *d)
{
    render_mark mark[FAP_POINT_COUNT];

    for (uint32_t i = 0; i < d->w->pin_count; i++) {
        fap_registration_to_head(d->w->registration, d->w->pin[i].at, mark[i].place_mm);
        memcpy(mark[i].rgb, mark_rgb, sizeof mark_rgb);
    }
    return draw(d, d->scan, "points", 0, mark, (int)d->w->pin_count);
}

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

static int draw_distances(const drawing *d)
{
    static const uint8_t unseen[4] = { 120, 120, 120, 20 };
    const fap_mesh *mesh = fap_bank_mesh(d->w->bank);
    const float(*at)[3] = fap_registration_positions(d->w->registration);
    uint8_t(*colour)[4] = malloc(mesh->vertex_count * sizeof *colour);
    fap_bank_builder *b = NULL;
    surface_index *index = NULL;
    fap_bank *painted = NULL;

    fap_err err =
        colour ? surface_index_open(&index, (const float(*)[3])d->in_head, d->w->scan->vertex_count,
                                    (const uint32_t(*)[3])d->w->scan->triangle, d->w->scan->triangle_count)
               : FAP_E_NOMEM;
    for (uint32_t i = 0; err == FAP_OK && i < mesh->vertex_count; i++) {
        surface_hit h;
        memcpy(colour[i], unseen, sizeof unseen);
        if (mesh->part[i] == FAP_PART_SKIN &&
            surface_index_nearest(index, at[i], (float)d->w->opt->fit.reach_mm, NULL, NULL, &h))
            warm((double)h.distance, colour[i]);
    }
    if (err == FAP_OK)
        err = fap_bank_retarget(&b, d->w->bank, at, "distances", NULL);
    if (err == FAP_OK) {
        fap_bank_builder_colours(b, (const uint8_t(*)[4])colour);
        err = bank_rewrite(&painted, b);
    }
    const int ok = err == FAP_OK ? draw(d, painted, "distances", 0, NULL, 0) : fail(d, err, "");
    fap_bank_close(&painted);
    fap_bank_builder_close(&b);
    surface_index_close(&index);
    free(colour);
    return ok;
}

int fit_pictures_write(fit_work *w, fault *f)
{
    drawing d = { .w = w, .f = f };

    if (mkdir(w->opt->pictures, 0777) && errno != EEXIST)
        return fault_set(f, EXIT_DATA, "%s: %s", w->opt->pictures, strerror(errno));
    fap_err err = bank_rewrite(&d.face, w->face);
    if (err == FAP_OK)
        err = make_scan(&d);
    const int ok = err == FAP_OK ? draw(&d, d.scan, "before", 0, NULL, 0) && draw_points(&d) &&
                                       draw(&d, d.face, "after", 0, NULL, 0) &&
                                       draw(&d, d.face, "wireframe", 1, NULL, 0) && draw_distances(&d)
                                 : fail(&d, err, "");
    fap_bank_close(&d.scan);
    fap_bank_close(&d.face);
    free(d.in_head);
    return ok;
}
