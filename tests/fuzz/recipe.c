/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any text as a recipe of fapbank. Whatever file it names, it gets a small mesh, a small motion or a few landmarks; a bank that
 * it makes must be written and load again, or be refused.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "databank/build/recipe.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

/* A pyramid of two groups, its tip moved where the file's name is long. */
static const char mesh[] = "v 0 0 0\nv 60 0 0\nv 60 50 0\nv 0 50 0\nv 30 25 %d\nvt 0 0\nvt 1 1\n"
                           "g face\nf 1/1 2/2 5/1\nf 2 3 5\ng eye\nf 3 4 5\nf 4 1 5\n";
static const char landmarks[] = "8.3,0\n8.4,1\n9.3,4\n2.1,2\n";
static const char motion[] = "4 0 0.1 -0.2\n0 1 0 0\n";

static uint8_t *copy(const char *text, size_t *size)
{
    *size = strlen(text);
    uint8_t *p = malloc(*size + 1);
    check(p != NULL);
    memcpy(p, text, *size + 1);
    return p;
}

static fap_err read_any(void *user, const char *name, uint8_t **data, size_t *size)
{
    (void)user;
    if (strlen(name) > 40)
        return FAP_E_IO;
    *data = copy(strstr(name, ".target") ? motion : strstr(name, ".csv") ? landmarks : mesh, size);
    char *depth = strstr((char *)*data, "%d");
    if (depth)
        memcpy(depth, strlen(name) > 6 ? "30" : "20", 2);
    return FAP_OK;
}

typedef struct sink {
    uint8_t *data;
    size_t size, room;
} sink;

static int write_sink(void *user, const void *data, size_t size)
{
    sink *s = user;

    if (s->size + size > s->room) {
        s->room = 2 * (s->size + size);
        s->data = realloc(s->data, s->room);
        check(s->data != NULL);
    }
    memcpy(s->data + s->size, data, size);
    s->size += size;
    return 0;
}

static void write_and_load(fap_bank_builder *builder)
{
    sink s = { 0 };
    fap_bank *bank;

    if (fap_bank_builder_write(builder, &(fap_writer){ write_sink, &s }) == FAP_OK) {
        check(fap_bank_load(&bank, s.data, s.size, NULL) == FAP_OK);
        fap_bank_close(&bank);
    }
    free(s.data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const recipe_files files = { .read = read_any };
    static recipe_outcome outcome;
    fap_bank_builder *builder;
    char *text = malloc(size + 1);

    check(text != NULL);
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    const fap_err err = recipe_parse(&builder, text, &files, &(recipe_watch){ 0 }, &outcome);
    check((err == FAP_OK) == (builder != NULL) && (err != FAP_OK || !outcome.line));
    if (builder)
        write_and_load(builder);
    fap_bank_builder_close(&builder);
    free(text);
    return 0;
}
