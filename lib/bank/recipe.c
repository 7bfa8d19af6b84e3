/* SPDX-License-Identifier: BSD-2-Clause */
/* See recipe.h. */
#include <string.h>

#include <fap/tables.h>

#include "bank/recipe.h"
#include "gen/key_models.h"

static const struct row {
    fap_key_kind kind;
    int number;
    const char *name, *unit;
    int percent;
} rows[] = {
#define X(kind, number, name, unit, percent) { FAP_KEY_##kind, number, name, unit, percent },
    KEY_MODELS_ROWS(X)
#undef X
};
enum { ROW_COUNT = sizeof rows / sizeof *rows };

/* The standard's own keys take the standard's names. */
static const char *key_name(const struct row *r)
{
    return r->kind == FAP_KEY_VISEME       ? fap_viseme_name(r->number)
           : r->kind == FAP_KEY_EXPRESSION ? fap_expression_name(r->number)
                                           : r->name;
}

static int same_key(const struct row *a, const struct row *b)
{
    return a->kind == b->kind && a->number == b->number && !strcmp(a->name, b->name);
}

const fap_recipe_row *fap_recipe_get(int row, fap_recipe_row *out)
{
    if (row < 0 || row >= ROW_COUNT)
        return NULL;
    const struct row *r = &rows[row];
    *out = (fap_recipe_row){ r->kind, r->number,           key_name(r),
                             r->unit, r->percent / 100.0f, row + 1 == ROW_COUNT || !same_key(r, r + 1) };
    return out;
}
