/* SPDX-License-Identifier: BSD-2-Clause */
/* See target.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shape/number.h"
#include "shape/target.h"

static fap_err take_line(const char *p, float weight, float (*delta)[3], uint32_t count)
{
    char *end;
    float d[3];

    p += strspn(p, " \t\r");
    if (!*p || *p == '\n' || *p == '#')
        return FAP_OK;
    const unsigned long vertex = strtoul(p, &end, 10);
    if (end == p || !fap_read_floats(end, d, 3))
        return FAP_E_SYNTAX;
    if (*p == '-' || vertex >= count)
        return FAP_E_DATA;
    for (int axis = 0; axis < 3; axis++)
        delta[vertex][axis] += weight * d[axis];
    return FAP_OK;
}

fap_err fap_target_add(const char *text, float weight, float (*delta)[3], uint32_t count, int *line)
{
    for (int n = 1; *text; n++) {
        const fap_err err = take_line(text, weight, delta, count);
        if (err) {
            if (line)
                *line = n;
            return err;
        }
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    return FAP_OK;
}
