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

#include "surface/gltf.h"

enum { MOST_VISITS = 1 << 16, MOST_DEPTH = 64 };

/* --- the walk --- */

/* The number of a target in the surface: by its name, so that eyes and skin that share one share it. */
static uint32_t target_of(gltf *g, const primitive *p, uint32_t number)
{
    json_text names = g->names[p->mesh];
    char name[FAP_SURFACE_NAME_SIZE] = "";
    int first = 1;
    text t;

    if (gltf_is_there(&names) && json_text_enter(&names, '['))
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

    if (!gltf_open_column(g, &c, index, 3) || c.a->count != vertices)
        return;
    float(*delta)[3] = g->s->target[target_of(g, p, number)].delta;
    for (uint64_t i = 0; i < vertices; i++) {
        double v[4];
        gltf_element(&c, i, v);
        place(m, v, 0, delta[g->vertices + i]);
    }
}

/* Every target of a primitive; in the first walk their number. */
static uint32_t walk_targets(gltf *g, const primitive *p, const double m[16], uint64_t vertices)
{
    json_text j = p->targets;
    uint32_t number = 0;
    int first = 1;

    if (!gltf_is_there(&j) || !json_text_enter(&j, '['))
        return 0;
    for (; json_text_next(&j, ']', &first) && number < FAP_SURFACE_MAX_TARGETS; number++) {
        primitive t = { .position = -1 };
        gltf_read_attributes(&t, &j);
        if (g->filling)
            fill_target(g, p, m, t.position, number, vertices);
    }
    return number;
}

static void fill_triangles(gltf *g, const primitive *p, uint64_t vertices, uint64_t corners)
{
    column c = { 0 };
    const int indexed = p->indices >= 0 && gltf_open_column(g, &c, p->indices, 1);
    uint32_t three[3] = { 0 };

    for (uint64_t i = 0; i < corners; i++) {
        double v[4] = { (double)i };
        if (indexed)
            gltf_element(&c, i, v);
        /* An index past the end names no vertex: whoever called refuses it. */
        const uint32_t at = v[0] < (double)vertices ? (uint32_t)(g->vertices + (uint64_t)v[0]) : UINT32_MAX;
        if (p->mode == GLTF_TRIANGLES) {
            three[i % 3] = at;
        } else if (i < 3) {
            three[i] = at;
        } else {
            three[p->mode == GLTF_FAN ? 1 : 0] = p->mode == GLTF_FAN ? three[2] : three[1];
            if (p->mode == GLTF_STRIP)
                three[1] = three[2];
            three[2] = at;
        }
        if (p->mode == GLTF_TRIANGLES ? i % 3 != 2 : i < 2)
            continue;
        uint32_t *t = g->s->triangle[g->triangles++];
        memcpy(t, three, sizeof three);
        if (p->mode == GLTF_STRIP && i % 2) { /* every second one turns the other way */
            t[0] = three[1];
            t[1] = three[0];
        }
    }
}

static void fill_vertices(gltf *g, const primitive *p, const double m[16], uint64_t vertices)
{
    column at, uv, colour;
    const int has_uv = g->s->uv && gltf_open_column(g, &uv, p->uv, 2) && uv.a->count == vertices;
    const int has_colour = g->s->colour && gltf_open_column(g, &colour, p->colour, 0) &&
                           colour.a->count == vertices && colour.a->width >= 3;
    double v[4];

    if (!gltf_open_column(g, &at, p->position, 3))
        return;
    for (uint64_t i = 0; i < vertices; i++) {
        gltf_element(&at, i, v);
        place(m, v, 1, g->s->position[g->vertices + i]);
        if (has_uv) {
            gltf_element(&uv, i, v);
            g->s->uv[g->vertices + i][0] = (float)gltf_unit(uv.a, v[0]);
            g->s->uv[g->vertices + i][1] =
                (float)(1 - gltf_unit(uv.a, v[1])); /* from the top in glTF, from below here */
        }
        v[3] = 1;
        if (has_colour)
            gltf_element(&colour, i, v);
        for (int k = 0; has_colour && k < 4; k++) {
            const double shade = k < colour.a->width ? gltf_unit(colour.a, v[k]) : 1;
            g->s->colour[g->vertices + i][k] = (uint8_t)(255 * fmin(1, fmax(0, shade)) + 0.5);
        }
    }
}

static void walk_primitive(gltf *g, const primitive *p, const double m[16])
{
    column at, corner;

    if (p->mode < GLTF_TRIANGLES || p->mode > GLTF_FAN || p->position < 0)
        return; /* points and lines */
    if (!gltf_open_column(g, &at, p->position, 3))
        return gltf_stop(g, FAP_E_DATA,
                         "positions are not within the file; buffers must be in the GLB itself");
    uint64_t corners = at.a->count;
    if (p->indices >= 0) {
        if (!gltf_open_column(g, &corner, p->indices, 1) || !gltf_counts(corner.a->type))
            return gltf_stop(g, FAP_E_DATA, "indices of triangles are not within the file");
        corners = corner.a->count;
    }
    if (g->filling) {
        fill_vertices(g, p, m, at.a->count);
        fill_triangles(g, p, at.a->count, corners);
    } else
        g->triangles += p->mode == GLTF_TRIANGLES ? corners / 3 : corners > 2 ? corners - 2 : 0;
    const uint32_t targets = walk_targets(g, p, m, at.a->count);
    g->targets = targets > g->targets ? targets : g->targets;
    g->vertices += at.a->count;
    if (g->vertices > FAP_SURFACE_MAX_VERTICES || g->triangles > FAP_SURFACE_MAX_TRIANGLES)
        gltf_stop(g, FAP_E_LIMIT, "more vertices or triangles than are read");
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
        return gltf_stop(g, FAP_E_LIMIT, "its nodes are too many, or go round in a circle");
    const node *n = &g->node[index];
    multiply(above, n->matrix, m);
    for (int p = 0; n->mesh >= 0 && p < g->primitive_count && g->err == FAP_OK; p++)
        if (g->primitive[p].mesh == n->mesh)
            walk_primitive(g, &g->primitive[p], m);
    json_text children = n->children;
    if (gltf_is_there(&children) && json_text_enter(&children, '['))
        while (json_text_next(&children, ']', &first))
            walk_node(g, gltf_index(&children), m, depth + 1);
}

static void walk_roots(gltf *g, json_text nodes)
{
    static const double as_is[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    int first = 1;

    if (gltf_is_there(&nodes) && json_text_enter(&nodes, '['))
        while (json_text_next(&nodes, ']', &first))
            walk_node(g, gltf_index(&nodes), as_is, 0);
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
    if (gltf_is_there(&scenes) && json_text_enter(&scenes, '['))
        for (int i = 0; json_text_next(&scenes, ']', &first); i++) {
            json_text scene = gltf_keep(&scenes);
            int one = 1;
            if (i != g->scene || !json_text_enter(&scene, '{'))
                continue;
            while (json_text_next(&scene, '}', &one) && json_text_key(&scene, &key))
                if (gltf_same(key, "nodes")) {
                    found = 1;
                    walk_roots(g, gltf_keep(&scene));
                } else
                    json_text_skip(&scene);
        }
    for (int p = 0; !found && p < g->primitive_count && g->err == FAP_OK; p++)
        walk_primitive(g, &g->primitive[p], as_is);
}

/* --- the whole --- */

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

static fap_err read(const surface_source *src, fap_surface **out)
{
    gltf g = { .src = src };

    if (gltf_open(&g) == FAP_OK)
        walk(&g, 0);
    if (g.err == FAP_OK)
        g.err = make_surface(&g);
    if (g.err == FAP_OK)
        walk(&g, 1);
    gltf_close(&g);
    *out = g.s;
    return g.err;
}

static int sniff(const uint8_t *data, size_t size)
{
    return size > 12 && !memcmp(data, "glTF", 4);
}

const surface_driver surface_driver_gltf = { "gltf", sniff, read };
