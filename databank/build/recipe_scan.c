/* SPDX-License-Identifier: BSD-2-Clause */
/* A recipe's scans: one person at rest, and what that face does. Source: Zhu 2006 section 4.7. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/landmarks.h>
#include <fap/studio/retarget.h>

#include "databank/build/recipe_state.h"
#include "databank/range/range_file.h"

typedef struct scanned {
    fap_surface *surface;
    fap_take *landmarks;
} scanned;

/* --- files --- */

static fap_err blame(const recipe *r, const char *file, fap_err err, const char *where)
{
    snprintf(r->outcome->why, sizeof r->outcome->why, "%s: %s", file, *where ? where : fap_strerror(err));
    return err;
}

/* A range image's pictures are in the folder of its camera. */
typedef struct beside {
    const recipe *r;
    const char *camera;
} beside;

static fap_err read_beside(void *user, const char *name, uint8_t **data, size_t *size)
{
    const beside *b = user;
    const char *slash = strrchr(b->camera, '/');
    char path[1024];
    const int n =
        snprintf(path, sizeof path, "%.*s%s", slash ? (int)(slash - b->camera) + 1 : 0, b->camera, name);

    return n > 0 && (size_t)n < sizeof path ? b->r->files->read(b->r->files->user, path, data, size)
                                            : FAP_E_ARG;
}

static fap_err read_surface(const recipe *r, const char *file, fap_surface **out)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;
    fap_err err = r->files->read(r->files->user, file, &data, &size);

    if (err == FAP_OK) {
        err = fap_surface_read(out, data, size, NULL, where);
        if (err == FAP_E_UNKNOWN_FORMAT && range_file_may_be(data, size)) {
            const range_folder folder = { read_beside, &(beside){ r, file } };
            err = range_file_read(out, &folder, data, size, where);
        }
        free(data);
    }
    return err == FAP_OK ? err : blame(r, file, err == FAP_E_UNSUPPORTED ? FAP_E_DATA : err, where);
}

static fap_err read_landmarks(const recipe *r, const char *file, scanned *s)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;
    fap_err err = r->files->read(r->files->user, file, &data, &size);

    if (err == FAP_OK) {
        err = fap_landmarks_read(&s->landmarks, data, size, s->surface, NULL, where);
        free(data);
    }
    return err == FAP_OK ? err : blame(r, file, err, where);
}

static void close_scan(scanned *s)
{
    fap_surface_close(&s->surface);
    fap_take_close(&s->landmarks);
}

/* "SCAN LANDMARKS": the last blank is between them. */
static fap_err read_scan(const recipe *r, const char *files, scanned *s)
{
    char scan[512];
    const char *blank = strrchr(files, ' '), *tab = strrchr(files, '\t');

    *s = (scanned){ 0 };
    if (tab && (!blank || tab > blank))
        blank = tab;
    if (!blank || (size_t)(blank - files) >= sizeof scan)
        return FAP_E_SYNTAX;
    snprintf(scan, sizeof scan, "%.*s", (int)(blank - files), files);
    for (size_t n = strlen(scan); n && (scan[n - 1] == ' ' || scan[n - 1] == '\t'); n--)
        scan[n - 1] = '\0';
    fap_err err = read_surface(r, scan, &s->surface);
    if (err == FAP_OK)
        err = read_landmarks(r, blank + 1, s);
    if (err != FAP_OK)
        close_scan(s);
    return err;
}

/* --- what is set --- */

fap_err recipe_take_like(recipe *r, const char *rest)
{
    uint8_t *data;
    size_t size;

    if (r->builder || r->person.like || !*rest)
        return FAP_E_SYNTAX;
    if (!strcmp(rest, "builtin"))
        return fap_bank_builtin(&r->person.like, NULL);
    fap_err err = r->files->read(r->files->user, rest, &data, &size);
    if (err == FAP_OK) {
        err = fap_bank_load(&r->person.like, data, size, NULL);
        free(data);
    }
    return err == FAP_OK ? err : blame(r, rest, err, "");
}

fap_err recipe_take_method(recipe *r, const char *rest)
{
    for (int m = 0; fap_registration_name(m); m++)
        if (!strcmp(rest, fap_registration_name(m))) {
            r->person.config.fit.method = (fap_registration_method)m;
            return FAP_OK;
        }
    return FAP_E_SYNTAX;
}

fap_err recipe_take_alignment(recipe *r, const char *rest)
{
    static const char *const names[FAP_ALIGN_COUNT] = { "icp", "orientation" };

    for (int i = 0; i < FAP_ALIGN_COUNT; i++)
        if (!strcmp(rest, names[i])) {
            r->person.config.alignment = (fap_head_alignment)i;
            return FAP_OK;
        }
    return FAP_E_SYNTAX;
}

fap_err recipe_take_alone(recipe *r, const char *rest)
{
    if (*rest || r->builder)
        return FAP_E_SYNTAX;
    r->person.alone = 1;
    return FAP_OK;
}

/* --- the face at rest --- */

static void working(const recipe *r, const char *name)
{
    char text[128];

    snprintf(text, sizeof text, "laying the face onto the scan %d, %s", r->outcome->scan_count + 1, name);
    if (r->watch->working)
        r->watch->working(r->watch->user, text);
}

/* @head: NULL: as the fit at rest says. */
static fap_err show(const recipe *r, const char *name, const fap_surface *scan, const double (*head)[4],
                    const float (*motion)[3])
{
    const recipe_person *p = &r->person;
    const uint32_t n = fap_bank_mesh(p->like)->vertex_count;

    if (!r->watch->laid)
        return FAP_OK;
    float(*in_head)[3] = malloc(scan->vertex_count * sizeof *in_head), (*face)[3] = malloc(n * sizeof *face);
    for (uint32_t i = 0; in_head && i < scan->vertex_count; i++) {
        fap_registration_to_head(p->rest, scan->position[i], in_head[i]);
        for (int a = 0; head && a < 3; a++)
            in_head[i][a] = (float)(head[a][0] * (double)scan->position[i][0] +
                                    head[a][1] * (double)scan->position[i][1] +
                                    head[a][2] * (double)scan->position[i][2] + head[a][3]);
    }
    for (uint32_t i = 0; face && i < 3 * n; i++)
        face[i / 3][i % 3] =
            fap_registration_positions(p->rest)[i / 3][i % 3] + (motion ? motion[i / 3][i % 3] : 0);
    const recipe_laid laid = { name, r->outcome->scan_count,     p->like,
                               scan, (const float(*)[3])in_head, (const float(*)[3])face };
    const fap_err err = in_head && face ? r->watch->laid(r->watch->user, &laid) : FAP_E_NOMEM;
    free(in_head);
    free(face);
    return err;
}

static recipe_scan *note_scan(const recipe *r, const char *name)
{
    recipe_outcome *o = r->outcome;

    if (o->scan_count == RECIPE_MAX_SCANS)
        return NULL;
    recipe_scan *s = &o->scan[o->scan_count++];
    snprintf(s->name, sizeof s->name, "%s", name);
    return s;
}

static fap_err lay_at_rest(recipe *r, const scanned *s)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_registration_config cfg;
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t pins;
    fap_generic generic;

    fap_registration_config_init(&cfg);
    cfg.method = r->person.config.fit.method;
    cfg.mm_per_unit = r->scaled ? (double)r->scale : 0;
    fap_err err = fap_landmarks_pin(s->landmarks, r->person.like, pin, &pins, where);
    if (err == FAP_OK)
        err = fap_generic_of_bank(&generic, r->person.like, NULL);
    if (err == FAP_OK) {
        err = fap_register(&r->person.rest, &generic, s->surface, pin, pins, &cfg, where);
        fap_generic_free(&generic, NULL);
    }
    return err == FAP_OK ? err : blame(r, "the face at rest", err, where);
}

static fap_err open_person(recipe *r)
{
    recipe_person *p = &r->person;

    note_scan(r, "at rest")->report.fit = *fap_registration_report_get(p->rest);
    const fap_err err =
        fap_bank_retarget(&r->builder, p->like, fap_registration_positions(p->rest), r->name, NULL);
    if (err == FAP_OK && p->alone)
        fap_bank_builder_forget_keys(r->builder);
    return err;
}

fap_err recipe_take_scan(recipe *r, const char *rest)
{
    scanned s;

    if (r->builder)
        return FAP_E_SYNTAX;
    fap_err err = r->person.like ? FAP_OK : recipe_take_like(r, "default");
    if (err == FAP_OK)
        err = read_scan(r, rest, &s);
    if (err != FAP_OK)
        return err;
    working(r, "at rest");
    err = lay_at_rest(r, &s);
    r->person.landmarks = s.landmarks;
    s.landmarks = NULL;
    if (err == FAP_OK)
        err = open_person(r);
    if (err == FAP_OK)
        err = show(r, "at rest", s.surface, NULL, NULL);
    close_scan(&s);
    return err;
}

/* --- what it does --- */

fap_err recipe_scan_motion(recipe *r, fap_key_kind kind, const char *name, const char *files,
                           float (*delta)[3])
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_expression_config cfg = r->person.config;
    scanned s;
    fap_err err = read_scan(r, files, &s);

    if (err != FAP_OK)
        return err;
    working(r, name);
    recipe_scan *note = note_scan(r, name);
    cfg.masked = kind == FAP_KEY_VISEME;
    const fap_person person = { r->person.like, r->person.rest, r->person.landmarks };
    err = note ? fap_expression_lay(delta, &person, s.surface, s.landmarks, &cfg, &note->report, where)
               : FAP_E_LIMIT;
    if (err != FAP_OK)
        blame(r, name, err, where);
    else
        err = show(r, name, s.surface, (const double(*)[4])note->report.head, (const float(*)[3])delta);
    close_scan(&s);
    return err;
}

void recipe_person_close(recipe_person *p)
{
    fap_registration_close(&p->rest);
    fap_take_close(&p->landmarks);
    fap_bank_close(&p->like);
}
