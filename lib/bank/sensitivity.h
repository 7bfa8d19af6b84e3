/* SPDX-License-Identifier: BSD-2-Clause */
/* What an encoder needs beside <fap/sensitivity.h>: distances of mixes in steps of 63, whole square roots. */
#ifndef LIB_BANK_SENSITIVITY_H
#define LIB_BANK_SENSITIVITY_H

#include <stdint.h>

#include <fap/frame.h>

/* Rounded down. */
uint64_t fap_isqrt(uint64_t v);
int64_t fap_viseme_distance(const fap_viseme *a, const fap_viseme *b);
int64_t fap_expression_distance(const fap_expression *a, const fap_expression *b);

#endif
