/* SPDX-License-Identifier: BSD-2-Clause */
/* Every kernel against the C one: the same bits. */
#include "tests/test.h"

#include <string.h>

#include "dsp/dsp.h"

enum { N = 64, BLOCKS = 5 };

typedef struct bed {
    _Alignas(32) float xyz[3 * N];
    float field[BLOCKS * 8];
    int16_t delta[BLOCKS * 24];
    uint16_t block[BLOCKS];
} bed;

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static float noise(uint32_t *seed)
{
    return (float)((int)(next(seed) % 20001) - 10000) / 77;
}

static void fill(bed *b, uint32_t seed)
{
    for (int i = 0; i < 3 * N; i++)
        b->xyz[i] = noise(&seed);
    for (int i = 0; i < BLOCKS * 8; i++)
        b->field[i] = noise(&seed);
    for (int i = 0; i < BLOCKS * 24; i++)
        b->delta[i] = (int16_t)(next(&seed) & 0xffff);
    for (int i = 0; i < BLOCKS; i++)
        b->block[i] = (uint16_t)(i + (i > 2));
}

static void kernels(fap_dsp *plain, fap_dsp *best)
{
    fap_dsp_init(plain, 0);
    fap_dsp_init(best, fap_cpu_detect());
}

TEST(dsp, key_kernels_agree_to_the_bit)
{
    fap_dsp plain, best;
    bed a, b;

    kernels(&plain, &best);
    fill(&a, 1), fill(&b, 1);
    plain.add_key(a.xyz, N, a.block, a.delta, BLOCKS, 0.37f);
    best.add_key(b.xyz, N, b.block, b.delta, BLOCKS, 0.37f);
    assert_memory_equal(a.xyz, b.xyz, sizeof a.xyz);
}

TEST(dsp, regional_key_kernels_agree_to_the_bit)
{
    fap_dsp plain, best;
    bed a, b;
    float map[4 * N];
    const float w[4] = { 0.3f, -0.01f, 0, 1.7f };
    uint32_t seed = 9;

    kernels(&plain, &best);
    fill(&a, 1), fill(&b, 1);
    for (int i = 0; i < 4 * N; i++)
        map[i] = (float)(next(&seed) % 1001) / 1000;
    plain.add_key_regions(a.xyz, N, a.block, a.delta, BLOCKS, map, w);
    best.add_key_regions(b.xyz, N, b.block, b.delta, BLOCKS, map, w);
    assert_memory_equal(a.xyz, b.xyz, sizeof a.xyz);
}

TEST(dsp, shares_of_one_make_a_regional_key_a_plain_one)
{
    fap_dsp plain;
    bed a, b;
    float map[4 * N];
    const float w[4] = { 0.37f, 0.37f, 0.37f, 0.37f };

    fap_dsp_init(&plain, 0);
    fill(&a, 1), fill(&b, 1);
    for (int i = 0; i < 4 * N; i++)
        map[i] = 0.25f;
    plain.add_key(a.xyz, N, a.block, a.delta, BLOCKS, 0.37f);
    plain.add_key_regions(b.xyz, N, b.block, b.delta, BLOCKS, map, w);
    for (int i = 0; i < 3 * N; i++)
        assert_float_equal(a.xyz[i], b.xyz[i], 1e-2);
}

TEST(dsp, a_key_moves_its_blocks_and_nothing_else)
{
    fap_dsp best;
    bed a = { 0 };

    fap_dsp_init(&best, fap_cpu_detect());
    a.block[0] = 3;
    a.delta[8 + 2] = 100; /* y of lane 2 */
    best.add_key(a.xyz, N, a.block, a.delta, 1, 0.5f);
    for (int i = 0; i < 3 * N; i++)
        assert_true(a.xyz[i] == (i == N + 3 * 8 + 2 ? 50 : 0));
}

TEST(dsp, field_kernels_agree_to_the_bit)
{
    fap_dsp plain, best;
    bed a, b;
    const float c[3] = { 0.1f, -2, 3.3f };

    kernels(&plain, &best);
    fill(&a, 2), fill(&b, 2);
    plain.add_field(a.xyz, N, a.block, a.field, BLOCKS, c);
    best.add_field(b.xyz, N, b.block, b.field, BLOCKS, c);
    assert_memory_equal(a.xyz, b.xyz, sizeof a.xyz);
}

TEST(dsp, rotations_agree_to_the_bit)
{
    fap_dsp plain, best;
    bed a, b;
    const float m[3][3] = { { 0.8f, -0.6f, 0 }, { 0.6f, 0.8f, 0.1f }, { 0, 0.2f, 1 } },
                pivot[3] = { 1, 2, 3 };

    kernels(&plain, &best);
    fill(&a, 3), fill(&b, 3);
    plain.rotate(a.xyz, N, m, pivot, N);
    best.rotate(b.xyz, N, m, pivot, N);
    assert_memory_equal(a.xyz, b.xyz, sizeof a.xyz);
}

static void normals_of(const fap_dsp *dsp, const bed *b, int width, float *out)
{
    enum { QUADS = 31 };
    uint32_t quad[QUADS][4], index[8 * 6], seed = 9;
    float place[N][4], normals[QUADS + 1][4] = { 0 };

    for (int i = 0; i < QUADS * 4; i++)
        quad[i / 4][i % 4] = next(&seed) % N;
    for (int i = 0; i < 8 * width; i++) /* vertex 1 has no quad */
        index[i] = i / width == 1 ? QUADS : next(&seed) % QUADS;
    dsp->interleave(place, b->xyz, N, N);
    dsp->quad_normals(normals, (const float(*)[4])place, (const uint32_t(*)[4])quad, QUADS);
    dsp->sum_normals(out, N, (const float(*)[4])normals, index, width, 8);
    dsp->normalise(out, N, 8);
}

TEST(dsp, normals_agree_to_the_bit_and_are_unit_length)
{
    fap_dsp plain, best;
    bed a, out[2];

    kernels(&plain, &best);
    fill(&a, 4);
    memset(out, 0, sizeof out);
    for (int width = 4; width <= 6; width += 2) {
        normals_of(&plain, &a, width, out[0].xyz);
        normals_of(&best, &a, width, out[1].xyz);
        assert_memory_equal(out[0].xyz, out[1].xyz, sizeof a.xyz);
        for (int v = 0; v < 8; v++) {
            const float *n = out[1].xyz + v;
            assert_float_equal(n[0] * n[0] + n[N] * n[N] + n[2 * N] * n[2 * N], 1, 1e-5);
        }
        assert_true(out[1].xyz[2 * N + 1] == 1);
    }
}
