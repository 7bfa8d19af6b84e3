/* SPDX-License-Identifier: BSD-2-Clause */
/* The rare numbers of a .fap file: see ascii_number.h. */
#include <stddef.h>

#include "codec/ascii_number.h"

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static double power_of_ten(int n)
{
    double p = 1;
    for (int i = 0; i < (n < 0 ? -n : n); i++)
        p *= 10;
    return n < 0 ? 1 / p : p;
}

/* Digits into *value; how many were read. */
static int digits(const char **p, const char *end, double *value)
{
    int count = 0;
    for (; *p < end && is_digit(**p); ++*p, count++)
        *value = *value * 10 + (**p - '0');
    return count;
}

/* 0: letters that are no exponent. Past three digits it is as good as infinite, and bounded. */
static int exponent(const char **p, const char *end, int *value)
{
    double v = 0;

    if (*p == end)
        return 1;
    if (**p != 'e' && **p != 'E')
        return 0;
    ++*p;
    const int negative = *p < end && **p == '-';
    *p += *p < end && (**p == '-' || **p == '+');
    if (!digits(p, end, &v))
        return 0;
    *value = v > 999 ? 999 : (int)v;
    *value = negative ? -*value : *value;
    return 1;
}

int fap_ascii_decimal(const char *p, const char *end, double *value)
{
    const int negative = p < end && *p == '-';
    double v = 0;
    int power = 0;

    p += p < end && (*p == '-' || *p == '+');
    int count = digits(&p, end, &v);
    if (p < end && *p == '.') {
        p++;
        const int decimals = digits(&p, end, &v);
        count += decimals;
        power = decimals < 400 ? decimals : 400;
    }
    int scale = 0;
    if (!count || !exponent(&p, end, &scale) || p != end)
        return 0;
    v = scale - power >= 0 ? v * power_of_ten(scale - power) : v / power_of_ten(power - scale);
    *value = negative ? -v : v;
    return 1;
}

static int is_word(const char *p, const char *end, const char *word)
{
    for (; *word && p < end; p++, word++)
        if ((*p | 0x20) != *word)
            return 0;
    return !*word;
}

/* inf, infinity, nan, nan(...), -1.#INF and -1.#IND: what C libraries print. */
static int is_not_finite(const char *p, const char *end)
{
    p += p < end && (*p == '-' || *p == '+');
    if (is_word(p, end, "1.#"))
        return 1;
    return is_word(p, end, "inf") || is_word(p, end, "nan");
}

ascii_kind fap_ascii_odd_number(const char *p, const char *end, int64_t *value)
{
    double v;

    *value = 0;
    if (is_not_finite(p, end))
        return ASCII_ABSENT;
    if (!fap_ascii_decimal(p, end, &v))
        return ASCII_BAD;
    if (!(v >= (double)-ASCII_NUMBER_MAX && v <= (double)ASCII_NUMBER_MAX))
        return ASCII_BAD;
    *value = (int64_t)(v < 0 ? v - 0.5 : v + 0.5);
    for (; p < end; p++)
        if (*p == '.' || *p == 'e' || *p == 'E')
            return ASCII_ROUNDED;
    return ASCII_INTEGER;
}
