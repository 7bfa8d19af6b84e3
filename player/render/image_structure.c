/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Structural similarity. Source: Wang, Bovik, Sheikh, Simoncelli 2004, eq. 13, over plain windows of 8 x 8 pixels, four
 * apart, of the luma. The least of all windows, not the mean: most of a picture of a face is background, and a lid that hangs
 * lower is a window or two.
 */
#include <math.h>

#include "player/render/image.h"

enum { WINDOW = 8, STEP = 4 };

static const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;

typedef struct moments {
    double n, a, b, aa, bb, ab; /* sums */
} moments;

static double luma(const image *im, int x, int y)
{
    const uint8_t *p = im->rgba + 4 * ((size_t)y * (size_t)im->width + (size_t)x);
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

static moments measure(const image *a, const image *b, int left, int top, int width, int height)
{
    moments m = { .n = (double)width * height };

    for (int y = top; y < top + height; y++)
        for (int x = left; x < left + width; x++) {
            const double u = luma(a, x, y), v = luma(b, x, y);
            m.a += u;
            m.b += v;
            m.aa += u * u;
            m.bb += v * v;
            m.ab += u * v;
        }
    return m;
}

static double similarity(const moments *m)
{
    const double a = m->a / m->n, b = m->b / m->n;
    const double var_a = m->aa / m->n - a * a, var_b = m->bb / m->n - b * b, both = m->ab / m->n - a * b;

    return (2 * a * b + c1) * (2 * both + c2) / ((a * a + b * b + c1) * (var_a + var_b + c2));
}

double image_structure(const image *a, const image *b)
{
    const int width = a->width < WINDOW ? a->width : WINDOW, height = a->height < WINDOW ? a->height : WINDOW;
    double least = 1;

    for (int y = 0; y + height <= a->height; y += STEP)
        for (int x = 0; x + width <= a->width; x += STEP) {
            const moments m = measure(a, b, x, y, width, height);
            least = fmin(least, similarity(&m));
        }
    return least;
}
