/* SPDX-License-Identifier: BSD-2-Clause */
/* See items.h. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fap/version.h>

#include "encoder/batch/items.h"

/* --- which files --- */

static const char *const no_takes[] = { "wav", "mp3",  "flac", "ogg", "m4a", "aac",  "mp4", "mov",  "avi",
                                        "mkv", "webm", "m4v",  "png", "jpg", "jpeg", "gif", "webp", "bmp",
                                        "tif", "tiff", "svg",  "pdf", "md",  "html", "htm", "doc",  "docx",
                                        "xls", "xlsx", "zip",  "py",  "sh",  "exe",  "log" };

/* Of the last part of a path, the dot not included; "" when it has none. */
static const char *ending_of(const char *path)
{
    const char *const slash = strrchr(path, '/'), *const dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : path + strlen(path);
}

static int may_be_take(const char *name)
{
    const char *const ending = ending_of(name);

    for (size_t i = 0; i < sizeof no_takes / sizeof *no_takes; i++)
        if (!strcasecmp(ending, no_takes[i]))
            return 0;
    return 1;
}

/* --- where everything lies --- */

static size_t stem_length(const char *name)
{
    const char *const ending = ending_of(name);
    return (size_t)(ending - name) - (ending > name && ending[-1] == '.');
}

static int same_stem(const char *a, const char *b)
{
    return stem_length(a) == stem_length(b) && !strncmp(a, b, stem_length(a));
}

/* take.c3d and take.trc cannot both become take.fap. Those that begin alike stand together in the list. */
static int has_twin(const items *l, size_t i)
{
    const char *const name = l->item[i].name;
    const size_t length = stem_length(name);

    for (size_t k = i + 1; k < l->count && !strncmp(l->item[k].name, name, length); k++)
        if (same_stem(l->item[k].name, name))
            return 1;
    for (size_t k = i; k-- > 0 && !strncmp(l->item[k].name, name, length);)
        if (same_stem(l->item[k].name, name))
            return 1;
    return 0;
}

static char *text(const char *folder, const char *between, const char *name, size_t length)
{
    const size_t room = strlen(folder) + strlen(between) + length + 1;
    char *const out = malloc(room);

    if (out)
        snprintf(out, room, "%s%s%.*s", folder, between, (int)length, name);
    return out;
}

static fap_err place(items *l, size_t i, const options *opt)
{
    item *it = &l->item[i];
    const size_t whole = strlen(it->name);

    it->input = text(opt->batch_path, "/", it->name, whole);
    it->stem = text(opt->output, "/", it->name, has_twin(l, i) ? whole : stem_length(it->name));
    it->ledger = text(opt->output, "/.batch/", it->name, whole);
    return it->input && it->stem && it->ledger ? FAP_OK : FAP_E_NOMEM;
}

fap_err items_list(items *l, const options *opt)
{
    *l = (items){ 0 };
    fap_err err = folder_list_files(&l->files, opt->batch_path, opt->output);
    if (err != FAP_OK)
        return err;
    l->item = calloc(l->files.count + 1, sizeof *l->item);
    if (!l->item)
        return FAP_E_NOMEM;
    for (size_t i = 0; i < l->files.count; i++)
        if (may_be_take(l->files.name[i]))
            l->item[l->count++].name = l->files.name[i];
    for (size_t i = 0; i < l->count && err == FAP_OK; i++)
        err = place(l, i, opt);
    return err;
}

void items_free(items *l)
{
    for (size_t i = 0; l->item && i < l->count; i++) {
        free(l->item[i].input);
        free(l->item[i].stem);
        free(l->item[i].ledger);
    }
    free(l->item);
    folder_list_free(&l->files);
}

int item_path(char path[ITEM_PATH_SIZE], const char *base, const char *ending)
{
    return snprintf(path, ITEM_PATH_SIZE, "%s%s", base, ending) < ITEM_PATH_SIZE;
}

/* --- what a result is made of --- */

/* FNV-1a: to notice other options, not to keep anybody out. */
static uint64_t hash(uint64_t h, const void *data, size_t size)
{
    const uint8_t *const byte = data;

    for (size_t i = 0; i < size; i++)
        h = (h ^ byte[i]) * UINT64_C(0x100000001b3);
    return h;
}

/* A table that was edited is another table. */
static uint64_t hash_file(uint64_t h, const char *path)
{
    struct stat s;

    if (!path || stat(path, &s))
        return h;
    const int64_t of[3] = { s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec };
    return hash(h, of, sizeof of);
}

void item_made_of(const item *it, const options *opt, char out[RESULT_VALUE_SIZE])
{
    struct stat s = { 0 };
    uint64_t h = hash(UINT64_C(0xcbf29ce484222325), opt->given, strlen(opt->given));

    h = hash_file(h, opt->markers_path);
    h = hash_file(h, opt->fapu_path);
    h = hash_file(h, opt->bank_path);
    h = hash_file(h, opt->fit_path);
    if (stat(it->input, &s))
        s.st_size = -1;
    snprintf(out, RESULT_VALUE_SIZE, "%s %" PRId64 " %" PRId64 ".%09ld %016" PRIx64, fap_version(),
             (int64_t)s.st_size, (int64_t)s.st_mtim.tv_sec, s.st_mtim.tv_nsec, h);
}

/* Somebody may have taken it away to have it made again. */
static int output_is_there(const result *r, const options *opt)
{
    char path[ITEM_PATH_SIZE];

    if (strcmp(r->value[RESULT_status], result_encoded))
        return 1;
    return snprintf(path, sizeof path, "%s/%s", opt->output, r->value[RESULT_output]) < (int)sizeof path &&
           !access(path, R_OK);
}

int item_result(const item *it, const options *opt, result *r)
{
    char path[ITEM_PATH_SIZE], made_of[RESULT_VALUE_SIZE];

    item_made_of(it, opt, made_of);
    return item_path(path, it->ledger, ".result") && result_read(r, path) &&
           !strcmp(r->value[RESULT_made_of], made_of) && output_is_there(r, opt);
}
