/* SPDX-License-Identifier: BSD-2-Clause */
/* A JSON writer: commas and escapes are its business, nesting is the caller's. */
#ifndef COMMON_JSON_H
#define COMMON_JSON_H

#include <stdint.h>
#include <stdio.h>

typedef struct json {
    FILE *out;
    int depth;
    int wrote; /* something stands before the next item on this level */
} json;

/* Keys are NULL inside arrays and for the outermost value. */
void json_open(json *j, const char *key, char bracket); /* '{' or '[' */
void json_close(json *j, char bracket);                 /* '}' or ']' */
void json_string(json *j, const char *key, const char *value);
void json_number(json *j, const char *key, double value); /* null where not finite */
void json_float(json *j, const char *key, float value);   /* so that reading gives the same bits */
void json_integer(json *j, const char *key, int64_t value);
void json_bool(json *j, const char *key, int value);

#endif
