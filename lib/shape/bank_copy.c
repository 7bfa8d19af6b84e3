/* SPDX-License-Identifier: BSD-2-Clause */
/* A bank back into a builder, as a start for another one. */
#include <stdlib.h>
#include <string.h>

#include <fap/studio/bank_build.h>

static fap_err copy_points(fap_bank_builder *b, const fap_bank *bank)
{
    fap_err err = FAP_OK;

    for (int p = 0; !err && p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(bank, p);
        if (!point->present)
            continue;
        err = point->vertex_count ? fap_bank_builder_point(b, p, point->vertex, point->vertex_count)
                                  : fap_bank_builder_place(b, p, point->position_mm);
    }
    return err;
}

static void unpack(const fap_key *key, uint32_t vertex_count, float (*delta)[3])
{
    memset(delta, 0, vertex_count * sizeof *delta);
    for (uint32_t b = 0; b < key->block_count; b++)
        for (uint32_t lane = 0; lane < FAP_BLOCK; lane++) {
            const uint32_t v = (uint32_t)key->block[b] * FAP_BLOCK + lane;
            for (uint32_t axis = 0; v < vertex_count && axis < 3; axis++)
                delta[v][axis] = key->scale_mm * key->delta[(b * 3 + axis) * FAP_BLOCK + lane];
        }
}

static fap_err copy_keys(fap_bank_builder *b, const fap_bank *bank)
{
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    float(*delta)[3] = malloc(n * sizeof *delta);
    fap_err err = delta ? FAP_OK : FAP_E_NOMEM;

    for (int k = 0; !err && k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        unpack(key, n, delta);
        err = fap_bank_builder_key(b, (fap_key_kind)key->kind, key->number, key->name,
                                   (const float(*)[3])delta);
    }
    free(delta);
    return err;
}

static fap_err copy_mesh(fap_bank_builder **out, const fap_bank *bank)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    float(*position)[3] = malloc(m->vertex_count * sizeof *position);

    if (!position)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        for (uint32_t axis = 0; axis < 3; axis++)
            position[v][axis] = m->position[axis * m->stride + v];
    const fap_build_mesh mesh = {
        m->vertex_count, m->triangle_count, (const float(*)[3])position,    (const float(*)[2])m->uv,
        m->part,         m->head_weight,    (const uint8_t(*)[4])m->colour, (const uint32_t(*)[3])m->triangle
    };
    const fap_err err = fap_bank_builder_open(out, fap_bank_name(bank), &mesh);
    free(position);
    return err;
}

static void copy_eyes(fap_bank_builder *b, const fap_bank *bank)
{
    for (int right = 0; right < 2; right++) {
        float centre[3], radius;
        if (fap_bank_eye(bank, right, centre, &radius))
            fap_bank_builder_eye(b, right, centre, radius);
    }
}

static fap_err copy_maps(fap_bank_builder *b, const fap_bank *bank)
{
    fap_err err = FAP_OK;

    if (fap_bank_masks(bank))
        err = fap_bank_builder_masks(b, fap_bank_masks(bank));
    if (!err && fap_bank_regions(bank))
        err = fap_bank_builder_regions(b, fap_bank_regions(bank), fap_bank_mesh(bank)->stride);
    return err;
}

fap_err fap_bank_builder_copy(fap_bank_builder **out, const fap_bank *bank)
{
    *out = NULL;
    fap_err err = copy_mesh(out, bank);
    if (!err)
        err = copy_points(*out, bank);
    if (!err)
        err = copy_keys(*out, bank);
    if (!err)
        err = copy_maps(*out, bank);
    if (!err)
        copy_eyes(*out, bank);
    if (err)
        fap_bank_builder_close(out);
    return err;
}
