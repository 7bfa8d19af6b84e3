/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * MATLAB's level 5 files, in place: arrays of numbers, texts, and structures of them. What nothing here asks for (cells, objects, sparse
 * matrices) is passed over. Source: MathWorks, "MAT-File Format", level 5.
 */
#ifndef LIB_TAKE_MAT5_H
#define LIB_TAKE_MAT5_H

#include "take/text.h"

/* A stretch of the file and its byte order. */
typedef struct mat5 {
    const uint8_t *at, *end;
    int big;
} mat5;

typedef enum mat5_kind { MAT5_NUMBERS, MAT5_TEXT, MAT5_STRUCTURES, MAT5_OTHER } mat5_kind;

/* One array, pointing into the file. */
typedef struct mat5_array {
    mat5_kind kind;
    text name;
    uint64_t rows, columns, count;
    int type;               /* of a number in the file */
    const uint8_t *numbers; /* of MAT5_NUMBERS and MAT5_TEXT; column by column */
    uint64_t stored;        /* how many there are */
    int big;
    uint32_t fields, name_size; /* of MAT5_STRUCTURES */
    const uint8_t *field_names;
    mat5 members; /* arrays, field after field of the first structure, then of the second */
} mat5_array;

/* How surely it is one: 0 to 100. */
int mat5_claims(const uint8_t *data, size_t size);
/* Behind the head. */
mat5 mat5_open(const uint8_t *data, size_t size);
/*
 * The next array: 1. 0: there is none. -1: it is packed, in @packed, and its insides (mat5_inside) come after unpacking.
 */
int mat5_next(mat5 *m, mat5_array *a, text *packed);
mat5 mat5_inside(const uint8_t *data, size_t size, int big);
/* The name of a structure's field. */
text mat5_field(const mat5_array *a, uint32_t field);
/* A number, or NAN beyond the last one. */
double mat5_number(const mat5_array *a, uint64_t index);
/* A text's letters as bytes, others as '?'; cut at @room, a NUL behind. */
void mat5_text(const mat5_array *a, char *out, size_t room);

#endif
