/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Files for the tools: reading with a limit, and writing so that an output appears whole or not at all.
 */
#ifndef COMMON_FILE_H
#define COMMON_FILE_H

#include <stdint.h>
#include <stdio.h>

#include <fap/error.h>
#include <fap/io.h>

/* Reads all of @p path ("-": standard input) into malloc'ed memory, one NUL behind it. FAP_E_LIMIT past @p max bytes. */
fap_err file_read(const char *path, size_t max, uint8_t **data, size_t *size);

/* An output that is written to a temporary name beside its target and renamed when whole. A signal that ends
 * the program (Ctrl-C) removes the temporary. */
typedef struct out_file {
    FILE *stream;      /* write here */
    char *path, *temp; /* temp is NULL for standard output */
} out_file;

/* @p path "-" is standard output. On error errno says why. */
fap_err out_file_open(out_file *f, const char *path);
/* Flushes, closes, renames. On error nothing is left behind and the target is what it was. */
fap_err out_file_commit(out_file *f);
/* Closes and removes the temporary. Harmless after a commit. */
void out_file_abandon(out_file *f);

/* libfap's callbacks over a FILE. */
fap_reader file_reader(FILE *f);
fap_writer file_writer(FILE *f);

#endif
