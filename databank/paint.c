/* SPDX-License-Identifier: BSD-2-Clause */
/* See paint.h. */
#include <stdlib.h>
#include <string.h>

#include <fap/studio/bank_build.h>

#include "databank/paint.h"
#include "databank/rewrite.h"

static fap_err with_colours(fap_bank **bank, const uint8_t (*colour)[4])
{
    fap_bank_builder *b;
    fap_err err = fap_bank_builder_copy(&b, *bank);

    if (!err && colour)
        fap_bank_builder_colours(b, colour);
    if (!err)
        err = bank_rewrite(bank, b);
    fap_bank_builder_close(&b);
    return err;
}

void paint_mask_colour(uint8_t mask, uint8_t colour[4])
{
    static const uint8_t colours[FAP_MASK_BITS][4] = { { 220, 40, 40 },  { 40, 80, 220 },  { 250, 170, 30 },
                                                       { 30, 160, 160 }, { 250, 170, 30 }, { 30, 160, 160 } };

    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        if (mask >> bit & 1)
            memcpy(colour, colours[bit], 4);
}

static void colour_of_mask(const fap_bank *bank, uint32_t v, uint8_t out[4])
{
    paint_mask_colour(fap_bank_masks(bank)[v], out);
}

static uint8_t channel(float distance_mm, float extent_mm)
{
    const float t = extent_mm > 0 ? 0.5f + 2.5f * distance_mm / extent_mm : distance_mm > 0;

    return (uint8_t)(40 + 190 * (t < 0 ? 0 : t > 1 ? 1 : t));
}

/* Red is the face's left, blue its upper half; they fade over the overlap that a face has unless told. */
static void colour_of_region(const fap_bank *bank, uint32_t v, uint8_t out[4])
{
    const fap_region_lines *lines = fap_bank_regions(bank);

    out[0] = channel(lines->from[v], lines->extent[0]);
    out[1] = 110;
    out[2] = channel(lines->from[fap_bank_mesh(bank)->stride + v], lines->extent[1]);
    out[3] = 0;
}

fap_err paint_find_maps(fap_bank **bank)
{
    return fap_bank_masks(*bank) && fap_bank_regions(*bank) ? FAP_OK : with_colours(bank, NULL);
}

fap_err paint_bank(fap_bank **bank, paint what)
{
    fap_err err = paint_find_maps(bank);
    const fap_mesh *mesh = fap_bank_mesh(*bank);
    uint8_t(*colour)[4] = err ? NULL : malloc((size_t)mesh->vertex_count * sizeof *colour);

    if (!colour)
        return err ? err : FAP_E_NOMEM;
    memcpy(colour, mesh->colour, (size_t)mesh->vertex_count * sizeof *colour);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        (what == PAINT_MASKS ? colour_of_mask : colour_of_region)(*bank, v, colour[v]);
    err = with_colours(bank, (const uint8_t(*)[4])colour);
    free(colour);
    return err;
}
