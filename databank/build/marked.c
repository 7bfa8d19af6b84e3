/* SPDX-License-Identifier: BSD-2-Clause */
/* See marked.h. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/arkit.h>
#include <fap/tables.h>

#include "databank/build/marked.h"

static const double iris_mm = 5.8, pupil_mm = 2.2;
static const uint8_t skin[4] = { 204, 157, 131, 36 }, white[4] = { 236, 233, 228, 230 },
                     iris[4] = { 96, 118, 112, 240 }, pupil[4] = { 12, 12, 14, 250 };
static const uint8_t part_colour[FAP_PART_COUNT][4] = { [FAP_PART_TEETH_UPPER] = { 236, 228, 210, 200 },
                                                        [FAP_PART_TEETH_LOWER] = { 236, 228, 210, 200 },
                                                        [FAP_PART_TONGUE] = { 186, 98, 96, 150 },
                                                        [FAP_PART_LASHES] = { 38, 28, 24, 20 } };

int marked_open(marked *m, const fap_surface *mesh)
{
    const uint32_t n = mesh->vertex_count;

    *m = (marked){
        .mesh = mesh, .part = calloc(n, 1), .weight = malloc(n), .colour = malloc(n * sizeof *m->colour)
    };
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        m->point[p] = MARKED_NONE;
    for (uint32_t v = 0; m->colour && v < n; v++)
        memcpy(m->colour[v], skin, sizeof skin);
    if (m->weight)
        memset(m->weight, 255, n);
    return m->part && m->weight && m->colour;
}

void marked_close(marked *m)
{
    free(m->part);
    free(m->weight);
    free(m->colour);
    *m = (marked){ 0 };
}

/* --- eyeballs --- */

/* Middle and half height of the vertices of an eyeball, which may be open behind; 0: there is none. */
static int find_eye(const marked *m, int right, float centre[3], float *radius)
{
    const uint8_t part = right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT;
    float low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    for (uint32_t v = 0; v < m->mesh->vertex_count; v++)
        for (int a = 0; a < 3 && m->part[v] == part; a++) {
            low[a] = fminf(low[a], m->mesh->position[v][a]);
            high[a] = fmaxf(high[a], m->mesh->position[v][a]);
        }
    if (!(high[1] > low[1]))
        return 0;
    *radius = (high[1] - low[1]) / 2;
    for (int a = 0; a < 2; a++)
        centre[a] = (low[a] + high[a]) / 2;
    centre[2] = high[2] - *radius;
    return 1;
}

static const uint8_t *eye_colour(const float at[3], const float centre[3])
{
    const double off = hypot((double)at[0] - (double)centre[0], (double)at[1] - (double)centre[1]);

    return at[2] < centre[2] || off > iris_mm ? white : off > pupil_mm ? iris : pupil;
}

void marked_paint(marked *m)
{
    for (int right = 0; right < 2; right++) {
        float centre[3], radius;
        if (!find_eye(m, right, centre, &radius))
            continue;
        for (uint32_t v = 0; v < m->mesh->vertex_count; v++)
            if (m->part[v] == (right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT))
                memcpy(m->colour[v], eye_colour(m->mesh->position[v], centre), sizeof *m->colour);
    }
    for (uint32_t v = 0; v < m->mesh->vertex_count; v++)
        if (part_colour[m->part[v]][3])
            memcpy(m->colour[v], part_colour[m->part[v]], sizeof *m->colour);
}

/* --- the builder --- */

static int is_whole(const marked *m, const uint32_t t[3])
{
    return m->part[t[0]] == m->part[t[1]] && m->part[t[1]] == m->part[t[2]];
}

static fap_err give_points(const marked *m, fap_bank_builder *b)
{
    fap_err err = FAP_OK;

    for (int p = 0; p < FAP_POINT_COUNT && err == FAP_OK; p++) {
        const uint32_t v = (uint32_t)m->point[p];
        if (m->point[p] != MARKED_NONE)
            err = fap_bank_builder_point(b, p, &v, 1);
        else if (m->has_place[p])
            err = fap_bank_builder_place(b, p, m->place[p]);
    }
    return err;
}

fap_err marked_begin(fap_bank_builder **out, const marked *m, const char *name)
{
    const fap_surface *s = m->mesh;
    uint32_t(*triangle)[3] = malloc(s->triangle_count * sizeof *triangle), count = 0;

    *out = NULL;
    if (!triangle)
        return FAP_E_NOMEM;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        if (is_whole(m, s->triangle[t]))
            memcpy(triangle[count++], s->triangle[t], sizeof *triangle);
    const fap_build_mesh mesh = { .vertex_count = s->vertex_count,
                                  .triangle_count = count,
                                  .position = (const float(*)[3])s->position,
                                  .uv = (const float(*)[2])s->uv,
                                  .part = m->part,
                                  .head_weight = m->weight,
                                  .colour = (const uint8_t(*)[4])m->colour,
                                  .triangle = (const uint32_t(*)[3])triangle };
    fap_err err = fap_bank_builder_open(out, name, &mesh);
    free(triangle);
    if (err == FAP_OK)
        err = give_points(m, *out);
    for (int right = 0; right < 2 && err == FAP_OK; right++) {
        float centre[3], radius;
        if (find_eye(m, right, centre, &radius))
            fap_bank_builder_eye(*out, right, centre, radius);
    }
    if (err != FAP_OK)
        fap_bank_builder_close(out);
    return err;
}

/* --- shapes --- */

static int number_of(const char *name, int count, const char *(*name_of)(int))
{
    for (int i = 1; i <= count; i++)
        if (!strcmp(name, name_of(i)))
            return i;
    return 0;
}

/* "viseme_PP", "expression_joy": as fapplay -o NAME.glb calls them. */
static const char *plain_name(const char *name)
{
    static const char *const prefixes[] = { "viseme_", "expression_" };

    for (int i = 0; i < 2; i++)
        if (!strncmp(name, prefixes[i], strlen(prefixes[i])))
            return name + strlen(prefixes[i]);
    return name;
}

fap_err marked_add_shape(fap_bank_builder *b, const char *given, const float (*delta)[3])
{
    const char *name = plain_name(given);
    const int expression = number_of(name, FAP_EXPRESSION_COUNT, fap_expression_name);
    const int viseme = number_of(name, FAP_VISEME_COUNT, fap_viseme_name), shape = fap_arkit_by_name(name);

    if (expression)
        return fap_bank_builder_key(b, FAP_KEY_EXPRESSION, expression, name, delta);
    if (viseme)
        return fap_bank_builder_key(b, FAP_KEY_VISEME, viseme, name, delta);
    char unit[64];
    snprintf(unit, sizeof unit, "%s", shape >= 0 ? fap_arkit_name(shape) : name);
    if (shape >= 0)
        unit[0] = (char)tolower(
            (unsigned char)unit[0]); /* a bank's units are called as Apple's, not as Live Link's columns */
    return fap_bank_builder_key(b, FAP_KEY_UNIT, 0, unit, delta);
}
