/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A generic face laid onto scans whose truth is known: ICT-FaceKit's face (9,409 vertices) onto people made of its identity
 * modes, scanned with 37,000 triangles of another mesh, 0.2 mm of noise, every tenth of them missing, in another unit and
 * other axes, with 68 landmarks that are 1 mm off along each axis.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/registration.h>

#include "bench.h"
#include "base/mem.h"
#include "common/file.h"
#include "ict.h"
#include "registration/loop.h"
#include "shape/obj.h"
#include "shape/target.h"
#include "surface/edges.h"
#include "surface/nearest.h"
#include "surface/normals.h"

static const char folder[] = "../shared/data/faces/ict";
static const double noise_mm = 0.2, pin_noise_mm = 1, missing = 0.1, many_triangles = 700000;

enum { FACE = ICT_FACE_VERTICES, MODES = 10, PEOPLE = 3, LANDMARKS = 68, FILE_MAX = 64 << 20 };

typedef struct person {
    float (*truth)[3]; /* [FACE] millimetres, head axes */
    fap_surface *scan;
    fap_pin pin[LANDMARKS];
} person;

typedef struct stage {
    float (*face)[3]; /* [FACE] the generic face */
    uint8_t *mask;    /* [FACE] */
    uint32_t (*triangle)[3];
    uint32_t triangle_count, quad_count;
    uint32_t (*quad)[4];
    uint32_t landmark[LANDMARKS];
    double mm_per_unit;
    float (*mode[MODES])[3]; /* [all vertices of the model] */
    uint32_t all;
} stage;

/* --- numbers by chance, the same each time --- */

static double chance(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static double bell(uint64_t *state)
{
    const double u = fmax(1e-12, chance(state)), v = chance(state);
    return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

/* --- the model --- */

static int read_text(const char *name, uint8_t **text, size_t *size)
{
    char path[256];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return file_read(path, FILE_MAX, text, size) == FAP_OK;
}

static int read_landmarks(stage *s)
{
    uint8_t *text;
    size_t size;

    if (!read_text("vertex_indices.json", &text, &size))
        return 0;
    const char *p = strstr((char *)text, "idx_to_landmark_verts");
    p = p ? strchr(p, '[') : NULL;
    int count = 0;
    for (; p && count < LANDMARKS; count++) {
        char *end;
        s->landmark[count] = (uint32_t)strtoul(p + 1, &end, 10);
        p = end > p + 1 && s->landmark[count] < FACE ? end : NULL;
    }
    free(text);
    return p != NULL;
}

static int read_modes(stage *s)
{
    for (int m = 0; m < MODES; m++) {
        char name[64];
        uint8_t *text;
        size_t size;
        snprintf(name, sizeof name, "identity/identity%03d.target", m);
        s->mode[m] = calloc(s->all, sizeof *s->mode[m]);
        if (!s->mode[m] || !read_text(name, &text, &size))
            return 0;
        const fap_err err = fap_target_add((char *)text, (float)s->mm_per_unit, s->mode[m], s->all, NULL);
        free(text);
        if (err != FAP_OK)
            return 0;
    }
    return 1;
}

static int is_of_face(const fap_obj *o, const fap_obj_face *f)
{
    for (uint32_t k = 0; k < f->count; k++)
        if (o->vertex[f->first + k] >= FACE)
            return 0;
    return f->count == 4;
}

static int take_faces(stage *s, const fap_obj *o)
{
    s->quad = calloc(o->face_count, sizeof *s->quad);
    s->triangle = calloc(2 * (size_t)o->face_count, sizeof *s->triangle);
    for (uint32_t i = 0; s->quad && s->triangle && i < o->face_count; i++) {
        const uint32_t *v = o->vertex + o->face[i].first;
        if (!is_of_face(o, &o->face[i]))
            continue;
        memcpy(s->quad[s->quad_count++], v, sizeof *s->quad);
        memcpy(s->triangle[s->triangle_count++], (uint32_t[3]){ v[0], v[1], v[2] }, sizeof *s->triangle);
        memcpy(s->triangle[s->triangle_count++], (uint32_t[3]){ v[0], v[2], v[3] }, sizeof *s->triangle);
    }
    return s->quad && s->triangle;
}

static int read_model(stage *s)
{
    uint8_t *text;
    size_t size;
    fap_obj o;
    ict model;

    if (!ict_open(&model))
        return 0;
    s->all = model.vertex_count;
    s->mm_per_unit = model.mm_per_unit;
    s->face = calloc(FACE, sizeof *s->face);
    s->mask = calloc(FACE, 1);
    int ok = s->face && s->mask && read_text("generic_neutral_mesh.obj", &text, &size);
    if (ok) {
        ok = fap_obj_parse(&o, (char *)text, size, NULL) == FAP_OK;
        free(text);
    }
    for (uint32_t v = 0; ok && v < FACE; v++)
        for (int a = 0; a < 3; a++)
            s->face[v][a] = (float)(s->mm_per_unit * (double)o.position[v][a]);
    for (uint32_t v = 0; ok && v < model.vertex_count; v++)
        if (ict_original(&model, v) < FACE)
            s->mask[ict_original(&model, v)] = fap_bank_masks(model.bank)[v];
    ok = ok && take_faces(s, &o);
    if (ok)
        fap_obj_free(&o);
    ict_close(&model);
    return ok && read_landmarks(s) && read_modes(s);
}

static void free_model(stage *s)
{
    free(s->face);
    free(s->mask);
    free(s->quad);
    free(s->triangle);
    for (int m = 0; m < MODES; m++)
        free(s->mode[m]);
}

/* --- a person, scanned --- */

/* The scanner's axes: turned by 20 degrees about a slanted axis, somewhere else, in centimetres. */
static void to_scanner(const double mm[3], float out[3])
{
    static const double r[3][3] = { { 0.9495, -0.3005, 0.0900 },
                                    { 0.3091, 0.9440, -0.1147 },
                                    { -0.0505, 0.1367, 0.9893 } };

    for (int a = 0; a < 3; a++)
        out[a] = (float)((r[a][0] * mm[0] + r[a][1] * mm[1] + r[a][2] * mm[2]) / 10 + 3 * a - 2);
}

static int make_truth(const stage *s, person *p, uint64_t *seed)
{
    p->truth = malloc(FACE * sizeof *p->truth);
    if (!p->truth)
        return 0;
    memcpy(p->truth, s->face, FACE * sizeof *p->truth);
    for (int m = 0; m < MODES; m++) {
        const double weight = bell(seed);
        for (uint32_t v = 0; v < FACE; v++)
            for (int a = 0; a < 3; a++)
                p->truth[v][a] += (float)(weight * (double)s->mode[m][v][a]);
    }
    return 1;
}

/* Vertices of the scan, noise free: the face's, and the middle of each quad. */
static void place(const stage *s, const person *p, uint32_t v, double at[3])
{
    for (int a = 0; a < 3; a++) {
        if (v < FACE) {
            at[a] = (double)p->truth[v][a];
            continue;
        }
        const uint32_t *q = s->quad[v - FACE];
        at[a] = ((double)p->truth[q[0]][a] + (double)p->truth[q[1]][a] + (double)p->truth[q[2]][a] +
                 (double)p->truth[q[3]][a]) /
                4;
    }
}

static int scan_person(const stage *s, person *p, uint64_t *seed)
{
    const uint32_t vertices = FACE + s->quad_count;
    uint32_t t = 0;

    if (fap_surface_create(&p->scan, vertices, 4 * s->quad_count, NULL) != FAP_OK)
        return 0;
    for (uint32_t v = 0; v < vertices; v++) {
        double at[3];
        place(s, p, v, at);
        for (int a = 0; a < 3; a++)
            at[a] += noise_mm * bell(seed);
        to_scanner(at, p->scan->position[v]);
    }
    for (uint32_t q = 0; q < s->quad_count; q++)
        for (int k = 0; k < 4; k++) {
            const uint32_t corner[3] = { s->quad[q][k], s->quad[q][(k + 1) % 4], FACE + q };
            if (chance(seed) >= missing)
                memcpy(p->scan->triangle[t++], corner, sizeof corner);
        }
    p->scan->triangle_count = t;
    return 1;
}

static void click(const stage *s, person *p, uint64_t *seed)
{
    for (int i = 0; i < LANDMARKS; i++) {
        const uint32_t v = s->landmark[i];
        double at[3];
        for (int a = 0; a < 3; a++)
            at[a] = (double)p->truth[v][a] + pin_noise_mm * bell(seed);
        p->pin[i] = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        to_scanner(at, p->pin[i].at);
    }
}

static void free_person(person *p)
{
    free(p->truth);
    fap_surface_close(&p->scan);
}

/* --- what came out --- */

typedef struct outcome {
    double seconds, surface2, correspondence2;
    uint32_t count, folds, wrong, clearly_wrong;
} outcome;

static uint8_t across(uint8_t mask)
{
    const uint8_t upper = mask & 0x15, lower = mask & 0x2a;
    return (uint8_t)(upper << 1 | lower >> 1);
}

/* A vertex of one lip that has come to lie on the other. */
static int is_wrong(const stage *s, uint32_t v, const surface_hit *h)
{
    uint8_t there = 0;

    for (int c = 0; c < 3; c++)
        if (h->share[c] > 0.01F)
            there |= s->mask[s->triangle[h->triangle][c]];
    return (there & across(s->mask[v])) && !(there & s->mask[v]);
}

/* The truth's triangles of one side of a slit. */
typedef struct own_side {
    const stage *s;
    uint8_t mask;
} own_side;

static int is_own(const void *user, uint32_t t)
{
    const own_side *o = user;

    for (int c = 0; c < 3; c++)
        if (o->s->mask[o->s->triangle[t][c]] & o->mask)
            return 1;
    return 0;
}

/* By more than what the scan's noise can hide where lips touch. */
static int is_clearly_wrong(const stage *s, const surface_index *truth, const float at[3], uint32_t v,
                            const surface_hit *other)
{
    const own_side side = { s, s->mask[v] };
    surface_hit own;

    return !surface_index_nearest(truth, at, 100, is_own, &side, &own) ||
           (double)own.distance > (double)other->distance + noise_mm;
}

static double turn(const float (*at)[3], const stage *s, const surface_edge *e)
{
    double n[2][3];

    for (int k = 0; k < 2; k++)
        surface_triangle_normal(at, (const uint32_t *)s->triangle[e->triangle[k]], n[k]);
    return n[0][0] * n[1][0] + n[0][1] * n[1][1] + n[0][2] * n[1][2];
}

/* Edges that are sharper than a right angle, and are not so on the person. */
static uint32_t count_folds(const stage *s, const person *p, const float (*at)[3])
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    surface_edges e;
    uint32_t count = 0;

    if (surface_edges_find(&e, (const uint32_t(*)[3])s->triangle, s->triangle_count, FACE, &heap) != FAP_OK)
        return UINT32_MAX;
    for (uint32_t i = 0; i < e.count; i++)
        count += e.edge[i].triangles == 2 && turn(at, s, &e.edge[i]) < 0 &&
                 turn((const float(*)[3])p->truth, s, &e.edge[i]) > 0;
    surface_edges_free(&e, &heap);
    return count;
}

/* The true surface, without noise and holes, where the registration says that the head is. */
static int bring_truth(person *p, const fap_registration *r)
{
    for (uint32_t v = 0; v < FACE; v++) {
        const double at[3] = { (double)p->truth[v][0], (double)p->truth[v][1], (double)p->truth[v][2] };
        float scan[3];
        to_scanner(at, scan);
        fap_registration_to_head(r, scan, p->truth[v]);
    }
    return 1;
}

static int judge(const stage *s, person *p, const fap_registration *r, outcome *o)
{
    const float(*at)[3] = fap_registration_positions(r);
    surface_index *truth;

    if (!bring_truth(p, r) ||
        surface_index_open(&truth, (const float(*)[3])p->truth, FACE, (const uint32_t(*)[3])s->triangle,
                           s->triangle_count) != FAP_OK)
        return 0;
    for (uint32_t v = 0; v < FACE; v++) {
        surface_hit h;
        if (!surface_index_nearest(truth, at[v], 100, NULL, NULL, &h))
            continue;
        o->count++;
        o->surface2 += (double)h.distance * (double)h.distance;
        if (is_wrong(s, v, &h)) {
            o->wrong++;
            o->clearly_wrong += (uint32_t)is_clearly_wrong(s, truth, at[v], v, &h);
        }
        for (int a = 0; a < 3; a++)
            o->correspondence2 += pow((double)at[v][a] - (double)p->truth[v][a], 2);
    }
    surface_index_close(&truth);
    o->folds += count_folds(s, p, at);
    return 1;
}

static int fit_person(const stage *s, person *p, fap_registration_method method, outcome *o)
{
    const fap_generic g = { .vertex_count = FACE,
                            .triangle_count = s->triangle_count,
                            .position = (const float(*)[3])s->face,
                            .triangle = (const uint32_t(*)[3])s->triangle,
                            .mask = s->mask };
    fap_registration_config cfg;
    fap_registration *r;

    fap_registration_config_init(&cfg);
    cfg.method = method;
    const double begin = bench_now_s();
    if (fap_register(&r, &g, p->scan, p->pin, LANDMARKS, &cfg, NULL) != FAP_OK)
        return 0;
    o->seconds += bench_now_s() - begin;
    const int ok = judge(s, p, r, o);
    fap_registration_close(&r);
    return ok;
}

static int fit_people(fap_registration_method method, outcome *o)
{
    stage s = { 0 };
    uint64_t seed = 7;
    int ok = read_model(&s);

    for (int i = 0; i < PEOPLE && ok; i++) {
        person p = { 0 };
        ok = make_truth(&s, &p, &seed) && scan_person(&s, &p, &seed);
        if (ok) {
            click(&s, &p, &seed);
            ok = fit_person(&s, &p, method, o);
        }
        free_person(&p);
    }
    free_model(&s);
    return ok;
}

/* --- as large as a laser scanner makes them --- */

/* The person's face made finer three times, and as many of its triangles left out as are too many. */
static int scan_finely(const stage *s, person *p, uint64_t *seed)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    loop_mesh m[3] = { { 0 } };
    fap_err err = loop_subdivide(&m[0], (const float(*)[3])p->truth, FACE, (const uint32_t(*)[3])s->triangle,
                                 s->triangle_count, NULL, NULL, &heap);

    for (int i = 1; i < 3 && err == FAP_OK; i++)
        err = loop_subdivide(&m[i], (const float(*)[3])m[i - 1].position, m[i - 1].vertex_count,
                             (const uint32_t(*)[3])m[i - 1].triangle, m[i - 1].triangle_count, NULL, NULL,
                             &heap);
    if (err == FAP_OK)
        err = fap_surface_create(&p->scan, m[2].vertex_count, m[2].triangle_count, NULL);
    for (uint32_t v = 0; err == FAP_OK && v < m[2].vertex_count; v++) {
        double at[3];
        for (int a = 0; a < 3; a++)
            at[a] = (double)m[2].position[v][a] + 0.02 * bell(seed);
        to_scanner(at, p->scan->position[v]);
    }
    if (err == FAP_OK) {
        const double kept = many_triangles / (double)m[2].triangle_count;
        p->scan->triangle_count = 0;
        for (uint32_t t = 0; t < m[2].triangle_count; t++)
            if (chance(seed) < kept)
                memcpy(p->scan->triangle[p->scan->triangle_count++], m[2].triangle[t],
                       sizeof *p->scan->triangle);
    }
    for (int i = 0; i < 3; i++)
        loop_free(&m[i], &heap);
    return err == FAP_OK;
}

double bench_fit_700k_s(void)
{
    stage s = { 0 };
    person p = { 0 };
    outcome o = { 0 };
    uint64_t seed = 11;
    int ok = read_model(&s) && make_truth(&s, &p, &seed) && scan_finely(&s, &p, &seed);

    if (ok) {
        click(&s, &p, &seed);
        ok = fit_person(&s, &p, FAP_REGISTER_AUTO, &o);
    }
    free_person(&p);
    free_model(&s);
    return ok ? o.seconds : -1;
}

/* Measured once a method, asked for five times. */
static const outcome *outcome_of(fap_registration_method method)
{
    static outcome outcomes[FAP_REGISTER_COUNT];
    static int state[FAP_REGISTER_COUNT];

    if (!state[method])
        state[method] = fit_people(method, &outcomes[method]) ? 1 : -1;
    return state[method] > 0 ? &outcomes[method] : NULL;
}

#define X(name, method)                                                                                      \
    double bench_fit_s_##name(void)                                                                          \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? o->seconds / PEOPLE : -1;                                                                 \
    }                                                                                                        \
    double bench_fit_surface_rms_mm_##name(void)                                                             \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? sqrt(o->surface2 / o->count) : -1;                                                        \
    }                                                                                                        \
    double bench_fit_correspondence_rms_mm_##name(void)                                                      \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? sqrt(o->correspondence2 / o->count) : -1;                                                 \
    }                                                                                                        \
    double bench_fit_folds_##name(void)                                                                      \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? (double)o->folds / PEOPLE : -1;                                                           \
    }                                                                                                        \
    double bench_fit_wrong_lip_##name(void)                                                                  \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? (double)o->wrong / PEOPLE : -1;                                                           \
    }                                                                                                        \
    double bench_fit_wrong_lip_clear_##name(void)                                                            \
    {                                                                                                        \
        const outcome *o = outcome_of(method);                                                               \
        return o ? (double)o->clearly_wrong / PEOPLE : -1;                                                   \
    }
BENCH_REGISTRATION(X)
#undef X
