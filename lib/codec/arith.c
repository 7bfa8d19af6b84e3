/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See arith.h. Both sides renormalise in one step: first the leading bits that both ends of the interval share
 * go, then those by which it lies across the middle (low 01.., high 10..); it cannot be the other way round.
 */
#include "codec/arith.h"
#include "base/bitops.h"

enum { FULL = 65536, TOP_BIT = 32768, CODE_BITS = 16, MAX_ZEROS = 22, FLUSH_BITS = 2 };

/* By how many bits an interval grows when its ends share @p same of them and @p across follow. */
typedef struct growth {
    int same, across;
} growth;

static growth growth_of(uint32_t low, uint32_t high)
{
    growth g;

    g.same = fap_leading_zeros(2 * (low ^ high) + 1) - (31 - CODE_BITS);
    g.across = fap_leading_zeros(~((low & ~high) << g.same << (31 - CODE_BITS + 2)));
    return g;
}

static uint32_t grown_low(uint32_t low, growth g)
{
    return low << (g.same + g.across) & (TOP_BIT - 1);
}

/* --- decoder --- */

/* Stuffing is dropped in front of the bit that needs it, so that a run may end right behind 22 zeros. */
static uint32_t code_bit(arith_decoder *a, uint64_t number)
{
    if (a->zeros == MAX_ZEROS) {
        a->zeros = 0;
        a->stuffed = number;
        if (!fap_bits_peek(a->bits, a->at++, 1) && !a->not_a_1)
            a->not_a_1 = number;
    }
    const uint32_t bit = fap_bits_peek(a->bits, a->at++, 1);
    a->zeros = bit ? 0 : a->zeros + 1;
    return bit;
}

/* The next @p n code bits, 0 to 16; @p before of them were read. */
static uint32_t code_bits(arith_decoder *a, int n, uint64_t before)
{
    uint32_t v = 0;

    if (a->zeros + n <= MAX_ZEROS) {
        v = fap_bits_peek(a->bits, a->at, n);
        a->at += (uint64_t)n;
        a->zeros = v ? fap_trailing_zeros(v) : a->zeros + n;
    } else {
        for (int i = 1; i <= n; i++)
            v = v << 1 | code_bit(a, before + (uint64_t)i);
    }
    return v;
}

void fap_arith_begin(arith_decoder *a, fap_bits *bits)
{
    *a = (arith_decoder){ .bits = bits, .span = FULL, .at = bits->at };
    a->offset = code_bits(a, CODE_BITS, 0);
}

uint32_t fap_arith_target(const arith_decoder *a, uint32_t total)
{
    return ((a->offset + 1) * total - 1) / a->span;
}

void fap_arith_take(arith_decoder *a, arith_interval i)
{
    const uint32_t start = a->span * i.low / i.total, end = a->span * i.high / i.total;
    const uint32_t low = a->low + start, high = a->low + end - 1;
    const growth g = growth_of(low, high);
    const int n = g.same + g.across;

    a->low = grown_low(low, g);
    a->span = (end - start) << n;
    a->offset = (a->offset - start) << n | code_bits(a, n, a->shifts + CODE_BITS);
    a->shifts += (uint64_t)n;
}

/*
 * The encoder emitted shifts + 2 code bits; the decoder has read 14 more, and passed one stuffed bit at most
 * on the way.
 */
void fap_arith_end(arith_decoder *a)
{
    const uint64_t last = a->shifts + FLUSH_BITS;
    const uint64_t at = a->at - (CODE_BITS - FLUSH_BITS) - (a->stuffed > last);
    fap_bits *b = a->bits;

    if (b->bad == BITS_FINE && at > b->end) {
        b->bad = BITS_PAST_END;
        b->bad_at = b->end;
    } else if (b->bad == BITS_FINE && a->not_a_1 && a->not_a_1 <= last) {
        b->bad = BITS_MARKER;
        b->bad_at = at;
    }
    b->at = at < b->end ? at : b->end;
}

/* --- encoder --- */

static void emit_bit(arith_encoder *a, uint32_t bit)
{
    if (a->zeros == MAX_ZEROS) {
        fap_bits_put(a->bits, 1, 1);
        a->zeros = 0;
    }
    fap_bits_put(a->bits, 1, bit);
    a->zeros = bit ? 0 : a->zeros + 1;
}

/* @p n bits of @p v, 0 to 32. */
static void emit(arith_encoder *a, int n, uint32_t v)
{
    if (a->zeros + n <= MAX_ZEROS) {
        fap_bits_put(a->bits, n, v);
        a->zeros = v ? fap_trailing_zeros(v) : a->zeros + n;
    } else {
        while (n-- > 0)
            emit_bit(a, v >> n & 1);
    }
}

/* @p n bits of @p v, 1 to 16; behind the first come as many of its opposite as are pending. */
static void emit_with_pending(arith_encoder *a, int n, uint32_t v)
{
    const uint32_t first = v >> (n - 1) & 1, rest = v & ((1u << (n - 1)) - 1);

    if (a->pending < CODE_BITS) {
        const uint32_t head = first ? 1u << a->pending : (1u << a->pending) - 1;
        emit(a, a->pending + n, head << (n - 1) | rest);
    } else {
        emit(a, 1, first);
        for (int i = 0; i < a->pending; i++)
            emit(a, 1, !first);
        emit(a, n - 1, rest);
    }
    a->pending = 0;
}

void fap_arith_encoder_begin(arith_encoder *a, fap_bit_writer *bits)
{
    *a = (arith_encoder){ .bits = bits, .span = FULL };
}

void fap_arith_encoder_put(arith_encoder *a, arith_interval i)
{
    const uint32_t start = a->span * i.low / i.total, end = a->span * i.high / i.total;
    const uint32_t low = a->low + start, high = a->low + end - 1;
    const growth g = growth_of(low, high);

    if (g.same)
        emit_with_pending(a, g.same, low >> (CODE_BITS - g.same));
    a->pending += g.across;
    a->low = grown_low(low, g);
    a->span = (end - start) << (g.same + g.across);
}

void fap_arith_encoder_end(arith_encoder *a)
{
    a->pending++;
    emit_with_pending(a, 1, a->low >= TOP_BIT / 2);
}
