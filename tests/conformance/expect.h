/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Plays an assembled stream and compares every word the decoder says with a text of expectations.
 * docs/conformance.md lists the lines of such a text. Source: include/fap/decoder.h.
 */
#ifndef TESTS_CONFORMANCE_EXPECT_H
#define TESTS_CONFORMANCE_EXPECT_H

#include <stdio.h>

#include <fap/decoder.h>

#include "tests/conformance/assemble.h"

/* What came out of a stream, as text: one line for each receive, notice and end of a unit. */
typedef struct transcript {
    char **line;
    size_t count, room;
} transcript;

/* @p options: the text of expectations, for its "option" lines. 1: played; 0: *why says what the decoder broke. */
int transcript_make(transcript *t, const assembly *a, const char *options, const char **why);
/* The first difference goes to @p message. 1: none. */
int transcript_matches(const transcript *t, const char *expect, char *message, size_t size);
void transcript_print(const transcript *t, FILE *to);
void transcript_free(transcript *t);

#endif
