/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * File names with a number in them: "out_%04d.png". The user's text is taken apart here and is never a format
 * of printf.
 */
#ifndef PLAYER_NAME_PATTERN_H
#define PLAYER_NAME_PATTERN_H

#include <stddef.h>
#include <stdint.h>

typedef struct name_pattern {
    const char *text;  /* borrowed */
    size_t before;     /* bytes in front of the number */
    int digits;        /* least digits, 1 to 9; 0: the name has no number */
    const char *after; /* the rest, inside text */
} name_pattern;

/* 0: a '%' that is not exactly one %d or %0Nd, N from 1 to 9. */
int name_pattern_parse(name_pattern *p, const char *text);
/* The name of @number (not negative), malloc'ed; NULL without memory. */
char *name_pattern_make(const name_pattern *p, int64_t number);

#endif
