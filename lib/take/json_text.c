/* SPDX-License-Identifier: BSD-2-Clause */
/* See json_text.h. */
#include <string.h>

#include "take/json_text.h"

json_text json_text_open(const uint8_t *data, size_t size)
{
    const text_lines t = text_open(data, size); /* without its byte order mark */
    return (json_text){ t.at, t.end, 0 };
}

/* The next character that is no blank; 0 at the end and after a fault. */
static char peek(json_text *j)
{
    while (j->at < j->end && (*j->at == ' ' || *j->at == '\t' || *j->at == '\n' || *j->at == '\r'))
        j->at++;
    return !j->bad && j->at < j->end ? *j->at : 0;
}

static int fault(json_text *j)
{
    j->bad = 1;
    return 0;
}

int json_text_enter(json_text *j, char bracket)
{
    if (peek(j) != bracket)
        return 0;
    j->at++;
    return 1;
}

int json_text_next(json_text *j, char closing, int *first)
{
    const char c = peek(j);

    if (c == closing) {
        j->at++;
        return 0;
    }
    if (!*first && c != ',')
        return fault(j);
    if (!*first)
        j->at++;
    *first = 0;
    return c != 0 || fault(j);
}

int json_text_string(json_text *j, text *value)
{
    if (peek(j) != '"')
        return fault(j);
    const char *start = ++j->at;
    for (; j->at < j->end && *j->at != '"'; j->at++)
        if (*j->at == '\\' && j->at + 1 < j->end)
            j->at++;
    if (j->at == j->end)
        return fault(j);
    *value = (text){ start, (size_t)(j->at - start) };
    j->at++;
    return 1;
}

int json_text_key(json_text *j, text *key)
{
    if (!json_text_string(j, key) || peek(j) != ':')
        return fault(j);
    j->at++;
    return 1;
}

/* A run of what numbers, true, false and null are written with. */
static text bare_word(json_text *j)
{
    const char *start = j->at;

    while (j->at < j->end && !strchr(",:{}[]\" \t\r\n", *j->at))
        j->at++;
    return (text){ start, (size_t)(j->at - start) };
}

int json_text_number(json_text *j, double *value)
{
    const char c = peek(j);

    if (c != '-' && (c < '0' || c > '9')) {
        json_text_skip(j);
        return 0;
    }
    return text_number(bare_word(j), value) == TEXT_NUMBER;
}

void json_text_skip(json_text *j)
{
    size_t depth = 0;
    text word;

    do {
        const char c = peek(j);
        if (c == '{' || c == '[') {
            depth++;
            j->at++;
        } else if (c == '}' || c == ']' || c == ',' || c == ':') {
            if (!depth) {
                fault(j);
                return;
            }
            depth -= c == '}' || c == ']';
            j->at++;
        } else if (c == '"') {
            json_text_string(j, &word);
        } else if (!c || !bare_word(j).length) {
            fault(j);
        }
    } while (depth && !j->bad);
}
