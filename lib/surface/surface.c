/* SPDX-License-Identifier: BSD-2-Clause */
/* See fap/studio/surface.h. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "surface/surface_driver.h"

static const surface_driver *const drivers[] = { &surface_driver_ply, &surface_driver_gltf,
                                                 &surface_driver_obj };

/* Past this it is no length, and its square must not overflow. */
static const float farthest = 1e15F;

fap_err surface_fail(const surface_source *src, fap_err err, const char *fmt, ...)
{
    va_list args;

    va_start(args, fmt);
    vsnprintf(src->where, FAP_ERROR_TEXT_SIZE, fmt, args);
    va_end(args);
    return err;
}

void surface_note(fap_surface *s, const char *fmt, ...)
{
    va_list args;

    if (s->note_count == FAP_SURFACE_MAX_NOTES)
        return;
    va_start(args, fmt);
    vsnprintf(s->note[s->note_count++], FAP_SURFACE_NOTE_SIZE, fmt, args);
    va_end(args);
}

/* --- memory --- */

fap_err fap_surface_create(fap_surface **out, uint32_t vertex_count, uint32_t triangle_count,
                           const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);

    *out = NULL;
    if (!vertex_count)
        return FAP_E_ARG;
    if (vertex_count > FAP_SURFACE_MAX_VERTICES || triangle_count > FAP_SURFACE_MAX_TRIANGLES)
        return FAP_E_LIMIT;
    fap_surface *s = fap_mem_calloc(&a, 1, sizeof *s);
    if (!s)
        return FAP_E_NOMEM;
    s->alloc = a;
    s->format = "";
    s->vertex_count = vertex_count;
    s->triangle_count = triangle_count;
    s->position = fap_mem_calloc(&a, vertex_count, sizeof *s->position);
    s->triangle = fap_mem_calloc(&a, triangle_count, sizeof *s->triangle);
    if (s->position && s->triangle)
        *out = s;
    else
        fap_surface_close(&s);
    return *out ? FAP_OK : FAP_E_NOMEM;
}

void fap_surface_close(fap_surface **surface)
{
    fap_surface *s = *surface;

    if (!s)
        return;
    const fap_allocator a = s->alloc;
    for (uint32_t i = 0; s->target && i < s->target_count; i++)
        fap_mem_free(&a, s->target[i].delta);
    fap_mem_free(&a, s->target);
    fap_mem_free(&a, s->position);
    fap_mem_free(&a, s->triangle);
    fap_mem_free(&a, s->uv);
    fap_mem_free(&a, s->colour);
    fap_mem_free(&a, s->grid);
    fap_mem_free(&a, s);
    *surface = NULL;
}

int surface_want_uv(fap_surface *s)
{
    if (!s->uv)
        s->uv = fap_mem_calloc(&s->alloc, s->vertex_count, sizeof *s->uv);
    return s->uv != NULL;
}

int surface_want_colour(fap_surface *s)
{
    if (!s->colour)
        s->colour = fap_mem_calloc(&s->alloc, s->vertex_count, sizeof *s->colour);
    return s->colour != NULL;
}

int surface_want_targets(fap_surface *s, uint32_t count)
{
    s->target = fap_mem_calloc(&s->alloc, count, sizeof *s->target);
    if (!s->target)
        return 0;
    for (s->target_count = 0; s->target_count < count; s->target_count++) {
        fap_surface_target *t = &s->target[s->target_count];
        t->delta = fap_mem_calloc(&s->alloc, s->vertex_count, sizeof *t->delta);
        if (!t->delta)
            return 0;
    }
    return 1;
}

/* --- what every file is checked for --- */

fap_err surface_check_counts(const surface_source *src, uint64_t vertices, uint64_t triangles)
{
    if (!vertices)
        return surface_fail(src, FAP_E_DATA, "no vertex in it");
    if (vertices > FAP_SURFACE_MAX_VERTICES || triangles > FAP_SURFACE_MAX_TRIANGLES)
        return surface_fail(src, FAP_E_LIMIT, "%llu vertices and %llu triangles; at most %d and %d are read",
                            (unsigned long long)vertices, (unsigned long long)triangles,
                            FAP_SURFACE_MAX_VERTICES, FAP_SURFACE_MAX_TRIANGLES);
    return FAP_OK;
}

static int is_place(const float p[3])
{
    return fabsf(p[0]) < farthest && fabsf(p[1]) < farthest && fabsf(p[2]) < farthest;
}

static fap_err check_positions(const surface_source *src, const fap_surface *s)
{
    for (uint32_t i = 0; i < s->vertex_count; i++)
        if (!is_place(s->position[i]))
            return surface_fail(src, FAP_E_DATA, "vertex %u is no place in space", (unsigned)i + 1);
    for (uint32_t t = 0; t < s->target_count; t++)
        for (uint32_t i = 0; i < s->vertex_count; i++)
            if (!is_place(s->target[t].delta[i]))
                return surface_fail(src, FAP_E_DATA, "target %u moves vertex %u to no place in space",
                                    (unsigned)t + 1, (unsigned)i + 1);
    return FAP_OK;
}

static int has_area(const fap_surface *s, const uint32_t v[3])
{
    const float *a = s->position[v[0]], *b = s->position[v[1]], *c = s->position[v[2]];
    const double u[3] = { (double)b[0] - a[0], (double)b[1] - a[1], (double)b[2] - a[2] };
    const double w[3] = { (double)c[0] - a[0], (double)c[1] - a[1], (double)c[2] - a[2] };
    const double n[3] = { u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0] };

    return v[0] != v[1] && v[1] != v[2] && v[2] != v[0] && n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 0;
}

static fap_err check_triangles(const surface_source *src, fap_surface *s)
{
    uint32_t kept = 0;

    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t v[3] = { s->triangle[t][0], s->triangle[t][1], s->triangle[t][2] };
        for (int i = 0; i < 3; i++)
            if (v[i] >= s->vertex_count)
                return surface_fail(src, FAP_E_DATA, "triangle %u names vertex %u of %u", (unsigned)t + 1,
                                    (unsigned)v[i] + 1, (unsigned)s->vertex_count);
        if (has_area(s, v))
            memcpy(s->triangle[kept++], v, sizeof v);
        else
            s->dropped++;
    }
    s->triangle_count = kept;
    if (s->dropped)
        surface_note(s, "%u triangles without an area are left out", (unsigned)s->dropped);
    return FAP_OK;
}

fap_err fap_surface_read(fap_surface **out, const void *data, size_t size, const fap_allocator *alloc,
                         char *where)
{
    char own[FAP_ERROR_TEXT_SIZE];
    const fap_allocator a = fap_mem_allocator(alloc);
    const surface_source src = { data, size, &a, where ? where : own };

    *out = NULL;
    *src.where = '\0';
    for (size_t i = 0; i < sizeof drivers / sizeof *drivers; i++) {
        if (!drivers[i]->sniff(data, size))
            continue;
        fap_err err = drivers[i]->read(&src, out);
        if (err == FAP_OK)
            err = check_positions(&src, *out);
        if (err == FAP_OK)
            err = check_triangles(&src, *out);
        if (err == FAP_OK)
            (*out)->format = drivers[i]->name;
        else
            fap_surface_close(out);
        return err;
    }
    return surface_fail(&src, FAP_E_UNKNOWN_FORMAT, "neither OBJ nor PLY nor GLB");
}
