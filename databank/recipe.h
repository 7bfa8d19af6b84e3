/* SPDX-License-Identifier: BSD-2-Clause */
/* Text recipes: any set of meshes with one topology into a databank. fapbank(1) describes the language. */
#ifndef DATABANK_RECIPE_H
#define DATABANK_RECIPE_H

#include <stddef.h>

#include <fap/studio/bank_build.h>

/* 1 where the file begins with a recipe's first line, "fapbank recipe". */
int recipe_is(const char *path);

/* Files are named relative to the recipe. @p bad gets "FILE:LINE" of what is at fault. */
fap_err recipe_make(fap_bank_builder **out, const char *path, char *bad, size_t bad_size);

#endif
