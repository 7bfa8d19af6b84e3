/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Motions on another face and back, what is lost on the way and how long one takes: between faces of one structure (Zhu 2006
 * section 5.1), and through a face of another structure (5.2): ICT-FaceKit's shapes to the default face laid over it, and back.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/landmarks.h>
#include <fap/studio/retarget.h>

#include "bench.h"
#include "common/bank_file.h"
#include "ict.h"
#include "shape/bytes.h"

static int keep(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return ((fap_bytes *)user)->failed;
}

static fap_bank *load(fap_bank_builder *b)
{
    fap_bytes file = { 0 };
    const fap_writer w = { keep, &file };
    fap_bank *bank = NULL;

    if (b && fap_bank_builder_write(b, &w) == FAP_OK &&
        fap_bank_load(&bank, file.data, file.size, NULL) != FAP_OK)
        bank = NULL;
    fap_bytes_free(&file);
    return bank;
}

static fap_bank *default_face(void)
{
    char path[BANK_PATH_SIZE], where[FAP_ERROR_TEXT_SIZE];
    fap_bank *bank = NULL;

    return bank_file_default(path) && bank_file_read(&bank, path, where) == FAP_OK ? bank : NULL;
}

/* --- one structure --- */

/* Another head: wider below, shorter, a longer nose. */
static void bend(const float p[3], float out[3])
{
    out[0] = p[0] * (1.06F - 0.0008F * p[1]);
    out[1] = p[1] * 0.95F;
    out[2] = p[2] + 4 * expf(-(p[0] * p[0] + p[1] * p[1]) / 900);
}

static double points_apart(const fap_bank *a, const fap_bank *b)
{
    double sum = 0;
    uint32_t count = 0;

    for (int k = 0; k < fap_bank_key_count(a); k++)
        for (int i = 0; i < 3 * FAP_POINT_COUNT; i++, count++) {
            const fap_key *x = fap_bank_key_get(a, k), *y = fap_bank_key_get(b, k);
            sum += pow((double)x->point_mm[i / 3][i % 3] - (double)y->point_mm[i / 3][i % 3], 2);
        }
    return count ? sqrt(3 * sum / count) : -1;
}

static fap_bank *retargeted(const fap_bank *bank, const float (*position)[3], double *seconds)
{
    fap_bank_builder *b;
    const double begin = bench_now_s();
    const fap_err err = fap_bank_retarget(&b, bank, position, fap_bank_name(bank), NULL);

    *seconds = bench_now_s() - begin;
    fap_bank *out = err == FAP_OK ? load(b) : NULL;
    fap_bank_builder_close(&b);
    return out;
}

typedef struct trip {
    double us, error_mm;
} trip;

/* There, and from there back. Vertices may have changed places in the file between. */
static int travel(trip *t)
{
    fap_bank *face = default_face(), *there = NULL, *back = NULL;
    fap_generic g = { 0 }, other = { 0 };
    double seconds;

    if (!face || fap_generic_of_bank(&g, face, NULL) != FAP_OK) {
        fap_bank_close(&face);
        return 0;
    }
    float(*bent)[3] = malloc(g.vertex_count * sizeof *bent);
    for (uint32_t i = 0; bent && i < g.vertex_count; i++)
        bend(g.position[i], bent[i]);
    if (bent)
        there = retargeted(face, (const float(*)[3])bent, &seconds);
    if (there && fap_generic_of_bank(&other, there, NULL) == FAP_OK) {
        t->us = 1e6 * seconds / fap_bank_key_count(face);
        float(*home)[3] = malloc(g.vertex_count * sizeof *home);
        for (uint32_t i = 0; home && i < g.vertex_count; i++) { /* the way back, by halving the difference */
            memcpy(home[i], other.position[i], sizeof home[i]);
            for (int round = 0; round < 60; round++) {
                float at[3];
                bend(home[i], at);
                for (int a = 0; a < 3; a++)
                    home[i][a] += 0.7F * (other.position[i][a] - at[a]);
            }
        }
        back = home ? retargeted(there, (const float(*)[3])home, &seconds) : NULL;
        free(home);
    }
    t->error_mm = back ? points_apart(face, back) : -1;
    const int ok = back != NULL;
    free(bent);
    fap_generic_free(&g, NULL);
    fap_generic_free(&other, NULL);
    fap_bank_close(&face);
    fap_bank_close(&there);
    fap_bank_close(&back);
    return ok;
}

static const trip *one_structure(void)
{
    static trip t;
    static int state;

    if (!state)
        state = travel(&t) ? 1 : -1;
    return state > 0 ? &t : NULL;
}

double bench_retarget_us(void)
{
    return one_structure() ? one_structure()->us : -1;
}

double bench_retarget_error_mm(void)
{
    return one_structure() ? one_structure()->error_mm : -1;
}

/* --- another structure --- */

typedef struct passage {
    ict model;
    fap_bank *face;
    fap_generic from, to;   /* ICT's head; the default face */
    fap_registration *laid; /* the default face on ICT's */
    fap_surface *source, *between;
    float (*there)[3], (*back)[3];
    uint8_t *from_skin, *to_skin;
} passage;

static fap_surface *surface_of(const fap_generic *g, const float (*position)[3])
{
    fap_surface *s;

    if (fap_surface_create(&s, g->vertex_count, g->triangle_count, NULL) != FAP_OK)
        return NULL;
    memcpy(s->position, position, g->vertex_count * sizeof *s->position);
    memcpy(s->triangle, g->triangle, g->triangle_count * sizeof *s->triangle);
    return s;
}

static uint32_t pin_points(const passage *p, fap_pin *pin)
{
    uint32_t count = 0;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_bank_point *a = fap_bank_point_get(p->face, i), *b = fap_bank_point_get(p->model.bank, i);
        if (!a->present || !a->vertex_count || !b->present || p->to.part[a->vertex[0]] != FAP_PART_SKIN)
            continue;
        const uint32_t v = a->vertex[0];
        pin[count] = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        memcpy(pin[count++].at, b->position_mm, sizeof pin->at);
    }
    return count;
}

static uint8_t *skin_of(const fap_generic *g)
{
    uint8_t *skin = malloc(g->vertex_count);

    for (uint32_t i = 0; skin && i < g->vertex_count; i++)
        skin[i] = g->part[i] == FAP_PART_SKIN;
    return skin;
}

static int open_passage(passage *p)
{
    fap_registration_config cfg;
    fap_pin pin[FAP_POINT_COUNT];

    p->face = default_face();
    if (!p->face || !ict_open(&p->model) || fap_generic_of_bank(&p->from, p->model.bank, NULL) != FAP_OK ||
        fap_generic_of_bank(&p->to, p->face, NULL) != FAP_OK)
        return 0;
    p->source = surface_of(&p->from, p->from.position);
    fap_registration_config_init(&cfg);
    cfg.mm_per_unit = 1;
    if (!p->source ||
        fap_register(&p->laid, &p->to, p->source, pin, pin_points(p, pin), &cfg, NULL) != FAP_OK)
        return 0;
    p->there = malloc(p->to.vertex_count * sizeof *p->there);
    p->back = malloc(p->from.vertex_count * sizeof *p->back);
    p->from_skin = skin_of(&p->from);
    p->to_skin = skin_of(&p->to);
    if (!p->there || !p->back || !p->from_skin || !p->to_skin)
        return 0;
    /* The scan in the head's axes, as the laid face is. */
    for (uint32_t i = 0; i < p->from.vertex_count; i++)
        fap_registration_to_head(p->laid, p->from.position[i], p->source->position[i]);
    p->between = surface_of(&p->to, fap_registration_positions(p->laid));
    return p->between != NULL;
}

static void close_passage(passage *p)
{
    fap_surface_close(&p->source);
    fap_surface_close(&p->between);
    fap_registration_close(&p->laid);
    fap_generic_free(&p->from, NULL);
    fap_generic_free(&p->to, NULL);
    fap_bank_close(&p->face);
    free(p->there);
    free(p->back);
    free(p->from_skin);
    free(p->to_skin);
    ict_close(&p->model);
}

/* Squares of what one shape loses, over the vertices that it moves by a millimetre or more. */
static int pass(passage *p, int unit, double *sum, uint32_t *count)
{
    const float(*delta)[3] = (const float(*)[3])p->model.delta[unit];

    if (fap_motion_resample((const float(*)[3])p->between->position, p->to.vertex_count, p->to.triangle,
                            p->to.triangle_count, p->to_skin, 8, p->source, delta, p->there) != FAP_OK ||
        fap_motion_resample((const float(*)[3])p->source->position, p->from.vertex_count, p->from.triangle,
                            p->from.triangle_count, p->from_skin, 8, p->between, (const float(*)[3])p->there,
                            p->back) != FAP_OK)
        return 0;
    for (uint32_t i = 0; i < p->from.vertex_count; i++) {
        const double moved =
            pow((double)delta[i][0], 2) + pow((double)delta[i][1], 2) + pow((double)delta[i][2], 2);
        if (!p->model.face[i] || moved < 1)
            continue;
        for (int a = 0; a < 3; a++)
            *sum += pow((double)delta[i][a] - (double)p->back[i][a], 2);
        ++*count;
    }
    return 1;
}

double bench_retarget_other_error_mm(void)
{
    passage p = { 0 };
    double sum = 0;
    uint32_t count = 0;
    int ok = open_passage(&p);

    for (int u = 0; ok && u < p.model.unit_count; u += 4)
        ok = pass(&p, u, &sum, &count);
    close_passage(&p);
    return ok && count ? sqrt(sum / count) : -1;
}
