/* SPDX-License-Identifier: BSD-2-Clause */
/* See name_pattern.h. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "player/name_pattern.h"

/* @s stands behind the '%'. Returns what follows the 'd', NULL where there is something else. */
static const char *parse_number(const char *s, int *digits)
{
    *digits = 1;
    if (s[0] == '0' && s[1] >= '1' && s[1] <= '9') {
        *digits = s[1] - '0';
        s += 2;
    }
    return *s == 'd' ? s + 1 : NULL;
}

int name_pattern_parse(name_pattern *p, const char *text)
{
    const char *percent = strchr(text, '%');

    *p = (name_pattern){ .text = text, .before = strlen(text), .after = "" };
    if (!percent)
        return 1;
    p->before = (size_t)(percent - text);
    p->after = parse_number(percent + 1, &p->digits);
    return p->after && !strchr(p->after, '%');
}

char *name_pattern_make(const name_pattern *p, int64_t number)
{
    char digits[32] = "";

    if (p->digits)
        snprintf(digits, sizeof digits, "%0*" PRId64, p->digits, number);
    const size_t size = p->before + strlen(digits) + strlen(p->after) + 1;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s%s%s", (int)p->before, p->text, digits, p->after);
    return name;
}
