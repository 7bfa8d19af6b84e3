/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Sums in eight lanes: a loop over blocks of eight is vector instructions with any compiler, and the same sum with all of
 * them, since the order of additions is written down.
 */
#ifndef LIB_BASE_LANES_H
#define LIB_BASE_LANES_H

enum { FAP_LANES = 8 };

/* The next multiple of FAP_LANES. */
static inline int fap_lanes_padded(int n)
{
    return (n + FAP_LANES - 1) / FAP_LANES * FAP_LANES;
}

static inline float fap_lanes_sum(const float s[FAP_LANES])
{
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

/* @p n may be anything. */
static inline float fap_lanes_dot(const float *a, const float *b, int n)
{
    float sum[FAP_LANES] = { 0 };
    int i = 0;

    for (; i + FAP_LANES <= n; i += FAP_LANES)
        for (int k = 0; k < FAP_LANES; k++)
            sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        sum[i % FAP_LANES] += a[i] * b[i];
    return fap_lanes_sum(sum);
}

/* to += by * from */
static inline void fap_lanes_add(float *restrict to, const float *restrict from, float by, int n)
{
    int i = 0;

    for (; i + FAP_LANES <= n; i += FAP_LANES)
        for (int k = 0; k < FAP_LANES; k++)
            to[i + k] += by * from[i + k];
    for (; i < n; i++)
        to[i] += by * from[i];
}

#endif
