/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_window.h. */
#include <string.h>

#include "codec/fba_window.h"

enum { SECONDS = 2 };

void fap_fba_window_init(fba_window *w, uint32_t rate_16, int offset, int64_t limit)
{
    const uint64_t numerator = (uint64_t)SECONDS * rate_16 * (offset ? 1000 : 1001), denominator = 16 * 1001;
    const uint64_t frames = (numerator + denominator - 1) / denominator;

    *w = (fba_window){ .frames = (int)frames, .limit = limit };
}

static void advance(fba_window *w, int64_t number)
{
    if (number - w->newest >= w->frames) {
        memset(w->bits, 0, sizeof w->bits);
        w->sum = 0;
    } else {
        for (int64_t i = w->newest + 1; i <= number; i++) {
            uint32_t *bits = &w->bits[i % w->frames];
            w->sum -= *bits;
            *bits = 0;
        }
    }
    w->newest = number;
}

void fap_fba_window_add(fba_window *w, int64_t number, uint32_t bits)
{
    if (number > w->newest)
        advance(w, number);
    w->bits[number % w->frames] += bits;
    w->sum += bits;
    if (w->sum > w->largest)
        w->largest = w->sum;
}

uint32_t fap_fba_window_at(const fba_window *w, int64_t number)
{
    return number >= 0 && number <= w->newest && number > w->newest - w->frames ? w->bits[number % w->frames]
                                                                                : 0;
}

int64_t fap_fba_window_used(const fba_window *w, int64_t number)
{
    int64_t used = w->sum;

    if (number - w->newest >= w->frames)
        return 0;
    for (int64_t i = w->newest + 1; i <= number; i++)
        used -= w->bits[i % w->frames];
    return used;
}
