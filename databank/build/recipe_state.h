/* SPDX-License-Identifier: BSD-2-Clause */
/* A recipe while it is read: shared by its statements' files. */
#ifndef DATABANK_BUILD_RECIPE_STATE_H
#define DATABANK_BUILD_RECIPE_STATE_H

#include "databank/build/recipe.h"
#include "shape/obj.h"

enum { RECIPE_MAX_GROUPS = 64 };

typedef struct group_style {
    char group[64];
    uint8_t part, colour[4];
} group_style;

/* Scans of one person; rest is NULL where the recipe is of meshes. */
typedef struct recipe_person {
    fap_bank *like; /* whose structure the face has; NULL: not said yet */
    fap_registration *rest;
    fap_take *landmarks; /* at rest */
    fap_expression_config config;
    int alone; /* 1: nothing of the bank's keys is taken over */
} recipe_person;

typedef struct recipe {
    const recipe_files *files;
    const recipe_watch *watch;
    recipe_outcome *outcome;
    char name[64];
    float scale, neck_y[2]; /* heights where the head weight is 0 and 1 */
    int scaled;             /* scale was told */
    group_style group[RECIPE_MAX_GROUPS];
    int group_count;
    fap_obj mesh;
    recipe_person person;
    fap_bank_builder *builder;
} recipe;

/* One statement a function: what stands behind its word. FAP_E_SYNTAX: it is not one. */
fap_err recipe_take_mesh(recipe *r, const char *rest);
fap_err recipe_take_group(recipe *r, const char *rest);
fap_err recipe_take_masks(recipe *r, const char *rest);
/* Motion out of a .target, or as the difference of another OBJ of the same topology. */
fap_err recipe_read_motion(const recipe *r, const char *file, float (*delta)[3]);

fap_err recipe_take_like(recipe *r, const char *rest);
fap_err recipe_take_method(recipe *r, const char *rest);
fap_err recipe_take_alignment(recipe *r, const char *rest);
fap_err recipe_take_alone(recipe *r, const char *rest);
fap_err recipe_take_scan(recipe *r, const char *rest);
/* Motion out of "FILE LANDMARKS", a scan of the person. */
fap_err recipe_scan_motion(recipe *r, fap_key_kind kind, const char *name, const char *files,
                           float (*delta)[3]);
void recipe_person_close(recipe_person *p);

static inline uint32_t recipe_vertex_count(const recipe *r)
{
    return r->person.rest ? fap_bank_mesh(r->person.like)->vertex_count : r->mesh.position_count;
}

#endif
