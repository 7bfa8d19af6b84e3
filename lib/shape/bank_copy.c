/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A bank back into a builder, as a start for another one: as it is, or on another neutral face with its motions scaled.
 * Source of the latter: Zhu 2006 section 5.1, eq. 5.1 and 5.2.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/retarget.h>

/* Another face of the bank's structure; the bank itself where there is no position. */
typedef struct other_face {
    const float (*position)[3];
    const char *name;
    fap_retarget_scale scale;
    int still; /* 1: its keys are left out */
} other_face;

/* A place that no vertex has is scaled about the middle of the eyes' axes, the origin. */
static void scale_place(const other_face *other, const float place[3], float out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = place[a] * (float)other->scale.scale;
}

static fap_err copy_points(fap_bank_builder *b, const fap_bank *bank, const other_face *other)
{
    fap_err err = FAP_OK;

    for (int p = 0; !err && p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(bank, p);
        if (!point->present)
            continue;
        float place[3];
        scale_place(other, point->position_mm, place);
        err = point->vertex_count ? fap_bank_builder_point(b, p, point->vertex, point->vertex_count)
                                  : fap_bank_builder_place(b, p, place);
    }
    return err;
}

static void unpack(const fap_key *key, uint32_t vertex_count, float scale, float (*delta)[3])
{
    memset(delta, 0, vertex_count * sizeof *delta);
    for (uint32_t b = 0; b < key->block_count; b++)
        for (uint32_t lane = 0; lane < FAP_BLOCK; lane++) {
            const uint32_t v = (uint32_t)key->block[b] * FAP_BLOCK + lane;
            for (uint32_t axis = 0; v < vertex_count && axis < 3; axis++)
                delta[v][axis] = scale * key->scale_mm * key->delta[(b * 3 + axis) * FAP_BLOCK + lane];
        }
}

static fap_err copy_keys(fap_bank_builder *b, const fap_bank *bank, const other_face *other)
{
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    float(*delta)[3] = malloc(n * sizeof *delta);
    fap_err err = delta ? FAP_OK : FAP_E_NOMEM;

    for (int k = 0; !err && k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        unpack(key, n, (float)other->scale.scale, delta);
        err = fap_bank_builder_key(b, (fap_key_kind)key->kind, key->number, key->name,
                                   (const float(*)[3])delta);
    }
    free(delta);
    return err;
}

static fap_err copy_mesh(fap_bank_builder **out, const fap_bank *bank, const other_face *other)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    float(*position)[3] = malloc(m->vertex_count * sizeof *position);

    if (!position)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        for (uint32_t axis = 0; axis < 3; axis++)
            position[v][axis] =
                other->position ? other->position[v][axis] : m->position[axis * m->stride + v];
    const fap_build_mesh mesh = {
        m->vertex_count, m->triangle_count, (const float(*)[3])position,    (const float(*)[2])m->uv,
        m->part,         m->head_weight,    (const uint8_t(*)[4])m->colour, (const uint32_t(*)[3])m->triangle
    };
    const fap_err err =
        fap_bank_builder_open(out, other->position ? other->name : fap_bank_name(bank), &mesh);
    free(position);
    return err;
}

/* Where the eyeball's vertices have gone, and how much wider they stand. */
static void follow_eye(const fap_bank *bank, const other_face *other, uint8_t part, float centre[3],
                       float *radius)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    double from[3] = { 0 }, to[3] = { 0 }, from_spread = 0, to_spread = 0;
    uint32_t count = 0;

    for (uint32_t v = 0; v < m->vertex_count; v++)
        for (uint32_t a = 0; m->part[v] == part && a < 3; a++) {
            from[a] += (double)m->position[a * m->stride + v];
            to[a] += (double)other->position[v][a];
            count += a == 0;
        }
    for (uint32_t v = 0; v < m->vertex_count && count; v++)
        for (uint32_t a = 0; m->part[v] == part && a < 3; a++) {
            from_spread += pow((double)m->position[a * m->stride + v] - from[a] / count, 2);
            to_spread += pow((double)other->position[v][a] - to[a] / count, 2);
        }
    const double scale = from_spread > 0 ? sqrt(to_spread / from_spread) : other->scale.scale;
    for (int a = 0; a < 3 && count; a++)
        centre[a] = (float)(to[a] / count + scale * ((double)centre[a] - from[a] / count));
    *radius *= (float)scale;
}

static void copy_eyes(fap_bank_builder *b, const fap_bank *bank, const other_face *other)
{
    for (int right = 0; right < 2; right++) {
        float centre[3], radius;
        if (!fap_bank_eye(bank, right, centre, &radius))
            continue;
        if (other->position)
            follow_eye(bank, other, right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT, centre, &radius);
        fap_bank_builder_eye(b, right, centre, radius);
    }
}

/* The region map is in millimetres: of another face it is drawn anew. */
static fap_err copy_maps(fap_bank_builder *b, const fap_bank *bank, const other_face *other)
{
    fap_err err = FAP_OK;

    if (fap_bank_masks(bank))
        err = fap_bank_builder_masks(b, fap_bank_masks(bank));
    if (!err && fap_bank_regions(bank) && !other->position)
        err = fap_bank_builder_regions(b, fap_bank_regions(bank), fap_bank_mesh(bank)->stride);
    return err;
}

static fap_err copy(fap_bank_builder **out, const fap_bank *bank, const other_face *other)
{
    *out = NULL;
    fap_err err = copy_mesh(out, bank, other);
    if (!err)
        err = copy_points(*out, bank, other);
    if (!err && !other->still)
        err = copy_keys(*out, bank, other);
    if (!err)
        err = copy_maps(*out, bank, other);
    if (!err)
        copy_eyes(*out, bank, other);
    if (err)
        fap_bank_builder_close(out);
    return err;
}

fap_err fap_bank_builder_copy(fap_bank_builder **out, const fap_bank *bank)
{
    return copy(out, bank, &(other_face){ .scale.scale = 1 });
}

fap_err fap_bank_builder_still(fap_bank_builder **out, const fap_bank *bank)
{
    return copy(out, bank, &(other_face){ .scale.scale = 1, .still = 1 });
}

/* --- another face --- */

/* A feature point's place on the bank's face, or on the other one; 0: it has none. */
static int place_of(const fap_bank *bank, const float (*position)[3], const char *name, double out[3])
{
    const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(name));

    if (!p->present || !p->vertex_count)
        return 0;
    for (int a = 0; a < 3; a++) {
        out[a] = position ? 0 : (double)p->position_mm[a];
        for (uint32_t i = 0; position && i < p->vertex_count; i++)
            out[a] += (double)position[p->vertex[i]][a] / p->vertex_count;
    }
    return 1;
}

static void middle(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (a[i] + b[i]) / 2;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* Figure 5.1: x1 and x2, y1 and y2. */
static int measure(const fap_bank *bank, const float (*position)[3], double out[4])
{
    static const char *const names[] = { "3.7", "3.11", "3.8", "3.12", "8.3", "8.4", "9.3" };
    double at[7][3], left[3], right[3], eyes[3], mouth[3];

    for (int i = 0; i < 7; i++)
        if (!place_of(bank, position, names[i], at[i]))
            return 0;
    middle(at[0], at[1], left);
    middle(at[2], at[3], right);
    middle(left, right, eyes);
    middle(at[4], at[5], mouth);
    out[0] = distance(left, right);
    out[1] = distance(at[4], at[5]);
    out[2] = distance(eyes, at[6]);
    out[3] = distance(at[6], mouth);
    return out[0] > 0 && out[1] > 0 && out[2] > 0 && out[3] > 0;
}

static int find_scale(const fap_bank *bank, const float (*position)[3], fap_retarget_scale *s)
{
    double from[4], to[4];

    if (!measure(bank, NULL, from) || !measure(bank, position, to))
        return 0;
    *s = (fap_retarget_scale){ to[0] / from[0], to[1] / from[1], to[2] / from[2], to[3] / from[3], 0 };
    s->scale = (s->eyes + s->mouth + s->nose + s->lips) / 4;
    return 1;
}

fap_err fap_bank_retarget(fap_bank_builder **out, const fap_bank *bank, const float (*position)[3],
                          const char *name, fap_retarget_scale *scale)
{
    other_face other = { .position = position, .name = name };

    *out = NULL;
    if (!find_scale(bank, position, &other.scale))
        return FAP_E_DATA;
    if (scale)
        *scale = other.scale;
    return copy(out, bank, &other);
}
