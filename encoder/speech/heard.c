/* SPDX-License-Identifier: BSD-2-Clause */
/* See heard.h. A hundredth of a second is loud when it is well above the quietest tenth of the sound and not far below the
 * loudest. */
#include <math.h>
#include <stdlib.h>

#include "encoder/speech/heard.h"

static const double window_s = 0.01, above_noise = 4, below_peak = 0.03;
/* A click is not speech: loud for this many windows in a row. */
enum { IN_A_ROW = 3 };

static double level(const sound *s, int64_t from, int64_t count)
{
    double sum = 0;

    for (int64_t i = from * s->channels; i < (from + count) * s->channels; i++)
        sum += (double)s->sample[i] * s->sample[i];
    return sqrt(sum / (double)(count * s->channels));
}

static int by_level(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double threshold(const double *levels, double *sorted, int64_t count)
{
    for (int64_t i = 0; i < count; i++)
        sorted[i] = levels[i];
    qsort(sorted, (size_t)count, sizeof *sorted, by_level);
    return fmax(above_noise * sorted[count / 10], below_peak * sorted[count - 1]);
}

static int find_span(const double *levels, int64_t count, double least, int64_t *first, int64_t *last)
{
    int found = 0;

    for (int64_t i = 0, row = 0; i < count; i++) {
        row = levels[i] > least ? row + 1 : 0;
        if (row < IN_A_ROW)
            continue;
        if (!found)
            *first = i + 1 - IN_A_ROW;
        *last = i + 1;
        found = 1;
    }
    return found;
}

int heard_span(const sound *s, double *from_s, double *to_s)
{
    const int64_t window = (int64_t)fmax(1, window_s * s->rate_hz), count = s->frame_count / window;
    double *levels = calloc(2 * (size_t)count + 1, sizeof *levels);
    int64_t first = 0, last = 0;
    int found = 0;

    for (int64_t i = 0; levels && i < count; i++)
        levels[i] = level(s, i * window, window);
    if (levels && count)
        found = find_span(levels, count, threshold(levels, levels + count, count), &first, &last);
    free(levels);
    *from_s = (double)(first * window) / s->rate_hz;
    *to_s = (double)(last * window) / s->rate_hz;
    return found;
}
