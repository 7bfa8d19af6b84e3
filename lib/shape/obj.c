/* SPDX-License-Identifier: BSD-2-Clause */
/* See obj.h. Two passes: one counts, so that memory is bounded by the file's own size; one fills. */
#include <stdlib.h>
#include <string.h>

#include "shape/number.h"
#include "shape/obj.h"

enum { MAX_CORNERS = 64, MAX_LINES = 1 << 24, MAX_GROUPS = 4096 };

typedef struct reader {
    fap_obj *obj;
    int filling; /* second pass */
    uint32_t group;
    int bad;
} reader;

static const char *skip_blanks(const char *p)
{
    while (*p == ' ' || *p == '\t')
        p++;
    return p;
}

/* One based, or counted back from the last one read so far. */
static int resolve(long index, uint32_t count, uint32_t *out)
{
    const long zero_based = index > 0 ? index - 1 : (long)count + index;

    *out = (uint32_t)zero_based;
    return index != 0 && zero_based >= 0 && zero_based < (long)count;
}

/* "v", "v/vt", "v//vn" or "v/vt/vn". @return what follows, NULL where it is none of them. */
static const char *read_corner(const fap_obj *o, const char *p, uint32_t *vertex, uint32_t *uv)
{
    char *end;
    const long v = strtol(p, &end, 10);

    *uv = FAP_OBJ_NO_UV;
    if (end == p || !resolve(v, o->position_count, vertex))
        return NULL;
    p = end;
    if (*p == '/' && p[1] != '/') {
        const long t = strtol(p + 1, &end, 10);
        if (end == p + 1 || !resolve(t, o->uv_count, uv))
            return NULL;
        p = end;
    }
    if (*p == '/') {
        p += p[1] == '/' ? 2 : 1;
        strtol(p, &end, 10);
        if (end == p)
            return NULL;
        p = end;
    }
    return p;
}

static void take_face(reader *r, const char *p)
{
    fap_obj *o = r->obj;
    uint32_t count = 0;

    for (p = skip_blanks(p); *p && *p != '\r' && *p != '\n' && *p != '#'; p = skip_blanks(p)) {
        uint32_t vertex, uv;
        p = read_corner(o, p, &vertex, &uv);
        if (!p || count == MAX_CORNERS) {
            r->bad = 1;
            return;
        }
        if (r->filling) {
            o->vertex[o->corner_count + count] = vertex;
            o->corner_uv[o->corner_count + count] = uv;
        }
        count++;
    }
    if (count < 3)
        r->bad = 1;
    if (r->filling)
        o->face[o->face_count] = (fap_obj_face){ o->corner_count, count, r->group };
    o->corner_count += count;
    o->face_count++;
}

static void take_group(reader *r, const char *p)
{
    fap_obj *o = r->obj;
    char name[sizeof *o->group] = { 0 };

    p = skip_blanks(p);
    strncpy(name, p, sizeof name - 1);
    name[strcspn(name, " \t\r\n")] = '\0';
    if (!r->filling) {
        if (++o->group_count > MAX_GROUPS)
            r->bad = 1;
        return;
    }
    r->group = fap_obj_group(o, name);
    if (r->group == UINT32_MAX) {
        r->group = o->group_count++;
        memcpy(o->group[r->group], name, sizeof name);
    }
}

static int is_word(const char *line, const char *word, size_t length)
{
    return !strncmp(line, word, length) && (line[length] == ' ' || line[length] == '\t');
}

static void take_line(reader *r, const char *p)
{
    fap_obj *o = r->obj;
    float v[3];

    p = skip_blanks(p);
    if (is_word(p, "v", 1)) {
        r->bad |= !fap_read_floats(p + 1, v, 3);
        if (r->filling && !r->bad)
            memcpy(o->position[o->position_count], v, sizeof v);
        o->position_count++;
    } else if (is_word(p, "vt", 2)) {
        r->bad |= !fap_read_floats(p + 2, v, 2);
        if (r->filling && !r->bad)
            memcpy(o->uv[o->uv_count], v, 2 * sizeof *v);
        o->uv_count++;
    } else if (is_word(p, "f", 1)) {
        take_face(r, p + 1);
    } else if (is_word(p, "g", 1)) {
        take_group(r, p + 1);
    }
}

/* @return the number of the bad line, 0: none */
static int run(reader *r, const char *text)
{
    for (int line = 1; *text; line++) {
        take_line(r, text);
        if (r->bad || line == MAX_LINES)
            return line;
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    return 0;
}

static int allocate(fap_obj *o)
{
    o->position = calloc(o->position_count + 1u, sizeof *o->position);
    o->uv = calloc(o->uv_count + 1u, sizeof *o->uv);
    o->face = calloc(o->face_count + 1u, sizeof *o->face);
    o->vertex = calloc(o->corner_count + 1u, sizeof *o->vertex);
    o->corner_uv = calloc(o->corner_count + 1u, sizeof *o->corner_uv);
    o->group = calloc(o->group_count + 1u, sizeof *o->group);
    return o->position && o->uv && o->face && o->vertex && o->corner_uv && o->group;
}

fap_err fap_obj_parse(fap_obj *obj, const char *text, size_t size, int *line)
{
    *obj = (fap_obj){ 0 };
    reader count = { .obj = obj }, fill = { .obj = obj, .filling = 1 };

    const int bad_line = memchr(text, '\0', size) ? 1 : run(&count, text);
    if (line)
        *line = bad_line;
    if (bad_line)
        return FAP_E_SYNTAX;
    if (!allocate(obj)) {
        fap_obj_free(obj);
        return FAP_E_NOMEM;
    }
    obj->position_count = obj->uv_count = obj->face_count = obj->corner_count = 0;
    obj->group_count = 1;
    run(&fill, text); /* the first pass has found every line good */
    return FAP_OK;
}

void fap_obj_free(fap_obj *o)
{
    free(o->position);
    free(o->uv);
    free(o->face);
    free(o->vertex);
    free(o->corner_uv);
    free(o->group);
    *o = (fap_obj){ 0 };
}

uint32_t fap_obj_group(const fap_obj *o, const char *name)
{
    for (uint32_t g = 0; g < o->group_count; g++)
        if (!strcmp(o->group[g], name))
            return g;
    return UINT32_MAX;
}
