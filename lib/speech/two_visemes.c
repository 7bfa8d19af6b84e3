/* SPDX-License-Identifier: BSD-2-Clause */
/* See two_visemes.h. */
#include <math.h>

#include "speech/two_visemes.h"

void strongest_three(const double *strength, int count, int best[3])
{
    best[0] = best[1] = best[2] = -1;
    for (int v = 0; v < count; v++) {
        int at = 3;
        while (at > 0 && (best[at - 1] < 0 || strength[v] > strength[best[at - 1]]))
            at--;
        for (int i = 2; i > at; i--)
            best[i] = best[i - 1];
        if (at < 3)
            best[at] = v;
    }
}

double lead_over(double strength, double third)
{
    return strength > 0 ? 1 - pow(third / strength, 4) : 0;
}

void two_visemes(const double strength[FAP_VISEME_COUNT + 1], fap_viseme *out)
{
    int best[3];

    strongest_three(strength, FAP_VISEME_COUNT + 1, best);
    const double third = strength[best[2]];
    const double first = strength[best[0]] * lead_over(strength[best[0]], third),
                 second = strength[best[1]] * lead_over(strength[best[1]], third);
    const int blend = first + second > 0 ? (int)lround(63 * first / (first + second)) : 32;
    *out = (fap_viseme){ .select1 = (uint8_t)best[0],
                         .select2 = (uint8_t)(blend < 63 ? best[1] : best[0]),
                         .blend = (uint8_t)blend };
}
