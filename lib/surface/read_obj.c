/* SPDX-License-Identifier: BSD-2-Clause */
/* Wavefront OBJ as a surface; shape/obj.h reads the text. */
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "shape/obj.h"
#include "surface/surface_driver.h"

/* A text whose first line that says anything is one that OBJ has. */
static int sniff(const uint8_t *data, size_t size)
{
    static const char *const words[] = { "v", "vt", "vn", "f", "g", "o", "s", "mtllib", "usemtl" };
    const char *p = (const char *)data, *end = p + size;

    while (p < end) {
        while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n'))
            p++;
        if (p < end && *p != '#')
            break;
        p = p < end ? memchr(p, '\n', (size_t)(end - p)) : NULL;
        if (!p)
            return 0;
    }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const size_t length = strlen(words[i]);
        if ((size_t)(end - p) > length && !memcmp(p, words[i], length) &&
            (p[length] == ' ' || p[length] == '\t'))
            return 1;
    }
    return 0;
}

static uint64_t count_triangles(const fap_obj *o)
{
    uint64_t count = 0;

    for (uint32_t f = 0; f < o->face_count; f++)
        count += o->face[f].count - 2;
    return count;
}

static void fill(fap_surface *s, const fap_obj *o)
{
    uint32_t t = 0;

    memcpy(s->position, o->position, o->position_count * sizeof *s->position);
    for (uint32_t f = 0; f < o->face_count; f++)
        for (uint32_t k = 2; k < o->face[f].count; k++, t++) {
            const uint32_t *v = o->vertex + o->face[f].first;
            s->triangle[t][0] = v[0];
            s->triangle[t][1] = v[k - 1];
            s->triangle[t][2] = v[k];
        }
}

/* A vertex on a seam has several; one of them is as good as another for finding a colour. */
static int fill_uv(fap_surface *s, const fap_obj *o)
{
    if (!o->uv_count)
        return 1;
    if (!surface_want_uv(s))
        return 0;
    for (uint32_t c = 0; c < o->corner_count; c++)
        if (o->corner_uv[c] != FAP_OBJ_NO_UV)
            memcpy(s->uv[o->vertex[c]], o->uv[o->corner_uv[c]], sizeof *s->uv);
    return 1;
}

static fap_err convert(const surface_source *src, const fap_obj *o, fap_surface **out)
{
    const uint64_t triangles = count_triangles(o);

    fap_err err = surface_check_counts(src, o->position_count, triangles);
    if (err == FAP_OK)
        err = fap_surface_create(out, o->position_count, (uint32_t)triangles, src->alloc);
    if (err != FAP_OK)
        return err;
    fill(*out, o);
    return fill_uv(*out, o) ? FAP_OK : FAP_E_NOMEM;
}

static fap_err read(const surface_source *src, fap_surface **out)
{
    char *text = fap_mem_calloc(src->alloc, src->size + 1, 1);
    fap_obj obj;
    int line;

    if (!text)
        return FAP_E_NOMEM;
    memcpy(text, src->data, src->size);
    fap_err err = fap_obj_parse(&obj, text, src->size, &line);
    fap_mem_free(src->alloc, text);
    if (err == FAP_E_SYNTAX)
        return surface_fail(src, err, "line %d is no vertex, face or group", line);
    if (err == FAP_OK)
        err = convert(src, &obj, out);
    fap_obj_free(&obj);
    return err;
}

const surface_driver surface_driver_obj = { "obj", sniff, read };
