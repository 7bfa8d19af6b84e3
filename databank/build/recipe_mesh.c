/* SPDX-License-Identifier: BSD-2-Clause */
/* A recipe's meshes: the face at rest, its groups, and posed ones of the same topology. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "databank/build/recipe_state.h"
#include "shape/obj.h"
#include "shape/number.h"
#include "shape/target.h"

static const char *const part_names[FAP_PART_COUNT] = { "skin",        "eye_left", "eye_right", "teeth_upper",
                                                        "teeth_lower", "tongue",   "lashes" };

static fap_err read_obj(const recipe *r, const char *name, fap_obj *out)
{
    uint8_t *text;
    size_t size;
    fap_err err = r->files->read(r->files->user, name, &text, &size);

    if (!err) {
        err = fap_obj_parse(out, (const char *)text, size, NULL);
        free(text);
    }
    return err;
}

static const group_style *style_of(const recipe *r, const char *group)
{
    static const group_style plain = { "", FAP_PART_SKIN, { 204, 157, 131, 36 } };

    for (int i = 0; i < r->group_count; i++)
        if (!strcmp(r->group[i].group, group))
            return &r->group[i];
    return &plain;
}

/* Arrays of a mesh on its way into the builder. */
typedef struct arrays {
    float (*position)[3], (*uv)[2];
    uint8_t *part, *weight, (*colour)[4];
    uint32_t (*triangle)[3], triangle_count;
} arrays;

static int arrays_open(arrays *a, const fap_obj *o)
{
    a->position = calloc(o->position_count + 1u, sizeof *a->position);
    a->uv = calloc(o->position_count + 1u, sizeof *a->uv);
    a->part = calloc(o->position_count + 1u, 1);
    a->weight = calloc(o->position_count + 1u, 1);
    a->colour = calloc(o->position_count + 1u, sizeof *a->colour);
    a->triangle = calloc(o->corner_count + 1u, sizeof *a->triangle);
    return a->position && a->uv && a->part && a->weight && a->colour && a->triangle;
}

static void arrays_close(arrays *a)
{
    free(a->position);
    free(a->uv);
    free(a->part);
    free(a->weight);
    free(a->colour);
    free(a->triangle);
}

static void add_face(arrays *a, const recipe *r, const fap_obj_face *f)
{
    const fap_obj *o = &r->mesh;
    const group_style *style = style_of(r, o->group[f->group]);

    for (uint32_t i = 0; i < f->count; i++) {
        const uint32_t v = o->vertex[f->first + i], uv = o->corner_uv[f->first + i];
        a->part[v] = style->part;
        memcpy(a->colour[v], style->colour, sizeof *a->colour);
        if (uv != FAP_OBJ_NO_UV)
            memcpy(a->uv[v], o->uv[uv], sizeof *a->uv);
    }
    for (uint32_t i = 1; i + 1 < f->count; i++) {
        uint32_t *t = a->triangle[a->triangle_count++];
        t[0] = o->vertex[f->first], t[1] = o->vertex[f->first + i], t[2] = o->vertex[f->first + i + 1];
    }
}

static void fill(arrays *a, const recipe *r)
{
    const float rise = r->neck_y[1] - r->neck_y[0];

    for (uint32_t v = 0; v < r->mesh.position_count; v++) {
        for (int axis = 0; axis < 3; axis++)
            a->position[v][axis] = r->mesh.position[v][axis] * r->scale;
        const float t = rise > 0 ? fminf(1, fmaxf(0, (a->position[v][1] - r->neck_y[0]) / rise)) : 1;
        a->weight[v] = (uint8_t)lrintf(255 * t);
    }
    for (uint32_t f = 0; f < r->mesh.face_count; f++)
        add_face(a, r, &r->mesh.face[f]);
}

fap_err recipe_take_mesh(recipe *r, const char *rest)
{
    arrays a = { 0 };

    if (r->builder)
        return FAP_E_SYNTAX;
    fap_err err = read_obj(r, rest, &r->mesh);
    if (!err && !arrays_open(&a, &r->mesh))
        err = FAP_E_NOMEM;
    if (!err) {
        fill(&a, r);
        const fap_build_mesh mesh = { r->mesh.position_count,
                                      a.triangle_count,
                                      (const float(*)[3])a.position,
                                      r->mesh.uv_count ? (const float(*)[2])a.uv : NULL,
                                      a.part,
                                      a.weight,
                                      (const uint8_t(*)[4])a.colour,
                                      (const uint32_t(*)[3])a.triangle };
        err = fap_bank_builder_open(&r->builder, r->name, &mesh);
    }
    arrays_close(&a);
    return err;
}

fap_err recipe_take_group(recipe *r, const char *rest)
{
    group_style g = { .part = FAP_PART_COUNT };
    char part[32];
    unsigned c[4] = { 204, 157, 131, 36 };
    const int n = sscanf(rest, "%63s %31s %u %u %u %u", g.group, part, &c[0], &c[1], &c[2], &c[3]);

    for (int p = 0; n >= 2 && p < FAP_PART_COUNT; p++)
        if (!strcmp(part, part_names[p]))
            g.part = (uint8_t)p;
    if ((n != 2 && n != 6) || g.part == FAP_PART_COUNT || r->group_count == RECIPE_MAX_GROUPS || r->builder)
        return FAP_E_SYNTAX;
    for (int i = 0; i < 4; i++) {
        if (c[i] > 255)
            return FAP_E_SYNTAX;
        g.colour[i] = (uint8_t)c[i];
    }
    r->group[r->group_count++] = g;
    return FAP_OK;
}

/* --- posed meshes --- */

static int ends_with(const char *s, const char *end)
{
    const size_t n = strlen(s), m = strlen(end);
    return n >= m && !strcmp(s + n - m, end);
}

fap_err recipe_read_motion(const recipe *r, const char *file, float (*delta)[3])
{
    const uint32_t n = r->mesh.position_count;
    fap_obj posed;
    uint8_t *text;
    size_t size;
    int line;

    if (ends_with(file, ".target")) {
        fap_err err = r->files->read(r->files->user, file, &text, &size);
        if (!err) {
            err = fap_target_add((const char *)text, r->scale, delta, n, &line);
            free(text);
        }
        return err;
    }
    fap_err err = read_obj(r, file, &posed);
    if (err)
        return err;
    if (posed.position_count != n)
        err = FAP_E_DATA;
    for (uint32_t v = 0; !err && v < n; v++)
        for (int axis = 0; axis < 3; axis++)
            delta[v][axis] = (posed.position[v][axis] - r->mesh.position[v][axis]) * r->scale;
    fap_obj_free(&posed);
    return err;
}
