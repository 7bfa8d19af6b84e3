/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See drawing.h. A scan is drawn as a face is: a bank is made of it, feature points where the face's are, so that one camera sees
 * both alike.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <fap/studio/retarget.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/drawing.h"
#include "databank/rewrite.h"
#include "surface/normals.h"

enum { TILE_PX = 640, PATH_SIZE = 4096, PNG_LEVEL = 6, VIEWS = 2 };

static const uint8_t plaster[4] = { 205, 195, 185, 40 };
static const render_camera cameras[VIEWS] = { CAMERA_FRONT, CAMERA_THREE_QUARTER };

static int fail(const drawing *d, fap_err err, const char *where)
{
    return fault_set(d->f, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : EXIT_DATA, "%s: %s", d->folder,
                     *where ? where : fap_strerror(err));
}

int drawing_open_folder(const drawing *d)
{
    return !mkdir(d->folder, 0777) || errno == EEXIST ||
           fault_set(d->f, EXIT_DATA, "%s: %s", d->folder, strerror(errno));
}

/* --- files --- */

/* Names come from recipes and meshes: what is no letter or digit becomes "_", so that none leaves the folder. */
static int name_file(const drawing *d, const char *name, char path[PATH_SIZE])
{
    const int n = snprintf(path, PATH_SIZE, "%s/%s.png", d->folder, name);

    if (n < 0 || n >= PATH_SIZE)
        return fault_set(d->f, EXIT_USAGE, "--pictures: too long a name");
    for (char *p = path + strlen(d->folder) + 1; p < path + n - 4; p++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-", *p))
            *p = '_';
    return 1;
}

static int save(const drawing *d, const image *im, const char *name)
{
    char path[PATH_SIZE];
    out_file out;

    if (!name_file(d, name, path))
        return 0;
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

/* --- pixels --- */

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

/* What is drawn where on a picture. */
typedef struct shown {
    const fap_bank *bank;
    int wireframe, marks;
    const render_mark *mark;
    int column[VIEWS]; /* tiles from the left, of each view */
} shown;

static fap_err draw_views(renderer *r, const shown *s, const float *normal, image *tile, image *whole)
{
    fap_err err = FAP_OK;

    for (int i = 0; i < VIEWS && err == FAP_OK; i++) {
        render_view view = render_view_of(cameras[i]);
        view.distance *= 0.85F;
        const render_scene scene = { .position = fap_bank_mesh(s->bank)->position,
                                     .normal = normal,
                                     .view = view,
                                     .wireframe = s->wireframe,
                                     .mark = s->mark,
                                     .mark_count = s->marks };
        err = renderer_draw(r, &scene, tile);
        if (err == FAP_OK)
            image_blit(whole, tile, s->column[i] * TILE_PX, 0);
    }
    return err;
}

static fap_err draw(const drawing *d, const shown *s, image *whole, char *where)
{
    image tile = { 0 };
    renderer *r = NULL;
    void *block;
    const float *normal = make_normals(s->bank, &block);

    fap_err err = normal ? image_create(&tile, TILE_PX, TILE_PX) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = renderer_create(&r, d->gl, s->bank, TILE_PX, TILE_PX, where);
    if (err == FAP_OK)
        err = draw_views(r, s, normal, &tile, whole);
    renderer_destroy(&r);
    image_free(&tile);
    free(block);
    return err;
}

static int draw_all(const drawing *d, const shown *s, int count, const char *name)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    image whole = { 0 };

    fap_err err = image_create(&whole, count * VIEWS * TILE_PX, TILE_PX);
    for (int i = 0; i < count && err == FAP_OK; i++)
        err = draw(d, &s[i], &whole, where);
    const int ok = err == FAP_OK ? save(d, &whole, name) : fail(d, err, where);
    image_free(&whole);
    return ok;
}

int drawing_save(const drawing *d, const fap_bank *bank, const char *name, int wireframe,
                 const render_mark *mark, int marks)
{
    const shown one = { bank, wireframe, marks, mark, { 0, 1 } };
    return draw_all(d, &one, 1, name);
}

int drawing_save_pair(const drawing *d, const fap_bank *left, const fap_bank *right, const char *name)
{
    const shown two[2] = { { .bank = left, .column = { 0, 2 } }, { .bank = right, .column = { 1, 3 } } };
    return draw_all(d, two, 2, name);
}

/* --- banks to draw --- */

static fap_err give_points(const fap_bank *like, fap_bank_builder *b)
{
    fap_err err = FAP_OK;

    for (int p = 0; p < FAP_POINT_COUNT && err == FAP_OK; p++) {
        const fap_bank_point *point = fap_bank_point_get(like, p);
        if (point->present)
            err = fap_bank_builder_place(b, p, point->position_mm);
    }
    return err;
}

static fap_err open_scan(fap_bank_builder **b, const fap_surface *s, const float (*in_head)[3])
{
    const uint32_t n = s->vertex_count;
    uint8_t *block = calloc(n, 1 + 1 + 4), *part = block;
    if (!block)
        return FAP_E_NOMEM;
    uint8_t *weight = block + n, (*colour)[4] = (uint8_t(*)[4])(block + 2 * (size_t)n);

    memset(weight, 255, n);
    for (uint32_t i = 0; i < n; i++) {
        memcpy(colour[i], plaster, sizeof plaster);
        if (s->colour)
            memcpy(colour[i], s->colour[i], 3);
    }
    const fap_build_mesh mesh = { .vertex_count = n,
                                  .triangle_count = s->triangle_count,
                                  .position = in_head,
                                  .part = part,
                                  .head_weight = weight,
                                  .colour = (const uint8_t(*)[4])colour,
                                  .triangle = (const uint32_t(*)[3])s->triangle };
    const fap_err err = fap_bank_builder_open(b, "scan", &mesh);
    free(block);
    return err;
}

/* Masks and regions that cost nothing: nobody asks for them. */
static fap_err give_maps(fap_bank_builder *b, uint32_t n)
{
    uint8_t *mask = calloc(n, 1);
    float *from = calloc(n, 2 * sizeof *from);
    const fap_region_lines lines = { .extent = { 100, 100 }, .from = from };

    fap_err err = mask && from ? fap_bank_builder_masks(b, mask) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = fap_bank_builder_regions(b, &lines, n);
    free(mask);
    free(from);
    return err;
}

int drawing_of_scan(const drawing *d, fap_bank **out, const fap_bank *like, const fap_surface *scan,
                    const float (*in_head)[3])
{
    fap_bank_builder *b = NULL;

    fap_err err = open_scan(&b, scan, in_head);
    if (err == FAP_OK)
        err = give_points(like, b);
    if (err == FAP_OK)
        err = give_maps(b, scan->vertex_count);
    if (err == FAP_OK)
        err = bank_rewrite(out, b);
    fap_bank_builder_close(&b);
    return err == FAP_OK || fail(d, err, "");
}

int drawing_of_face(const drawing *d, fap_bank **out, const fap_bank *like, const float (*position)[3],
                    const uint8_t (*colour)[4])
{
    fap_bank_builder *b = NULL;

    fap_err err = fap_bank_retarget(&b, like, position, "face", NULL);
    if (err == FAP_OK) {
        fap_bank_builder_forget_keys(b);
        if (colour)
            fap_bank_builder_colours(b, colour);
        err = bank_rewrite(out, b);
    }
    fap_bank_builder_close(&b);
    return err == FAP_OK || fail(d, err, "");
}
