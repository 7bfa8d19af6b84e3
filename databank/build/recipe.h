/* SPDX-License-Identifier: BSD-2-Clause */
/* Text recipes: meshes of one topology, or scans of one person, into a databank. fapbank(1) describes the language. */
#ifndef DATABANK_BUILD_RECIPE_H
#define DATABANK_BUILD_RECIPE_H

#include <stddef.h>

#include <fap/studio/bank_build.h>
#include <fap/studio/expression.h>

enum { RECIPE_MAX_SCANS = 64, RECIPE_NAME_SIZE = 32 };

/* Where a recipe's files come from, by the name it has for them: malloc'ed bytes, one NUL behind them. */
typedef struct recipe_files {
    fap_err (*read)(void *user, const char *name, uint8_t **data, size_t *size);
    void *user;
} recipe_files;

/* A scan, and the face on it. */
typedef struct recipe_laid {
    const char *name;
    int number; /* of scans so far, this one too */
    const fap_bank *like;
    const fap_surface *scan;
    const float (*in_head)[3]; /* [scan->vertex_count] millimetres, head axes */
    const float (*face)[3];    /* [vertices of like's mesh] */
} recipe_laid;

/* Who wants to know how the work goes; all may be NULL. */
typedef struct recipe_watch {
    void (*working)(void *user, const char *what);
    fap_err (*laid)(void *user, const recipe_laid *laid);
    void *user;
} recipe_watch;

/* What became of one scan. */
typedef struct recipe_scan {
    char name[RECIPE_NAME_SIZE];  /* "at rest", "joy" ... */
    fap_expression_report report; /* at rest: of its fit alone */
} recipe_scan;

typedef struct recipe_outcome {
    int line;                      /* at fault; 0: none is, but the mesh is missing */
    char why[FAP_ERROR_TEXT_SIZE]; /* "": what the error's own text says */
    int scan_count;
    recipe_scan scan[RECIPE_MAX_SCANS];
} recipe_outcome;

/* The language itself. @p text is changed; its first line is not looked at. *out is NULL unless FAP_OK. */
fap_err recipe_parse(fap_bank_builder **out, char *text, const recipe_files *files, const recipe_watch *watch,
                     recipe_outcome *outcome);

/* 1 where the file begins with a recipe's first line, "fapbank recipe". */
int recipe_is(const char *path);

/* Files are named relative to the recipe. @p bad gets "FILE:LINE" of what is at fault. */
fap_err recipe_make(fap_bank_builder **out, const char *path, const recipe_watch *watch,
                    recipe_outcome *outcome, char *bad, size_t bad_size);

#endif
