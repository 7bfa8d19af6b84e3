/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A second, plain implementation of the arithmetic coder and its adaptive tables, for tests alone: dense tables of
 * cumulative counts, as the standard states them. It shares nothing with lib/codec, so that a mistake there
 * cannot hide here. Source: ISO/IEC 14496-2, arithmetic decoding of FAPs.
 */
#ifndef TESTS_CONFORMANCE_CODER_H
#define TESTS_CONFORMANCE_CODER_H

#include <stddef.h>
#include <stdint.h>

/* Bits, most significant first. Positions of bits that must be 1 are kept: tests turn them over. */
typedef struct bit_list {
    uint8_t *data;
    size_t room, bits;
    size_t *fixed; /* positions of markers and of the 1s behind 22 zeros */
    uint8_t *is_marker;
    size_t fixed_count, fixed_room;
} bit_list;

void bit_list_put(bit_list *b, unsigned n, uint32_t value);
void bit_list_put_fixed(bit_list *b, uint32_t value, int is_marker);
void bit_list_free(bit_list *b);

/* cum[k]: counts of the symbols k and above. size 0: not made yet. */
typedef struct dense_table {
    uint32_t *cum;
    uint32_t size;
} dense_table;

void dense_table_make(dense_table *t, uint32_t size);
void dense_table_update(dense_table *t, uint32_t symbol);
void dense_table_free(dense_table *t);

typedef struct coder {
    bit_list *out;
    uint32_t low, high, zeros, pending;
    uint32_t protection; /* the bit behind 22 zeros: 1, or 0 in a broken stream */
} coder;

void coder_begin(coder *c, bit_list *out, uint32_t protection);
void coder_put(coder *c, const dense_table *t, uint32_t symbol);
void coder_flush(coder *c);

#endif
