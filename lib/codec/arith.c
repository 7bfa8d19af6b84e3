/* SPDX-License-Identifier: BSD-2-Clause */
/* See arith.h. */
#include "codec/arith.h"

enum { Q1 = 16384, Q2 = 32768, Q3 = 49152, TOP = 65535, CODE_BITS = 16, MAX_ZEROS = 22, FLUSH_BITS = 2 };

static uint32_t stream_bit(arith_decoder *a)
{
    return fap_bits_peek_1(a->bits, a->at++);
}

/* Stuffing is dropped in front of the bit that needs it, so that a run may end right behind 22 zeros. */
static uint32_t code_bit(arith_decoder *a)
{
    a->read++;
    if (a->zeros == MAX_ZEROS) {
        a->zeros = 0;
        if (!stream_bit(a) && !a->false_stuffing)
            a->false_stuffing = a->read;
    }
    const uint32_t bit = stream_bit(a);
    a->zeros = bit ? 0 : a->zeros + 1;
    a->behind[a->read % ARITH_HISTORY] = a->at;
    return bit;
}

void fap_arith_begin(arith_decoder *a, fap_bits *bits)
{
    *a = (arith_decoder){ .bits = bits, .high = TOP, .at = bits->at };
    for (int i = 0; i < CODE_BITS; i++)
        a->code = a->code << 1 | code_bit(a);
}

uint32_t fap_arith_target(const arith_decoder *a, uint32_t total)
{
    return ((a->code - a->low + 1) * total - 1) / (a->high - a->low + 1);
}

/* One doubling of the interval, if its place allows one. @p offset: what leaves low, high and code first. */
static int can_double(uint32_t low, uint32_t high, uint32_t *offset)
{
    *offset = 0;
    if (high < Q2)
        return 1;
    if (low >= Q2)
        *offset = Q2;
    else if (low >= Q1 && high < Q3)
        *offset = Q1;
    return *offset != 0;
}

static void narrow(uint32_t *low, uint32_t *high, arith_interval i)
{
    const uint32_t span = *high - *low + 1;

    *high = *low - 1 + span * i.high / i.total;
    *low = *low + span * i.low / i.total;
}

void fap_arith_take(arith_decoder *a, arith_interval i)
{
    uint32_t offset;

    narrow(&a->low, &a->high, i);
    while (can_double(a->low, a->high, &offset)) {
        a->low = 2 * (a->low - offset);
        a->high = 2 * (a->high - offset) + 1;
        a->code = 2 * (a->code - offset) + code_bit(a);
        a->shifts++;
    }
}

/* The encoder emitted shifts + 2 code bits; the decoder has read 14 more. */
void fap_arith_end(arith_decoder *a)
{
    const uint64_t last = a->shifts + FLUSH_BITS, at = a->behind[last % ARITH_HISTORY];
    fap_bits *b = a->bits;

    if (b->bad == BITS_FINE && at > b->end) {
        b->bad = BITS_PAST_END;
        b->bad_at = b->end;
    } else if (b->bad == BITS_FINE && a->false_stuffing && a->false_stuffing <= last) {
        b->bad = BITS_MARKER;
        b->bad_at = at;
    }
    b->at = at < b->end ? at : b->end;
}

static void emit(arith_encoder *a, unsigned bit)
{
    if (a->zeros == MAX_ZEROS) {
        fap_bits_put(a->bits, 1, 1);
        a->zeros = 0;
    }
    fap_bits_put(a->bits, 1, bit);
    a->zeros = bit ? 0 : a->zeros + 1;
}

static void emit_with_pending(arith_encoder *a, unsigned bit)
{
    emit(a, bit);
    for (; a->pending; a->pending--)
        emit(a, !bit);
}

void fap_arith_encoder_begin(arith_encoder *a, fap_bit_writer *bits)
{
    *a = (arith_encoder){ .bits = bits, .high = TOP };
}

void fap_arith_encoder_put(arith_encoder *a, arith_interval i)
{
    uint32_t offset;

    narrow(&a->low, &a->high, i);
    while (can_double(a->low, a->high, &offset)) {
        if (offset == Q1)
            a->pending++;
        else
            emit_with_pending(a, offset == Q2);
        a->low = 2 * (a->low - offset);
        a->high = 2 * (a->high - offset) + 1;
    }
}

void fap_arith_encoder_end(arith_encoder *a)
{
    a->pending++;
    emit_with_pending(a, a->low >= Q1);
}
