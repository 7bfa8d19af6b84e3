/* SPDX-License-Identifier: BSD-2-Clause */
/* See neutral.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "encoder/neutral.h"

/* Digits first: no sign, blank, infinity or hexadecimal. Moves on to what follows the number and its "s". */
static int read_moment(const char **text, double *value, int *in_seconds)
{
    static const double most = 1e9;
    char *end;

    if (!strchr("0123456789.", **text) || strspn(*text, "0123456789.") != strcspn(*text, "s-"))
        return 0;
    *value = strtod(*text, &end);
    if (end == *text || *value > most)
        return 0;
    *in_seconds |= *end == 's';
    *text = end + (*end == 's');
    return 1;
}

int neutral_option_parse(neutral_option *n, const char *text)
{
    *n = (neutral_option){ .given = 1, .from = -1, .to = -1 };
    if (!strcmp(text, "auto"))
        return 1;
    if (!read_moment(&text, &n->from, &n->in_seconds))
        return 0;
    if (*text == '-' && (text++, !read_moment(&text, &n->to, &n->in_seconds)))
        return 0;
    if (*text || (n->to >= 0 && n->to < n->from))
        return 0;
    return n->in_seconds || (n->from == floor(n->from) && n->to == floor(n->to));
}

static int64_t frame_of(const neutral_option *n, double value, double rate_hz)
{
    if (value < 0)
        return -1;
    return (int64_t)llround(n->in_seconds ? value * rate_hz : value);
}

void neutral_option_frames(const neutral_option *n, double rate_hz, int64_t *first, int64_t *last)
{
    *first = n->given ? frame_of(n, n->from, rate_hz) : -1;
    *last = n->given ? frame_of(n, n->to, rate_hz) : -1;
}
