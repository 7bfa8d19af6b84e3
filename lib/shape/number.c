/* SPDX-License-Identifier: BSD-2-Clause */
/* See number.h. */
#include <math.h>
#include <stdlib.h>

#include "shape/number.h"

/* Numbers by hand: strtod minds the locale and takes "nan" and "0x". */
static const char *read_float(const char *p, float *out)
{
    double value = 0, scale = 1;
    int digits = 0;

    while (*p == ' ' || *p == '\t')
        p++;
    const int negative = *p == '-';
    p += *p == '-' || *p == '+';
    for (; *p >= '0' && *p <= '9'; p++, digits++)
        value = value * 10 + (*p - '0');
    if (*p == '.')
        for (p++; *p >= '0' && *p <= '9'; p++, digits++)
            value += (*p - '0') * (scale *= 0.1);
    if (digits && (*p == 'e' || *p == 'E')) {
        char *end;
        const long exponent = strtol(p + 1, &end, 10);
        if (end == p + 1 || exponent > 30 || exponent < -60)
            return NULL;
        value *= pow(10, (double)exponent);
        p = end;
    }
    if (!digits || !(value < 1e30))
        return NULL;
    *out = (float)(negative ? -value : value);
    return p;
}

int fap_read_floats(const char *p, float *out, int count)
{
    for (int i = 0; p && i < count; i++)
        p = read_float(p, &out[i]);
    return p != NULL;
}
