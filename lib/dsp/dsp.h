/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Kernels over vertex blocks: the plain C version of each, and faster ones chosen once by CPU. Arrays are
 * x[stride] y[stride] z[stride], 32-byte aligned, stride a multiple of 8. Every version gives the same bits
 * as the C one.
 */
#ifndef LIB_DSP_DSP_H
#define LIB_DSP_DSP_H

#include <stddef.h>
#include <stdint.h>

enum { FAP_CPU_AVX2 = 1, FAP_CPU_NEON = 2 };

typedef struct fap_dsp {
    /* xyz[axis][8 * block[b] + i] += w * delta[b][axis][i] */
    void (*add_key)(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                    size_t block_count, float w);
    /* The same with a weight of its own for each vertex: sum over r < 4 of w[r] * map[block[b]][r][i] */
    void (*add_key_regions)(float *xyz, size_t stride, const uint16_t *block, const int16_t *delta,
                            size_t block_count, const float *map, const float w[4]);
    /* xyz[axis][8 * block[b] + i] += c[axis] * field[b][i] */
    void (*add_field)(float *xyz, size_t stride, const uint16_t *block, const float *field,
                      size_t block_count, const float c[3]);
    /* xyz = pivot + m * (xyz - pivot), for n vertices, n a multiple of 8 */
    void (*rotate)(float *xyz, size_t stride, const float m[3][3], const float pivot[3], size_t n);
    /* out[v] = x y z 0 of each vertex; n a multiple of 8 */
    void (*interleave)(float (*out)[4], const float *xyz, size_t stride, size_t n);
    /* out[q] = (c - a) x (d - b) of each quad, twice its area long; out[q][3] = 0 */
    void (*quad_normals)(float (*out)[4], const float (*place)[4], const uint32_t (*quad)[4], size_t count);
    /* out[v] = sum of normals[index[width * v + i]] over i < width; n a multiple of 8 */
    void (*sum_normals)(float *out, size_t stride, const float (*normals)[4], const uint32_t *index,
                        int width, size_t n);
    /* Unit length, or (0, 0, 1) for what is too short to have a direction; n a multiple of 8. */
    void (*normalise)(float *xyz, size_t stride, size_t n);
} fap_dsp;

/* What this machine can do, FAP_CPU_* flags. */
unsigned fap_cpu_detect(void);
/* cpu 0: plain C. */
void fap_dsp_init(fap_dsp *dsp, unsigned cpu);
/* Replace the kernels that this CPU has faster ones for; x86/dsp_avx2.c, arm/dsp_neon.c. */
void fap_dsp_init_x86(fap_dsp *dsp, unsigned cpu);
void fap_dsp_init_arm(fap_dsp *dsp, unsigned cpu);

#endif
