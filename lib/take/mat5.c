/* SPDX-License-Identifier: BSD-2-Clause */
/* See mat5.h. */
#include <math.h>
#include <string.h>

#include "take/mat5.h"

enum { HEAD = 128, TAG = 8 };
/* Types of data elements. */
enum { I8 = 1, U8, I16, U16, I32, U32, F32, F64 = 9, I64 = 12, U64, MATRIX, PACKED, UTF8, UTF16, UTF32 };
/* Classes of arrays. */
enum { CLASS_STRUCTURE = 2, CLASS_TEXT = 4, CLASS_DOUBLE = 6, CLASS_U64 = 15 };

typedef struct element {
    int type;
    const uint8_t *data;
    size_t size;
} element;

static uint64_t whole(const uint8_t *at, int bytes, int big)
{
    uint64_t v = 0;

    for (int i = 0; i < bytes; i++)
        v |= (uint64_t)at[big ? bytes - 1 - i : i] << 8 * i;
    return v;
}

int mat5_claims(const uint8_t *data, size_t size)
{
    return size > HEAD && !memcmp(data, "MATLAB", 6) &&
                   (!memcmp(data + 126, "IM", 2) || !memcmp(data + 126, "MI", 2))
               ? 90
               : 0;
}

mat5 mat5_inside(const uint8_t *data, size_t size, int big)
{
    return (mat5){ data, data + size, big };
}

mat5 mat5_open(const uint8_t *data, size_t size)
{
    return mat5_inside(data + HEAD, size - HEAD, data[126] == 'M');
}

/* A short one has its data within its tag; others are followed by zeros up to a multiple of 8, packed ones are not. */
static int next_element(mat5 *m, element *e)
{
    const size_t left = (size_t)(m->end - m->at);

    if (left < TAG)
        return 0;
    const uint32_t first = (uint32_t)whole(m->at, 4, m->big);
    if (first >> 16) {
        *e = (element){ (int)(first & 0xFFFF), m->at + 4, first >> 16 };
        m->at += TAG;
        return e->size <= 4;
    }
    *e = (element){ (int)first, m->at + TAG, (size_t)whole(m->at + 4, 4, m->big) };
    if (e->size > left - TAG)
        return 0;
    const size_t padded = e->type == PACKED ? e->size : (e->size + 7) / 8 * 8;
    m->at += padded < left - TAG ? TAG + padded : left;
    return 1;
}

static int size_of(int type)
{
    switch (type) {
    case I8:
    case U8:
    case UTF8: return 1;
    case I16:
    case U16:
    case UTF16: return 2;
    case I32:
    case U32:
    case F32:
    case UTF32: return 4;
    case F64:
    case I64:
    case U64: return 8;
    default: return 0;
    }
}

/* --- an array --- */

static int read_dimensions(const element *e, mat5_array *a)
{
    const size_t count = e->size / 4;

    if (e->type != I32 || count < 2)
        return 0;
    a->rows = whole(e->data, 4, a->big);
    a->columns = 1;
    for (size_t i = 1; i < count; i++) {
        a->columns *= whole(e->data + 4 * i, 4, a->big);
        if (a->columns > UINT32_MAX)
            return 0;
    }
    a->count = a->rows * a->columns;
    return 1;
}

static int read_numbers(mat5 *m, mat5_array *a)
{
    element e;

    if (!next_element(m, &e))
        return 0;
    const int bytes = size_of(e.type);
    a->type = e.type;
    a->numbers = e.data;
    a->stored = bytes ? e.size / (size_t)bytes : 0;
    return 1;
}

static int read_structures(mat5 *m, mat5_array *a)
{
    element length, names;

    if (!next_element(m, &length) || length.type != I32 || length.size < 4 || !next_element(m, &names) ||
        names.type != I8)
        return 0;
    a->name_size = (uint32_t)whole(length.data, 4, a->big);
    if (!a->name_size || a->name_size > names.size)
        return 0;
    a->fields = (uint32_t)(names.size / a->name_size);
    a->field_names = names.data;
    a->members = *m;
    return 1;
}

static mat5_kind kind_of(unsigned class)
{
    if (class == CLASS_STRUCTURE)
        return MAT5_STRUCTURES;
    if (class == CLASS_TEXT)
        return MAT5_TEXT;
    return class >= CLASS_DOUBLE && class <= CLASS_U64 ? MAT5_NUMBERS : MAT5_OTHER;
}

/* What is damaged becomes MAT5_OTHER: there may be something sound behind it. An empty one has nothing inside. */
static void read_array(mat5 m, mat5_array *a)
{
    element flags, dimensions, name;

    *a = (mat5_array){ .kind = MAT5_OTHER, .name = { "", 0 }, .big = m.big };
    if (!next_element(&m, &flags) || flags.type != U32 || flags.size < 8 || !next_element(&m, &dimensions) ||
        !read_dimensions(&dimensions, a) || !next_element(&m, &name) || name.type != I8)
        return;
    a->name = (text){ (const char *)name.data, name.size };
    const mat5_kind kind = kind_of((unsigned)whole(flags.data, 4, m.big) & 0xFF);
    const int sound =
        kind == MAT5_STRUCTURES ? read_structures(&m, a) : kind != MAT5_OTHER && read_numbers(&m, a);
    if (sound)
        a->kind = kind;
}

int mat5_next(mat5 *m, mat5_array *a, text *packed)
{
    element e;

    while (next_element(m, &e)) {
        if (e.type == PACKED) {
            *packed = (text){ (const char *)e.data, e.size };
            return -1;
        }
        if (e.type != MATRIX)
            continue;
        read_array(mat5_inside(e.data, e.size, m->big), a);
        return 1;
    }
    return 0;
}

text mat5_field(const mat5_array *a, uint32_t field)
{
    const char *name = (const char *)a->field_names + (size_t)field * a->name_size;

    return (text){ name, strnlen(name, a->name_size) };
}

/* --- numbers --- */

static double signed_number(uint64_t bits, int bytes)
{
    const uint64_t sign = (uint64_t)1 << (8 * bytes - 1);

    return bits & sign ? -(double)((~bits + 1) & (sign | (sign - 1))) : (double)bits;
}

static double real_number(uint64_t bits, int bytes)
{
    const uint32_t half = (uint32_t)bits;
    double d;
    float f;

    if (bytes == 8) {
        memcpy(&d, &bits, sizeof d);
        return d;
    }
    memcpy(&f, &half, sizeof f);
    return (double)f;
}

double mat5_number(const mat5_array *a, uint64_t index)
{
    const int bytes = size_of(a->type);

    if (index >= a->stored || !bytes)
        return NAN;
    const uint64_t bits = whole(a->numbers + index * (uint64_t)bytes, bytes, a->big);
    if (a->type == F32 || a->type == F64)
        return real_number(bits, bytes);
    return a->type == I8 || a->type == I16 || a->type == I32 || a->type == I64 ? signed_number(bits, bytes)
                                                                               : (double)bits;
}

void mat5_text(const mat5_array *a, char *out, size_t room)
{
    size_t used = 0;

    for (uint64_t i = 0; i < a->stored && used + 1 < room; i++) {
        const double c = mat5_number(a, i);
        out[used++] = c >= 32 && c < 127 ? (char)c : '?';
    }
    out[used] = '\0';
}
