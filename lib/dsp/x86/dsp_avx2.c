/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * AVX2 kernels, eight vertices at a time. Products and sums stay separate instructions (no FMA), so that the
 * bits are those of the C version.
 */
#include "dsp/dsp.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))

AVX2 static inline void add_scaled(float *dst, __m256 value, __m256 w)
{
    _mm256_store_ps(dst, _mm256_add_ps(_mm256_load_ps(dst), _mm256_mul_ps(w, value)));
}

AVX2 static inline __m256 load_delta(const int16_t *delta)
{
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)delta)));
}

AVX2 static void add_key_avx2(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                              size_t block_count, float w)
{
    const __m256 scale = _mm256_set1_ps(w);

    for (size_t b = 0; b < block_count; b++, delta += 24) {
        float *dst = xyz + 8u * block[b];
        add_scaled(dst, load_delta(delta), scale);
        add_scaled(dst + stride, load_delta(delta + 8), scale);
        add_scaled(dst + 2 * stride, load_delta(delta + 16), scale);
    }
}

AVX2 static inline __m256 own_weight(const float *m, const float w[4])
{
    const __m256 a = _mm256_mul_ps(_mm256_set1_ps(w[0]), _mm256_loadu_ps(m));
    const __m256 b = _mm256_mul_ps(_mm256_set1_ps(w[1]), _mm256_loadu_ps(m + 8));
    const __m256 c = _mm256_mul_ps(_mm256_set1_ps(w[2]), _mm256_loadu_ps(m + 16));
    const __m256 d = _mm256_mul_ps(_mm256_set1_ps(w[3]), _mm256_loadu_ps(m + 24));
    return _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(a, b), c), d);
}

AVX2 static void add_key_regions_avx2(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                                      size_t block_count, const float *map, const float w[4])
{
    for (size_t b = 0; b < block_count; b++, delta += 24) {
        float *dst = xyz + 8u * block[b];
        const __m256 own = own_weight(map + 32u * block[b], w);
        add_scaled(dst, load_delta(delta), own);
        add_scaled(dst + stride, load_delta(delta + 8), own);
        add_scaled(dst + 2 * stride, load_delta(delta + 16), own);
    }
}

AVX2 static void add_field_avx2(float *xyz, size_t stride, const uint16_t *block, const float *field,
                                size_t block_count, const float c[3])
{
    const __m256 cx = _mm256_set1_ps(c[0]), cy = _mm256_set1_ps(c[1]), cz = _mm256_set1_ps(c[2]);

    for (size_t b = 0; b < block_count; b++, field += 8) {
        float *dst = xyz + 8u * block[b];
        const __m256 value = _mm256_loadu_ps(field);
        add_scaled(dst, value, cx);
        add_scaled(dst + stride, value, cy);
        add_scaled(dst + 2 * stride, value, cz);
    }
}

AVX2 static inline __m256 dot_row(const float row[3], __m256 x, __m256 y, __m256 z)
{
    const __m256 xy =
        _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(row[0]), x), _mm256_mul_ps(_mm256_set1_ps(row[1]), y));
    return _mm256_add_ps(xy, _mm256_mul_ps(_mm256_set1_ps(row[2]), z));
}

AVX2 static void rotate_avx2(float *xyz, size_t stride, const float m[3][3], const float pivot[3], size_t n)
{
    const __m256 px = _mm256_set1_ps(pivot[0]), py = _mm256_set1_ps(pivot[1]), pz = _mm256_set1_ps(pivot[2]);

    for (float *p = xyz; p < xyz + n; p += 8) {
        const __m256 x = _mm256_sub_ps(_mm256_load_ps(p), px);
        const __m256 y = _mm256_sub_ps(_mm256_load_ps(p + stride), py);
        const __m256 z = _mm256_sub_ps(_mm256_load_ps(p + 2 * stride), pz);
        _mm256_store_ps(p, _mm256_add_ps(px, dot_row(m[0], x, y, z)));
        _mm256_store_ps(p + stride, _mm256_add_ps(py, dot_row(m[1], x, y, z)));
        _mm256_store_ps(p + 2 * stride, _mm256_add_ps(pz, dot_row(m[2], x, y, z)));
    }
}

/* One quarter of eight vertices: rows x y z 0 of lanes 0 and 4, 1 and 5 ... */
AVX2 static inline void store_rows(float (*out)[4], __m256 rows)
{
    _mm_storeu_ps(out[0], _mm256_castps256_ps128(rows));
    _mm_storeu_ps(out[4], _mm256_extractf128_ps(rows, 1));
}

AVX2 static void interleave_avx2(float (*out)[4], const float *xyz, size_t stride, size_t n)
{
    const __m256 zero = _mm256_setzero_ps();

    for (const float *p = xyz; p < xyz + n; p += 8, out += 8) {
        const __m256 x = _mm256_load_ps(p), y = _mm256_load_ps(p + stride),
                     z = _mm256_load_ps(p + 2 * stride);
        const __m256 xz_low = _mm256_unpacklo_ps(x, z), xz_high = _mm256_unpackhi_ps(x, z);
        const __m256 y_low = _mm256_unpacklo_ps(y, zero), y_high = _mm256_unpackhi_ps(y, zero);
        store_rows(out, _mm256_unpacklo_ps(xz_low, y_low));
        store_rows(out + 1, _mm256_unpackhi_ps(xz_low, y_low));
        store_rows(out + 2, _mm256_unpacklo_ps(xz_high, y_high));
        store_rows(out + 3, _mm256_unpackhi_ps(xz_high, y_high));
    }
}

AVX2 static inline __m256 turn_left(__m256 v)
{
    return _mm256_permute_ps(v, _MM_SHUFFLE(3, 0, 2, 1)); /* y z x, in each half */
}

AVX2 static inline __m256 cross(__m256 u, __m256 v)
{
    return turn_left(_mm256_sub_ps(_mm256_mul_ps(u, turn_left(v)), _mm256_mul_ps(turn_left(u), v)));
}

AVX2 static inline __m256 load_two(const float low[4], const float high[4])
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
}

/* Gathering eight quads at once was slower than two in one register. */
AVX2 static inline __m256 two_quads(const float (*place)[4], const uint32_t *q, const uint32_t *r)
{
    const __m256 u = _mm256_sub_ps(load_two(place[q[2]], place[r[2]]), load_two(place[q[0]], place[r[0]]));
    const __m256 v = _mm256_sub_ps(load_two(place[q[3]], place[r[3]]), load_two(place[q[1]], place[r[1]]));
    return cross(u, v);
}

AVX2 static void quad_normals_avx2(float (*out)[4], const float (*place)[4], const uint32_t (*quad)[4],
                                   size_t count)
{
    size_t q = 0;

    for (; q + 2 <= count; q += 2)
        _mm256_storeu_ps(out[q], two_quads(place, quad[q], quad[q + 1]));
    if (q < count)
        _mm_storeu_ps(out[q], _mm256_castps256_ps128(two_quads(place, quad[q], quad[q])));
}

AVX2 static inline __m128 sum_round(const float (*normals)[4], const uint32_t *index, int width)
{
    __m128 sum = _mm_loadu_ps(normals[index[0]]);

    for (int i = 1; i < width; i++)
        sum = _mm_add_ps(sum, _mm_loadu_ps(normals[index[i]]));
    return sum;
}

AVX2 static void sum_normals_avx2(float *out, size_t stride, const float (*normals)[4], const uint32_t *index,
                                  int width, size_t n)
{
    for (float *p = out; p < out + n; p += 4, index += 4 * width) {
        __m128 x = sum_round(normals, index, width), y = sum_round(normals, index + width, width);
        __m128 z = sum_round(normals, index + 2 * width, width),
               w = sum_round(normals, index + 3 * width, width);
        _MM_TRANSPOSE4_PS(x, y, z, w);
        _mm_store_ps(p, x);
        _mm_store_ps(p + stride, y);
        _mm_store_ps(p + 2 * stride, z);
    }
}

AVX2 static void normalise_avx2(float *xyz, size_t stride, size_t n)
{
    const __m256 one = _mm256_set1_ps(1), shortest = _mm256_set1_ps(1e-20f);

    for (float *p = xyz; p < xyz + n; p += 8) {
        const __m256 x = _mm256_load_ps(p), y = _mm256_load_ps(p + stride),
                     z = _mm256_load_ps(p + 2 * stride);
        const __m256 xy = _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y));
        const __m256 square = _mm256_add_ps(xy, _mm256_mul_ps(z, z));
        const __m256 good = _mm256_cmp_ps(square, shortest, _CMP_GT_OQ);
        const __m256 scale = _mm256_div_ps(one, _mm256_sqrt_ps(_mm256_blendv_ps(one, square, good)));
        _mm256_store_ps(p, _mm256_and_ps(good, _mm256_mul_ps(x, scale)));
        _mm256_store_ps(p + stride, _mm256_and_ps(good, _mm256_mul_ps(y, scale)));
        _mm256_store_ps(p + 2 * stride, _mm256_blendv_ps(one, _mm256_mul_ps(z, scale), good));
    }
}

void fap_dsp_init_x86(fap_dsp *dsp, unsigned cpu)
{
    if (!(cpu & FAP_CPU_AVX2))
        return;
    dsp->add_key = add_key_avx2;
    dsp->add_key_regions = add_key_regions_avx2;
    dsp->add_field = add_field_avx2;
    dsp->rotate = rotate_avx2;
    dsp->interleave = interleave_avx2;
    dsp->quad_normals = quad_normals_avx2;
    dsp->sum_normals = sum_normals_avx2;
    dsp->normalise = normalise_avx2;
}
#endif
