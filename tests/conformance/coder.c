/* SPDX-License-Identifier: BSD-2-Clause */
/* See coder.h. */
#include "tests/conformance/coder.h"

#include <stdlib.h>
#include <string.h>

/* A test without memory has nothing to say. */
static void *grown(void *old, size_t size)
{
    void *p = realloc(old, size);
    if (!p)
        abort();
    return p;
}

static void put_bit(bit_list *b, uint32_t bit)
{
    if (b->bits / 8 == b->room) {
        b->room = 2 * b->room + 64;
        b->data = grown(b->data, b->room);
    }
    if (b->bits % 8 == 0)
        b->data[b->bits / 8] = 0;
    b->data[b->bits / 8] |= (uint8_t)(bit << (7 - b->bits % 8));
    b->bits++;
}

void bit_list_put(bit_list *b, unsigned n, uint32_t value)
{
    while (n-- > 0)
        put_bit(b, value >> n & 1);
}

void bit_list_put_fixed(bit_list *b, uint32_t value, int is_marker)
{
    if (b->fixed_count == b->fixed_room) {
        b->fixed_room = 2 * b->fixed_room + 64;
        b->fixed = grown(b->fixed, b->fixed_room * sizeof *b->fixed);
        b->is_marker = grown(b->is_marker, b->fixed_room);
    }
    b->is_marker[b->fixed_count] = (uint8_t)is_marker;
    b->fixed[b->fixed_count++] = b->bits;
    put_bit(b, value);
}

void bit_list_free(bit_list *b)
{
    free(b->data);
    free(b->fixed);
    free(b->is_marker);
    memset(b, 0, sizeof *b);
}

/* --- tables --- */

void dense_table_make(dense_table *t, uint32_t size)
{
    t->size = size;
    t->cum = grown(t->cum, (size + 1) * sizeof *t->cum);
    for (uint32_t k = 0; k <= size; k++)
        t->cum[k] = size - k;
}

static void halve(dense_table *t)
{
    uint32_t above = 0, old_above = 0;

    for (uint32_t k = t->size; k-- > 0;) {
        const uint32_t count = t->cum[k] - old_above;
        old_above = t->cum[k];
        above += (count + 1) / 2;
        t->cum[k] = above;
    }
}

void dense_table_update(dense_table *t, uint32_t symbol)
{
    if (t->cum[0] == 16383)
        halve(t);
    for (uint32_t k = 0; k <= symbol; k++)
        t->cum[k]++;
}

void dense_table_free(dense_table *t)
{
    free(t->cum);
    memset(t, 0, sizeof *t);
}

/* --- coder --- */

void coder_begin(coder *c, bit_list *out, uint32_t protection)
{
    *c = (coder){ .out = out, .high = 65535, .protection = protection };
}

static void code_bit(coder *c, uint32_t bit)
{
    if (c->zeros == 22) {
        bit_list_put_fixed(c->out, c->protection, 0);
        c->zeros = 0;
    }
    bit_list_put(c->out, 1, bit);
    c->zeros = bit ? 0 : c->zeros + 1;
}

static void settle(coder *c, uint32_t bit)
{
    code_bit(c, bit);
    while (c->pending) {
        code_bit(c, 1 - bit);
        c->pending--;
    }
}

void coder_put(coder *c, const dense_table *t, uint32_t symbol)
{
    const uint32_t span = c->high - c->low + 1, total = t->cum[0];

    c->high = c->low - 1 + span * t->cum[symbol] / total;
    c->low = c->low + span * t->cum[symbol + 1] / total;
    for (;;) {
        if (c->high < 32768) {
            settle(c, 0);
        } else if (c->low >= 32768) {
            settle(c, 1);
            c->low -= 32768;
            c->high -= 32768;
        } else if (c->low >= 16384 && c->high < 49152) {
            c->pending++;
            c->low -= 16384;
            c->high -= 16384;
        } else {
            return;
        }
        c->low = 2 * c->low;
        c->high = 2 * c->high + 1;
    }
}

void coder_flush(coder *c)
{
    c->pending++;
    settle(c, c->low < 16384 ? 0 : 1);
}
