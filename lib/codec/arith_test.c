/* SPDX-License-Identifier: BSD-2-Clause */
/* Bits, the arithmetic coder and its models, against plain versions of the same. */
#include "tests/test.h"

#include <string.h>

#include "codec/arith.h"
#include "codec/models.h"

static uint32_t draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

TEST(bits, what_was_put_is_got)
{
    uint8_t data[8];
    fap_bit_writer w;
    fap_bits b;

    fap_bit_writer_init(&w, data, sizeof data);
    fap_bits_put(&w, 3, 5);
    fap_bits_put(&w, 32, 0xDEADBEEF);
    fap_bits_put(&w, 1, 1);
    fap_bits_put_stuffing(&w);
    assert_int_equal(w.at, 40);
    fap_bits_put_stuffing(&w);
    assert_int_equal(w.at, 48);
    assert_int_equal(data[5], 0x7F);
    fap_bits_init(&b, data, 6);
    assert_int_equal(fap_bits_get(&b, 3), 5);
    assert_int_equal(fap_bits_get(&b, 32), 0xDEADBEEF);
    fap_bits_marker(&b);
    assert_int_equal(fap_bits_get(&b, 4), 7);
    assert_int_equal(b.bad, BITS_FINE);
}

TEST(bits, reading_past_the_end_gives_zeros_and_says_so)
{
    const uint8_t data[1] = { 0xFF };
    fap_bits b;

    fap_bits_init(&b, data, sizeof data);
    assert_int_equal(fap_bits_get(&b, 6), 63);
    assert_int_equal(fap_bits_get(&b, 4), 12);
    assert_int_equal(b.bad, BITS_PAST_END);
    assert_int_equal(b.bad_at, 6);
    assert_int_equal(fap_bits_get(&b, 32), 0);
}

TEST(bits, a_marker_that_is_0_is_remembered)
{
    const uint8_t data[1] = { 0x40 };
    fap_bits b;

    fap_bits_init(&b, data, sizeof data);
    fap_bits_marker(&b);
    fap_bits_marker(&b);
    assert_int_equal(b.bad, BITS_MARKER);
    assert_int_equal(b.bad_at, 0);
}

TEST(bits, a_full_writer_stops)
{
    uint8_t data[1];
    fap_bit_writer w;

    fap_bit_writer_init(&w, data, sizeof data);
    fap_bits_put(&w, 9, 0x1FF);
    assert_int_equal(w.full, 1);
    assert_int_equal(w.at, 8);
    assert_int_equal(data[0], 0xFF);
}

/* --- models against a table of all counts --- */

enum { SYMBOLS = 300 };

static arith_interval plain_interval(const uint32_t *count, int size, int symbol)
{
    arith_interval i = { 0 };

    for (int k = size - 1; k >= 0; k--) {
        i.low += k > symbol ? count[k] : 0;
        i.total += count[k];
    }
    i.high = i.low + count[symbol];
    return i;
}

static void plain_count(uint32_t *count, int size, int symbol)
{
    if (plain_interval(count, size, 0).total == 16383)
        for (int k = 0; k < size; k++)
            count[k] = (count[k] + 1) / 2;
    count[symbol]++;
}

/* Coded symbols lie around @p centre, the nearer the more often; 1 in 100 anywhere. */
static int likely_symbol(uint32_t *seed, int size, int centre, int width)
{
    const int off = (int)(draw(seed) % (1 + draw(seed) % (unsigned)width)) * (draw(seed) % 2 ? 1 : -1);
    const int symbol = draw(seed) % 100 ? centre + off : (int)(draw(seed) % (unsigned)size);
    return symbol < 0 ? 0 : symbol >= size ? size - 1 : symbol;
}

/* One symbol by one of the three ways there are, all of which must see the plain interval. */
static void code_like_plain(model_pool *pool, model *m, uint32_t *count, int size, int symbol, uint32_t *seed)
{
    const arith_interval want = plain_interval(count, size, symbol);
    const uint32_t target = want.low + draw(seed) % (want.high - want.low);
    arith_interval got = fap_model_interval(pool, m, size, symbol);

    assert_memory_equal(&got, &want, sizeof got);
    got = (arith_interval){ 0 };
    assert_int_equal(fap_model_total(m, size), want.total);
    switch (draw(seed) % 3) {
    case 0: assert_int_equal(fap_model_decode(pool, m, size, target, &got), symbol); break;
    case 1: assert_int_equal(fap_model_encode(pool, m, size, symbol, &got), 1); break;
    default: assert_int_equal(fap_model_count(pool, m, size, symbol), 1); return;
    }
    assert_memory_equal(&got, &want, sizeof got);
}

TEST(models, count_like_a_table_of_all_symbols)
{
    static model_node node[SYMBOLS + 1];
    const int sizes[] = { SYMBOLS, 1, 2, 61, 15 };
    uint32_t count[SYMBOLS], seed = 7;
    model_pool pool;

    fap_model_pool_init(&pool, node, SYMBOLS);
    for (int round = 0; round < 5; round++) {
        model m = { 0 };
        const int size = sizes[round];
        for (int k = 0; k < size; k++)
            count[k] = 1;
        for (int i = 0; i < 40000; i++) {
            const int symbol = likely_symbol(&seed, size, i / 5000 * size / 8, 1 + size / 8);
            code_like_plain(&pool, &m, count, size, symbol, &seed);
            plain_count(count, size, symbol);
        }
        fap_model_clear(&pool, &m);
        assert_int_equal(fap_model_total(&m, size), size);
    }
}

/* Walks must be short where the next symbol is near the one before: both lists begin there. */
TEST(models, the_symbol_coded_last_is_where_walks_begin)
{
    static model_node node[101];
    model_pool pool;
    model m = { 0 };
    uint32_t seed = 19;

    fap_model_pool_init(&pool, node, 100);
    for (int k = 0; k < 100; k++)
        assert_int_equal(fap_model_count(&pool, &m, 100, k), 1);
    for (int k = 0; k < 300; k++) {
        const int symbol = 1 + (int)(draw(&seed) % 98);
        assert_int_equal(fap_model_count(&pool, &m, 100, symbol), 1);
        assert_int_equal(node[m.down].symbol, symbol);
        assert_int_equal(node[m.up].symbol, symbol + 1);
    }
}

TEST(models, say_when_their_memory_is_used_up)
{
    model_node node[3];
    model_pool pool;
    model m = { 0 };

    fap_model_pool_init(&pool, node, 2);
    assert_int_equal(fap_model_count(&pool, &m, 10, 4), 1);
    assert_int_equal(fap_model_count(&pool, &m, 10, 5), 1);
    assert_int_equal(fap_model_count(&pool, &m, 10, 6), 0);
    arith_interval i;
    assert_int_equal(fap_model_decode(&pool, &m, 10, 0, &i), -1);
    assert_int_equal(fap_model_encode(&pool, &m, 10, 9, &i), 0);
    assert_int_equal(fap_model_count(&pool, &m, 10, 5), 1);
    fap_model_clear(&pool, &m);
    assert_int_equal(fap_model_count(&pool, &m, 10, 6), 1);
}

/* --- coder --- */

enum { MAX_RUN = 80 };

typedef struct run {
    int count;
    arith_interval i[MAX_RUN];
} run;

/* The middle third again and again: no bit is decided before the end. */
static run undecided_run(int count)
{
    run r = { .count = count };

    for (int k = 0; k < r.count; k++)
        r.i[k] = (arith_interval){ 1, 2, 3 };
    return r;
}

/* Narrow or wide intervals; many that begin at 0, which make long rows of 0 bits. */
static run random_run(uint32_t *seed)
{
    run r = { .count = (int)(draw(seed) % MAX_RUN) };

    if (draw(seed) % 16 == 0)
        return undecided_run(r.count);

    for (int k = 0; k < r.count; k++) {
        const uint32_t total = 1 + draw(seed) % 16383, low = draw(seed) % 3 ? 0 : draw(seed) % total;
        const uint32_t width = draw(seed) % 2 ? 1 : 1 + draw(seed) % (total - low);
        r.i[k] = (arith_interval){ low, low + width, total };
    }
    return r;
}

static void put_run(fap_bit_writer *w, const run *r)
{
    arith_encoder a;

    fap_arith_encoder_begin(&a, w);
    for (int k = 0; k < r->count; k++)
        fap_arith_encoder_put(&a, r->i[k]);
    fap_arith_encoder_end(&a);
}

static void check_run(fap_bits *b, const run *r)
{
    arith_decoder a;

    fap_arith_begin(&a, b);
    for (int k = 0; k < r->count; k++) {
        const uint32_t target = fap_arith_target(&a, r->i[k].total);
        assert_true(target >= r->i[k].low && target < r->i[k].high);
        fap_arith_take(&a, r->i[k]);
    }
    fap_arith_end(&a);
    assert_int_equal(b->bad, BITS_FINE);
}

/* Runs at every bit offset, with all kinds of bits behind them: the end must be found exactly. */
TEST(arith, runs_are_read_back_and_end_where_they_end)
{
    static uint8_t data[1024];
    uint32_t seed = 3;

    for (int i = 0; i < 3000; i++) {
        const uint32_t lead = draw(&seed) % 8, behind = i % 3 == 0 ? 0 : i % 3 == 1 ? 0xFFFFFF : draw(&seed);
        const run r = random_run(&seed);
        fap_bit_writer w;
        fap_bits b;

        fap_bit_writer_init(&w, data, sizeof data);
        fap_bits_put(&w, (int)lead, 0);
        put_run(&w, &r);
        const uint64_t end = w.at;
        fap_bits_put(&w, 24, behind);
        assert_int_equal(w.full, 0);
        fap_bits_init(&b, data, (size_t)(w.at + 7) / 8);
        fap_bits_get(&b, (int)lead);
        check_run(&b, &r);
        assert_int_equal(b.at, end);
    }
}

TEST(arith, no_run_has_23_zeros_in_a_row)
{
    static uint8_t data[1024];
    uint32_t seed = 5;
    int longest = 0;

    for (int i = 0; i < 3000; i++) {
        const run r = random_run(&seed);
        fap_bit_writer w;
        fap_bits b;
        int zeros = 0;

        fap_bit_writer_init(&w, data, sizeof data);
        put_run(&w, &r);
        fap_bits_init(&b, data, sizeof data);
        for (uint64_t at = 0; at < w.at; at++) {
            zeros = fap_bits_peek(&b, at, 1) ? 0 : zeros + 1;
            longest = zeros > longest ? zeros : longest;
        }
    }
    assert_int_equal(longest, 22);
}

TEST(arith, a_cut_run_is_noticed)
{
    static uint8_t data[1024];
    uint32_t seed = 9;

    for (int i = 0; i < 200; i++) {
        run r = random_run(&seed);
        fap_bit_writer w;
        fap_bits b;
        arith_decoder a;

        fap_bit_writer_init(&w, data, sizeof data);
        put_run(&w, &r);
        fap_bits_init(&b, data, (size_t)(w.at - 1) / 8);
        fap_arith_begin(&a, &b);
        for (int k = 0; k < r.count; k++)
            fap_arith_take(&a, r.i[k]); /* the right symbols: only the length is wrong */
        fap_arith_end(&a);
        assert_int_equal(b.bad, BITS_PAST_END);
    }
}

TEST(arith, a_wrong_stuffed_bit_is_noticed)
{
    static uint8_t data[64];
    const run r = { .count = 4, .i = { { 0, 1, 16000 }, { 0, 1, 16000 }, { 0, 1, 16000 }, { 0, 1, 16000 } } };
    fap_bit_writer w;
    fap_bits b;
    arith_decoder a;

    fap_bit_writer_init(&w, data, sizeof data);
    put_run(&w, &r);
    assert_int_equal(data[2], 2); /* 22 zeros and the 1 */
    data[2] = 0;
    fap_bits_init(&b, data, (size_t)(w.at + 7) / 8);
    fap_arith_begin(&a, &b);
    for (int k = 0; k < r.count; k++)
        fap_arith_take(&a, r.i[k]);
    fap_arith_end(&a);
    assert_int_equal(b.bad, BITS_MARKER);
}

/* --- against a coder that doubles the interval one step at a time, as the standard has it --- */

typedef struct plain_coder {
    uint32_t low, high, code;
    const fap_bits *in;
    uint64_t at, read, behind[4096], false_stuffing;
    fap_bit_writer *out;
    int zeros, pending;
} plain_coder;

static uint32_t plain_read(plain_coder *c)
{
    c->read++;
    if (c->zeros == 22) {
        c->zeros = 0;
        if (!fap_bits_peek(c->in, c->at++, 1) && !c->false_stuffing)
            c->false_stuffing = c->read;
    }
    const uint32_t bit = fap_bits_peek(c->in, c->at++, 1);
    c->zeros = bit ? 0 : c->zeros + 1;
    c->behind[c->read] = c->at;
    return bit;
}

static void plain_write(plain_coder *c, uint32_t bit)
{
    if (c->zeros == 22)
        fap_bits_put(c->out, 1, 1);
    c->zeros = bit ? 0 : c->zeros % 22 + 1;
    fap_bits_put(c->out, 1, bit);
}

static void plain_decide(plain_coder *c, uint32_t bit)
{
    plain_write(c, bit);
    for (; c->pending; c->pending--)
        plain_write(c, !bit);
}

static void plain_step(plain_coder *c, arith_interval i)
{
    const uint32_t span = c->high - c->low + 1;

    c->high = c->low + span * i.high / i.total - 1;
    c->low += span * i.low / i.total;
    for (;;) {
        const int upper = c->low >= 32768, across = c->low >= 16384 && c->high < 49152;
        if (!upper && c->high >= 32768 && !across)
            return;
        const uint32_t offset = upper ? 32768 : c->high < 32768 ? 0 : 16384;
        c->low = 2 * (c->low - offset);
        c->high = 2 * (c->high - offset) + 1;
        if (c->in)
            c->code = 2 * (c->code - offset) + plain_read(c);
        else if (offset == 16384)
            c->pending++;
        else
            plain_decide(c, (uint32_t)upper);
    }
}

TEST(arith, writes_the_bits_of_the_plain_coder)
{
    static uint8_t data[2][1024];
    uint32_t seed = 11;

    for (int i = 0; i < 3000; i++) {
        const run r = random_run(&seed);
        fap_bit_writer w[2];

        for (int k = 0; k < 2; k++)
            fap_bit_writer_init(&w[k], data[k], sizeof data[k]);
        put_run(&w[0], &r);
        plain_coder c = { .high = 65535, .out = &w[1] };
        for (int k = 0; k < r.count; k++)
            plain_step(&c, r.i[k]);
        c.pending++;
        plain_decide(&c, c.low >= 16384);
        assert_int_equal(w[0].at, w[1].at);
        assert_memory_equal(data[0], data[1], (size_t)(w[0].at + 7) / 8);
    }
}

/* Any interval of @p total that holds @p target. */
static arith_interval around(uint32_t target, uint32_t total, uint32_t *seed)
{
    const uint32_t low = draw(seed) % 2 ? target : target - draw(seed) % (target + 1);
    return (arith_interval){ low, target + 1 + draw(seed) % (total - target), total };
}

/* Bits that no encoder wrote, many of them 0, from any place to beyond the end. */
TEST(arith, reads_any_bits_as_the_plain_coder_does)
{
    uint8_t data[64];
    uint32_t seed = 13;
    int faults = 0;

    for (int i = 0; i < 20000; i++) {
        const size_t size = 1 + draw(&seed) % sizeof data;
        const uint32_t zeros = 1 + draw(&seed) % 16;
        for (size_t k = 0; k < size; k++)
            data[k] = (uint8_t)(draw(&seed) % zeros ? 0 : draw(&seed));
        fap_bits b;
        arith_decoder a;
        fap_bits_init(&b, data, size);
        b.at = draw(&seed) % 9;
        plain_coder c = { .high = 65535, .in = &b, .at = b.at };
        for (int k = 0; k < 16; k++)
            c.code = c.code << 1 | plain_read(&c);
        fap_arith_begin(&a, &b);
        for (int count = (int)(draw(&seed) % MAX_RUN); count > 0; count--) {
            const uint32_t total = 1 + draw(&seed) % 16383;
            const uint32_t target = ((c.code - c.low + 1) * total - 1) / (c.high - c.low + 1);
            assert_int_equal(fap_arith_target(&a, total), target);
            const arith_interval where = around(target, total, &seed);
            fap_arith_take(&a, where);
            plain_step(&c, where);
        }
        fap_arith_end(&a);
        const uint64_t last = c.read - 14, end = c.behind[last];
        const int is_false = c.false_stuffing && c.false_stuffing <= last;
        assert_int_equal(b.at, end < b.end ? end : b.end);
        assert_int_equal(b.bad, end > b.end ? BITS_PAST_END : is_false ? BITS_MARKER : BITS_FINE);
        faults += b.bad == BITS_MARKER;
    }
    assert_true(faults > 100);
}

TEST(bits, any_width_at_any_place_reads_like_single_bits)
{
    uint8_t data[19];
    uint32_t seed = 17;
    fap_bits b;

    for (size_t k = 0; k < sizeof data; k++)
        data[k] = (uint8_t)draw(&seed);
    for (size_t size = 1; size <= sizeof data; size++) {
        fap_bits_init(&b, data, size);
        for (uint64_t at = 0; at < b.end + 9; at++)
            for (int n = 0; n <= 32; n++) {
                uint32_t want = 0;
                for (uint64_t k = at; k < at + (uint64_t)n; k++)
                    want = want << 1 | (k < b.end ? data[k / 8] >> (7 - k % 8) & 1u : 0);
                assert_int_equal(fap_bits_peek(&b, at, n), want);
            }
    }
}

/* Into rooms of all sizes, with what is written across the end. */
TEST(bits, any_width_is_put_like_single_bits)
{
    uint32_t seed = 23;

    for (int i = 0; i < 2000; i++) {
        uint8_t data[2][24];
        fap_bit_writer w[2];
        const size_t room = draw(&seed) % sizeof data[0];
        for (int k = 0; k < 2; k++) {
            memset(data[k], k ? 0x55 : 0xAA, sizeof data[k]);
            fap_bit_writer_init(&w[k], data[k], room);
        }
        for (int puts = 0; puts < 12; puts++) {
            const int n = (int)(draw(&seed) % 33);
            const uint32_t value = draw(&seed) << 16 ^ draw(&seed);
            fap_bits_put(&w[0], n, value);
            for (int bit = n - 1; bit >= 0; bit--)
                fap_bits_put(&w[1], 1, value >> bit & 1);
        }
        assert_int_equal(w[0].at, w[1].at);
        assert_int_equal(w[0].full, w[1].full);
        assert_memory_equal(data[0], data[1], (size_t)(w[0].at + 7) / 8);
        assert_true(room == sizeof data[0] || data[0][room] == 0xAA);
    }
}

TEST(bits, what_stands_behind_the_writer_does_not_matter)
{
    uint8_t data[3] = { 0xFF, 0xFF, 0xFF };
    fap_bit_writer w;

    fap_bit_writer_init(&w, data, sizeof data);
    fap_bits_put(&w, 0, 1);
    fap_bits_put(&w, 3, 2 + 8); /* more than its 3 bits */
    fap_bits_put(&w, 10, 0);
    assert_int_equal(data[0], 0x40);
    assert_int_equal(data[1], 0);
    w.at = 2; /* taken back */
    fap_bits_put(&w, 2, 1);
    assert_int_equal(data[0], 0x50);
}

TEST(models, flat_ones_are_models_that_counted_nothing)
{
    const model none = { 0 };

    for (int symbol = 0; symbol < 20; symbol++) {
        const arith_interval want = fap_model_interval(NULL, &none, 20, symbol),
                             got = fap_flat_interval(20, symbol);
        assert_memory_equal(&got, &want, sizeof got);
        assert_int_equal(fap_flat_symbol(20, want.low), symbol);
    }
}
