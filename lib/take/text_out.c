/* SPDX-License-Identifier: BSD-2-Clause */
/* See text_out.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "take/text_out.h"

static void put(text_out *o, const char *text, size_t size)
{
    if (!o->failed && size)
        o->failed = o->to->write(o->to->user, text, size);
}

void text_put(text_out *o, const char *text)
{
    put(o, text, strlen(text));
}

void text_put_name(text_out *o, const char *name, char separator)
{
    for (const char *c = name; *c; c++)
        put(o, (unsigned char)*c < ' ' || *c == separator ? "_" : c, 1);
}

void text_put_number(text_out *o, double value, int decimals)
{
    const double most = 9e15;
    long long parts = 1;
    char text[48];

    for (int i = 0; i < decimals; i++)
        parts *= 10;
    const long long whole = llround(fmin(fmax(value * (double)parts, -most), most)),
                    size = whole < 0 ? -whole : whole;
    int used = snprintf(text, sizeof text, "%s%lld", whole < 0 ? "-" : "", size / parts);
    if (decimals)
        used += snprintf(text + used, sizeof text - (size_t)used, ".%0*lld", decimals, size % parts);
    put(o, text, (size_t)used);
}
