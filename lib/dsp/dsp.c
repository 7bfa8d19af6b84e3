/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The C version of every kernel, and the choice. These define the result: other versions must give the same
 * bits.
 */
#include <math.h>

#include "dsp/dsp.h"

static const float shortest = 1e-20f; /* squared; below it a normal has no direction */

static void add_key_c(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                      size_t block_count, float w)
{
    for (size_t b = 0; b < block_count; b++, delta += 24) {
        float *dst = xyz + 8u * block[b];
        for (int axis = 0; axis < 3; axis++, dst += stride)
            for (int i = 0; i < 8; i++)
                dst[i] += w * (float)delta[8 * axis + i];
    }
}

static void add_key_regions_c(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                              size_t block_count, const float *map, const float w[4])
{
    for (size_t b = 0; b < block_count; b++, delta += 24) {
        const float *m = map + 32u * block[b];
        float *dst = xyz + 8u * block[b], own[8];
        for (int i = 0; i < 8; i++)
            own[i] = ((w[0] * m[i] + w[1] * m[8 + i]) + w[2] * m[16 + i]) + w[3] * m[24 + i];
        for (int axis = 0; axis < 3; axis++, dst += stride)
            for (int i = 0; i < 8; i++)
                dst[i] += own[i] * (float)delta[8 * axis + i];
    }
}

static void add_field_c(float *xyz, size_t stride, const uint16_t *block, const float *field,
                        size_t block_count, const float c[3])
{
    for (size_t b = 0; b < block_count; b++, field += 8) {
        float *dst = xyz + 8u * block[b];
        for (int axis = 0; axis < 3; axis++, dst += stride)
            for (int i = 0; i < 8; i++)
                dst[i] += c[axis] * field[i];
    }
}

static void rotate_c(float *xyz, size_t stride, const float m[3][3], const float pivot[3], size_t n)
{
    float *x = xyz, *y = xyz + stride, *z = y + stride;

    for (size_t i = 0; i < n; i++) {
        const float dx = x[i] - pivot[0], dy = y[i] - pivot[1], dz = z[i] - pivot[2];
        x[i] = pivot[0] + ((m[0][0] * dx + m[0][1] * dy) + m[0][2] * dz);
        y[i] = pivot[1] + ((m[1][0] * dx + m[1][1] * dy) + m[1][2] * dz);
        z[i] = pivot[2] + ((m[2][0] * dx + m[2][1] * dy) + m[2][2] * dz);
    }
}

static void interleave_c(float (*out)[4], const float *xyz, size_t stride, size_t n)
{
    for (size_t v = 0; v < n; v++) {
        for (size_t axis = 0; axis < 3; axis++)
            out[v][axis] = xyz[axis * stride + v];
        out[v][3] = 0;
    }
}

static void quad_normals_c(float (*out)[4], const float (*place)[4], const uint32_t (*quad)[4], size_t count)
{
    for (size_t q = 0; q < count; q++) {
        const float *a = place[quad[q][0]], *b = place[quad[q][1]];
        const float *c = place[quad[q][2]], *d = place[quad[q][3]];
        const float ux = c[0] - a[0], uy = c[1] - a[1], uz = c[2] - a[2];
        const float vx = d[0] - b[0], vy = d[1] - b[1], vz = d[2] - b[2];
        out[q][0] = uy * vz - uz * vy;
        out[q][1] = uz * vx - ux * vz;
        out[q][2] = ux * vy - uy * vx;
        out[q][3] = 0;
    }
}

static void sum_normals_c(float *out, size_t stride, const float (*normals)[4], const uint32_t *index,
                          int width, size_t n)
{
    for (size_t v = 0; v < n; v++, index += width) {
        float x = normals[index[0]][0], y = normals[index[0]][1], z = normals[index[0]][2];
        for (int i = 1; i < width; i++) {
            const float *normal = normals[index[i]];
            x += normal[0];
            y += normal[1];
            z += normal[2];
        }
        out[v] = x;
        out[stride + v] = y;
        out[2 * stride + v] = z;
    }
}

static void normalise_c(float *xyz, size_t stride, size_t n)
{
    float *x = xyz, *y = xyz + stride, *z = y + stride;

    for (size_t i = 0; i < n; i++) {
        const float square = (x[i] * x[i] + y[i] * y[i]) + z[i] * z[i];
        const int good = square > shortest;
        const float scale = 1 / sqrtf(good ? square : 1);
        x[i] = good ? x[i] * scale : 0;
        y[i] = good ? y[i] * scale : 0;
        z[i] = good ? z[i] * scale : 1;
    }
}

unsigned fap_cpu_detect(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_cpu_supports("avx2") ? FAP_CPU_AVX2 : 0;
#elif defined(__aarch64__)
    return FAP_CPU_NEON;
#else
    return 0;
#endif
}

void fap_dsp_init(fap_dsp *dsp, unsigned cpu)
{
    *dsp = (fap_dsp){ add_key_c,    add_key_regions_c, add_field_c,   rotate_c,
                      interleave_c, quad_normals_c,    sum_normals_c, normalise_c };
#if defined(__x86_64__) && defined(__GNUC__)
    fap_dsp_init_x86(dsp, cpu);
#elif defined(__aarch64__) && defined(__GNUC__)
    fap_dsp_init_arm(dsp, cpu);
#else
    (void)cpu;
#endif
}
