/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * AArch64 kernels, four vertices at a time. Every AArch64 CPU has them, and their arithmetic is IEEE 754's, which that
 * of 32-bit Arm is not. Products and sums stay separate instructions, so that the bits are those of the C version.
 */
#include "dsp/dsp.h"

#if defined(__aarch64__) && defined(__GNUC__)
#include <arm_neon.h>

static inline void add_scaled(float *dst, float32x4_t value, float32x4_t w)
{
    vst1q_f32(dst, vaddq_f32(vld1q_f32(dst), vmulq_f32(w, value)));
}

static inline void add_scaled_8(float *dst, const int16_t *delta, float32x4_t w)
{
    const int16x8_t d = vld1q_s16(delta);

    add_scaled(dst, vcvtq_f32_s32(vmovl_s16(vget_low_s16(d))), w);
    add_scaled(dst + 4, vcvtq_f32_s32(vmovl_high_s16(d)), w);
}

static void add_key_neon(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                         size_t block_count, float w)
{
    const float32x4_t scale = vdupq_n_f32(w);

    for (size_t b = 0; b < block_count; b++, delta += 24) {
        float *dst = xyz + 8u * block[b];
        add_scaled_8(dst, delta, scale);
        add_scaled_8(dst + stride, delta + 8, scale);
        add_scaled_8(dst + 2 * stride, delta + 16, scale);
    }
}

static void add_field_neon(float *xyz, size_t stride, const uint16_t *block, const float *field,
                           size_t block_count, const float c[3])
{
    for (size_t b = 0; b < block_count; b++, field += 8) {
        const float32x4_t low = vld1q_f32(field), high = vld1q_f32(field + 4);
        float *dst = xyz + 8u * block[b];
        for (int axis = 0; axis < 3; axis++, dst += stride) {
            add_scaled(dst, low, vdupq_n_f32(c[axis]));
            add_scaled(dst + 4, high, vdupq_n_f32(c[axis]));
        }
    }
}

static inline float32x4_t dot_row(const float row[3], float32x4_t x, float32x4_t y, float32x4_t z)
{
    const float32x4_t xy = vaddq_f32(vmulq_n_f32(x, row[0]), vmulq_n_f32(y, row[1]));
    return vaddq_f32(xy, vmulq_n_f32(z, row[2]));
}

static void rotate_neon(float *xyz, size_t stride, const float m[3][3], const float pivot[3], size_t n)
{
    const float32x4_t px = vdupq_n_f32(pivot[0]), py = vdupq_n_f32(pivot[1]), pz = vdupq_n_f32(pivot[2]);

    for (float *p = xyz; p < xyz + n; p += 4) {
        const float32x4_t x = vsubq_f32(vld1q_f32(p), px);
        const float32x4_t y = vsubq_f32(vld1q_f32(p + stride), py);
        const float32x4_t z = vsubq_f32(vld1q_f32(p + 2 * stride), pz);
        vst1q_f32(p, vaddq_f32(px, dot_row(m[0], x, y, z)));
        vst1q_f32(p + stride, vaddq_f32(py, dot_row(m[1], x, y, z)));
        vst1q_f32(p + 2 * stride, vaddq_f32(pz, dot_row(m[2], x, y, z)));
    }
}

static inline float32x4_t turn_left(float32x4_t v)
{
    const float32x4_t yzwx = vextq_f32(v, v, 1);
    return vcopyq_laneq_f32(yzwx, 2, v, 0); /* y z x x: the last is nobody's */
}

static void quad_normals_neon(float (*out)[4], const float (*place)[4], const uint32_t (*quad)[4],
                              size_t count)
{
    for (size_t q = 0; q < count; q++) {
        const float32x4_t u = vsubq_f32(vld1q_f32(place[quad[q][2]]), vld1q_f32(place[quad[q][0]]));
        const float32x4_t v = vsubq_f32(vld1q_f32(place[quad[q][3]]), vld1q_f32(place[quad[q][1]]));
        const float32x4_t zxy = vsubq_f32(vmulq_f32(u, turn_left(v)), vmulq_f32(turn_left(u), v));
        vst1q_f32(out[q], vsetq_lane_f32(0, turn_left(zxy), 3));
    }
}

/* The next vertex's sum, and past it. */
static inline float32x4_t sum_round(const float (*normals)[4], const uint32_t **index, int width)
{
    float32x4_t sum = vld1q_f32(normals[(*index)[0]]);

    for (int i = 1; i < width; i++)
        sum = vaddq_f32(sum, vld1q_f32(normals[(*index)[i]]));
    *index += width;
    return sum;
}

static void sum_normals_neon(float *out, size_t stride, const float (*normals)[4], const uint32_t *index,
                             int width, size_t n)
{
    for (size_t v = 0; v < n; v++) {
        const float32x4_t sum = sum_round(normals, &index, width);
        vst1q_lane_f32(out + v, sum, 0);
        vst1q_lane_f32(out + stride + v, sum, 1);
        vst1q_lane_f32(out + 2 * stride + v, sum, 2);
    }
}

static void interleave_neon(float (*out)[4], const float *xyz, size_t stride, size_t n)
{
    for (size_t v = 0; v < n; v += 4) {
        const float32x4x4_t rows = { { vld1q_f32(xyz + v), vld1q_f32(xyz + stride + v),
                                       vld1q_f32(xyz + 2 * stride + v), vdupq_n_f32(0) } };
        vst4q_f32(out[v], rows);
    }
}

static inline float32x4_t own_weight(const float *m, const float w[4])
{
    const float32x4_t a = vmulq_n_f32(vld1q_f32(m), w[0]), b = vmulq_n_f32(vld1q_f32(m + 8), w[1]);
    const float32x4_t c = vmulq_n_f32(vld1q_f32(m + 16), w[2]), d = vmulq_n_f32(vld1q_f32(m + 24), w[3]);
    return vaddq_f32(vaddq_f32(vaddq_f32(a, b), c), d);
}

static void add_key_regions_neon(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                                 size_t block_count, const float *map, const float w[4])
{
    for (size_t b = 0; b < block_count; b++, delta += 24) {
        const float32x4_t low = own_weight(map + 32u * block[b], w),
                          high = own_weight(map + 32u * block[b] + 4, w);
        float *dst = xyz + 8u * block[b];
        for (int axis = 0; axis < 3; axis++, dst += stride) {
            const int16x8_t d = vld1q_s16(delta + 8 * axis);
            add_scaled(dst, vcvtq_f32_s32(vmovl_s16(vget_low_s16(d))), low);
            add_scaled(dst + 4, vcvtq_f32_s32(vmovl_high_s16(d)), high);
        }
    }
}

static void normalise_neon(float *xyz, size_t stride, size_t n)
{
    const float32x4_t zero = vdupq_n_f32(0), one = vdupq_n_f32(1), shortest = vdupq_n_f32(1e-20f);

    for (float *p = xyz; p < xyz + n; p += 4) {
        const float32x4_t x = vld1q_f32(p), y = vld1q_f32(p + stride), z = vld1q_f32(p + 2 * stride);
        const float32x4_t xy = vaddq_f32(vmulq_f32(x, x), vmulq_f32(y, y));
        const float32x4_t square = vaddq_f32(xy, vmulq_f32(z, z));
        const uint32x4_t good = vcgtq_f32(square, shortest);
        const float32x4_t scale = vdivq_f32(one, vsqrtq_f32(vbslq_f32(good, square, one)));
        vst1q_f32(p, vbslq_f32(good, vmulq_f32(x, scale), zero));
        vst1q_f32(p + stride, vbslq_f32(good, vmulq_f32(y, scale), zero));
        vst1q_f32(p + 2 * stride, vbslq_f32(good, vmulq_f32(z, scale), one));
    }
}

void fap_dsp_init_arm(fap_dsp *dsp, unsigned cpu)
{
    if (!(cpu & FAP_CPU_NEON))
        return;
    dsp->add_key = add_key_neon;
    dsp->add_key_regions = add_key_regions_neon;
    dsp->add_field = add_field_neon;
    dsp->rotate = rotate_neon;
    dsp->interleave = interleave_neon;
    dsp->quad_normals = quad_normals_neon;
    dsp->sum_normals = sum_normals_neon;
    dsp->normalise = normalise_neon;
}
#endif
