/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Binary glTF (GLB): the triangles of the scene's nodes where their transforms put them, texture coordinates, colours, morph targets
 * with the names that exporters leave in extras.targetNames. Two walks over the scene: one counts, one fills. No library: cgltf is
 * not in Debian, and the little that a face needs is read here under the bounds that every byte is held to. Source: Khronos,
 * glTF 2.0 specification.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "surface/surface_driver.h"
#include "take/json_text.h"

enum { HEAD = 12, CHUNK_HEAD = 8, JSON_CHUNK = 0x4E4F534A, BIN_CHUNK = 0x004E4942 };
enum { MOST_ITEMS = 1 << 16, MOST_VISITS = 1 << 16, MOST_DEPTH = 64, TRIANGLES = 4, STRIP = 5, FAN = 6 };
enum { I8 = 5120, U8, I16, U16, U32 = 5125, F32 };

typedef struct view {
    uint64_t offset, length, stride;
} view;

typedef struct accessor {
    int view, sparse_indices, sparse_values; /* -1: none */
    uint64_t offset, count, sparse_count, sparse_indices_offset, sparse_values_offset;
    int type, sparse_type, width, normalized;
} accessor;

typedef struct primitive {
    int mesh, position, uv, colour, indices, mode;
    json_text targets; /* at the array; end where there is none */
} primitive;

typedef struct node {
    int mesh;
    double matrix[16]; /* columns */
    json_text children;
} node;

typedef struct gltf {
    const surface_source *src;
    const uint8_t *bin;
    uint64_t bin_size;
    json_text views_text, accessors_text, meshes_text, nodes_text, scenes_text, required_text;
    int scene;
    view *view;
    accessor *accessor;
    primitive *primitive;
    node *node;
    int view_count, accessor_count, primitive_count, node_count, mesh_count;
    json_text *names; /* [mesh_count] extras.targetNames */
    /* What the first walk counts and the second fills. */
    fap_surface *s;
    uint64_t vertices, triangles;
    uint32_t targets;
    int visits, filling;
    fap_err err;
} gltf;

static void stop(gltf *g, fap_err err, const char *why)
{
    if (g->err == FAP_OK)
        g->err = surface_fail(g->src, err, "%s", why);
}

static uint32_t read_32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* --- JSON --- */

static int same(text key, const char *word)
{
    return key.length == strlen(word) && !memcmp(key.start, word, key.length);
}

static int is_there(const json_text *j)
{
    return j->at < j->end && !j->bad;
}

static uint64_t whole(json_text *j)
{
    double v = 0;
    json_text_number(j, &v);
    return v >= 0 && v < 9e15 ? (uint64_t)v : UINT64_MAX;
}

static int index_of(json_text *j)
{
    const uint64_t v = whole(j);
    return v < MOST_ITEMS ? (int)v : -1;
}

/* A value for later: where it begins; the reader goes on behind it. */
static json_text keep(json_text *j)
{
    json_text here = *j;

    json_text_skip(j);
    here.end = j->at;
    return here;
}

static int count_items(json_text j)
{
    int count = 0, first = 1;

    if (!is_there(&j) || !json_text_enter(&j, '['))
        return 0;
    while (json_text_next(&j, ']', &first) && count <= MOST_ITEMS) {
        json_text_skip(&j);
        count++;
    }
    return count;
}

static void read_top(gltf *g, json_text j)
{
    int first = 1;
    text key;

    if (!json_text_enter(&j, '{'))
        return stop(g, FAP_E_SYNTAX, "its JSON is no object");
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (same(key, "bufferViews"))
            g->views_text = keep(&j);
        else if (same(key, "accessors"))
            g->accessors_text = keep(&j);
        else if (same(key, "meshes"))
            g->meshes_text = keep(&j);
        else if (same(key, "nodes"))
            g->nodes_text = keep(&j);
        else if (same(key, "scenes"))
            g->scenes_text = keep(&j);
        else if (same(key, "extensionsRequired"))
            g->required_text = keep(&j);
        else if (same(key, "scene"))
            g->scene = index_of(&j);
        else
            json_text_skip(&j);
    }
    if (j.bad)
        stop(g, FAP_E_SYNTAX, "its JSON is damaged");
}

static void refuse_packed(gltf *g)
{
    json_text j = g->required_text;
    int first = 1;
    text name;

    if (!is_there(&j) || !json_text_enter(&j, '['))
        return;
    while (json_text_next(&j, ']', &first) && json_text_string(&j, &name))
        if (same(name, "KHR_draco_mesh_compression") || same(name, "EXT_meshopt_compression"))
            stop(g, FAP_E_UNSUPPORTED,
                 "its meshes are packed (Draco or meshopt); export it without compression");
}

/* --- views and accessors --- */

static void read_view(gltf *g, json_text *j)
{
    view *v = &g->view[g->view_count++];
    int first = 1;
    text key;

    *v = (view){ 0 };
    uint64_t buffer = 0;
    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "buffer"))
            buffer = whole(j);
        else if (same(key, "byteOffset"))
            v->offset = whole(j);
        else if (same(key, "byteLength"))
            v->length = whole(j);
        else if (same(key, "byteStride"))
            v->stride = whole(j);
        else
            json_text_skip(j);
    }
    if (buffer || v->length > g->bin_size || v->offset > g->bin_size - v->length || v->stride > 255)
        v->length = 0; /* of another file, or outside: nothing can be read from it */
}

static int width_of(text type)
{
    static const char *const names[] = { "SCALAR", "VEC2", "VEC3", "VEC4" };

    for (int i = 0; i < 4; i++)
        if (same(type, names[i]))
            return i + 1;
    return 0;
}

static void read_sparse_part(json_text *j, int *at_view, uint64_t *offset, int *type)
{
    int first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "bufferView"))
            *at_view = index_of(j);
        else if (same(key, "byteOffset"))
            *offset = whole(j);
        else if (type && same(key, "componentType"))
            *type = index_of(j);
        else
            json_text_skip(j);
    }
}

static void read_sparse(accessor *a, json_text *j)
{
    int first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "count"))
            a->sparse_count = whole(j);
        else if (same(key, "indices"))
            read_sparse_part(j, &a->sparse_indices, &a->sparse_indices_offset, &a->sparse_type);
        else if (same(key, "values"))
            read_sparse_part(j, &a->sparse_values, &a->sparse_values_offset, NULL);
        else
            json_text_skip(j);
    }
}

static void read_accessor(gltf *g, json_text *j)
{
    accessor *a = &g->accessor[g->accessor_count++];
    int first = 1;
    text key, type;

    *a = (accessor){ .view = -1, .sparse_indices = -1, .sparse_values = -1 };
    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "bufferView"))
            a->view = index_of(j);
        else if (same(key, "byteOffset"))
            a->offset = whole(j);
        else if (same(key, "count"))
            a->count = whole(j);
        else if (same(key, "componentType"))
            a->type = index_of(j);
        else if (same(key, "type") && json_text_string(j, &type))
            a->width = width_of(type);
        else if (same(key, "sparse"))
            read_sparse(a, j);
        else
            json_text_skip(j);
    }
}

static uint64_t size_of(int type)
{
    return type == I8 || type == U8 ? 1 : type == I16 || type == U16 ? 2 : type == U32 || type == F32 ? 4 : 0;
}

/* What may number things. */
static int counts(int type)
{
    return type == U8 || type == U16 || type == U32;
}

static double component(int type, const uint8_t *p)
{
    float f;
    uint32_t bits;

    switch (type) {
    case I8: return (int8_t)p[0];
    case U8: return p[0];
    case I16: return (int16_t)(p[0] | p[1] << 8);
    case U16: return p[0] | p[1] << 8;
    case U32: return read_32(p);
    default:
        bits = read_32(p);
        memcpy(&f, &bits, sizeof f);
        return (double)f;
    }
}

/* Bytes of @p count elements of @p size, @p stride apart, from @p offset of a view; NULL: not all of them are there. */
static const uint8_t *reach(const gltf *g, int at_view, uint64_t offset, uint64_t count, uint64_t size,
                            uint64_t stride)
{
    if (at_view < 0 || at_view >= g->view_count || !count || !size)
        return NULL;
    const view *v = &g->view[at_view];
    if (count > (uint64_t)1 << 32 || offset > v->length || (count - 1) * stride + size > v->length - offset)
        return NULL;
    return g->bin + v->offset + offset;
}

/* What an accessor gives, element by element. */
typedef struct column {
    const accessor *a;
    const uint8_t *base, *indices, *values; /* NULL: zeroes; not sparse */
    uint64_t stride, size;
    uint64_t next; /* of the sparse elements: those in front are behind us */
} column;

/* 0: it does not say what it should, or not within the file. @p width: 0: any. */
static int open_column(const gltf *g, column *c, int index, int width)
{
    if (index < 0 || index >= g->accessor_count)
        return 0;
    const accessor *a = &g->accessor[index];
    *c = (column){ .a = a, .size = size_of(a->type) * (uint64_t)a->width };
    if (!c->size || !a->count || a->count > FAP_SURFACE_MAX_TRIANGLES * 3ull || (width && a->width != width))
        return 0;
    if (a->view >= 0) {
        c->stride = a->view < g->view_count && g->view[a->view].stride ? g->view[a->view].stride : c->size;
        c->base = reach(g, a->view, a->offset, a->count, c->size, c->stride);
        if (!c->base)
            return 0;
    } else if (!a->sparse_count)
        return 0;
    if (a->sparse_count) {
        const uint64_t size = size_of(a->sparse_type);
        c->indices = !counts(a->sparse_type)
                         ? NULL
                         : reach(g, a->sparse_indices, a->sparse_indices_offset, a->sparse_count, size, size);
        c->values = reach(g, a->sparse_values, a->sparse_values_offset, a->sparse_count, c->size, c->size);
        return c->indices && c->values && a->sparse_count <= a->count;
    }
    return 1;
}

/* Elements are asked for in ascending order, as sparse ones are stored. */
static void element(column *c, uint64_t i, double *out)
{
    const accessor *a = c->a;
    const uint64_t each = size_of(a->type), index_size = size_of(a->sparse_type);
    const uint8_t *p = c->base ? c->base + i * c->stride : NULL;

    while (c->indices && c->next < a->sparse_count &&
           component(a->sparse_type, c->indices + c->next * index_size) < (double)i)
        c->next++;
    if (c->indices && c->next < a->sparse_count &&
        component(a->sparse_type, c->indices + c->next * index_size) == (double)i)
        p = c->values + c->next * c->size;
    for (int k = 0; k < a->width; k++)
        out[k] = p ? component(a->type, p + (uint64_t)k * each) : 0;
}

/* Whole numbers that stand for 0 to 1. */
static double unit(const accessor *a, double v)
{
    return a->type == U8 ? v / 255 : a->type == U16 ? v / 65535 : v;
}

/* --- meshes and nodes --- */

static void read_attributes(primitive *p, json_text *j)
{
    int first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "POSITION"))
            p->position = index_of(j);
        else if (same(key, "TEXCOORD_0"))
            p->uv = index_of(j);
        else if (same(key, "COLOR_0"))
            p->colour = index_of(j);
        else
            json_text_skip(j);
    }
}

static void read_primitive(gltf *g, json_text *j, int mesh)
{
    primitive *p = &g->primitive[g->primitive_count++];
    int first = 1;
    text key;

    *p =
        (primitive){ .mesh = mesh, .position = -1, .uv = -1, .colour = -1, .indices = -1, .mode = TRIANGLES };
    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "attributes"))
            read_attributes(p, j);
        else if (same(key, "indices"))
            p->indices = index_of(j);
        else if (same(key, "mode"))
            p->mode = index_of(j);
        else if (same(key, "targets"))
            p->targets = keep(j);
        else
            json_text_skip(j);
    }
}

static void read_extras(gltf *g, json_text *j, int mesh)
{
    json_text extras = keep(j);
    int first = 1;
    text key;

    if (!json_text_enter(&extras, '{'))
        return;
    while (json_text_next(&extras, '}', &first) && json_text_key(&extras, &key)) {
        if (same(key, "targetNames"))
            g->names[mesh] = keep(&extras);
        else
            json_text_skip(&extras);
    }
}

static void read_mesh(gltf *g, json_text *j, int room)
{
    const int mesh = g->mesh_count++;
    int first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        int one = 1;
        if (same(key, "extras"))
            read_extras(g, j, mesh);
        else if (!same(key, "primitives"))
            json_text_skip(j);
        else if (json_text_enter(j, '['))
            while (json_text_next(j, ']', &one)) {
                if (g->primitive_count < room)
                    read_primitive(g, j, mesh);
                else
                    json_text_skip(j);
            }
    }
}

static int read_numbers(json_text *j, double *out, int count)
{
    int n = 0, first = 1;

    if (!json_text_enter(j, '['))
        return 0;
    while (json_text_next(j, ']', &first)) {
        double v = 0;
        json_text_number(j, &v);
        if (n < count)
            out[n] = v;
        n++;
    }
    return n == count;
}

/* Translation, rotation (a quaternion, w last) and scale as a matrix. */
static void compose(const double t[3], const double q[4], const double s[3], double m[16])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double r[9] = { 1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
                          2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                          2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y) };

    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 4; a++)
            m[4 * c + a] = a < 3 ? r[3 * c + a] * s[c] : 0;
    m[12] = t[0], m[13] = t[1], m[14] = t[2], m[15] = 1;
}

static void read_node(gltf *g, json_text *j)
{
    node *n = &g->node[g->node_count++];
    double t[3] = { 0 }, q[4] = { 0, 0, 0, 1 }, s[3] = { 1, 1, 1 };
    int first = 1, has_matrix = 0;
    text key;

    *n = (node){ .mesh = -1 };
    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same(key, "mesh"))
            n->mesh = index_of(j);
        else if (same(key, "children"))
            n->children = keep(j);
        else if (same(key, "matrix"))
            has_matrix = read_numbers(j, n->matrix, 16);
        else if (same(key, "translation"))
            read_numbers(j, t, 3);
        else if (same(key, "rotation"))
            read_numbers(j, q, 4);
        else if (same(key, "scale"))
            read_numbers(j, s, 3);
        else
            json_text_skip(j);
    }
    if (!has_matrix)
        compose(t, q, s, n->matrix);
}

/* --- the walk --- */

/* The number of a target in the surface: by its name, so that eyes and skin that share one share it. */
static uint32_t target_of(gltf *g, const primitive *p, uint32_t number)
{
    json_text names = g->names[p->mesh];
    char name[FAP_SURFACE_NAME_SIZE] = "";
    int first = 1;
    text t;

    if (is_there(&names) && json_text_enter(&names, '['))
        for (uint32_t i = 0; json_text_next(&names, ']', &first) && json_text_string(&names, &t); i++)
            if (i == number) {
                const size_t length = t.length < sizeof name - 1 ? t.length : sizeof name - 1;
                memcpy(name, t.start, length);
                name[length] = '\0';
            }
    for (uint32_t i = 0; *name && i < g->s->target_count; i++)
        if (!strcmp(g->s->target[i].name, name))
            return i;
    for (uint32_t i = 0; *name && i < g->s->target_count; i++)
        if (!*g->s->target[i].name) {
            memcpy(g->s->target[i].name, name, sizeof name);
            return i;
        }
    return number < g->s->target_count ? number : 0;
}

static void place(const double m[16], const double v[3], int with_shift, float out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = (float)(m[a] * v[0] + m[4 + a] * v[1] + m[8 + a] * v[2] + (with_shift ? m[12 + a] : 0));
}

static void fill_target(gltf *g, const primitive *p, const double m[16], int index, uint32_t number,
                        uint64_t vertices)
{
    column c;

    if (!open_column(g, &c, index, 3) || c.a->count != vertices)
        return;
    float(*delta)[3] = g->s->target[target_of(g, p, number)].delta;
    for (uint64_t i = 0; i < vertices; i++) {
        double v[4];
        element(&c, i, v);
        place(m, v, 0, delta[g->vertices + i]);
    }
}

/* Every target of a primitive; in the first walk their number. */
static uint32_t walk_targets(gltf *g, const primitive *p, const double m[16], uint64_t vertices)
{
    json_text j = p->targets;
    uint32_t number = 0;
    int first = 1;

    if (!is_there(&j) || !json_text_enter(&j, '['))
        return 0;
    for (; json_text_next(&j, ']', &first) && number < FAP_SURFACE_MAX_TARGETS; number++) {
        primitive t = { .position = -1 };
        read_attributes(&t, &j);
        if (g->filling)
            fill_target(g, p, m, t.position, number, vertices);
    }
    return number;
}

static void fill_triangles(gltf *g, const primitive *p, uint64_t vertices, uint64_t corners)
{
    column c = { 0 };
    const int indexed = p->indices >= 0 && open_column(g, &c, p->indices, 1);
    uint32_t three[3] = { 0 };

    for (uint64_t i = 0; i < corners; i++) {
        double v[4] = { (double)i };
        if (indexed)
            element(&c, i, v);
        /* An index past the end names no vertex: whoever called refuses it. */
        const uint32_t at = v[0] < (double)vertices ? (uint32_t)(g->vertices + (uint64_t)v[0]) : UINT32_MAX;
        if (p->mode == TRIANGLES) {
            three[i % 3] = at;
        } else if (i < 3) {
            three[i] = at;
        } else {
            three[p->mode == FAN ? 1 : 0] = p->mode == FAN ? three[2] : three[1];
            if (p->mode == STRIP)
                three[1] = three[2];
            three[2] = at;
        }
        if (p->mode == TRIANGLES ? i % 3 != 2 : i < 2)
            continue;
        uint32_t *t = g->s->triangle[g->triangles++];
        memcpy(t, three, sizeof three);
        if (p->mode == STRIP && i % 2) { /* every second one turns the other way */
            t[0] = three[1];
            t[1] = three[0];
        }
    }
}

static void fill_vertices(gltf *g, const primitive *p, const double m[16], uint64_t vertices)
{
    column at, uv, colour;
    const int has_uv = g->s->uv && open_column(g, &uv, p->uv, 2) && uv.a->count == vertices;
    const int has_colour = g->s->colour && open_column(g, &colour, p->colour, 0) &&
                           colour.a->count == vertices && colour.a->width >= 3;
    double v[4];

    if (!open_column(g, &at, p->position, 3))
        return;
    for (uint64_t i = 0; i < vertices; i++) {
        element(&at, i, v);
        place(m, v, 1, g->s->position[g->vertices + i]);
        if (has_uv) {
            element(&uv, i, v);
            g->s->uv[g->vertices + i][0] = (float)unit(uv.a, v[0]);
            g->s->uv[g->vertices + i][1] =
                (float)(1 - unit(uv.a, v[1])); /* from the top in glTF, from below here */
        }
        v[3] = 1;
        if (has_colour)
            element(&colour, i, v);
        for (int k = 0; has_colour && k < 4; k++) {
            const double shade = k < colour.a->width ? unit(colour.a, v[k]) : 1;
            g->s->colour[g->vertices + i][k] = (uint8_t)(255 * fmin(1, fmax(0, shade)) + 0.5);
        }
    }
}

static void walk_primitive(gltf *g, const primitive *p, const double m[16])
{
    column at, corner;

    if (p->mode < TRIANGLES || p->mode > FAN || p->position < 0)
        return; /* points and lines */
    if (!open_column(g, &at, p->position, 3))
        return stop(g, FAP_E_DATA, "positions are not within the file; buffers must be in the GLB itself");
    uint64_t corners = at.a->count;
    if (p->indices >= 0) {
        if (!open_column(g, &corner, p->indices, 1) || !counts(corner.a->type))
            return stop(g, FAP_E_DATA, "indices of triangles are not within the file");
        corners = corner.a->count;
    }
    if (g->filling) {
        fill_vertices(g, p, m, at.a->count);
        fill_triangles(g, p, at.a->count, corners);
    } else
        g->triangles += p->mode == TRIANGLES ? corners / 3 : corners > 2 ? corners - 2 : 0;
    const uint32_t targets = walk_targets(g, p, m, at.a->count);
    g->targets = targets > g->targets ? targets : g->targets;
    g->vertices += at.a->count;
    if (g->vertices > FAP_SURFACE_MAX_VERTICES || g->triangles > FAP_SURFACE_MAX_TRIANGLES)
        stop(g, FAP_E_LIMIT, "more vertices or triangles than are read");
}

static void multiply(const double a[16], const double b[16], double out[16])
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) {
            out[4 * c + r] = 0;
            for (int k = 0; k < 4; k++)
                out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
        }
}

/* A scene is no tree by force: depth and visits are limited, circles end there. */
static void walk_node(gltf *g, int index, const double above[16], int depth)
{
    double m[16];
    int first = 1;

    if (index < 0 || index >= g->node_count || g->err != FAP_OK)
        return;
    if (depth == MOST_DEPTH || ++g->visits > MOST_VISITS)
        return stop(g, FAP_E_LIMIT, "its nodes are too many, or go round in a circle");
    const node *n = &g->node[index];
    multiply(above, n->matrix, m);
    for (int p = 0; n->mesh >= 0 && p < g->primitive_count && g->err == FAP_OK; p++)
        if (g->primitive[p].mesh == n->mesh)
            walk_primitive(g, &g->primitive[p], m);
    json_text children = n->children;
    if (is_there(&children) && json_text_enter(&children, '['))
        while (json_text_next(&children, ']', &first))
            walk_node(g, index_of(&children), m, depth + 1);
}

static void walk_roots(gltf *g, json_text nodes)
{
    static const double as_is[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    int first = 1;

    if (is_there(&nodes) && json_text_enter(&nodes, '['))
        while (json_text_next(&nodes, ']', &first))
            walk_node(g, index_of(&nodes), as_is, 0);
}

/* The scene that the file means; without one, its meshes as they are. */
static void walk(gltf *g, int filling)
{
    static const double as_is[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    json_text scenes = g->scenes_text;
    int first = 1, found = 0;
    text key;

    g->filling = filling;
    g->vertices = g->triangles = 0;
    g->visits = 0;
    if (is_there(&scenes) && json_text_enter(&scenes, '['))
        for (int i = 0; json_text_next(&scenes, ']', &first); i++) {
            json_text scene = keep(&scenes);
            int one = 1;
            if (i != g->scene || !json_text_enter(&scene, '{'))
                continue;
            while (json_text_next(&scene, '}', &one) && json_text_key(&scene, &key))
                if (same(key, "nodes")) {
                    found = 1;
                    walk_roots(g, keep(&scene));
                } else
                    json_text_skip(&scene);
        }
    for (int p = 0; !found && p < g->primitive_count && g->err == FAP_OK; p++)
        walk_primitive(g, &g->primitive[p], as_is);
}

/* --- the whole --- */

static fap_err find_chunks(gltf *g, json_text *j)
{
    const surface_source *src = g->src;

    if (src->size < HEAD + CHUNK_HEAD || read_32(src->data + 4) != 2)
        return surface_fail(src, FAP_E_UNSUPPORTED, "glTF of another version than 2");
    const uint64_t json_size = read_32(src->data + HEAD);
    if (read_32(src->data + HEAD + 4) != JSON_CHUNK || json_size > src->size - HEAD - CHUNK_HEAD)
        return surface_fail(src, FAP_E_DATA, "the JSON in front is cut");
    *j = json_text_open(src->data + HEAD + CHUNK_HEAD, json_size);
    const uint64_t at = HEAD + CHUNK_HEAD + json_size;
    if (src->size - at < CHUNK_HEAD || read_32(src->data + at + 4) != BIN_CHUNK)
        return surface_fail(src, FAP_E_UNSUPPORTED,
                            "no binary part in it: its data are in another file; export it as one GLB");
    g->bin = src->data + at + CHUNK_HEAD;
    g->bin_size = src->size - at - CHUNK_HEAD;
    if (read_32(src->data + at) < g->bin_size)
        g->bin_size = read_32(src->data + at);
    return FAP_OK;
}

static int count_primitives(json_text meshes)
{
    int count = 0, first = 1;
    text key;

    if (!is_there(&meshes) || !json_text_enter(&meshes, '['))
        return 0;
    while (json_text_next(&meshes, ']', &first) && json_text_enter(&meshes, '{')) {
        int one = 1;
        while (json_text_next(&meshes, '}', &one) && json_text_key(&meshes, &key)) {
            const json_text value = keep(&meshes);
            count += same(key, "primitives") ? count_items(value) : 0;
        }
    }
    return count;
}

static void each(gltf *g, json_text list, void (*take)(gltf *g, json_text *j), int most)
{
    int first = 1;

    if (!is_there(&list) || !json_text_enter(&list, '['))
        return;
    for (int i = 0; i < most && json_text_next(&list, ']', &first); i++)
        take(g, &list);
}

static fap_err read_tables(gltf *g)
{
    const int views = count_items(g->views_text), accessors = count_items(g->accessors_text);
    const int meshes = count_items(g->meshes_text), nodes = count_items(g->nodes_text);
    const int primitives = count_primitives(g->meshes_text);
    const fap_allocator *a = g->src->alloc;
    json_text list = g->meshes_text;
    int first = 1;

    if (views > MOST_ITEMS || accessors > MOST_ITEMS || meshes > MOST_ITEMS || nodes > MOST_ITEMS ||
        primitives > MOST_ITEMS)
        return surface_fail(g->src, FAP_E_LIMIT, "more than %d of something", MOST_ITEMS);
    g->view = fap_mem_calloc(a, (size_t)views, sizeof *g->view);
    g->accessor = fap_mem_calloc(a, (size_t)accessors, sizeof *g->accessor);
    g->primitive = fap_mem_calloc(a, (size_t)primitives, sizeof *g->primitive);
    g->node = fap_mem_calloc(a, (size_t)nodes, sizeof *g->node);
    g->names = fap_mem_calloc(a, (size_t)meshes, sizeof *g->names);
    if (!g->view || !g->accessor || !g->primitive || !g->node || !g->names)
        return FAP_E_NOMEM;
    each(g, g->views_text, read_view, views);
    each(g, g->accessors_text, read_accessor, accessors);
    each(g, g->nodes_text, read_node, nodes);
    if (is_there(&list) && json_text_enter(&list, '['))
        while (g->mesh_count < meshes && json_text_next(&list, ']', &first))
            read_mesh(g, &list, primitives);
    return g->err;
}

static int wants(const gltf *g, int uv)
{
    for (int p = 0; p < g->primitive_count; p++)
        if ((uv ? g->primitive[p].uv : g->primitive[p].colour) >= 0)
            return 1;
    return 0;
}

static fap_err make_surface(gltf *g)
{
    fap_err err = surface_check_counts(g->src, g->vertices, g->triangles);

    if (err == FAP_OK && (uint64_t)g->targets * g->vertices > FAP_SURFACE_MAX_VERTICES * 16ull)
        err = surface_fail(g->src, FAP_E_LIMIT, "%u morph targets of %llu vertices are more than are read",
                           (unsigned)g->targets, (unsigned long long)g->vertices);
    if (err == FAP_OK)
        err = fap_surface_create(&g->s, (uint32_t)g->vertices, (uint32_t)g->triangles, g->src->alloc);
    if (err != FAP_OK)
        return err;
    const int ok = (!wants(g, 1) || surface_want_uv(g->s)) && (!wants(g, 0) || surface_want_colour(g->s)) &&
                   (!g->targets || surface_want_targets(g->s, g->targets));
    return ok ? FAP_OK : FAP_E_NOMEM;
}

static void tidy(gltf *g)
{
    const fap_allocator *a = g->src->alloc;

    fap_mem_free(a, g->view);
    fap_mem_free(a, g->accessor);
    fap_mem_free(a, g->primitive);
    fap_mem_free(a, g->node);
    fap_mem_free(a, g->names);
}

static fap_err read(const surface_source *src, fap_surface **out)
{
    gltf g = { .src = src };
    json_text j;

    g.err = find_chunks(&g, &j);
    if (g.err == FAP_OK)
        read_top(&g, j);
    if (g.err == FAP_OK)
        refuse_packed(&g);
    if (g.err == FAP_OK)
        g.err = read_tables(&g);
    if (g.err == FAP_OK)
        walk(&g, 0);
    if (g.err == FAP_OK)
        g.err = make_surface(&g);
    if (g.err == FAP_OK)
        walk(&g, 1);
    tidy(&g);
    *out = g.s;
    return g.err;
}

static int sniff(const uint8_t *data, size_t size)
{
    return size > HEAD && !memcmp(data, "glTF", 4);
}

const surface_driver surface_driver_gltf = { "gltf", sniff, read };
