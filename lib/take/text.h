/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Lines and cells of exported tables, without copying and without the locale: LF and CRLF, a byte order mark,
 * quotes, decimal points and commas, and the many ways to say "missing".
 */
#ifndef LIB_TAKE_TEXT_H
#define LIB_TAKE_TEXT_H

#include <stddef.h>
#include <stdint.h>

typedef struct text {
    const char *start;
    size_t length;
} text;

typedef struct text_lines {
    const char *at, *end;
    unsigned number; /* of the line last given, from 1 */
} text_lines;

/* A row cut into cells; room for as many as a table may have columns. */
enum { TEXT_MAX_CELLS = 3 * 4096 + 64 };
typedef struct text_row {
    size_t count;
    text cell[TEXT_MAX_CELLS];
} text_row;

typedef enum text_value { TEXT_NUMBER, TEXT_MISSING, TEXT_OTHER } text_value;

text_lines text_open(const uint8_t *data, size_t size);
/* The next line without its end; 0 after the last. */
int text_next(text_lines *lines, text *line);

/* Cells without surrounding blanks and quotes; those past TEXT_MAX_CELLS are dropped. */
void text_split(text line, char separator, text_row *row);
/* Cell @p n, empty past the end of the row. */
text text_cell(const text_row *row, size_t n);
int text_row_is_blank(const text_row *row);
/* Whichever of ; tab , occurs most often. */
char text_separator(text line);

/* Without regard to case. */
int text_is(text t, const char *word);
int text_starts(text t, const char *word);
text text_trim(text t);

/*
 * A decimal number with '.' or ',' as its mark. Empty, NaN, NA, N/A and - are missing. @p value is set only
 * for a number.
 */
text_value text_number(text t, double *value);

#endif
