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

/* What of the last byte is not yet written is 0, so that pieces can be joined. */
void fap_bits_put(fap_bit_writer *w, int n, uint32_t value)
{
    while (n > 0) {
        const size_t byte = (size_t)(w->at / 8);
        const int used = (int)(w->at % 8), take = n < 8 - used ? n : 8 - used;
        if (byte >= w->room) {
            w->full = 1;
            return;
        }
        n -= take;
        const unsigned before = used ? w->data[byte] : 0, piece = value >> n & ((1u << take) - 1);
        w->data[byte] = (uint8_t)(before | piece << (8 - used - take));
        w->at += (uint64_t)take;
    }
}

void fap_bits_put_stuffing(fap_bit_writer *w)
{
    fap_bits_put(w, 1, 0);
    while (w->at % 8 && !w->full)
        fap_bits_put(w, 1, 1);
}
