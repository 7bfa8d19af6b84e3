/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * JSON read in place, from front to back, without a tree: the caller says what it expects and skips the rest. Nothing is
 * allocated, nothing recurses, and after the first fault every call says no.
 */
#ifndef LIB_TAKE_JSON_TEXT_H
#define LIB_TAKE_JSON_TEXT_H

#include "take/text.h"

typedef struct json_text {
    const char *at, *end;
    int bad;
} json_text;

json_text json_text_open(const uint8_t *data, size_t size);
/* Steps into '{' or '['; 0: there is none. */
int json_text_enter(json_text *j, char bracket);
/* Before every item: 1 there is one, 0 the bracket was closed, and @p j is behind it. @p first: begins as 1. */
int json_text_next(json_text *j, char closing, int *first);
/* The key of an object's item, as it is written, with the colon behind. */
int json_text_key(json_text *j, text *key);
/* A string without its quotes; escapes stay as they are. */
int json_text_string(json_text *j, text *value);
/* A number. null and strings are skipped and give 0 without being a fault. */
int json_text_number(json_text *j, double *value);
/* Any value, however deep. */
void json_text_skip(json_text *j);

#endif
