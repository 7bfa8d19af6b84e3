/* SPDX-License-Identifier: BSD-2-Clause */
/* Counting zeros of a word, as every processor can. */
#ifndef LIB_BASE_BITOPS_H
#define LIB_BASE_BITOPS_H

#include <stdint.h>

/* In front of the highest 1 of @p v, which is not 0. */
static inline int fap_leading_zeros(uint32_t v)
{
#if defined(__GNUC__)
    return __builtin_clz(v);
#else
    int n = 0;
    for (; !(v >> 31); v <<= 1)
        n++;
    return n;
#endif
}

/* Behind the lowest 1 of @p v, which is not 0. */
static inline int fap_trailing_zeros(uint32_t v)
{
    return 31 - fap_leading_zeros(v & -v);
}

#endif
