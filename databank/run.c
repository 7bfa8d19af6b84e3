/* SPDX-License-Identifier: BSD-2-Clause */
/* See run.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <fap/fat.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/build/import_ict.h"
#include "databank/build/import_makehuman.h"
#include "databank/build/import_shapes.h"
#include "databank/drawing.h"
#include "databank/paint.h"
#include "databank/build/recipe.h"
#include "databank/run.h"
#include "databank/sheet.h"

enum { MAX_BANK = 256 << 20 };

static fap_err blame(report *rep, const char *file, fap_err err)
{
    if (err)
        snprintf(rep->where, sizeof rep->where, "%s", file);
    return err;
}

static fap_err load_bank(const char *path, report *rep)
{
    uint8_t *data;

    if (!strcmp(path, "builtin"))
        return blame(rep, path, fap_bank_builtin(&rep->bank, NULL));
    fap_err err = file_read(path, MAX_BANK, &data, &rep->size);
    if (err)
        return blame(rep, path, err);
    err = fap_bank_load(&rep->bank, data, rep->size, NULL);
    free(data);
    return blame(rep, path, err);
}

static fap_err make_builtin(fap_bank_builder **out)
{
    fap_bank *bank;
    fap_err err = fap_bank_builtin(&bank, NULL);

    *out = NULL;
    if (!err)
        err = fap_bank_builder_copy(out, bank);
    fap_bank_close(&bank);
    return err;
}

/* --- recipes --- */

static void say_working(void *user, const char *what)
{
    (void)user;
    tool_note("%s", what);
}

static int draw_laid(const drawing *d, const recipe_laid *l)
{
    char name[64];
    fap_bank *face = NULL, *scan = NULL;

    snprintf(name, sizeof name, "%02d-%s", l->number, l->name);
    const int ok = drawing_of_face(d, &face, l->like, l->face, NULL) &&
                   drawing_of_scan(d, &scan, face, l->scan, l->in_head) &&
                   drawing_save_pair(d, scan, face, name);
    fap_bank_close(&scan);
    fap_bank_close(&face);
    return ok;
}

static fap_err show_laid(void *user, const recipe_laid *l)
{
    return draw_laid(user, l) ? FAP_OK : FAP_E_IO;
}

static fap_err make_recipe(fap_bank_builder **out, const options *opt, report *rep)
{
    fault f = { 0 };
    drawing pictures = { opt->pictures, opt->sheet.gl, &f };
    const recipe_watch watch = { say_working, opt->pictures ? show_laid : NULL, &pictures };

    fap_err err = opt->pictures && !drawing_open_folder(&pictures) ? FAP_E_IO : FAP_OK;
    if (err == FAP_OK)
        err = recipe_make(out, opt->input, &watch, &rep->recipe, rep->where, sizeof rep->where);
    if (*f.text) {
        snprintf(rep->recipe.why, sizeof rep->recipe.why, "%.200s", f.text);
        if (f.exit_status == EXIT_MISSING)
            err = FAP_E_UNSUPPORTED;
    }
    return err;
}

/* What a fault says, as a report does. */
static fap_err fail_with(const fault *f, report *rep)
{
    snprintf(rep->recipe.why, sizeof rep->recipe.why, "%.250s", f->text);
    *rep->where = '\0';
    return f->exit_status == EXIT_MISSING ? FAP_E_UNSUPPORTED
           : f->exit_status == EXIT_USAGE ? FAP_E_ARG
                                          : FAP_E_DATA;
}

static fap_err make_shapes(fap_bank_builder **out, const options *opt, report *rep)
{
    fault f = { 0 };

    return import_shapes(out, opt->input, opt->landmarks, opt->like, opt->unit_mm, &f) ? FAP_OK
                                                                                       : fail_with(&f, rep);
}

static fap_err make(fap_bank_builder **out, const options *opt, report *rep)
{
    const char *recipe = opt->input;
    static const char makehuman[] = "makehuman:", ict[] = "ict:";

    if (!strcmp(recipe, "builtin"))
        return blame(rep, recipe, make_builtin(out));
    if (!strncmp(recipe, ict, sizeof ict - 1))
        return import_ict(out, recipe + sizeof ict - 1, rep->where, sizeof rep->where);
    if (recipe_is(recipe))
        return make_recipe(out, opt, rep);
    if (import_shapes_is(recipe))
        return make_shapes(out, opt, rep);
#if !defined(HAVE_ZLIB)
    rep->missing = "zlib";
#elif !defined(HAVE_JPEG)
    rep->missing = "libjpeg";
#endif
    if (rep->missing)
        return FAP_E_UNSUPPORTED;
    const size_t prefix = strncmp(recipe, makehuman, sizeof makehuman - 1) ? 0 : sizeof makehuman - 1;
    return import_makehuman(out, recipe + prefix, rep->where, sizeof rep->where);
}

/* Bytes of a bank or of tables on their way to its file, and once more into memory: what was written is loaded before it
 * is kept. */
typedef struct tee {
    FILE *file;
    uint8_t *data;
    size_t size, room;
} tee;

static int tee_write(void *user, const void *data, size_t size)
{
    tee *t = user;

    if (t->size + size > t->room) {
        const size_t room = 2 * (t->size + size);
        uint8_t *grown = realloc(t->data, room);
        if (!grown)
            return 1;
        t->data = grown;
        t->room = room;
    }
    memcpy(t->data + t->size, data, size);
    t->size += size;
    return fwrite(data, 1, size, t->file) != size;
}

/* What is written, and what loads it again before it is kept. */
typedef struct product {
    fap_err (*write)(void *of, const fap_writer *out);
    fap_err (*check)(report *rep, const tee *t);
    void *of;
} product;

static fap_err write_product(const product *p, const options *opt, report *rep)
{
    out_file out;
    fap_err err = out_file_open(&out, opt->output);
    if (err)
        return blame(rep, opt->output, err);

    tee t = { .file = out.stream };
    const fap_writer w = { tee_write, &t };
    err = p->write(p->of, &w);
    if (!err)
        err = p->check(rep, &t);
    rep->size = t.size;
    free(t.data);
    if (!err)
        err = out_file_commit(&out);
    else
        out_file_abandon(&out);
    return blame(rep, opt->output, err);
}

static fap_err write_bank(void *builder, const fap_writer *out)
{
    return fap_bank_builder_write(builder, out);
}

static fap_err check_bank(report *rep, const tee *t)
{
    return fap_bank_load(&rep->bank, t->data, t->size, NULL);
}

static fap_err write_fat(void *fat, const fap_writer *out)
{
    return fap_fat_write(fat, out);
}

static fap_err check_fat(report *rep, const tee *t)
{
    fap_fat *again;
    const fap_err err = fap_fat_load(&again, t->data, t->size, NULL);

    (void)rep;
    fap_fat_close(&again);
    return err;
}

static fap_err make_fat(const options *opt, report *rep)
{
    fap_fat *fat = NULL;
    fap_err err = load_bank(opt->input, rep);

    if (!err)
        err = blame(rep, opt->input, fap_fat_bake(&fat, rep->bank, NULL));
    if (!err)
        err = write_product(&(product){ write_fat, check_fat, fat }, opt, rep);
    fap_fat_close(&fat);
    return err;
}

/* The bank once more, its principal components with it. */
static fap_err add_basis(const options *opt, report *rep)
{
    fap_bank_builder *b = NULL;
    fap_err err = load_bank(opt->input, rep);

    if (!err)
        err = blame(rep, opt->input, fap_bank_builder_copy(&b, rep->bank));
    if (!err)
        err = fap_bank_builder_basis(b, opt->components);
    fap_bank_close(&rep->bank);
    if (!err)
        err = write_product(&(product){ write_bank, check_bank, b }, opt, rep);
    fap_bank_builder_close(&b);
    return err;
}

static fap_err build(const options *opt, report *rep)
{
    fap_bank_builder *b;
    fap_err err = make(&b, opt, rep);

    if (!err)
        err = write_product(&(product){ write_bank, check_bank, b }, opt, rep);
    fap_bank_builder_close(&b);
    return err;
}

static fap_err render(const options *opt, report *rep)
{
    fap_err err = load_bank(opt->input, rep);

    if (!err && opt->paint)
        err = blame(rep, opt->input, paint_bank(&rep->bank, opt->paint));
    return err ? err : sheet_write(rep->bank, opt->output, &opt->sheet, rep->where);
}

fap_err run(const options *opt, report *rep)
{
    switch (opt->command) {
    case COMMAND_BUILD: return build(opt, rep);
    case COMMAND_INFO: return load_bank(opt->input, rep);
    case COMMAND_RENDER: return render(opt, rep);
    case COMMAND_FAT: return make_fat(opt, rep);
    case COMMAND_PCA: return add_basis(opt, rep);
    }
    return FAP_E_ARG;
}
