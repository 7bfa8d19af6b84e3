/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Lines out of a byte source, through one fixed buffer: LF, CRLF and CR end a line, a missing last end is
 * forgiven.
 */
#ifndef LIB_CODEC_ASCII_LINES_H
#define LIB_CODEC_ASCII_LINES_H

#include <stdint.h>

#include <fap/error.h>
#include <fap/io.h>

/* The longest value line, 78 numbers of 11 characters, is far below; a name or a comment may be long. */
enum { ASCII_LINE_MAX = 16384, ASCII_BUFFER = 2 * ASCII_LINE_MAX };

typedef struct ascii_lines {
    fap_reader in;
    char *start; /* first byte not yet given out */
    char *end;   /* end of the bytes in the buffer */
    char *feed;  /* the first LF from start on, or end; searched for once, however many CR stand before it */
    int64_t number; /* of the line last given, from 1 */
    int finished;   /* the source has no more bytes */
    int lone_cr;    /* some line ended in CR alone */
    int unended;    /* the line last given had no end: it is the last, and may be cut */
    int byte_order_mark;
    char buffer[ASCII_BUFFER + 1];
} ascii_lines;

void fap_ascii_lines_init(ascii_lines *l, const fap_reader *in);

/*
 * The next line. A '\n' is put where it ends, so that parsers need one test to stop; there may be NULs before
 * it. FAP_E_END, FAP_E_IO, FAP_E_LIMIT (longer than ASCII_LINE_MAX, which is then *length). The line lives
 * until the next call.
 */
fap_err fap_ascii_lines_next(ascii_lines *l, char **line, size_t *length);

#endif
