/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Reads the package: mesh, identity, units, masks. The identity is the even mix of three origins, three
 * quarters female, young, of average build.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "databank/build/makehuman.h"
#include "shape/target.h"

const char *const mh_unit_names[MH_UNITS] = {
    "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
    "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
    "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
    "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
    "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
    "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
    "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
    "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
    "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
    "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
    "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight",      "tongueOut",
    "_tongueUp",         "_tongueBack",
};

static const struct ingredient {
    const char *file;
    float weight;
} identity[] = {
    { "african-female-young", 0.25f },
    { "asian-female-young", 0.25f },
    { "caucasian-female-young", 0.25f },
    { "african-male-young", 0.25f / 3 },
    { "asian-male-young", 0.25f / 3 },
    { "caucasian-male-young", 0.25f / 3 },
    { "universal-female-young-averagemuscle-averageweight", 0.75f },
    { "universal-male-young-averagemuscle-averageweight", 0.25f },
};

static const float mm_per_dm = 100;

typedef struct reading {
    mh_source *s;
    const package *p;
    char *bad;
    size_t bad_size;
} reading;

static fap_err blame(const reading *r, const char *file, fap_err err)
{
    if (err)
        snprintf(r->bad, r->bad_size, "%s", file);
    return err;
}

static fap_err read_mesh(reading *r)
{
    uint8_t *text;
    size_t size;
    fap_err err = package_get(r->p, PACKAGE_MESH, "base.obj", &text, &size);

    if (!err) {
        err = fap_obj_parse(&r->s->obj, (const char *)text, size, NULL);
        free(text);
    }
    return blame(r, "base.obj", err);
}

static fap_err add_target(reading *r, package_kind kind, const char *name, const char *ending, float weight,
                          float (*to)[3])
{
    char file[128];
    uint8_t *text;
    size_t size;
    int line;

    snprintf(file, sizeof file, "%s%s", name, ending);
    fap_err err = package_get(r->p, kind, file, &text, &size);
    if (!err) {
        err = fap_target_add((const char *)text, weight, to, r->s->obj.position_count, &line);
        free(text);
    }
    return blame(r, file, err);
}

/* Mean of the cube that marks the top of the spine. */
static fap_err find_origin(const mh_source *s, float origin[3])
{
    const uint32_t joint = fap_obj_group(&s->obj, "joint-head");
    uint32_t count = 0;

    memset(origin, 0, 3 * sizeof *origin);
    for (uint32_t f = 0; f < s->obj.face_count; f++)
        for (uint32_t c = 0; s->obj.face[f].group == joint && c < s->obj.face[f].count; c++, count++)
            for (int axis = 0; axis < 3; axis++)
                origin[axis] += s->rest[s->obj.vertex[s->obj.face[f].first + c]][axis];
    for (int axis = 0; count && axis < 3; axis++)
        origin[axis] /= (float)count;
    origin[0] = 0;
    return count ? FAP_OK : FAP_E_DATA;
}

static fap_err read_identity(reading *r)
{
    mh_source *s = r->s;
    const uint32_t n = s->obj.position_count;
    float origin[3];

    s->base = malloc((n + 1u) * sizeof *s->base);
    s->rest = malloc((n + 1u) * sizeof *s->rest);
    if (!s->base || !s->rest)
        return FAP_E_NOMEM;
    memcpy(s->base, s->obj.position, n * sizeof *s->base);
    memcpy(s->rest, s->obj.position, n * sizeof *s->rest);
    for (size_t i = 0; i < sizeof identity / sizeof *identity; i++) {
        const fap_err err =
            add_target(r, PACKAGE_IDENTITY, identity[i].file, ".target.gz", identity[i].weight, s->rest);
        if (err)
            return err;
    }
    const fap_err err = find_origin(s, origin);
    for (uint32_t v = 0; !err && v < n; v++)
        for (int axis = 0; axis < 3; axis++)
            s->rest[v][axis] = (s->rest[v][axis] - origin[axis]) * mm_per_dm;
    return blame(r, "base.obj", err);
}

/* The rest is the face; without a unit it still is one, so a missing file only leaves its unit out. */
static fap_err read_units(reading *r)
{
    mh_source *s = r->s;

    for (int u = 0; u < MH_UNITS; u++) {
        s->unit[u] = calloc(s->obj.position_count + 1u, sizeof *s->unit[u]);
        if (!s->unit[u])
            return FAP_E_NOMEM;
        if (u >= MH_FILE_UNITS)
            continue;
        const fap_err err = add_target(r, PACKAGE_UNIT, mh_unit_names[u], ".target", mm_per_dm, s->unit[u]);
        if (err == FAP_E_NOT_FOUND) {
            free(s->unit[u]);
            s->unit[u] = NULL;
        } else if (err) {
            return err;
        }
    }
    return s->unit[0] ? FAP_OK : FAP_E_NOT_FOUND;
}

static fap_err read_mask(reading *r, const char *file, mask *m)
{
    uint8_t *data;
    size_t size;
    fap_err err = package_get(r->p, PACKAGE_MASK, file, &data, &size);

    if (!err) {
        err = mask_decode(m, data, size);
        free(data);
    }
    return blame(r, file, err);
}

static fap_err read_masks(reading *r)
{
    fap_err err = read_mask(r, "mpfb_lips.jpg", &r->s->lips);
    if (!err)
        err = read_mask(r, "mpfb_inside-mouth.jpg", &r->s->mouth);
    if (!err)
        err = read_mask(r, "mpfb_eyelids.jpg", &r->s->lids);
    return err;
}

fap_err mh_read(mh_source *s, const package *p, char *bad, size_t bad_size)
{
    reading r = { s, p, bad, bad_size };

    *s = (mh_source){ 0 };
    fap_err err = read_mesh(&r);
    if (!err)
        err = read_identity(&r);
    if (!err)
        err = read_units(&r);
    if (!err)
        err = read_masks(&r);
    if (err)
        mh_source_free(s);
    return err;
}

void mh_source_free(mh_source *s)
{
    fap_obj_free(&s->obj);
    free(s->base);
    free(s->rest);
    for (int u = 0; u < MH_UNITS; u++)
        free(s->unit[u]);
    mask_free(&s->lips);
    mask_free(&s->mouth);
    mask_free(&s->lids);
    *s = (mh_source){ 0 };
}
