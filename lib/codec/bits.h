/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Bits of an elementary stream, most significant first, read and written. Both sides remember that something
 * went wrong, so that a caller checks once after many calls: past the end zeros are read and nothing is
 * written.
 */
#ifndef LIB_CODEC_BITS_H
#define LIB_CODEC_BITS_H

#include <stddef.h>
#include <stdint.h>

typedef enum bits_fault { BITS_FINE, BITS_PAST_END, BITS_MARKER } bits_fault;

typedef struct fap_bits {
    const uint8_t *data;
    uint64_t at, end; /* bit positions */
    bits_fault bad;   /* the first thing that went wrong */
    uint64_t bad_at;
} fap_bits;

void fap_bits_init(fap_bits *b, const uint8_t *data, size_t size);
/* @p n bits, 0 to 32. */
uint32_t fap_bits_get(fap_bits *b, int n);
/* One bit that must be 1. */
void fap_bits_marker(fap_bits *b);
/* What went wrong, in words. */
const char *fap_bits_why(const fap_bits *b);
/* As fap_bits_peek(), for the last bytes of the data. */
uint32_t fap_bits_peek_tail(const fap_bits *b, uint64_t at, int n);

/* Eight bytes as one number; compilers make one load of it. */
static inline uint64_t fap_bits_word(const uint8_t *p)
{
    return (uint64_t)p[0] << 56 | (uint64_t)p[1] << 48 | (uint64_t)p[2] << 40 | (uint64_t)p[3] << 32 |
           (uint64_t)p[4] << 24 | (uint64_t)p[5] << 16 | (uint64_t)p[6] << 8 | (uint64_t)p[7];
}

/* @p n bits (0 to 32) at @p at without moving; zeros past the end, which is no fault. */
static inline uint32_t fap_bits_peek(const fap_bits *b, uint64_t at, int n)
{
    if (at + 64 > b->end)
        return fap_bits_peek_tail(b, at, n);
    return (uint32_t)(fap_bits_word(b->data + at / 8) << at % 8 >> 1 >> (63 - n)); /* n may be 0 */
}

typedef struct fap_bit_writer {
    uint8_t *data;
    size_t room;
    uint64_t at;
    int full; /* a bit found no room */
} fap_bit_writer;

void fap_bit_writer_init(fap_bit_writer *w, uint8_t *data, size_t room);
void fap_bits_put(fap_bit_writer *w, int n, uint32_t value);
/* next_start_code: a 0 and then 1s up to the byte boundary; a whole byte where the position is on one. */
void fap_bits_put_stuffing(fap_bit_writer *w);

#endif
