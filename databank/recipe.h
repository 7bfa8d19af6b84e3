/* SPDX-License-Identifier: BSD-2-Clause */
/* Text recipes: any set of meshes with one topology into a databank. fapbank(1) describes the language. */
#ifndef DATABANK_RECIPE_H
#define DATABANK_RECIPE_H

#include <stddef.h>

#include <fap/studio/bank_build.h>

/* Where a recipe's files come from, by the name it has for them: malloc'ed bytes, one NUL behind them. */
typedef struct recipe_files {
    fap_err (*read)(void *user, const char *name, uint8_t **data, size_t *size);
    void *user;
} recipe_files;

/*
 * The language itself. @p text is changed; its first line is not looked at. @p line gets the line at fault, 0
 * where none is, but the mesh is missing.
 */
fap_err recipe_parse(fap_bank_builder **out, char *text, const recipe_files *files, int *line);

/* 1 where the file begins with a recipe's first line, "fapbank recipe". */
int recipe_is(const char *path);

/* Files are named relative to the recipe. @p bad gets "FILE:LINE" of what is at fault. */
fap_err recipe_make(fap_bank_builder **out, const char *path, char *bad, size_t bad_size);

#endif
