/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * PLY, the Stanford polygon format, as its own header describes it: ASCII, little-endian, big-endian; any order of elements
 * and properties, those that nobody knows passed over. A range_grid element, as Stanford's range images have it, says which
 * samples of the image were seen. Source: Greg Turk, The PLY Polygon File Format, 1994.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "shape/number.h"
#include "surface/surface_driver.h"

enum { MAX_ELEMENTS = 16, MAX_PROPERTIES = 64, MAX_LINE = 1024, MAX_CORNERS = 4096 };

typedef enum number_kind { I8, U8, I16, U16, I32, U32, F32, F64, KIND_COUNT } number_kind;

static const struct {
    const char *name, *other;
    uint8_t size;
} kinds[KIND_COUNT] = {
    [I8] = { "char", "int8", 1 },      [U8] = { "uchar", "uint8", 1 },     [I16] = { "short", "int16", 2 },
    [U16] = { "ushort", "uint16", 2 }, [I32] = { "int", "int32", 4 },      [U32] = { "uint", "uint32", 4 },
    [F32] = { "float", "float32", 4 }, [F64] = { "double", "float64", 8 },
};

/* What a property means to us. */
typedef enum property_role { OTHER, X, Y, Z, RED, GREEN, BLUE, ALPHA, U, V, CORNERS } property_role;

static const struct {
    const char *name;
    property_role role;
} roles[] = {
    { "x", X },
    { "y", Y },
    { "z", Z },
    { "red", RED },
    { "green", GREEN },
    { "blue", BLUE },
    { "alpha", ALPHA },
    { "diffuse_red", RED },
    { "diffuse_green", GREEN },
    { "diffuse_blue", BLUE },
    { "u", U },
    { "v", V },
    { "s", U },
    { "t", V },
    { "texture_u", U },
    { "texture_v", V },
    { "vertex_indices", CORNERS },
    { "vertex_index", CORNERS },
};

typedef struct property {
    uint8_t kind, count_kind, is_list, role;
} property;

typedef enum element_meaning { NOTHING, VERTICES, FACES, STRIPS, GRID } element_meaning;

typedef struct element {
    element_meaning meaning;
    uint64_t count;
    int property_count;
    property property[MAX_PROPERTIES];
} element;

typedef enum encoding { ASCII, LITTLE, BIG } encoding;

typedef struct ply {
    const surface_source *src;
    const uint8_t *at, *end;
    encoding encoding;
    int element_count, line;
    element element[MAX_ELEMENTS];
    uint64_t columns, rows; /* obj_info num_cols, num_rows */
    int cut;                /* the file ended too early, or a number is none */
    fap_surface *s;
    uint32_t triangle_room;
} ply;

/* --- the header --- */

static int read_line(ply *p, char line[MAX_LINE])
{
    const uint8_t *stop = memchr(p->at, '\n', (size_t)(p->end - p->at));
    size_t length;

    if (!stop)
        return 0;
    length = (size_t)(stop - p->at);
    if (length >= MAX_LINE)
        return 0;
    memcpy(line, p->at, length);
    line[length] = '\0';
    line[strcspn(line, "\r")] = '\0';
    p->at = stop + 1;
    p->line++;
    return 1;
}

static int find_kind(const char *name)
{
    for (int k = 0; k < KIND_COUNT; k++)
        if (!strcmp(name, kinds[k].name) || !strcmp(name, kinds[k].other))
            return k;
    return -1;
}

static property_role find_role(const char *name)
{
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++)
        if (!strcmp(name, roles[i].name))
            return roles[i].role;
    return OTHER;
}

static fap_err bad_line(const ply *p, const char *line)
{
    return surface_fail(p->src, FAP_E_SYNTAX, "line %d of the header, \"%.60s\", makes no sense", p->line,
                        line);
}

static fap_err take_format(ply *p, const char *line, const char *name)
{
    if (!strcmp(name, "ascii"))
        p->encoding = ASCII;
    else if (!strcmp(name, "binary_little_endian"))
        p->encoding = LITTLE;
    else if (!strcmp(name, "binary_big_endian"))
        p->encoding = BIG;
    else
        return bad_line(p, line);
    return FAP_OK;
}

static const element *find_element(const ply *p, element_meaning meaning)
{
    for (int i = 0; i < p->element_count; i++)
        if (p->element[i].meaning == meaning)
            return &p->element[i];
    return NULL;
}

static element_meaning meaning_of(const char *name)
{
    return !strcmp(name, "vertex")       ? VERTICES
           : !strcmp(name, "face")       ? FACES
           : !strcmp(name, "tristrips")  ? STRIPS
           : !strcmp(name, "range_grid") ? GRID
                                         : NOTHING;
}

static fap_err take_element(ply *p, const char *line, const char *name, const char *count)
{
    char *end;
    const unsigned long long n = strtoull(count, &end, 10);

    if (*end || *count < '0' || *count > '9')
        return bad_line(p, line);
    if (p->element_count == MAX_ELEMENTS)
        return surface_fail(p->src, FAP_E_LIMIT, "more than %d kinds of elements", MAX_ELEMENTS);
    const element_meaning meaning = meaning_of(name);
    p->element[p->element_count] =
        (element){ .count = n, .meaning = find_element(p, meaning) ? NOTHING : meaning };
    p->element_count++; /* of two of a kind the second is passed over */
    return FAP_OK;
}

static fap_err take_property(ply *p, const char *line)
{
    char a[32], b[32], c[32], name[64];
    property made = { 0 };

    if (!p->element_count)
        return bad_line(p, line);
    element *e = &p->element[p->element_count - 1];
    if (e->property_count == MAX_PROPERTIES)
        return surface_fail(p->src, FAP_E_LIMIT, "more than %d properties of one element", MAX_PROPERTIES);
    made.is_list = sscanf(line, "property list %31s %31s %63s", b, c, name) == 3;
    if (!made.is_list && sscanf(line, "property %31s %63s", a, name) != 2)
        return bad_line(p, line);
    const int kind = find_kind(made.is_list ? c : a), count_kind = made.is_list ? find_kind(b) : 0;
    if (kind < 0 || count_kind < 0)
        return bad_line(p, line);
    made.kind = (uint8_t)kind;
    made.count_kind = (uint8_t)count_kind;
    made.role = (uint8_t)find_role(name);
    e->property[e->property_count++] = made;
    return FAP_OK;
}

static fap_err take_header_line(ply *p, const char *line)
{
    char word[32] = "", first[64] = "", second[64] = "";
    const int words = sscanf(line, "%31s %63s %63s", word, first, second);

    if (!strcmp(word, "format") && words >= 2)
        return take_format(p, line, first);
    if (!strcmp(word, "element"))
        return words == 3 ? take_element(p, line, first, second) : bad_line(p, line);
    if (!strcmp(word, "property"))
        return take_property(p, line);
    if (!strcmp(word, "obj_info") && !strcmp(first, "num_cols"))
        p->columns = strtoull(second, NULL, 10);
    if (!strcmp(word, "obj_info") && !strcmp(first, "num_rows"))
        p->rows = strtoull(second, NULL, 10);
    return FAP_OK; /* comments, and what nobody knows */
}

static fap_err read_header(ply *p)
{
    char line[MAX_LINE];
    fap_err err = FAP_OK;

    while (err == FAP_OK) {
        if (!read_line(p, line))
            return surface_fail(p->src, FAP_E_SYNTAX, "line %d: the header does not end", p->line + 1);
        if (!strcmp(line, "end_header"))
            return FAP_OK;
        err = take_header_line(p, line);
    }
    return err;
}

/* --- numbers --- */

static double read_text_number(ply *p)
{
    char text[64];
    size_t length = 0;
    float value;

    while (p->at < p->end && (*p->at == ' ' || *p->at == '\t' || *p->at == '\r' || *p->at == '\n'))
        p->at++;
    while (p->at<p->end && * p->at> ' ' && length + 1 < sizeof text)
        text[length++] = (char)*p->at++;
    text[length] = '\0';
    if (!length) {
        p->cut = 1;
        return 0;
    }
    char *end;
    const long whole = strtol(text, &end, 10);
    if (!*end)
        return (double)whole;
    if (!fap_read_floats(text, &value, 1)) {
        p->cut = 1;
        return 0;
    }
    return (double)value;
}

static double of_bits(uint64_t bits, uint8_t kind)
{
    float f;
    double d;
    const uint32_t low = (uint32_t)bits;

    switch (kind) {
    case I8: return (int8_t)low;
    case I16: return (int16_t)low;
    case I32: return (int32_t)low;
    case F32: memcpy(&f, &low, sizeof f); return (double)f;
    case F64: memcpy(&d, &bits, sizeof d); return d;
    default: return (double)low;
    }
}

static double read_number(ply *p, uint8_t kind)
{
    const uint8_t size = kinds[kind].size;
    uint64_t bits = 0;

    if (p->encoding == ASCII)
        return read_text_number(p);
    if ((size_t)(p->end - p->at) < size) {
        p->cut = 1;
        p->at = p->end;
        return 0;
    }
    for (uint8_t i = 0; i < size; i++)
        bits |= (uint64_t)p->at[i] << (8 * (p->encoding == LITTLE ? i : size - 1 - i));
    p->at += size;
    return of_bits(bits, kind);
}

/* A number that counts or names something; what is none of these is past every limit. */
static uint32_t read_index(ply *p, uint8_t kind)
{
    const double value = read_number(p, kind);
    return value >= 0 && value < 4294967295.0 ? (uint32_t)value : UINT32_MAX;
}

/* --- vertices --- */

/* Whole numbers count to 255, or to their own end; fractions to 1. */
static uint8_t shade(double value, uint8_t kind)
{
    if (kind == F32 || kind == F64)
        value *= 255;
    else if (kind == U16)
        value /= 257;
    return (uint8_t)(value > 255 ? 255 : value > 0 ? value + 0.5 : 0);
}

static void take_vertex_number(fap_surface *s, uint32_t v, const property *q, double value)
{
    switch (q->role) {
    case X:
    case Y:
    case Z: s->position[v][q->role - X] = (float)value; break;
    case RED:
    case GREEN:
    case BLUE:
    case ALPHA: s->colour[v][q->role - RED] = shade(value, q->kind); break;
    case U:
    case V: s->uv[v][q->role - U] = (float)value; break;
    default: break;
    }
}

static void skip_list(ply *p, const property *q)
{
    const uint32_t count = read_index(p, q->count_kind);

    for (uint32_t i = 0; i < count && !p->cut; i++)
        read_number(p, q->kind);
}

static int has_role(const element *e, property_role role)
{
    for (int i = 0; i < e->property_count; i++)
        if (e->property[i].role == role && !e->property[i].is_list)
            return 1;
    return 0;
}

static fap_err make_vertex_room(ply *p, const element *e)
{
    if (has_role(e, RED) && !surface_want_colour(p->s))
        return FAP_E_NOMEM;
    if (has_role(e, U) && has_role(e, V) && !surface_want_uv(p->s))
        return FAP_E_NOMEM;
    for (uint32_t i = 0; p->s->colour && i < p->s->vertex_count; i++)
        p->s->colour[i][3] = 255;
    return FAP_OK;
}

static int wanted(const fap_surface *s, const property *q)
{
    return (q->role < RED || s->colour || q->role > ALPHA) && (q->role < U || s->uv);
}

static fap_err read_vertices(ply *p, const element *e)
{
    const fap_err err = make_vertex_room(p, e);

    for (uint32_t v = 0; err == FAP_OK && v < e->count && !p->cut; v++)
        for (int i = 0; i < e->property_count; i++) {
            const property *q = &e->property[i];
            if (q->is_list) {
                skip_list(p, q);
                continue;
            }
            const double value = read_number(p, q->kind);
            if (wanted(p->s, q))
                take_vertex_number(p->s, v, q, value);
        }
    return err;
}

/* --- faces --- */

static int add_triangle(ply *p, uint32_t a, uint32_t b, uint32_t c)
{
    fap_surface *s = p->s;

    if (s->triangle_count == p->triangle_room) {
        const uint32_t room = 2 * p->triangle_room + 1024;
        uint32_t(*grown)[3] = s->triangle_count < FAP_SURFACE_MAX_TRIANGLES
                                  ? fap_mem_calloc(&s->alloc, room, sizeof *grown)
                                  : NULL;
        if (!grown)
            return 0;
        memcpy(grown, s->triangle, s->triangle_count * sizeof *grown);
        fap_mem_free(&s->alloc, s->triangle);
        s->triangle = grown;
        p->triangle_room = room;
    }
    uint32_t *t = s->triangle[s->triangle_count++];
    t[0] = a, t[1] = b, t[2] = c;
    return 1;
}

/* A polygon as a fan, its corners as they come. */
static int read_polygon(ply *p, const property *q)
{
    const uint32_t count = read_index(p, q->count_kind);
    uint32_t first = 0, last = 0;

    if (count > MAX_CORNERS)
        p->cut = 1;
    for (uint32_t i = 0; i < count && !p->cut; i++) {
        const uint32_t v = read_index(p, q->kind);
        if (i == 0)
            first = v;
        if (i >= 2 && !add_triangle(p, first, last, v))
            return 0;
        last = v;
    }
    return 1;
}

/* Strips turn at every triangle; a negative number begins the next one. */
static int read_strip(ply *p, const property *q)
{
    const uint32_t count = read_index(p, q->count_kind);
    uint32_t a = 0, b = 0, length = 0;

    for (uint32_t i = 0; i < count && !p->cut; i++) {
        const uint32_t v = read_index(p, q->kind);
        if (v == UINT32_MAX) {
            length = 0;
            continue;
        }
        if (length >= 2 && !(length & 1 ? add_triangle(p, b, a, v) : add_triangle(p, a, b, v)))
            return 0;
        a = b, b = v, length++;
    }
    return 1;
}

static fap_err read_faces(ply *p, const element *e)
{
    for (uint64_t f = 0; f < e->count && !p->cut; f++)
        for (int i = 0; i < e->property_count; i++) {
            const property *q = &e->property[i];
            const int ok = !q->is_list           ? (read_number(p, q->kind), 1)
                           : q->role != CORNERS  ? (skip_list(p, q), 1)
                           : e->meaning == FACES ? read_polygon(p, q)
                                                 : read_strip(p, q);
            if (!ok)
                return p->s->triangle_count < FAP_SURFACE_MAX_TRIANGLES ? FAP_E_NOMEM : FAP_E_LIMIT;
        }
    return FAP_OK;
}

/* --- range images --- */

static fap_err read_grid(ply *p, const element *e)
{
    fap_surface *s = p->s;

    if (!e->property_count || !e->property[0].is_list || p->columns * p->rows != e->count ||
        p->columns > e->count)
        return surface_fail(p->src, FAP_E_DATA,
                            "range_grid: obj_info num_cols and num_rows do not give its size");
    s->grid = fap_mem_calloc(&s->alloc, (size_t)e->count, sizeof *s->grid);
    if (!s->grid)
        return FAP_E_NOMEM;
    s->columns = (uint32_t)p->columns;
    s->rows = (uint32_t)p->rows;
    for (uint64_t i = 0; i < e->count && !p->cut; i++) {
        const uint32_t count = read_index(p, e->property[0].count_kind);
        s->grid[i] = count ? read_index(p, e->property[0].kind) : UINT32_MAX;
        for (uint32_t k = 1; k < count && !p->cut; k++)
            read_number(p, e->property[0].kind);
        if (s->grid[i] >= s->vertex_count && s->grid[i] != UINT32_MAX)
            return surface_fail(p->src, FAP_E_DATA, "range_grid: sample %llu names no vertex",
                                (unsigned long long)i + 1);
    }
    return FAP_OK;
}

static int grid_link(ply *p, uint32_t a, uint32_t b, uint32_t c)
{
    return a == UINT32_MAX || b == UINT32_MAX || c == UINT32_MAX || add_triangle(p, a, b, c);
}

/* An image without faces of its own: neighbours are joined. Rows run down, columns to the right. */
static fap_err mesh_grid(ply *p)
{
    const fap_surface *s = p->s;

    for (uint32_t y = 0; y + 1 < s->rows; y++)
        for (uint32_t x = 0; x + 1 < s->columns; x++) {
            const uint32_t *up = s->grid + (size_t)y * s->columns + x, *down = up + s->columns;
            if (!grid_link(p, up[0], down[0], down[1]) || !grid_link(p, up[0], down[1], up[1]))
                return FAP_E_NOMEM;
        }
    return FAP_OK;
}

/* --- the whole --- */

/* Bytes that an element cannot do without. */
static uint64_t least_bytes(const ply *p, const element *e)
{
    uint64_t bytes = 0;

    for (int i = 0; i < e->property_count; i++) {
        const property *q = &e->property[i];
        bytes += p->encoding == ASCII ? 2 : kinds[q->is_list ? q->count_kind : q->kind].size;
    }
    return bytes;
}

static fap_err check_sizes(const ply *p)
{
    const element *vertices = find_element(p, VERTICES), *faces = find_element(p, FACES);
    const uint64_t left = (uint64_t)(p->end - p->at) + 1;

    if (!vertices || !has_role(vertices, X) || !has_role(vertices, Y) || !has_role(vertices, Z))
        return surface_fail(p->src, FAP_E_DATA, "no element \"vertex\" with x, y and z");
    for (int i = 0; i < p->element_count; i++) {
        const uint64_t least = least_bytes(p, &p->element[i]);
        if (!least || p->element[i].count > left / least)
            return surface_fail(p->src, FAP_E_DATA,
                                "element %d has %llu rows, more than the file has bytes for", i + 1,
                                (unsigned long long)p->element[i].count);
    }
    return surface_check_counts(p->src, vertices->count, faces ? faces->count : 0);
}

static fap_err read_element(ply *p, const element *e)
{
    switch (e->meaning) {
    case VERTICES: return read_vertices(p, e);
    case FACES:
    case STRIPS: return read_faces(p, e);
    case GRID: return read_grid(p, e);
    default: break;
    }
    for (uint64_t i = 0; i < e->count && !p->cut; i++)
        for (int k = 0; k < e->property_count; k++)
            if (e->property[k].is_list)
                skip_list(p, &e->property[k]);
            else
                read_number(p, e->property[k].kind);
    return FAP_OK;
}

static fap_err read_body(ply *p)
{
    fap_err err = FAP_OK;

    for (int i = 0; i < p->element_count && err == FAP_OK; i++) {
        err = read_element(p, &p->element[i]);
        if (err == FAP_OK && p->cut)
            err = surface_fail(p->src, FAP_E_DATA, "the file ends, or has no number, in element %d of %d",
                               i + 1, p->element_count);
    }
    if (err == FAP_OK && p->s->grid && !p->s->triangle_count)
        err = mesh_grid(p);
    return err;
}

static fap_err read(const surface_source *src, fap_surface **out)
{
    ply p = { .src = src, .at = src->data, .end = src->data + src->size };

    fap_err err = read_header(&p);
    if (err == FAP_OK)
        err = check_sizes(&p);
    if (err != FAP_OK)
        return err;
    err = fap_surface_create(&p.s, (uint32_t)find_element(&p, VERTICES)->count, 0, src->alloc);
    if (err != FAP_OK)
        return err;
    err = read_body(&p);
    *out = p.s;
    return err;
}

static int sniff(const uint8_t *data, size_t size)
{
    return size > 4 && !memcmp(data, "ply", 3) && (data[3] == '\n' || data[3] == '\r');
}

const surface_driver surface_driver_ply = { "ply", sniff, read };
