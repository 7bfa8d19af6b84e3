/* SPDX-License-Identifier: BSD-2-Clause */
/* See json.h. */
#include <inttypes.h>
#include <math.h>

#include "common/json.h"

static void put_text(FILE *out, const char *s)
{
    fputc('"', out);
    for (; *s; s++) {
        const unsigned char c = (unsigned char)*s;
        if (c == '"' || c == '\\')
            fprintf(out, "\\%c", c);
        else if (c < 0x20)
            fprintf(out, "\\u%04x", c);
        else
            fputc(c, out);
    }
    fputc('"', out);
}

static void begin(json *j, const char *key)
{
    if (j->wrote)
        fputc(',', j->out);
    if (j->depth)
        fprintf(j->out, "\n%*s", 2 * j->depth, "");
    if (key) {
        put_text(j->out, key);
        fputs(": ", j->out);
    }
    j->wrote = 1;
}

void json_open(json *j, const char *key, char bracket)
{
    begin(j, key);
    fputc(bracket, j->out);
    j->depth++;
    j->wrote = 0;
}

void json_close(json *j, char bracket)
{
    j->depth--;
    if (j->wrote)
        fprintf(j->out, "\n%*s", 2 * j->depth, "");
    fputc(bracket, j->out);
    j->wrote = 1;
    if (!j->depth)
        fputc('\n', j->out);
}

void json_string(json *j, const char *key, const char *value)
{
    begin(j, key);
    put_text(j->out, value);
}

static void put_number(json *j, const char *key, double value, int digits)
{
    begin(j, key);
    if (isfinite(value))
        fprintf(j->out, "%.*g", digits, value);
    else
        fputs("null", j->out);
}

void json_number(json *j, const char *key, double value)
{
    put_number(j, key, value, 6);
}

void json_float(json *j, const char *key, float value)
{
    put_number(j, key, (double)value, 9);
}

void json_integer(json *j, const char *key, int64_t value)
{
    begin(j, key);
    fprintf(j->out, "%" PRId64, value);
}

void json_bool(json *j, const char *key, int value)
{
    begin(j, key);
    fputs(value ? "true" : "false", j->out);
}
