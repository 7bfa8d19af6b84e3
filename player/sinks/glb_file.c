/* SPDX-License-Identifier: BSD-2-Clause */
/* See glb_file.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "player/sinks/glb_file.h"

/* What graphics cards read as vertices has a stride, as several accessors share a view; indices have a target alone. */
static const struct {
    const char *name;
    int target, stride;
} sections[SECTION_COUNT] = {
    [SECTION_TRIANGLES] = { "triangles", 34963, 0 },
    [SECTION_POSITION] = { "positions", 34962, 12 },
    [SECTION_NORMAL] = { "normals", 34962, 12 },
    [SECTION_COLOUR] = { "colours", 34962, 8 },
    [SECTION_UV] = { "texture coordinates", 34962, 8 },
    [SECTION_VERTEX] = { "vertex numbers", 34962, 4 },
    [SECTION_JOINTS] = { "joints", 34962, 4 },
    [SECTION_SHARES] = { "shares of joints", 34962, 8 },
    [SECTION_MORPH] = { "morph targets", 34962, 12 },
    [SECTION_SPARSE_INDEX] = { "sparse morph targets: which", 0, 0 },
    [SECTION_SPARSE_VALUE] = { "sparse morph targets: where to", 0, 0 },
    [SECTION_BIND] = { "inverse bind matrices", 0, 0 },
    [SECTION_ANIMATION] = { "animation", 0, 0 },
    [SECTION_IMAGE] = { "texture", 0, 0 },
};

/* --- bytes, lowest first --- */

static int grow(glb_bytes *b, size_t more)
{
    if (b->size + more <= b->room)
        return 1;
    const size_t room = 2 * (b->size + more);
    uint8_t *larger = realloc(b->data, room);
    if (!larger)
        return 0;
    b->data = larger;
    b->room = room;
    return 1;
}

static void put(glb_bytes *b, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        b->data[b->size++] = (uint8_t)(value >> (8 * i));
}

static void put_float(glb_bytes *b, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    put(b, bits, 4);
}

static int size_of(glb_component component)
{
    return component == GLB_U8 ? 1 : component == GLB_U16 ? 2 : 4;
}

/* Room for @count more components, on a boundary of four. */
static int begin(glb_file *g, glb_section section, glb_component component, size_t count)
{
    glb_bytes *b = &g->section[section];

    g->failed = g->failed || !grow(b, count * (size_t)size_of(component) + 3);
    while (!g->failed && b->size % 4)
        b->data[b->size++] = 0;
    return !g->failed;
}

/* --- accessors --- */

static int add_accessor(glb_file *g, const glb_accessor *a)
{
    if (g->accessor_count == g->accessor_room) {
        const int room = 2 * g->accessor_room + 64;
        glb_accessor *larger = realloc(g->accessor, (size_t)room * sizeof *larger);
        g->failed = g->failed || !larger;
        if (!larger)
            return 0;
        g->accessor = larger;
        g->accessor_room = room;
    }
    g->accessor[g->accessor_count] = *a;
    return g->accessor_count++;
}

int glb_add_floats(glb_file *g, glb_section section, const float *value, uint32_t count, int width)
{
    if (!begin(g, section, GLB_FLOAT, (size_t)count * (size_t)width))
        return 0;
    glb_bytes *b = &g->section[section];
    const glb_accessor a = { (int)section, b->size, count, GLB_FLOAT, width, .has_range = 0 };
    for (size_t i = 0; i < (size_t)count * (size_t)width; i++)
        put_float(b, value[i]);
    return add_accessor(g, &a);
}

int glb_add_integers(glb_file *g, glb_section section, glb_component component, const uint32_t *value,
                     uint32_t count, int width, int normalised)
{
    if (!begin(g, section, component, (size_t)count * (size_t)width))
        return 0;
    glb_bytes *b = &g->section[section];
    const glb_accessor a = { (int)section, b->size, count, component, width, .normalised = normalised };
    for (size_t i = 0; i < (size_t)count * (size_t)width; i++)
        put(b, value[i], size_of(component));
    return add_accessor(g, &a);
}

void glb_add_bytes(glb_file *g, glb_section section, const uint8_t *data, size_t size)
{
    if (!begin(g, section, GLB_U8, size))
        return;
    memcpy(g->section[section].data + g->section[section].size, data, size);
    g->section[section].size += size;
}

void glb_set_range(glb_file *g, int accessor, const float *value)
{
    if (g->failed)
        return;
    glb_accessor *a = &g->accessor[accessor];
    a->has_range = 1;
    for (int k = 0; k < a->width && k < 3; k++) {
        a->least[k] = INFINITY;
        a->most[k] = -INFINITY;
        for (uint32_t i = 0; i < a->count; i++) {
            a->least[k] = fminf(a->least[k], value[(size_t)i * (size_t)a->width + (size_t)k]);
            a->most[k] = fmaxf(a->most[k], value[(size_t)i * (size_t)a->width + (size_t)k]);
        }
    }
}

/* --- motion --- */

static int is_zero(const float v[3], float least)
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < least * least || (v[0] == 0 && v[1] == 0 && v[2] == 0);
}

static uint32_t count_moved(const float (*value)[3], uint32_t count, float least)
{
    uint32_t moved = 0;

    for (uint32_t i = 0; i < count; i++)
        moved += !is_zero(value[i], least);
    return moved;
}

static void widen(glb_accessor *a, const float v[3])
{
    for (int k = 0; k < 3; k++) {
        a->least[k] = fminf(a->least[k], v[k]);
        a->most[k] = fmaxf(a->most[k], v[k]);
    }
}

static void put_sparse(glb_file *g, glb_accessor *a, const float (*value)[3], float least)
{
    glb_bytes *which = &g->section[SECTION_SPARSE_INDEX], *where = &g->section[SECTION_SPARSE_VALUE];

    a->sparse_component = a->count <= 65536 ? GLB_U16 : GLB_U32;
    if (!begin(g, SECTION_SPARSE_INDEX, a->sparse_component, a->sparse_count) ||
        !begin(g, SECTION_SPARSE_VALUE, GLB_FLOAT, 3 * (size_t)a->sparse_count))
        return;
    a->sparse_index = which->size;
    a->sparse_value = where->size;
    for (uint32_t i = 0; i < a->count; i++) {
        if (is_zero(value[i], least))
            continue;
        put(which, i, size_of(a->sparse_component));
        for (int k = 0; k < 3; k++)
            put_float(where, value[i][k]);
        widen(a, value[i]);
    }
}

int glb_add_motion(glb_file *g, const float (*value)[3], uint32_t count, float least)
{
    glb_accessor a = { .section = -1, .count = count, .component = GLB_FLOAT, .width = 3, .has_range = 1 };
    const uint32_t moved = count_moved(value, count, least);

    if ((size_t)moved * 14 >= (size_t)count * 12) {
        const int dense = glb_add_floats(g, SECTION_MORPH, value[0], count, 3);
        glb_set_range(g, dense, value[0]);
        return dense;
    }
    a.sparse_count = moved;
    if (moved)
        put_sparse(g, &a, value, least);
    return add_accessor(g, &a);
}

/* --- JSON --- */

static size_t padded(size_t size)
{
    return (size + 3) / 4 * 4;
}

static size_t binary_size(const glb_file *g)
{
    size_t size = 0;

    for (int s = 0; s < SECTION_COUNT; s++)
        size += padded(g->section[s].size);
    return size;
}

/* Empty sections have no view. */
int glb_view(const glb_file *g, int section)
{
    int view = 0;

    for (int s = 0; s < section; s++)
        view += g->section[s].size > 0;
    return view;
}

static void put_views(const glb_file *g, json *j)
{
    size_t offset = 0;

    json_open(j, "bufferViews", '[');
    for (int s = 0; s < SECTION_COUNT; s++) {
        if (!g->section[s].size)
            continue;
        json_open(j, NULL, '{');
        json_string(j, "name", sections[s].name);
        json_integer(j, "buffer", 0);
        json_integer(j, "byteOffset", (int64_t)offset);
        json_integer(j, "byteLength", (int64_t)g->section[s].size);
        if (sections[s].stride)
            json_integer(j, "byteStride", sections[s].stride);
        if (sections[s].target)
            json_integer(j, "target", sections[s].target);
        json_close(j, '}');
        offset += padded(g->section[s].size);
    }
    json_close(j, ']');
}

static void put_range(json *j, const char *key, const float *value, int width)
{
    json_open(j, key, '[');
    for (int k = 0; k < width; k++)
        json_float(j, NULL, value[k]);
    json_close(j, ']');
}

static void put_sparse_json(const glb_file *g, const glb_accessor *a, json *j)
{
    json_open(j, "sparse", '{');
    json_integer(j, "count", a->sparse_count);
    json_open(j, "indices", '{');
    json_integer(j, "bufferView", glb_view(g, SECTION_SPARSE_INDEX));
    json_integer(j, "byteOffset", (int64_t)a->sparse_index);
    json_integer(j, "componentType", a->sparse_component);
    json_close(j, '}');
    json_open(j, "values", '{');
    json_integer(j, "bufferView", glb_view(g, SECTION_SPARSE_VALUE));
    json_integer(j, "byteOffset", (int64_t)a->sparse_value);
    json_close(j, '}');
    json_close(j, '}');
}

static void put_accessor(const glb_file *g, const glb_accessor *a, json *j)
{
    static const char *const type[17] = { [1] = "SCALAR", "VEC2", "VEC3", "VEC4", [16] = "MAT4" };

    json_open(j, NULL, '{');
    if (a->section >= 0) {
        json_integer(j, "bufferView", glb_view(g, a->section));
        json_integer(j, "byteOffset", (int64_t)a->offset);
    }
    json_integer(j, "componentType", a->component);
    json_string(j, "type", type[a->width]);
    json_integer(j, "count", a->count);
    if (a->normalised)
        json_bool(j, "normalized", 1);
    if (a->has_range) {
        put_range(j, "min", a->least, a->width);
        put_range(j, "max", a->most, a->width);
    }
    if (a->sparse_count)
        put_sparse_json(g, a, j);
    json_close(j, '}');
}

void glb_put_json(const glb_file *g, json *j)
{
    json_open(j, "buffers", '[');
    json_open(j, NULL, '{');
    json_integer(j, "byteLength", (int64_t)binary_size(g));
    json_close(j, '}');
    json_close(j, ']');
    put_views(g, j);
    json_open(j, "accessors", '[');
    for (int i = 0; i < g->accessor_count; i++)
        put_accessor(g, &g->accessor[i], j);
    json_close(j, ']');
}

/* --- the file --- */

enum {
    HEADER_SIZE = 12,
    CHUNK_HEADER_SIZE = 8,
    CHUNK_JSON = 0x4e4f534a,
    CHUNK_BIN = 0x004e4942,
    GLTF = 0x46546c67
};

double glb_size(const glb_file *g, size_t text_size)
{
    return HEADER_SIZE + 2.0 * CHUNK_HEADER_SIZE + (double)padded(text_size) + (double)binary_size(g);
}

static void write_word(uint32_t value, FILE *out)
{
    for (int i = 0; i < 4; i++)
        fputc((int)(value >> (8 * i) & 255), out);
}

static void write_padded(const void *data, size_t size, char pad, FILE *out)
{
    if (size)
        fwrite(data, 1, size, out);
    for (; size % 4; size++)
        fputc(pad, out);
}

int glb_write(const glb_file *g, const char *text, size_t text_size, FILE *out)
{
    write_word(GLTF, out);
    write_word(2, out);
    write_word((uint32_t)glb_size(g, text_size), out);
    write_word((uint32_t)padded(text_size), out);
    write_word(CHUNK_JSON, out);
    write_padded(text, text_size, ' ', out);
    write_word((uint32_t)binary_size(g), out);
    write_word(CHUNK_BIN, out);
    for (int s = 0; s < SECTION_COUNT; s++)
        write_padded(g->section[s].data, g->section[s].size, 0, out);
    return !ferror(out);
}

void glb_file_close(glb_file *g)
{
    for (int s = 0; s < SECTION_COUNT; s++)
        free(g->section[s].data);
    free(g->accessor);
    *g = (glb_file){ 0 };
}
