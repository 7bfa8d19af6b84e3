/* SPDX-License-Identifier: BSD-2-Clause */
/* "masks FILE.csv": lips and lids as fapbank masks, or an artist, has found them, for those that build derives. */
#include <stdlib.h>

#include <fap/studio/masks.h>

#include "databank/build/recipe_state.h"

fap_err recipe_take_masks(recipe *r, const char *rest)
{
    const uint32_t n = recipe_vertex_count(r);
    uint8_t *text = NULL, *mask = calloc(n + 1u, 1);
    size_t size;

    fap_err err = mask ? r->files->read(r->files->user, rest, &text, &size) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = fap_masks_read(mask, n, text, size, NULL);
    if (err == FAP_OK)
        err = fap_bank_builder_masks(r->builder, mask);
    free(text);
    free(mask);
    return err;
}
