/* SPDX-License-Identifier: BSD-2-Clause */
/* See bits.h. */
#include "codec/bits.h"

void fap_bits_init(fap_bits *b, const uint8_t *data, size_t size)
{
    *b = (fap_bits){ .data = data, .end = (uint64_t)size * 8 };
}

uint32_t fap_bits_peek_tail(const fap_bits *b, uint64_t at, int n)
{
    const uint64_t first = at / 8, size = b->end / 8;
    uint8_t tail[8] = { 0 };

    for (uint64_t i = 0; i < sizeof tail && first + i < size; i++)
        tail[i] = b->data[first + i];
    return (uint32_t)(fap_bits_word(tail) << at % 8 >> 1 >> (63 - n));
}

static void fault(fap_bits *b, bits_fault what)
{
    if (b->bad == BITS_FINE) {
        b->bad = what;
        b->bad_at = b->at;
    }
}

uint32_t fap_bits_get(fap_bits *b, int n)
{
    const uint32_t v = fap_bits_peek(b, b->at, n);

    if ((uint64_t)n > b->end - b->at) {
        fault(b, BITS_PAST_END);
        b->at = b->end;
    } else {
        b->at += (uint64_t)n;
    }
    return v;
}

void fap_bits_marker(fap_bits *b)
{
    if (!fap_bits_peek(b, b->at, 1))
        fault(b, b->at < b->end ? BITS_MARKER : BITS_PAST_END);
    fap_bits_get(b, 1);
}

const char *fap_bits_why(const fap_bits *b)
{
    switch (b->bad) {
    case BITS_MARKER: return "a marker bit is 0";
    case BITS_PAST_END: return "the data is cut";
    case BITS_FINE: break;
    }
    return "";
}

void fap_bit_writer_init(fap_bit_writer *w, uint8_t *data, size_t room)
{
    *w = (fap_bit_writer){ .data = data, .room = room };
}

static void put_word(uint8_t *p, uint64_t v)
{
    p[0] = (uint8_t)(v >> 56);
    p[1] = (uint8_t)(v >> 48);
    p[2] = (uint8_t)(v >> 40);
    p[3] = (uint8_t)(v >> 32);
    p[4] = (uint8_t)(v >> 24);
    p[5] = (uint8_t)(v >> 16);
    p[6] = (uint8_t)(v >> 8);
    p[7] = (uint8_t)v;
}

/* Where there is no room for a word. */
static void put_bitwise(fap_bit_writer *w, int n, uint32_t value)
{
    for (; n > 0 && w->at / 8 < w->room; n--, w->at++) {
        uint8_t *byte = &w->data[w->at / 8];
        const int used = (int)(w->at % 8);
        *byte = (uint8_t)((*byte & 0xff00 >> used) | (value >> (n - 1) & 1) << (7 - used));
    }
    w->full |= n > 0;
}

/* Behind what is put the rest of a word becomes 0. */
void fap_bits_put(fap_bit_writer *w, int n, uint32_t value)
{
    const uint64_t byte = w->at / 8, used = w->at % 8;

    if (byte + 8 > w->room) {
        put_bitwise(w, n, value);
        return;
    }
    const uint64_t before = (uint64_t)(w->data[byte] & 0xff00 >> used)
                            << 56; /* 0xff00: its low byte counts */
    put_word(w->data + byte, before | (uint64_t)value << (63 - n) << 1 >> used); /* n may be 0 */
    w->at += (uint64_t)n;
}

void fap_bits_put_stuffing(fap_bit_writer *w)
{
    fap_bits_put(w, 1, 0);
    while (w->at % 8) /* inside of a byte there is room */
        fap_bits_put(w, 1, 1);
}
