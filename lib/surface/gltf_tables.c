/* SPDX-License-Identifier: BSD-2-Clause */
/* The JSON of a GLB into tables. See gltf.h. */
#include <string.h>

#include "base/mem.h"
#include "surface/gltf.h"

enum { HEAD = 12, CHUNK_HEAD = 8, JSON_CHUNK = 0x4E4F534A, BIN_CHUNK = 0x004E4942 };

void gltf_stop(gltf *g, fap_err err, const char *why)
{
    if (g->err == FAP_OK)
        g->err = surface_fail(g->src, err, "%s", why);
}

/* --- words and numbers --- */

int gltf_same(text key, const char *word)
{
    return key.length == strlen(word) && !memcmp(key.start, word, key.length);
}

int gltf_is_there(const json_text *j)
{
    return j->at < j->end && !j->bad;
}

static uint64_t whole(json_text *j)
{
    double v = 0;
    json_text_number(j, &v);
    return v >= 0 && v < 9e15 ? (uint64_t)v : UINT64_MAX;
}

int gltf_index(json_text *j)
{
    const uint64_t v = whole(j);
    return v < GLTF_MOST_ITEMS ? (int)v : -1;
}

/* A value for later: where it begins; the reader goes on behind it. */
json_text gltf_keep(json_text *j)
{
    json_text here = *j;

    json_text_skip(j);
    here.end = j->at;
    return here;
}

static int count_items(json_text j)
{
    int count = 0, first = 1;

    if (!gltf_is_there(&j) || !json_text_enter(&j, '['))
        return 0;
    while (json_text_next(&j, ']', &first) && count <= GLTF_MOST_ITEMS) {
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
        return gltf_stop(g, FAP_E_SYNTAX, "its JSON is no object");
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (gltf_same(key, "bufferViews"))
            g->views_text = gltf_keep(&j);
        else if (gltf_same(key, "accessors"))
            g->accessors_text = gltf_keep(&j);
        else if (gltf_same(key, "meshes"))
            g->meshes_text = gltf_keep(&j);
        else if (gltf_same(key, "nodes"))
            g->nodes_text = gltf_keep(&j);
        else if (gltf_same(key, "scenes"))
            g->scenes_text = gltf_keep(&j);
        else if (gltf_same(key, "extensionsRequired"))
            g->required_text = gltf_keep(&j);
        else if (gltf_same(key, "scene"))
            g->scene = gltf_index(&j);
        else
            json_text_skip(&j);
    }
    if (j.bad)
        gltf_stop(g, FAP_E_SYNTAX, "its JSON is damaged");
}

static void refuse_packed(gltf *g)
{
    json_text j = g->required_text;
    int first = 1;
    text name;

    if (!gltf_is_there(&j) || !json_text_enter(&j, '['))
        return;
    while (json_text_next(&j, ']', &first) && json_text_string(&j, &name))
        if (gltf_same(name, "KHR_draco_mesh_compression") || gltf_same(name, "EXT_meshopt_compression") ||
            gltf_same(name, "KHR_mesh_quantization"))
            gltf_stop(g, FAP_E_UNSUPPORTED,
                      "its meshes are packed (Draco, meshopt, quantised); export it without compression");
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
        if (gltf_same(key, "buffer"))
            buffer = whole(j);
        else if (gltf_same(key, "byteOffset"))
            v->offset = whole(j);
        else if (gltf_same(key, "byteLength"))
            v->length = whole(j);
        else if (gltf_same(key, "byteStride"))
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
        if (gltf_same(type, names[i]))
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
        if (gltf_same(key, "bufferView"))
            *at_view = gltf_index(j);
        else if (gltf_same(key, "byteOffset"))
            *offset = whole(j);
        else if (type && gltf_same(key, "componentType"))
            *type = gltf_index(j);
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
        if (gltf_same(key, "count"))
            a->sparse_count = whole(j);
        else if (gltf_same(key, "indices"))
            read_sparse_part(j, &a->sparse_indices, &a->sparse_indices_offset, &a->sparse_type);
        else if (gltf_same(key, "values"))
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
        if (gltf_same(key, "bufferView"))
            a->view = gltf_index(j);
        else if (gltf_same(key, "byteOffset"))
            a->offset = whole(j);
        else if (gltf_same(key, "count"))
            a->count = whole(j);
        else if (gltf_same(key, "componentType"))
            a->type = gltf_index(j);
        else if (gltf_same(key, "type") && json_text_string(j, &type))
            a->width = width_of(type);
        else if (gltf_same(key, "sparse"))
            read_sparse(a, j);
        else
            json_text_skip(j);
    }
}

/* --- meshes and nodes --- */

void gltf_read_attributes(primitive *p, json_text *j)
{
    int first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (gltf_same(key, "POSITION"))
            p->position = gltf_index(j);
        else if (gltf_same(key, "TEXCOORD_0"))
            p->uv = gltf_index(j);
        else if (gltf_same(key, "COLOR_0"))
            p->colour = gltf_index(j);
        else
            json_text_skip(j);
    }
}

static void read_primitive(gltf *g, json_text *j, int mesh)
{
    primitive *p = &g->primitive[g->primitive_count++];
    int first = 1;
    text key;

    *p = (primitive){
        .mesh = mesh, .position = -1, .uv = -1, .colour = -1, .indices = -1, .mode = GLTF_TRIANGLES
    };
    if (!json_text_enter(j, '{'))
        return;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (gltf_same(key, "attributes"))
            gltf_read_attributes(p, j);
        else if (gltf_same(key, "indices"))
            p->indices = gltf_index(j);
        else if (gltf_same(key, "mode"))
            p->mode = gltf_index(j);
        else if (gltf_same(key, "targets"))
            p->targets = gltf_keep(j);
        else
            json_text_skip(j);
    }
}

static void read_extras(gltf *g, json_text *j, int mesh)
{
    json_text extras = gltf_keep(j);
    int first = 1;
    text key;

    if (!json_text_enter(&extras, '{'))
        return;
    while (json_text_next(&extras, '}', &first) && json_text_key(&extras, &key)) {
        if (gltf_same(key, "targetNames"))
            g->names[mesh] = gltf_keep(&extras);
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
        if (gltf_same(key, "extras"))
            read_extras(g, j, mesh);
        else if (!gltf_same(key, "primitives"))
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
        if (gltf_same(key, "mesh"))
            n->mesh = gltf_index(j);
        else if (gltf_same(key, "children"))
            n->children = gltf_keep(j);
        else if (gltf_same(key, "matrix"))
            has_matrix = read_numbers(j, n->matrix, 16);
        else if (gltf_same(key, "translation"))
            read_numbers(j, t, 3);
        else if (gltf_same(key, "rotation"))
            read_numbers(j, q, 4);
        else if (gltf_same(key, "scale"))
            read_numbers(j, s, 3);
        else
            json_text_skip(j);
    }
    if (!has_matrix)
        compose(t, q, s, n->matrix);
}

/* --- the whole --- */

static fap_err find_chunks(gltf *g, json_text *j)
{
    const surface_source *src = g->src;

    if (src->size < HEAD + CHUNK_HEAD || gltf_read_32(src->data + 4) != 2)
        return surface_fail(src, FAP_E_UNSUPPORTED, "glTF of another version than 2");
    const uint64_t json_size = gltf_read_32(src->data + HEAD);
    if (gltf_read_32(src->data + HEAD + 4) != JSON_CHUNK || json_size > src->size - HEAD - CHUNK_HEAD)
        return surface_fail(src, FAP_E_DATA, "the JSON in front is cut");
    *j = json_text_open(src->data + HEAD + CHUNK_HEAD, json_size);
    const uint64_t at = HEAD + CHUNK_HEAD + json_size;
    if (src->size - at < CHUNK_HEAD || gltf_read_32(src->data + at + 4) != BIN_CHUNK)
        return surface_fail(src, FAP_E_UNSUPPORTED,
                            "no binary part in it: its data are in another file; export it as one GLB");
    g->bin = src->data + at + CHUNK_HEAD;
    g->bin_size = src->size - at - CHUNK_HEAD;
    if (gltf_read_32(src->data + at) < g->bin_size)
        g->bin_size = gltf_read_32(src->data + at);
    return FAP_OK;
}

static int count_primitives(json_text meshes)
{
    int count = 0, first = 1;
    text key;

    if (!gltf_is_there(&meshes) || !json_text_enter(&meshes, '['))
        return 0;
    while (json_text_next(&meshes, ']', &first) && json_text_enter(&meshes, '{')) {
        int one = 1;
        while (json_text_next(&meshes, '}', &one) && json_text_key(&meshes, &key)) {
            const json_text value = gltf_keep(&meshes);
            count += gltf_same(key, "primitives") ? count_items(value) : 0;
        }
    }
    return count;
}

static void each(gltf *g, json_text list, void (*take)(gltf *g, json_text *j), int most)
{
    int first = 1;

    if (!gltf_is_there(&list) || !json_text_enter(&list, '['))
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

    if (views > GLTF_MOST_ITEMS || accessors > GLTF_MOST_ITEMS || meshes > GLTF_MOST_ITEMS ||
        nodes > GLTF_MOST_ITEMS || primitives > GLTF_MOST_ITEMS)
        return surface_fail(g->src, FAP_E_LIMIT, "more than %d of something", GLTF_MOST_ITEMS);
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
    if (gltf_is_there(&list) && json_text_enter(&list, '['))
        while (g->mesh_count < meshes && json_text_next(&list, ']', &first))
            read_mesh(g, &list, primitives);
    return g->err;
}

fap_err gltf_open(gltf *g)
{
    json_text j;

    g->err = find_chunks(g, &j);
    if (g->err == FAP_OK)
        read_top(g, j);
    if (g->err == FAP_OK)
        refuse_packed(g);
    if (g->err == FAP_OK)
        g->err = read_tables(g);
    return g->err;
}

void gltf_close(gltf *g)
{
    const fap_allocator *a = g->src->alloc;

    fap_mem_free(a, g->view);
    fap_mem_free(a, g->accessor);
    fap_mem_free(a, g->primitive);
    fap_mem_free(a, g->node);
    fap_mem_free(a, g->names);
}
