/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_body.h. Masks, ranges and symbols must be read to find the end; values need not.
 * Source: ISO/IEC 14496-2, body object plane syntax.
 */
#include "codec/fba_body.h"
#include "gen/bap_groups.h"
#include "gen/bap_quant.h"

static const uint8_t group_count[] = {
#define X(group, count) count,
    BAP_GROUPS_ROWS(X)
#undef X
};

static const uint8_t scale[] = {
#define X(quant, value) value,
    BAP_QUANT_ROWS(X)
#undef X
};

enum { GROUPS = sizeof group_count, DEFAULT_BOUND = 1859, MARKER_EVERY = 4 };

enum {
    SUM = 0
#define X(group, count) +count
    BAP_GROUPS_ROWS(X)
#undef X
};
_Static_assert((int)SUM == (int)BODY_PARAMS, "bap_groups.csv has not 296 BAPs");

void fap_fba_body_init(fba_body *body)
{
    for (int i = 0; i < BODY_PARAMS; i++)
        body->range[FBA_P][i] = body->range[FBA_I][i] = (fba_range){ -DEFAULT_BOUND, DEFAULT_BOUND };
}

static int divisor(const fba_body *body)
{
    return scale[body->quant] ? scale[body->quant] : 1;
}

static fap_err read_masks(fba_body *body, fap_bits *b)
{
    for (int g = 0, i = 0; g < GROUPS; g++) {
        fap_bits_marker(b);
        const uint32_t type = fap_bits_get(b, 2);
        if (type == FBA_MASK_INTERPOLATE)
            return FAP_E_BITSTREAM;
        for (const int end = i + group_count[g]; i < end; i++)
            body->coded[i] = type == FBA_MASK_HOLD ? (uint8_t)fap_bits_get(b, 1) : type == FBA_MASK_ALL;
    }
    return FAP_OK;
}

/* @p max: which end of the ranges the table holds. */
static void read_bounds(fba_body *body, fap_bits *b, int kind, int max)
{
    for (int g = 0, i = 0; g < GROUPS; g++)
        for (int k = 0; k < group_count[g]; k++, i++) {
            if (k % MARKER_EVERY == 0)
                fap_bits_marker(b);
            if (!body->coded[i])
                continue;
            const int bound = (int)fap_bits_get(b, 5) * FBA_BOUND_UNIT / divisor(body);
            if (max)
                body->range[kind][i].max = (int16_t)bound;
            else
                body->range[kind][i].min = (int16_t)-bound;
        }
}

static fap_err read_intra_header(fba_body *body, fap_bits *b)
{
    body->quant = (uint8_t)fap_bits_get(b, 5);
    if (read_masks(body, b) != FAP_OK)
        return FAP_E_BITSTREAM;
    fap_bits_get(b, 1); /* fba_suggested_gender, as in the face data */
    if (fap_bits_get(b, 1))
        return FAP_E_UNSUPPORTED;
    const uint32_t flags = fap_bits_get(b, 4);
    for (int table = 0; table < 4; table++)
        if (flags >> (3 - table) & 1)
            read_bounds(body, b, table < 2 ? FBA_I : FBA_P, table % 2 == 0);
    return FAP_OK;
}

static fap_err skip_symbols(fba_body *body, fap_bits *b, int intra, model_pool *pool)
{
    arith_decoder a;
    arith_interval where;

    fap_arith_begin(&a, b);
    for (int i = 0; i < BODY_PARAMS; i++) {
        if (!body->coded[i])
            continue;
        model *m = &body->model[i];
        const int size = fba_range_size(body->range[intra ? FBA_I : FBA_P][i]);
        const uint32_t target = fap_arith_target(&a, fap_model_total(m, size));
        if (intra)
            where = fap_flat_interval(size, fap_flat_symbol(size, target));
        else if (fap_model_decode(pool, m, size, target, &where) < 0)
            return FAP_E_LIMIT;
        fap_arith_take(&a, where);
    }
    fap_arith_end(&a);
    return FAP_OK;
}

fap_err fap_fba_body_skip(fba_body *body, fap_bits *b, int intra, model_pool *pool)
{
    if (intra) {
        for (int i = 0; i < BODY_PARAMS; i++)
            fap_model_clear(pool, &body->model[i]);
        const fap_err err = read_intra_header(body, b);
        if (err != FAP_OK)
            return err;
    }
    return skip_symbols(body, b, intra, pool);
}
