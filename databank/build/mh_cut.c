/* SPDX-License-Identifier: BSD-2-Clause */
/* Cuts one part out of base.obj and refines it. Skin ends at the neck; teeth are coarse ridges and take two
 * steps. */
#include <stdlib.h>
#include <string.h>

#include "databank/build/makehuman.h"

/* The plane rises to the back: a level one would leave the tips of the shoulders. */
float mh_height_over_cut(const float base_dm[3])
{
    const float front_y = 5.75f, front_z = 0.7f, rise = 0.32f;
    return base_dm[1] - front_y + rise * (base_dm[2] - front_z);
}

static const struct recipe {
    const char *group;
    fap_part part;
    int steps;
} recipes[MH_PATCHES] = {
    [MH_SKIN] = { "body", FAP_PART_SKIN, 1 },
    [MH_TEETH_UPPER] = { "helper-upper-teeth", FAP_PART_TEETH_UPPER, 2 },
    [MH_TEETH_LOWER] = { "helper-lower-teeth", FAP_PART_TEETH_LOWER, 2 },
    [MH_TONGUE] = { "helper-tongue", FAP_PART_TONGUE, 1 },
};

/* The polygons of a patch before refinement, and texture coordinates of their corners. */
typedef struct cutting {
    mh_patch *patch;
    const mh_source *s;
    uint32_t face_count, corner_count, *start, *vertex;
    float (*corner_uv)[2];
} cutting;

static float height(const cutting *c, uint32_t corner)
{
    return mh_height_over_cut(c->s->base[c->s->obj.vertex[corner]]);
}

static int reaches_above(const cutting *c, const fap_obj_face *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        if (height(c, f->first + i) > 0)
            return 1;
    return 0;
}

static uint32_t compact(mh_patch *p, uint32_t vertex)
{
    if (p->compact[vertex] == UINT32_MAX) {
        p->source[p->coarse_count] = vertex;
        p->compact[vertex] = p->coarse_count++;
    }
    return p->compact[vertex];
}

static void take_face(cutting *c, const fap_obj_face *f)
{
    const fap_obj *o = &c->s->obj;

    for (uint32_t i = 0; i < f->count; i++) {
        const uint32_t uv = o->corner_uv[f->first + i], at = c->corner_count++;
        c->vertex[at] = compact(c->patch, o->vertex[f->first + i]);
        c->corner_uv[at][0] = uv == FAP_OBJ_NO_UV ? 0 : o->uv[uv][0];
        c->corner_uv[at][1] = uv == FAP_OBJ_NO_UV ? 0 : o->uv[uv][1];
    }
    c->start[++c->face_count] = c->corner_count;
}

/* A vertex below the plane slides along the edge that climbs most. */
static void slide(cutting *c, uint32_t low, uint32_t high)
{
    mh_patch *p = c->patch;
    const float y = height(c, low), up = height(c, high);

    if (y >= 0 || up <= 0)
        return;
    mh_slide *s = &p->slide[p->compact[c->s->obj.vertex[low]]];
    if (s->part > 0 && -y / (up - y) >= s->part)
        return;
    *s = (mh_slide){ c->s->obj.vertex[high], -y / (up - y) };
}

/* Along the edges of the face; where none leaves the plane's lower side, across it. */
static void slide_face(cutting *c, const fap_obj_face *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        const uint32_t a = f->first + i, b = f->first + (i + 1) % f->count;
        slide(c, a, b);
        slide(c, b, a);
    }
}

static void slide_rest(cutting *c, const fap_obj_face *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        for (uint32_t k = 0;
             k < f->count && !(c->patch->slide[c->patch->compact[c->s->obj.vertex[f->first + i]]].part > 0);
             k++)
            slide(c, f->first + i, f->first + k);
}

static void cut_plane(cutting *c, uint32_t group)
{
    const fap_obj *o = &c->s->obj;

    for (int pass = 0; pass < 2; pass++)
        for (uint32_t f = 0; f < o->face_count; f++)
            if (o->face[f].group == group && reaches_above(c, &o->face[f]))
                (pass ? slide_rest : slide_face)(c, &o->face[f]);
}

static int cut_open(cutting *c, const mh_source *s)
{
    const fap_obj *o = &s->obj;
    mh_patch *p = c->patch;

    p->compact = malloc((o->position_count + 1u) * sizeof *p->compact);
    p->source = malloc((o->position_count + 1u) * sizeof *p->source);
    p->slide = calloc(o->position_count + 1u, sizeof *p->slide);
    c->start = calloc(o->face_count + 2u, sizeof *c->start);
    c->vertex = malloc((o->corner_count + 1u) * sizeof *c->vertex);
    c->corner_uv = malloc((o->corner_count + 1u) * sizeof *c->corner_uv);
    if (!p->compact || !p->source || !p->slide || !c->start || !c->vertex || !c->corner_uv)
        return 0;
    memset(p->compact, 0xff, o->position_count * sizeof *p->compact);
    return 1;
}

static void middle(const float a[2], const float b[2], float out[2])
{
    out[0] = (a[0] + b[0]) / 2;
    out[1] = (a[1] + b[1]) / 2;
}

/* Texture coordinates refine within their face: at a seam the two sides of an edge have nothing in common. */
static int refine_uv(cutting *c)
{
    float(*fine)[4][2] = malloc((c->corner_count + 1u) * sizeof *fine);

    for (uint32_t f = 0; fine && f < c->face_count; f++) {
        const uint32_t first = c->start[f], last = c->start[f + 1] - 1, count = last - first + 1;
        float centre[2] = { 0, 0 };
        for (uint32_t i = first; i <= last; i++)
            for (int k = 0; k < 2; k++)
                centre[k] += c->corner_uv[i][k] / (float)count;
        for (uint32_t i = first; i <= last; i++) {
            memcpy(fine[i][0], c->corner_uv[i], sizeof fine[i][0]);
            middle(c->corner_uv[i], c->corner_uv[i == last ? first : i + 1], fine[i][1]);
            memcpy(fine[i][2], centre, sizeof centre);
            middle(c->corner_uv[i], c->corner_uv[i == first ? last : i - 1], fine[i][3]);
        }
    }
    free(c->corner_uv);
    c->corner_uv = fine ? (float(*)[2])fine : NULL;
    return fine != NULL;
}

/* The quads of a step become the polygons of the next. */
static int adopt(cutting *c, const fap_subdivision *s)
{
    uint32_t *start = malloc((s->quad_count + 1u) * sizeof *start);
    uint32_t *vertex = malloc((s->quad_count + 1u) * sizeof *s->quad);

    if (start && vertex && refine_uv(c)) {
        for (uint32_t q = 0; q <= s->quad_count; q++)
            start[q] = 4 * q;
        memcpy(vertex, s->quad, s->quad_count * sizeof *s->quad);
        free(c->start);
        free(c->vertex);
        c->start = start, c->vertex = vertex;
        c->face_count = s->quad_count;
        c->corner_count = 4 * s->quad_count;
        return 1;
    }
    free(start);
    free(vertex);
    return 0;
}

static fap_err refine(cutting *c)
{
    mh_patch *p = c->patch;

    p->count = p->coarse_count;
    for (int i = 0; i < p->steps; i++) {
        const fap_polygons mesh = { c->face_count, p->count, c->start, c->vertex };
        const fap_err err = fap_subdivide(&p->step[i], &mesh);
        if (err)
            return err;
        if (!adopt(c, &p->step[i]))
            return FAP_E_NOMEM;
        p->count = p->step[i].vertex_count;
    }
    return FAP_OK;
}

/* Hands polygons and coordinates over; where corners disagree, at seams, the last one wins. */
static fap_err finish(cutting *c)
{
    mh_patch *p = c->patch;

    p->uv = calloc(p->count + 1u, sizeof *p->uv);
    if (!p->uv)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < c->corner_count; i++)
        memcpy(p->uv[c->vertex[i]], c->corner_uv[i], sizeof *p->uv);
    p->quad_count = c->face_count;
    p->quad = (uint32_t(*)[4])c->vertex;
    c->vertex = NULL;
    return FAP_OK;
}

fap_err mh_cut(mh_patch *patch, const mh_source *s, enum mh_patch_id id)
{
    const struct recipe *r = &recipes[id];
    const uint32_t group = fap_obj_group(&s->obj, r->group);
    cutting c = { .patch = patch, .s = s };

    *patch = (mh_patch){ .part = r->part, .steps = r->steps };
    fap_err err = cut_open(&c, s) ? FAP_OK : FAP_E_NOMEM;
    for (uint32_t f = 0; !err && f < s->obj.face_count; f++)
        if (s->obj.face[f].group == group && (id != MH_SKIN || reaches_above(&c, &s->obj.face[f])))
            take_face(&c, &s->obj.face[f]);
    if (!err && id == MH_SKIN)
        cut_plane(&c, group);
    if (!err && !c.face_count)
        err = FAP_E_DATA;
    if (!err)
        err = refine(&c);
    if (!err)
        err = finish(&c);
    free(c.start);
    free(c.vertex);
    free(c.corner_uv);
    if (err)
        mh_patch_free(patch);
    return err;
}

void mh_patch_free(mh_patch *p)
{
    for (int i = 0; i < MH_MAX_STEPS; i++)
        fap_subdivision_free(&p->step[i]);
    free(p->source);
    free(p->compact);
    free(p->slide);
    free(p->quad);
    free(p->uv);
    *p = (mh_patch){ 0 };
}

fap_err mh_patch_apply(const mh_patch *p, const float (*in)[3], float (*out)[3])
{
    float(*from)[3] = malloc((p->count + 1u) * sizeof *from);
    if (!from)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < p->coarse_count; v++)
        for (int axis = 0; axis < 3; axis++)
            from[v][axis] = (1 - p->slide[v].part) * in[p->source[v]][axis] +
                            p->slide[v].part * in[p->slide[v].towards][axis];
    for (int i = 0; i < p->steps; i++) {
        fap_subdivision_apply(&p->step[i], (const float(*)[3])from, out);
        memcpy(from, out, p->step[i].vertex_count * sizeof *from);
    }
    free(from);
    return FAP_OK;
}
