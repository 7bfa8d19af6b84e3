/* SPDX-License-Identifier: BSD-2-Clause */
/* See fap/studio/landmarks.h. Landmarks are a take of one frame, so that every name that a marker may have is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/landmarks.h>
#include <fap/studio/markers.h>

#include "base/mem.h"
#include "shape/number.h"

enum { MAX_LINE = 512, MAX_CELLS = 5 };

/* --- the file --- */

typedef struct landmark {
    char name[FAP_TAKE_NAME_SIZE];
    float at[3];
} landmark;

typedef struct reading {
    const fap_surface *scan;
    landmark *found;
    uint32_t count;
    char *where;
} reading;

static fap_err fail(const reading *r, fap_err err, int line, const char *text)
{
    snprintf(r->where, FAP_ERROR_TEXT_SIZE, "line %d: %s", line, text);
    return err;
}

static int is_between(char c)
{
    return c == ',' || c == ';' || c == '\t' || c == ' ' || c == '\r';
}

/* Cells are ended in place. A cell may stand in quotes. */
static int split(char *line, char *cell[MAX_CELLS])
{
    int count = 0;

    for (char *p = line; count < MAX_CELLS;) {
        while (is_between(*p))
            p++;
        if (!*p)
            break;
        const char end = *p == '"' ? *p++ : '\0';
        cell[count++] = p;
        while (*p && (end ? *p != end : !is_between(*p)))
            p++;
        if (*p)
            *p++ = '\0';
    }
    return count;
}

static fap_err take_vertex(reading *r, int line, const char *text, float at[3])
{
    char *end;
    const unsigned long v = strtoul(text, &end, 10);

    if (*end || *text < '0' || *text > '9')
        return fail(r, FAP_E_SYNTAX, line, "expected NAME, x, y, z or NAME and the number of a vertex");
    if (!r->scan || v >= r->scan->vertex_count)
        return fail(r, FAP_E_DATA, line, "the scan has no vertex of that number");
    memcpy(at, r->scan->position[v], 3 * sizeof *at);
    return FAP_OK;
}

/* The sample of a range image that is nearest to a pixel. */
static fap_err take_pixel(reading *r, int line, char *const *cell, float at[3])
{
    const fap_surface *s = r->scan;
    float u, v;

    if (!s || !s->grid)
        return fail(r, FAP_E_DATA, line, "pixels are places in range images, and the scan is none");
    if (!fap_read_floats(cell[1], &u, 1) || !fap_read_floats(cell[2], &v, 1))
        return fail(r, FAP_E_SYNTAX, line, "expected NAME, column, row, px");
    if (!(u >= -0.5F && v >= -0.5F && u < (float)s->columns - 0.5F && v < (float)s->rows - 0.5F))
        return fail(r, FAP_E_DATA, line, "the range image has no such pixel");
    const uint32_t i = s->grid[(size_t)lrintf(v) * s->columns + (size_t)lrintf(u)];
    if (i == UINT32_MAX)
        return fail(r, FAP_E_DATA, line, "nothing was seen at that pixel");
    memcpy(at, s->position[i], 3 * sizeof *at);
    return FAP_OK;
}

/* A first line that has no number names the columns. */
static int is_heading(int line, char *const *cell, int count)
{
    float v;

    for (int i = 1; i < count; i++)
        if (fap_read_floats(cell[i], &v, 1))
            return 0;
    return line == 1;
}

static fap_err take_line(reading *r, int line, char *text)
{
    char *cell[MAX_CELLS];
    const int count = split(text, cell);
    landmark *m = &r->found[r->count];

    if (!count || *cell[0] == '#' || is_heading(line, cell, count))
        return FAP_OK;
    if (r->count == FAP_TAKE_MAX_POINTS)
        return fail(r, FAP_E_LIMIT, line, "more landmarks than a face has places");
    snprintf(m->name, sizeof m->name, "%s", cell[0]);
    if (count == 2) {
        const fap_err err = take_vertex(r, line, cell[1], m->at);
        if (err != FAP_OK)
            return err;
    } else if (count == 4 && !strcmp(cell[3], "px")) {
        const fap_err err = take_pixel(r, line, cell, m->at);
        if (err != FAP_OK)
            return err;
    } else if (count < 4 || !fap_read_floats(cell[1], &m->at[0], 1) ||
               !fap_read_floats(cell[2], &m->at[1], 1) || !fap_read_floats(cell[3], &m->at[2], 1))
        return fail(r, FAP_E_SYNTAX, line, "expected NAME, x, y, z or NAME and the number of a vertex");
    r->count++;
    return FAP_OK;
}

static fap_err take_lines(reading *r, const char *data, size_t size)
{
    fap_err err = FAP_OK;

    for (int line = 1; size && err == FAP_OK; line++) {
        const char *stop = memchr(data, '\n', size);
        const size_t length = stop ? (size_t)(stop - data) : size;
        char text[MAX_LINE];
        if (length >= MAX_LINE || memchr(data, '\0', length))
            return fail(r, FAP_E_SYNTAX, line, "no line of landmarks");
        memcpy(text, data, length);
        text[length] = '\0';
        err = take_line(r, line, text);
        data += length + (stop != NULL);
        size -= length + (stop != NULL);
    }
    return err;
}

static fap_err make_take(fap_take **out, const reading *r, const fap_allocator *alloc)
{
    if (!r->count) {
        snprintf(r->where, FAP_ERROR_TEXT_SIZE, "no landmark in it: lines of NAME, x, y, z");
        return FAP_E_NOT_FOUND;
    }
    const fap_err err = fap_take_create(out, r->count, 1, alloc);
    for (uint32_t i = 0; err == FAP_OK && i < r->count; i++) {
        memcpy((*out)->name[i], r->found[i].name, sizeof r->found[i].name);
        memcpy((*out)->xyz[i], r->found[i].at, sizeof r->found[i].at);
        (*out)->valid[i] = 1;
    }
    return err;
}

fap_err fap_landmarks_read(fap_take **out, const void *data, size_t size, const fap_surface *scan,
                           const fap_allocator *alloc, char *where)
{
    char own[FAP_ERROR_TEXT_SIZE];
    const fap_allocator a = fap_mem_allocator(alloc);
    reading r = { .scan = scan,
                  .where = where ? where : own,
                  .found = fap_mem_calloc(&a, FAP_TAKE_MAX_POINTS + 1, sizeof *r.found) };

    *out = NULL;
    *r.where = '\0';
    fap_err err = r.found ? take_lines(&r, data, size) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = make_take(out, &r, &a);
    fap_mem_free(&a, r.found);
    return err;
}

/* --- pins --- */

/* The vertex of the skin that stands for a feature point; 0: none does. */
static int find_vertex(const fap_bank *bank, int point, uint32_t *vertex)
{
    const fap_bank_point *p = fap_bank_point_get(bank, point);
    const fap_mesh *mesh = fap_bank_mesh(bank);

    if (!p->present || !p->vertex_count)
        return 0;
    *vertex = p->vertex[0];
    return mesh->part[*vertex] == FAP_PART_SKIN;
}

static void place_of(const fap_take *t, const fap_marker_source *s, float at[3])
{
    for (int a = 0; a < 3; a++) {
        at[a] = 0;
        for (int k = 0; k < s->count; k++)
            at[a] += t->xyz[s->index[k]][a] / (float)s->count;
    }
}

fap_err fap_landmarks_pin(const fap_take *t, const fap_bank *bank, fap_pin *pin, uint32_t *count, char *where)
{
    char own[FAP_ERROR_TEXT_SIZE];
    fap_markers *map = malloc(sizeof *map);

    *count = 0;
    where = where ? where : own;
    if (!map)
        return FAP_E_NOMEM;
    const fap_err err = fap_markers_map(map, t, NULL, 0, where);
    for (int p = 0; err == FAP_OK && p < FAP_POINT_COUNT; p++) {
        uint32_t v;
        if (!map->point[p].count || map->point[p].near || !find_vertex(bank, p, &v))
            continue;
        pin[*count] = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        place_of(t, &map->point[p], pin[(*count)++].at);
    }
    free(map);
    if (err == FAP_OK && *count < 3) {
        snprintf(where, FAP_ERROR_TEXT_SIZE,
                 "%u of %u landmarks are feature points on the skin, and three are the least; name them as "
                 "in \"8.3\"",
                 (unsigned)*count, (unsigned)t->point_count);
        return FAP_E_NOT_FOUND;
    }
    return err;
}

/* --- a bank's face --- */

fap_err fap_generic_of_bank(fap_generic *out, const fap_bank *bank, const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float(*position)[3] = fap_mem_calloc(&a, mesh->vertex_count, sizeof *position);

    *out = (fap_generic){ 0 };
    if (!position)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (uint32_t axis = 0; axis < 3; axis++)
            position[i][axis] = mesh->position[axis * mesh->stride + i];
    *out = (fap_generic){ .vertex_count = mesh->vertex_count,
                          .triangle_count = mesh->triangle_count,
                          .position = (const float(*)[3])position,
                          .triangle = (const uint32_t(*)[3])mesh->triangle,
                          .part = mesh->part,
                          .mask = fap_bank_masks(bank) };
    return FAP_OK;
}

void fap_generic_free(fap_generic *g, const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);

    fap_mem_free(&a, (void *)(uintptr_t)g->position);
    *g = (fap_generic){ 0 };
}
