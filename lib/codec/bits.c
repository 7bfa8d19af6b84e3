/* SPDX-License-Identifier: BSD-2-Clause */
/* See bits.h. */
#include "codec/bits.h"

void fap_bits_init(fap_bits *b, const uint8_t *data, size_t size)
{
    *b = (fap_bits){ .data = data, .end = (uint64_t)size * 8 };
}

uint32_t fap_bits_peek(const fap_bits *b, uint64_t at, int n)
{
    uint32_t v = 0;

    for (; n > 0; n--, at++)
        v = v << 1 | fap_bits_peek_1(b, at);
    return v;
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

static void put_bit(fap_bit_writer *w, unsigned bit)
{
    const size_t byte = (size_t)(w->at / 8);

    if (byte >= w->room) {
        w->full = 1;
        return;
    }
    if (w->at % 8 == 0)
        w->data[byte] = 0;
    w->data[byte] |= (uint8_t)(bit << (7 - w->at % 8));
    w->at++;
}

void fap_bits_put(fap_bit_writer *w, int n, uint32_t value)
{
    while (n-- > 0)
        put_bit(w, value >> n & 1);
}

void fap_bits_put_stuffing(fap_bit_writer *w)
{
    fap_bits_put(w, 1, 0);
    while (w->at % 8 && !w->full)
        fap_bits_put(w, 1, 1);
}
