/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Makes FBA streams out of text that reads like the syntax table. One statement a line, or several with ";" between;
 * "#" begins a comment. docs/conformance.md lists the statements.
 */
#ifndef TESTS_CONFORMANCE_ASSEMBLE_H
#define TESTS_CONFORMANCE_ASSEMBLE_H

#include "tests/conformance/coder.h"

enum { MAX_UNITS = 64 };

typedef struct assembly {
    bit_list bits;
    size_t unit_end[MAX_UNITS]; /* bytes; a unit as long as the one before it is a lost one */
    int units;
    char error[256]; /* "" or what is wrong with the text, and where */
} assembly;

/* 1: made; 0: see a->error. assembly_free() in either case. */
int assembly_make(assembly *a, const char *text);
void assembly_free(assembly *a);

#endif
