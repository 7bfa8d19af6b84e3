/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See import_shapes.h. The pieces of the mesh that hang together are asked as a whole: a piece is an eyeball when the vertices of the
 * laid face that are nearest to it are those of an eyeball. A feature point is the vertex nearest to its landmark, else to where
 * it is on the laid face.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "common/tool.h"
#include "databank/build/import_shapes.h"
#include "databank/build/marked.h"
#include "databank/inputs.h"
#include "databank/shapes.h"
#include "surface/nearest.h"

/* Nothing of a head is farther than this from where the laid face has its like. */
static const float reach_mm = 200;

typedef struct importing {
    shapes shapes;
    fap_bank *like;
    const fap_mesh *like_mesh;
    fap_generic generic;
    fap_take *landmarks;
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t pin_count;
    fap_registration *laid;
    marked marks;
    uint32_t *piece; /* [vertices] the first vertex of each piece */
    fap_bank_builder *builder;
} importing;

int import_shapes_is(const char *path)
{
    const char *dot = strrchr(path, '.');
    char base[4096];
    struct stat st;

    if (stat(path, &st))
        return 0;
    if (!S_ISDIR(st.st_mode))
        return dot && (!strcasecmp(dot, ".glb") || !strcasecmp(dot, ".ply") || !strcasecmp(dot, ".obj"));
    return snprintf(base, sizeof base, "%s/base.obj", path) < (int)sizeof base && stat(base, &st) != 0;
}

/* --- laid over it --- */

static int lay(importing *im, const char *path, double unit_mm, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_registration_config cfg;

    fap_err err = fap_landmarks_pin(im->landmarks, im->like, im->pin, &im->pin_count, where);
    if (err == FAP_OK)
        err = fap_generic_of_bank(&im->generic, im->like, NULL);
    fap_registration_config_init(&cfg);
    cfg.mm_per_unit = unit_mm;
    if (err == FAP_OK)
        err = fap_register(&im->laid, &im->generic, im->shapes.neutral, im->pin, im->pin_count, &cfg, where);
    return err == FAP_OK || inputs_blame(f, path, err, where);
}

/* Head axes and millimetres; shapes first, as they are counted from where the face was. */
static void turn(importing *im)
{
    fap_surface *n = im->shapes.neutral;

    for (uint32_t i = 0; i < n->vertex_count; i++) {
        float rest[3];
        fap_registration_to_head(im->laid, n->position[i], rest);
        for (int s = 0; s < im->shapes.count; s++) {
            float *d = im->shapes.delta[s][i], moved[3];
            for (int a = 0; a < 3; a++)
                moved[a] = n->position[i][a] + d[a];
            fap_registration_to_head(im->laid, moved, moved);
            for (int a = 0; a < 3; a++)
                d[a] = moved[a] - rest[a];
        }
        memcpy(n->position[i], rest, sizeof rest);
    }
}

/* --- pieces --- */

static uint32_t first_of(uint32_t *piece, uint32_t v)
{
    while (piece[v] != v)
        v = piece[v] = piece[piece[v]];
    return v;
}

static int find_pieces(importing *im)
{
    const fap_surface *s = im->shapes.neutral;

    im->piece = malloc(s->vertex_count * sizeof *im->piece);
    for (uint32_t v = 0; im->piece && v < s->vertex_count; v++)
        im->piece[v] = v;
    for (uint32_t t = 0; im->piece && t < s->triangle_count; t++)
        for (int c = 1; c < 3; c++) {
            const uint32_t a = first_of(im->piece, s->triangle[t][0]),
                           b = first_of(im->piece, s->triangle[t][c]);
            im->piece[a > b ? a : b] = a > b ? b : a;
        }
    for (uint32_t v = 0; im->piece && v < s->vertex_count; v++)
        im->piece[v] = first_of(im->piece, v);
    return im->piece != NULL;
}

/* Each vertex has a voice; skin has the last word where there are as many. */
static int vote(importing *im)
{
    const uint32_t n = im->shapes.neutral->vertex_count;
    uint32_t(*voice)[FAP_PART_COUNT] = calloc(n, sizeof *voice);

    for (uint32_t v = 0; voice && v < n; v++)
        voice[im->piece[v]][im->marks.part[v]]++;
    for (uint32_t v = 0; voice && v < n; v++) {
        const uint32_t *of = voice[im->piece[v]];
        uint8_t best = FAP_PART_SKIN;
        for (uint8_t p = 1; p < FAP_PART_COUNT; p++)
            if (of[p] > of[best])
                best = p;
        im->marks.part[v] = best;
    }
    free(voice);
    return voice != NULL;
}

/* --- what is what --- */

static void mark_vertex(importing *im, const surface_index *face, uint32_t v)
{
    const fap_mesh *like = im->like_mesh;
    surface_hit h;

    if (!surface_index_nearest(face, im->shapes.neutral->position[v], reach_mm, NULL, NULL, &h))
        return;
    const uint32_t *t = like->triangle + 3 * (size_t)h.triangle;
    float weight = 0.5F;
    for (int c = 0; c < 3; c++)
        weight += h.share[c] * (float)like->head_weight[t[c]];
    im->marks.part[v] = like->part[t[0]];
    im->marks.weight[v] = (uint8_t)weight;
    for (int a = 0; a < 4; a++) {
        float mixed = 0.5F;
        for (int c = 0; c < 3; c++)
            mixed += h.share[c] * (float)like->colour[4 * (size_t)t[c] + (size_t)a];
        im->marks.colour[v][a] = (uint8_t)mixed;
    }
    if (im->shapes.neutral->colour)
        memcpy(im->marks.colour[v], im->shapes.neutral->colour[v], 3);
}

static uint32_t nearest_vertex(const importing *im, const float at[3], uint8_t part)
{
    const fap_surface *s = im->shapes.neutral;
    uint32_t best = UINT32_MAX;
    double least = INFINITY;

    for (uint32_t v = 0; v < s->vertex_count; v++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)s->position[v][a] - (double)at[a], 2);
        if (im->marks.part[v] == part && d < least) {
            least = d;
            best = v;
        }
    }
    return best;
}

static void mark_point(importing *im, int p)
{
    const fap_bank_point *point = fap_bank_point_get(im->like, p);
    const float(*at)[3] = fap_registration_positions(im->laid);
    float place[3];

    if (!point->present)
        return;
    memcpy(place, point->vertex_count ? at[point->vertex[0]] : point->position_mm, sizeof place);
    for (uint32_t i = 0; i < im->pin_count; i++)
        if (point->vertex_count && im->pin[i].vertex[0] == point->vertex[0])
            fap_registration_to_head(im->laid, im->pin[i].at, place);
    const uint32_t v =
        point->vertex_count ? nearest_vertex(im, place, im->like_mesh->part[point->vertex[0]]) : UINT32_MAX;
    if (v != UINT32_MAX) {
        im->marks.point[p] = v;
        return;
    }
    memcpy(im->marks.place[p], place, sizeof place);
    im->marks.has_place[p] = 1;
}

static fap_err mark(importing *im)
{
    surface_index *face;

    if (!marked_open(&im->marks, im->shapes.neutral) || !find_pieces(im))
        return FAP_E_NOMEM;
    const fap_err err =
        surface_index_open(&face, fap_registration_positions(im->laid), im->like_mesh->vertex_count,
                           (const uint32_t(*)[3])im->like_mesh->triangle, im->like_mesh->triangle_count);
    for (uint32_t v = 0; err == FAP_OK && v < im->shapes.neutral->vertex_count; v++)
        mark_vertex(im, face, v);
    surface_index_close(&face);
    if (err != FAP_OK)
        return err;
    if (!vote(im))
        return FAP_E_NOMEM;
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        mark_point(im, p);
    if (!im->shapes.neutral->colour)
        marked_paint(&im->marks);
    return FAP_OK;
}

/* --- the bank --- */

static fap_err build(importing *im, const char *path)
{
    const char *slash = strrchr(path, '/');

    fap_err err = mark(im);
    if (err == FAP_OK)
        err = marked_begin(&im->builder, &im->marks, slash && slash[1] ? slash + 1 : path);
    for (int s = 0; err == FAP_OK && s < im->shapes.count; s++)
        err = marked_add_shape(im->builder, im->shapes.name[s], (const float(*)[3])im->shapes.delta[s]);
    return err == FAP_OK ? fap_bank_builder_models(im->builder) : err;
}

static void tidy(importing *im)
{
    marked_close(&im->marks);
    free(im->piece);
    fap_registration_close(&im->laid);
    fap_take_close(&im->landmarks);
    fap_generic_free(&im->generic, NULL);
    fap_bank_close(&im->like);
    shapes_free(&im->shapes);
    free(im);
}

static int run(importing *im, const char *path, const char *landmarks, const char *like, double unit_mm,
               fault *f)
{
    if (!landmarks)
        return fault_set(f, EXIT_USAGE,
                         "%s: where is the face in it? --landmarks POINTS.csv (fapbank pick makes one)",
                         path);
    if (!inputs_bank(&im->like, like, f) || !shapes_read(&im->shapes, path, f) ||
        !inputs_landmarks(&im->landmarks, landmarks, im->shapes.neutral, f))
        return 0;
    im->like_mesh = fap_bank_mesh(im->like);
    if (!lay(im, path, unit_mm, f))
        return 0;
    turn(im);
    const fap_err err = build(im, path);
    return err == FAP_OK ||
           inputs_blame(f, path, err,
                        err == FAP_E_ARG ? "a shape's name is empty or longer than 31 letters" : "");
}

int import_shapes(fap_bank_builder **out, const char *path, const char *landmarks, const char *like,
                  double unit_mm, fault *f)
{
    importing *im = calloc(1, sizeof *im);

    *out = NULL;
    if (!im)
        return fault_set(f, EXIT_DATA, "out of memory");
    const int ok = run(im, path, landmarks, like, unit_mm, f);
    if (!ok)
        fap_bank_builder_close(&im->builder);
    *out = im->builder;
    tidy(im);
    return ok;
}
