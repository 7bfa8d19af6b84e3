/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers of a GLB's binary part, every one of them within its bounds. See gltf.h. */
#include <string.h>

#include "surface/gltf.h"

uint32_t gltf_read_32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint64_t size_of(int type)
{
    return type == GLTF_I8 || type == GLTF_U8     ? 1
           : type == GLTF_I16 || type == GLTF_U16 ? 2
           : type == GLTF_U32 || type == GLTF_F32 ? 4
                                                  : 0;
}

/* What may number things. */
int gltf_counts(int type)
{
    return type == GLTF_U8 || type == GLTF_U16 || type == GLTF_U32;
}

static double component(int type, const uint8_t *p)
{
    float f;
    uint32_t bits;

    switch (type) {
    case GLTF_I8: return (int8_t)p[0];
    case GLTF_U8: return p[0];
    case GLTF_I16: return (int16_t)(p[0] | p[1] << 8);
    case GLTF_U16: return p[0] | p[1] << 8;
    case GLTF_U32: return gltf_read_32(p);
    default:
        bits = gltf_read_32(p);
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

/* 0: it does not say what it should, or not within the file. @p width: 0: any. */
int gltf_open_column(const gltf *g, column *c, int index, int width)
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
        c->indices = !gltf_counts(a->sparse_type)
                         ? NULL
                         : reach(g, a->sparse_indices, a->sparse_indices_offset, a->sparse_count, size, size);
        c->values = reach(g, a->sparse_values, a->sparse_values_offset, a->sparse_count, c->size, c->size);
        return c->indices && c->values && a->sparse_count <= a->count;
    }
    return 1;
}

/* Elements are asked for in ascending order, as sparse ones are stored. */
void gltf_element(column *c, uint64_t i, double *out)
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
double gltf_unit(const accessor *a, double v)
{
    return a->type == GLTF_U8 ? v / 255 : a->type == GLTF_U16 ? v / 65535 : v;
}
