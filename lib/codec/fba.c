/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba.h. */
#include "codec/fba.h"

int fap_fba_fap(int param)
{
    if (param < FBA_EXPRESSION_SELECT1)
        return 1;
    return param < FBA_FIRST_FAP ? 2 : param - FBA_FIRST_FAP + 3;
}

static int is_select(int param)
{
    return param == FBA_VISEME_SELECT1 || param == FBA_VISEME_SELECT2 || param == FBA_EXPRESSION_SELECT1 ||
           param == FBA_EXPRESSION_SELECT2;
}

int32_t fap_fba_step(int param, int quant)
{
    if (is_select(param) || quant == 0)
        return 1;
    return param < FBA_FIRST_FAP ? quant : quant * fap_info_get(fap_fba_fap(param))->quant_step;
}

/* Largest value of a parameter of FAPs 1 and 2, in levels. */
static int16_t high_level_max(int param, int quant)
{
    if (!is_select(param))
        return (int16_t)(quant ? (FRAME_STRENGTH_MAX + quant / 2) / quant : FRAME_STRENGTH_MAX);
    return fap_fba_fap(param) == 1 ? FAP_VISEME_COUNT : FAP_EXPRESSION_COUNT;
}

fba_range fap_fba_param_range(const fba_setup *s, int param, int intra)
{
    if (param >= FBA_FIRST_FAP)
        return s->range[intra ? FBA_I : FBA_P][fap_fba_fap(param)];
    const int16_t max = high_level_max(param, s->quant);
    return (fba_range){ intra ? 0 : (int16_t)-max, max };
}

static fba_coded coded_param(const fba_setup *s, int param)
{
    fba_coded c = { .param = (uint8_t)param,
                    .fap = (uint8_t)fap_fba_fap(param),
                    .step = (uint16_t)fap_fba_step(param, s->quant) };

    for (int kind = 0; kind < 2; kind++) {
        const fba_range range = fap_fba_param_range(s, param, kind == FBA_I);
        c.symbols[kind].min = range.min;
        c.symbols[kind].size = (uint16_t)fba_range_size(range);
    }
    return c;
}

void fap_fba_list_coded(fba_coded_list *list, const fba_setup *s)
{
    list->count = 0;
    for (int param = 0; param < FBA_PARAMS; param++)
        if (s->coded[fap_fba_fap(param)])
            list->of[list->count++] = coded_param(s, param);
}

int fap_fba_bound(int n, int quant)
{
    return n * FBA_BOUND_UNIT / (quant ? quant : 1);
}

/* Away from zero to what a stream could have sent. */
static int16_t rounded_bound(int value, int quant)
{
    const int n = ((value < 0 ? -value : value) + FBA_BOUND_UNIT - 1) / FBA_BOUND_UNIT;
    return (int16_t)fap_fba_bound(value < 0 ? -n : n, quant);
}

void fap_fba_default_ranges(fba_setup *s, int bound)
{
    const int quant = s->quant;

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const int16_t all = (int16_t)(bound / (quant ? quant : 1));
        s->range[FBA_I][fap] =
            bound ? (fba_range){ (int16_t)-all, all }
                  : (fba_range){ rounded_bound(info->i_min, quant), rounded_bound(info->i_max, quant) };
        s->range[FBA_P][fap] =
            bound ? (fba_range){ (int16_t)-all, all }
                  : (fba_range){ rounded_bound(info->p_min, quant), rounded_bound(info->p_max, quant) };
    }
}
