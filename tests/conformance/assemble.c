/* SPDX-License-Identifier: BSD-2-Clause */
/* See assemble.h. */
#include "tests/conformance/assemble.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODELS = 512, MAX_WORDS = 96, MAX_LINE = 2048, BODY_GROUPS = 24, BODY_PARAMS = 296 };

static const uint8_t face_group_size[] = { 2, 16, 12, 8, 4, 5, 3, 10, 4, 4 };
static const uint8_t body_group_size[BODY_GROUPS] = { 3,  4,  4,  6,  6,  5,  5, 7,  7,  12, 15, 18,
                                                      18, 12, 16, 16, 13, 13, 6, 22, 22, 22, 22, 22 };

/* Syntax elements and their bits: a slip of the pen in a stream does not pass for a test. */
static const struct {
    const char *name;
    unsigned bits;
} elements[] = {
    { "is_intra", 1 },
    { "fba_object_mask", 2 },
    { "is_frame_rate", 1 },
    { "frame_rate", 8 },
    { "seconds", 4 },
    { "frequency_offset", 1 },
    { "is_time_code", 1 },
    { "time_code_hours", 5 },
    { "time_code_minutes", 6 },
    { "time_code_seconds", 6 },
    { "skip_frames", 1 },
    { "number_of_frames_to_skip", 4 },
    { "fap_quant", 5 },
    { "fba_suggested_gender", 1 },
    { "fba_object_coding_type", 1 },
    { "is_i_new_max", 1 },
    { "is_i_new_min", 1 },
    { "is_p_new_max", 1 },
    { "is_p_new_min", 1 },
    { "viseme_def", 1 },
    { "init_face", 1 },
    { "expression_def", 1 },
    { "bap_quant", 5 },
};

typedef struct assembler {
    assembly *out;
    dense_table model[MODELS], flat;
    coder run;
    int in_run;
    uint32_t protection;
    uint8_t face[68], body[BODY_PARAMS]; /* what the last masks say is coded */
    const char *repeat;                  /* the line behind "repeat" */
    long repeats;
    int line, repeat_line;
} assembler;

static int wrong(assembler *a, const char *what, const char *word)
{
    snprintf(a->out->error, sizeof a->out->error, "line %d: %s: %s", a->line, what, word);
    return 0;
}

/* A number from 0 up; -1: none. */
static long number(const char *word, int base)
{
    char *end;
    const long n = strtol(word, &end, base);
    return *word && !*end && n >= 0 ? n : -1;
}

static int put_element(assembler *a, char **word, int words)
{
    for (size_t i = 0; i < sizeof elements / sizeof *elements; i++) {
        if (strcmp(word[0], elements[i].name))
            continue;
        const long bits = words == 3 ? number(word[1], 10) : -1,
                   value = words == 3 ? number(word[2], 10) : -1;
        if (bits != (long)elements[i].bits || value < 0 || value >> bits)
            return wrong(a, "name, bits and value do not fit", word[0]);
        bit_list_put(&a->out->bits, (unsigned)bits, (uint32_t)value);
        if (!strcmp(word[0], "is_intra") && value)
            for (int m = 0; m < MODELS; m++) /* every count is 1 again */
                dense_table_free(&a->model[m]);
        return 1;
    }
    return wrong(a, "no such statement", word[0]);
}

/* start_code BB */
static int put_start_code(assembler *a, char **word, int words)
{
    const long code = words == 2 ? number(word[1], 16) : -1;
    if (code < 0 || code > 255)
        return wrong(a, "start_code wants two hexadecimal digits", word[0]);
    bit_list_put(&a->out->bits, 32, 0x00000100u | (uint32_t)code);
    return 1;
}

/* A 0, and 1s up to the byte boundary. */
static int put_stuffing(assembler *a, char **word, int words)
{
    (void)word, (void)words;
    bit_list_put(&a->out->bits, 1, 0);
    while (a->out->bits.bits % 8)
        bit_list_put(&a->out->bits, 1, 1);
    return 1;
}

/* zeros: what some encoders write for stuffing */
static int put_zeros(assembler *a, char **word, int words)
{
    (void)word, (void)words;
    while (a->out->bits.bits % 8)
        bit_list_put(&a->out->bits, 1, 0);
    return 1;
}

/* bits N HEX */
static int put_bits(assembler *a, char **word, int words)
{
    const long n = words == 3 ? number(word[1], 10) : -1, value = words == 3 ? number(word[2], 16) : -1;
    if (n < 1 || n > 32 || value < 0 || (n < 32 && value >> n))
        return wrong(a, "bits wants a number of bits and hexadecimal digits", word[0]);
    bit_list_put(&a->out->bits, (unsigned)n, (uint32_t)value);
    return 1;
}

/* marker [0] */
static int put_marker(assembler *a, char **word, int words)
{
    bit_list_put_fixed(&a->out->bits, !(words == 2 && !strcmp(word[1], "0")), 1);
    return 1;
}

/* --- masks and tables --- */

typedef struct layout {
    const uint8_t *size;
    uint8_t *coded;
    int groups, first_group; /* of range tables; from 0 */
} layout;

static layout face_layout(assembler *a)
{
    return (layout){ face_group_size, a->face, 10, 1 };
}

static layout body_layout(assembler *a)
{
    return (layout){ body_group_size, a->body, BODY_GROUPS, 0 };
}

/* "G:TYPE" or "G:TYPE:BITS" for group G from 1; NULL: the group is not named. */
static const char *group_word(char **word, int words, int group)
{
    for (int i = 1; i < words; i++)
        if (atoi(word[i]) == group && strchr(word[i], ':'))
            return strchr(word[i], ':') + 1;
    return NULL;
}

static int put_group_mask(assembler *a, uint8_t *coded, int size, const char *what)
{
    const int type = what ? what[0] - '0' : 0;
    const char *bits = what && what[1] == ':' ? what + 2 : "";

    if (type < 0 || type > 3 || strlen(bits) != (size_t)(type == 1 || type == 2 ? size : 0) ||
        strspn(bits, "01") != strlen(bits))
        return wrong(a, "no mask of this group", what ? what : "");
    bit_list_put_fixed(&a->out->bits, 1, 1);
    bit_list_put(&a->out->bits, 2, (uint32_t)type);
    for (int i = 0; i < size; i++) {
        coded[i] = (uint8_t)(*bits ? bits[i] == '1' : type == 3);
        if (*bits)
            bit_list_put(&a->out->bits, 1, coded[i]);
    }
    return 1;
}

/* All groups: marker, type, mask bits; type 0 for those that are not named. */
static int put_masks(assembler *a, layout l, char **word, int words)
{
    for (int g = 0, i = 0; g < l.groups; i += l.size[g++])
        if (!put_group_mask(a, l.coded + i, l.size[g], group_word(word, words, g + 1)))
            return 0;
    return 1;
}

static int put_face_masks(assembler *a, char **word, int words)
{
    return put_masks(a, face_layout(a), word, words);
}

static int put_body_masks(assembler *a, char **word, int words)
{
    return put_masks(a, body_layout(a), word, words);
}

/* "NAME N [I:M ...]": N for every coded parameter, M for number I; NAME is for the reader. */
static int put_table(assembler *a, layout l, char **word, int words)
{
    const long n = words > 2 ? number(word[2], 10) : -1;

    if (n < 0 || n > 31)
        return wrong(a, "a table wants a name and a number up to 31", word[0]);
    for (int g = 0, i = 0; g < l.groups; g++)
        for (int k = 0; k < l.size[g]; k++, i++) {
            if (g < l.first_group)
                continue;
            if (k % 4 == 0)
                bit_list_put_fixed(&a->out->bits, 1, 1);
            const char *own = group_word(word + 2, words - 2, i + 1);
            if (l.coded[i])
                bit_list_put(&a->out->bits, 5, (uint32_t)(own ? atoi(own) : n));
        }
    return 1;
}

static int put_face_table(assembler *a, char **word, int words)
{
    return put_table(a, face_layout(a), word, words);
}

static int put_body_table(assembler *a, char **word, int words)
{
    return put_table(a, body_layout(a), word, words);
}

/* --- arithmetic runs --- */

static int begin_run(assembler *a, char **word, int words)
{
    (void)words;
    if (a->in_run)
        return wrong(a, "a run in a run", word[0]);
    a->in_run = 1;
    coder_begin(&a->run, &a->out->bits, a->protection);
    return 1;
}

static int end_run(assembler *a, char **word, int words)
{
    (void)words;
    if (!a->in_run)
        return wrong(a, "no run to end", word[0]);
    a->in_run = 0;
    coder_flush(&a->run);
    return 1;
}

/* symbol VALUE MIN MAX [model ID]: without a model all counts are 1 */
static int put_symbol(assembler *a, char **word, int words)
{
    const int adaptive = words == 6 && !strcmp(word[4], "model");
    if (!a->in_run || (words != 4 && !adaptive))
        return wrong(a, "a symbol has VALUE MIN MAX [model ID] and stands in a run", word[0]);
    const int value = atoi(word[1]), min = atoi(word[2]), max = atoi(word[3]);
    const long id = adaptive ? number(word[5], 10) : 0;
    if (value < min || value > max || max - min > 16000 || id < 0 || id >= MODELS)
        return wrong(a, "a value out of its range", word[1]);
    dense_table *t = adaptive ? &a->model[id] : &a->flat;
    const uint32_t size = (uint32_t)(max - min + 1), symbol = (uint32_t)(value - min);
    if (!adaptive || !t->size)
        dense_table_make(t, size);
    if (t->size != size)
        return wrong(a, "a model cannot change its size", word[5]);
    coder_put(&a->run, t, symbol);
    if (adaptive)
        dense_table_update(t, symbol);
    return 1;
}

/* protection 0: what stands behind 22 zeros from here on */
static int set_protection(assembler *a, char **word, int words)
{
    a->protection = !(words == 2 && !strcmp(word[1], "0"));
    return 1;
}

/* --- units --- */

static int end_unit(assembler *a)
{
    assembly *out = a->out;

    if (out->bits.bits % 8)
        return wrong(a, "a unit ends on a byte boundary", "unit");
    if (out->units == MAX_UNITS)
        return wrong(a, "too many units", "unit");
    out->unit_end[out->units++] = out->bits.bits / 8;
    return 1;
}

/* unit: what follows is sent by itself; unit lost: and between the two one was lost */
static int next_unit(assembler *a, char **word, int words)
{
    return end_unit(a) && (words < 2 || strcmp(word[1], "lost") || end_unit(a));
}

static const struct {
    const char *name;
    int (*put)(assembler *a, char **word, int words);
} statements[] = {
    { "start_code", put_start_code },
    { "stuffing", put_stuffing },
    { "zeros", put_zeros },
    { "bits", put_bits },
    { "marker", put_marker },
    { "masks", put_face_masks },
    { "body_masks", put_body_masks },
    { "table", put_face_table },
    { "body_table", put_body_table },
    { "run", begin_run },
    { "flush", end_run },
    { "symbol", put_symbol },
    { "protection", set_protection },
    { "unit", next_unit },
};

static int put_statement(assembler *a, char *text)
{
    char *word[MAX_WORDS], *save;
    int words = 0;

    for (char *w = strtok_r(text, " \t\r", &save); w && words < MAX_WORDS; w = strtok_r(NULL, " \t\r", &save))
        word[words++] = w;
    if (!words)
        return 1;
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (!strcmp(word[0], statements[i].name))
            return statements[i].put(a, word, words);
    return put_element(a, word, words);
}

static int put_line(assembler *a, char *line)
{
    char *save;

    line[strcspn(line, "#")] = 0;
    for (char *s = strtok_r(line, ";", &save); s; s = strtok_r(NULL, ";", &save))
        if (!put_statement(a, s))
            return 0;
    return 1;
}

/* "repeat N" and "end_repeat", alone on their lines. 1: it was one of them, and *next is where to go on. */
static int is_repeat(assembler *a, const char *line, const char **next)
{
    if (sscanf(line, "repeat %ld", &a->repeats) == 1) {
        a->repeat = *next;
        a->repeat_line = a->line;
        return 1;
    }
    if (strncmp(line, "end_repeat", 10))
        return 0;
    if (a->repeat && --a->repeats > 0) {
        *next = a->repeat;
        a->line = a->repeat_line;
    }
    return 1;
}

static int put_text(assembler *a, const char *text)
{
    char line[MAX_LINE];

    for (const char *at = text, *next; *at; at = next) {
        const size_t n = strcspn(at, "\n");
        next = at + n + (at[n] == '\n');
        a->line++;
        if (n >= sizeof line)
            return wrong(a, "too long", "");
        memcpy(line, at, n);
        line[n] = 0;
        if (!is_repeat(a, line, &next) && !put_line(a, line))
            return 0;
    }
    return end_unit(a);
}

int assembly_make(assembly *out, const char *text)
{
    assembler *a = calloc(1, sizeof *a);
    if (!a)
        abort();
    memset(out, 0, sizeof *out);
    a->out = out;
    a->protection = 1;
    const int ok = put_text(a, text);
    for (int m = 0; m < MODELS; m++)
        dense_table_free(&a->model[m]);
    dense_table_free(&a->flat);
    free(a);
    return ok;
}

void assembly_free(assembly *a)
{
    bit_list_free(&a->bits);
}
