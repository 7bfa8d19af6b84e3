/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The kinds of tables. Lengths are millimetres in head axes of the room, FAPs count their own units (the header says
 * which), weights are shares of a key model. docs/export.md describes the columns.
 */
#include <ctype.h>
#include <string.h>

#include <fap/tables.h>

#include "player/sinks/csv.h"

static const char head_names[] = "frame,time_s";

enum { HEAD_SIZE = 24, NUMBER_SIZE = 12 };

/* --- feature points --- */

static void put_point_names(FILE *out, const fap_bank *bank)
{
    (void)bank;
    fputs(head_names, out);
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const char *name = fap_point_get(i)->name;
        fprintf(out, ",%s.x,%s.y,%s.z", name, name, name);
    }
}

/* Points that the face cannot carry have empty cells. */
static void put_points(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank,
                       void *state)
{
    (void)state;
    fputs(head, out);
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const float *p = shown->point[i];
        if (fap_bank_point_get(bank, i)->present)
            fprintf(out, ",%.4f,%.4f,%.4f", p[0], p[1], p[2]);
        else
            fputs(",,,", out);
    }
    fputc('\n', out);
}

static double points_size(const fap_bank *bank)
{
    (void)bank;
    return HEAD_SIZE + 3 * NUMBER_SIZE * FAP_POINT_COUNT;
}

static const csv_kind points = {
    .name = "points", .put_names = put_point_names, .put_frame = put_points, .frame_size = points_size
};

/* --- vertices: a line each, for a spreadsheet takes no hundred thousand columns --- */

static void put_vertex_names(FILE *out, const fap_bank *bank)
{
    (void)bank;
    fputs(head_names, out);
    fputs(",vertex,x,y,z", out);
}

static void put_vertices(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank,
                         void *state)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const float *x = shown->position, *y = x + mesh->stride, *z = y + mesh->stride;

    (void)state;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        fprintf(out, "%s,%u,%.4f,%.4f,%.4f\n", head, (unsigned)v, x[v], y[v], z[v]);
}

static double vertices_size(const fap_bank *bank)
{
    return (HEAD_SIZE + 4.0 * NUMBER_SIZE) * fap_bank_mesh(bank)->vertex_count;
}

static const csv_kind vertices = {
    .name = "vertices", .put_names = put_vertex_names, .put_frame = put_vertices, .frame_size = vertices_size
};

/* --- weights of key models --- */

/* Names are unique within a kind only: a viseme and a unit may share one. */
static void put_key_names(FILE *out, const fap_bank *bank)
{
    static const char *const kind[] = { "viseme", "expression", "extra", "unit" };

    fputs(head_names, out);
    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        fprintf(out, ",%s.", key->kind <= FAP_KEY_UNIT ? kind[key->kind] : "key");
        for (const char *c = key->name; *c; c++) /* a face from elsewhere is called what it likes */
            fputc(*c == ',' || *c == '"' || iscntrl((unsigned char)*c) ? '_' : *c, out);
    }
}

static void put_weights(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank,
                        void *state)
{
    (void)state;
    fputs(head, out);
    for (int k = 0; k < fap_bank_key_count(bank); k++)
        fprintf(out, ",%.6g", shown->weight[k]);
    fputc('\n', out);
}

static double weights_size(const fap_bank *bank)
{
    return HEAD_SIZE + (double)NUMBER_SIZE * fap_bank_key_count(bank);
}

static const csv_kind weights = {
    .name = "weights", .put_names = put_key_names, .put_frame = put_weights, .frame_size = weights_size
};

/* --- FAPs --- */

static void put_fap_names(FILE *out, const fap_bank *bank)
{
    static const char *const unit[] = { "", "IRISD", "ES", "ENS", "MNS", "MW", "AU" };

    (void)bank;
    fputs(head_names, out);
    fputs(",viseme.select1,viseme.select2,viseme.blend", out);
    fputs(",expression.select1,expression.intensity1,expression.select2,expression.intensity2", out);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        fprintf(out, ",%s.%s", fap_info_get(fap)->name, unit[fap_info_get(fap)->unit]);
}

static void put_viseme(FILE *out, const fap_frame *f)
{
    const fap_viseme *v = &f->viseme;

    if (f->state[1] == FAP_ABSENT)
        fputs(",,,", out);
    else
        fprintf(out, ",%d,%d,%d", v->select1, v->select2, v->blend);
}

static void put_expression(FILE *out, const fap_frame *f)
{
    const fap_expression *e = &f->expression;

    if (f->state[2] == FAP_ABSENT)
        fputs(",,,,", out);
    else
        fprintf(out, ",%d,%d,%d,%d", e->select1, e->intensity1, e->select2, e->intensity2);
}

/* As the face shows them: interpolated in time, derived from others; a FAP without a value is an empty cell. */
static void put_faps(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank, void *state)
{
    const fap_frame *f = shown->frame;

    (void)bank, (void)state;
    fputs(head, out);
    put_viseme(out, f);
    put_expression(out, f);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->state[fap] == FAP_ABSENT)
            fputc(',', out);
        else
            fprintf(out, ",%d", (int)f->value[fap]);
    fputc('\n', out);
}

static double faps_size(const fap_bank *bank)
{
    (void)bank;
    return HEAD_SIZE + NUMBER_SIZE * (FAP_COUNT + 5);
}

static const csv_kind faps = {
    .name = "faps", .put_names = put_fap_names, .put_frame = put_faps, .frame_size = faps_size
};

/* --- the list --- */

const csv_kind *const csv_kinds[] = { &points, &vertices, &weights, &faps, &csv_arkit, NULL };

const csv_kind *csv_kind_by_name(const char *name)
{
    for (int i = 0; csv_kinds[i]; i++)
        if (!strcmp(csv_kinds[i]->name, name))
            return csv_kinds[i];
    return NULL;
}
