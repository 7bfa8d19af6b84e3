/* SPDX-License-Identifier: BSD-2-Clause */
/* See fapu_file.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/file.h"
#include "common/fapu_file.h"

static const char *const names[5] = { "IRISD", "ES", "ENS", "MNS", "MW" };

static float *slot(fap_fapu *f, int i)
{
    float *const slots[5] = { &f->irisd_mm, &f->es_mm, &f->ens_mm, &f->mns_mm, &f->mw_mm };
    return slots[i];
}

/* "ES", and "ES0" as the standard writes the distance itself. */
static int find_name(const char *word)
{
    for (int i = 0; i < 5; i++) {
        const size_t n = strlen(names[i]);
        if (!strncasecmp(word, names[i], n) && (!word[n] || !strcmp(word + n, "0")))
            return i;
    }
    return -1;
}

static fap_err parse_line(char *line, unsigned number, fap_fapu *out, char *where)
{
    static const char gaps[] = " \t\r,;:=";
    char *rest, *end, *word = strtok_r(line, gaps, &rest), *value = word ? strtok_r(NULL, gaps, &rest) : NULL;

    if (!word || *word == '#')
        return FAP_OK;
    const int i = find_name(word);
    const double mm = value ? strtod(value, &end) : 0;
    if (i < 0 || !value || *end || !(mm > 0 && mm < 1000)) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "line %u: expected IRISD, ES, ENS, MNS or MW and millimetres",
                 number);
        return FAP_E_SYNTAX;
    }
    *slot(out, i) = (float)mm;
    return FAP_OK;
}

fap_err fapu_file_parse(const char *text, fap_fapu *out, char *where)
{
    char line[128];

    *out = (fap_fapu){ 0 };
    for (unsigned number = 1; *text; number++) {
        const size_t length = strcspn(text, "\n");
        snprintf(line, sizeof line, "%.*s", (int)(length < sizeof line ? length : sizeof line - 1), text);
        const fap_err err = parse_line(line, number, out, where);
        if (err != FAP_OK)
            return err;
        text += length + (text[length] == '\n');
    }
    for (int i = 0; i < 5; i++)
        if (!(*slot(out, i) > 0)) {
            snprintf(where, FAP_ERROR_TEXT_SIZE, "%s is missing", names[i]);
            return FAP_E_SYNTAX;
        }
    return FAP_OK;
}

fap_err fapu_file_read(const char *path, fap_fapu *out, char *where)
{
    uint8_t *text;
    size_t size;

    *where = '\0';
    fap_err err = file_read(path, 1 << 16, &text, &size);
    if (err != FAP_OK)
        return err;
    err = fapu_file_parse((const char *)text, out, where);
    free(text);
    return err;
}
