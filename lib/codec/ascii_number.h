/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Numbers of a .fap line. Hand-written: strtol and strtod took most of the time of reading a file, and follow
 * the locale. Every line ends in '\n', which no number contains, so nothing here reads past it.
 */
#ifndef LIB_CODEC_ASCII_NUMBER_H
#define LIB_CODEC_ASCII_NUMBER_H

#include <stdint.h>

/* Times in milliseconds since 1970 have 13 digits; doubles hold 15 exactly. */
#define ASCII_NUMBER_MAX INT64_C(1000000000000000)

typedef enum ascii_kind {
    ASCII_BAD, /* not a number, or past ASCII_NUMBER_MAX */
    ASCII_INTEGER,
    ASCII_ROUNDED, /* decimals or an exponent: rounded, halves away from zero */
    ASCII_ABSENT,  /* inf or nan */
} ascii_kind;

static inline int ascii_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static inline const char *ascii_skip_blanks(const char *p)
{
    while (ascii_is_blank(*p))
        p++;
    return p;
}

static inline const char *ascii_skip_word(const char *p)
{
    while (!ascii_is_blank(*p) && *p != '\n')
        p++;
    return p;
}

/* A decimal number with optional sign, decimals and exponent that fills [p, end). 0: it is none. */
int fap_ascii_decimal(const char *p, const char *end, double *value);

/* Any number a producer was seen to write that fills [p, end). */
ascii_kind fap_ascii_odd_number(const char *p, const char *end, int64_t *value);

/*
 * The common number: up to nine digits, perhaps a minus sign, then a blank or the end of the line.
 * Gives the place behind it, or NULL for anything else: then fap_ascii_odd_number() looks.
 */
static inline const char *ascii_plain_number(const char *p, int32_t *value)
{
    const int negative = *p == '-';
    p += negative;

    const char *const first = p;
    uint32_t v = 0, digit;
    while ((digit = (uint32_t)(unsigned char)*p - '0') <= 9) {
        v = v * 10 + digit; /* wraps for ten digits and more, which are refused below */
        p++;
    }
    if (p == first || p - first > 9 || !(ascii_is_blank(*p) || *p == '\n'))
        return 0;
    *value = negative ? -(int32_t)v : (int32_t)v;
    return p;
}

#endif
