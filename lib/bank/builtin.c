/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The face the library always carries, made into a bank: mesh, feature points, units, and the key models
 * composed of them (fap_tables/key_models.csv). Good enough to prove the code and to stand in where no better
 * face is there.
 */
#include <string.h>

#include "bank/bank.h"
#include "bank/builtin.h"
#include "bank/pack.h"
#include "bank/recipe.h"
#include "base/mem.h"

/* Where a point of the left half or the midline is; its mirror image serves the right half. */
typedef struct place {
    const char *point;
    enum {
        AT_UPPER,
        AT_LOWER,
        AT_LIP_UPPER,
        AT_LIP_LOWER,
        AT_EYE,
        AT_TEETH_UPPER,
        AT_TEETH_LOWER,
        AT_TONGUE,
        AT_FIXED
    } at;
    int row, column; /* of the grid, the tongue, or the edges of the teeth; columns count from the midline */
    float fixed[3];  /* AT_FIXED */
} place;

static const place places[] = {
    { "2.1", AT_UPPER, 17, 0, { 0 } },
    { "2.2", AT_LIP_UPPER, 0, 0, { 0 } },
    { "2.3", AT_LIP_LOWER, 0, 0, { 0 } },
    { "2.4", AT_LIP_UPPER, 0, MOUTH_CORNER, { 0 } },
    { "2.6", AT_LIP_UPPER, 0, 2, { 0 } },
    { "2.8", AT_LIP_LOWER, 0, 2, { 0 } },
    { "2.10", AT_UPPER, 16, 0, { 0 } },
    { "2.11", AT_UPPER, 17, 4, { 0 } },
    { "2.13", AT_UPPER, 13, 9, { 0 } },
    { "3.1", AT_UPPER, ROW_EYE, 5, { 0 } },
    { "3.3", AT_LOWER, ROW_EYE, 5, { 0 } },
    { "3.5", AT_EYE, 0, 0, { 0 } },
    { "3.7", AT_UPPER, ROW_EYE, EYE_OUTER, { 0 } },
    { "3.9", AT_UPPER, ROW_EYE + 1, 5, { 0 } },
    { "3.11", AT_UPPER, ROW_EYE, EYE_INNER, { 0 } },
    { "3.13", AT_UPPER, ROW_CREASE, 5, { 0 } },
    { "4.1", AT_UPPER, ROW_BROW, 2, { 0 } },
    { "4.3", AT_UPPER, ROW_BROW, 5, { 0 } },
    { "4.5", AT_UPPER, ROW_BROW, 7, { 0 } },
    { "5.1", AT_UPPER, ROW_MOUTH, 7, { 0 } },
    { "5.3", AT_UPPER, 9, 7, { 0 } },
    { "6.1", AT_TONGUE, TONGUE_ROWS - 1, 0, { 0 } },
    { "6.2", AT_TONGUE, 3, 0, { 0 } },
    { "6.3", AT_TONGUE, 3, TONGUE_COLUMNS / 2, { 0 } },
    { "7.1", AT_FIXED, 0, 0, { 0 } },
    { "8.1", AT_UPPER, ROW_MOUTH - 1, 0, { 0 } },
    { "8.2", AT_UPPER, ROW_MOUTH + 1, 0, { 0 } },
    { "8.3", AT_UPPER, ROW_MOUTH, MOUTH_CORNER + 1, { 0 } },
    { "8.5", AT_UPPER, ROW_MOUTH - 1, 3, { 0 } },
    { "8.7", AT_UPPER, ROW_MOUTH + 1, 3, { 0 } },
    { "8.10", AT_UPPER, ROW_MOUTH - 1, 1, { 0 } },
    { "9.1", AT_UPPER, 10, 3, { 0 } },
    { "9.3", AT_UPPER, 10, 0, { 0 } },
    { "9.5", AT_UPPER, 11, 2, { 0 } },
    { "9.7", AT_UPPER, 6, 1, { 0 } },
    { "9.8", AT_TEETH_UPPER, 0, 0, { 0 } },
    { "9.9", AT_TEETH_LOWER, 1, 0, { 0 } },
    { "9.10", AT_TEETH_UPPER, 1, 0, { 0 } },
    { "9.11", AT_TEETH_LOWER, 0, 0, { 0 } },
    { "9.12", AT_UPPER, 8, 0, { 0 } },
    { "9.13", AT_UPPER, 8, 2, { 0 } },
    { "9.15", AT_UPPER, 11, 0, { 0 } },
    { "10.1", AT_UPPER, 6, 9, { 0 } },
    { "10.3", AT_UPPER, 8, 9, { 0 } },
    { "10.5", AT_UPPER, 10, 9, { 0 } },
    { "10.7", AT_FIXED, 0, 0, { 66, -9, 34 } },
    { "10.9", AT_FIXED, 0, 0, { 71, 31, 40 } },
    { "11.1", AT_UPPER, 1, 0, { 0 } },
    { "11.3", AT_UPPER, 2, 8, { 0 } },
    { "11.4", AT_FIXED, 0, 0, { 0, 143, 31 } },
    { "11.5", AT_FIXED, 0, 0, { 0, 143, 31 } },
    { "11.6", AT_UPPER, 6, CAGE_SIDE, { 0 } },
};

/* What is needed only while the bank is made. */
typedef struct maker {
    fap_bank *bank;
    cage_fine *face;
    float *motion; /* of the key at hand */
} maker;

static uint32_t sheet_vertex(uint32_t first, int columns, int row, int column)
{
    return first + (uint32_t)(row * columns + columns / 2 + column);
}

/* A cage's vertex keeps its number in the face. */
static uint32_t place_vertex(const cage_fine *f, const place *p, int right)
{
    const cage *c = &f->cage;
    const int column = right ? -p->column : p->column;

    switch (p->at) {
    case AT_UPPER: return c->upper[p->row][CAGE_SIDE + column];
    case AT_LOWER: return c->lower[p->row][CAGE_SIDE + column];
    case AT_LIP_UPPER: return c->lip_upper[MOUTH_CORNER + column];
    case AT_LIP_LOWER: return c->lip_lower[MOUTH_CORNER + column];
    case AT_EYE: return f->eye[right];
    case AT_TEETH_UPPER: return sheet_vertex(f->teeth_upper, TEETH_COLUMNS, p->row, column);
    case AT_TEETH_LOWER: return sheet_vertex(f->teeth_lower, TEETH_COLUMNS, p->row, column);
    case AT_TONGUE: return sheet_vertex(f->tongue, TONGUE_COLUMNS, p->row, column);
    case AT_FIXED: break;
    }
    return 0;
}

static fap_err set_point(maker *m, const place *p, int point, int right)
{
    fap_bank_point *out = &m->bank->point[point];

    out->present = 1;
    if (p->at == AT_FIXED) {
        memcpy(out->position_mm, p->fixed, sizeof out->position_mm);
        if (right)
            out->position_mm[0] = -out->position_mm[0];
        return FAP_OK;
    }
    uint32_t *vertex = fap_bank_keep(m->bank, 1, sizeof *vertex);
    if (!vertex)
        return FAP_E_NOMEM;
    *vertex = place_vertex(m->face, p, right);
    memcpy(out->position_mm, m->face->position[*vertex], sizeof out->position_mm);
    out->vertex = vertex;
    out->vertex_count = 1;
    return FAP_OK;
}

static fap_err set_points(maker *m)
{
    fap_err err = FAP_OK;

    for (size_t i = 0; !err && i < sizeof places / sizeof *places; i++) {
        const int point = fap_point_by_name(places[i].point), mirror = fap_point_get(point)->mirror;
        err = set_point(m, &places[i], point, 0);
        if (!err && mirror != point)
            err = set_point(m, &places[i], mirror, 1);
    }
    return err;
}

static fap_err measure(maker *m)
{
    float points[FAP_POINT_COUNT][3];

    for (int i = 0; i < FAP_POINT_COUNT; i++)
        memcpy(points[i], m->bank->point[i].position_mm, sizeof points[i]);
    return fap_fapu_measure((const float(*)[3])points, &m->bank->fapu);
}

static fap_err set_mesh(maker *m)
{
    const cage_fine *c = m->face;
    const uint32_t n = c->vertex_count, stride = (n + FAP_BLOCK - 1) / FAP_BLOCK * FAP_BLOCK;
    float *position = fap_bank_keep(m->bank, 3 * stride, sizeof *position);
    uint8_t *bytes = fap_bank_keep(m->bank, 6 * stride, 1);
    uint32_t *triangle = fap_bank_keep(m->bank, c->triangle_count, sizeof *c->triangle);

    if (!position || !bytes || !triangle)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < n; v++)
        for (int axis = 0; axis < 3; axis++)
            position[axis * stride + v] = c->position[v][axis];
    memcpy(bytes, c->colour, 4 * n);
    memcpy(bytes + 4 * stride, c->part, n);
    memcpy(bytes + 5 * stride, c->weight, n);
    memcpy(triangle, c->triangle, c->triangle_count * sizeof *c->triangle);
    m->bank->mesh =
        (fap_mesh){ n,     stride, c->triangle_count, position, bytes + 4 * stride, bytes + 5 * stride,
                    bytes, NULL,   triangle };
    return FAP_OK;
}

static void set_eyes(fap_bank *bank)
{
    for (int right = 0; right < 2; right++) {
        memcpy(bank->eye[right].centre_mm, cage_eye_centre, sizeof cage_eye_centre);
        bank->eye[right].radius_mm = cage_eye_radius;
    }
    bank->eye[1].centre_mm[0] = -cage_eye_centre[0];
}

/* Keeps what m->motion holds as the next key model. Units come before the models made of them. */
static fap_err add_key(maker *m, const char *name, fap_key_kind kind, int number)
{
    const uint32_t stride = m->bank->mesh.stride, count = fap_pack_blocks(m->motion, stride, NULL);
    uint16_t *block = fap_bank_keep(m->bank, count, sizeof *block);
    int16_t *delta = fap_bank_keep(m->bank, (size_t)count * 3 * FAP_BLOCK, sizeof *delta);
    float(*point_mm)[3] = fap_bank_keep(m->bank, FAP_POINT_COUNT, sizeof *point_mm);

    if (!block || !delta || !point_mm)
        return FAP_E_NOMEM;
    const float scale_mm = fap_pack_scale(m->motion, stride);
    fap_pack_blocks(m->motion, stride, block);
    fap_pack_delta(m->motion, stride, block, count, scale_mm, delta);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int axis = 0; m->bank->point[p].vertex_count && axis < 3; axis++)
            point_mm[p][axis] = m->motion[axis * stride + m->bank->point[p].vertex[0]];
    m->bank->key[m->bank->key_count++] =
        (fap_key){ name,     (uint8_t)kind, (uint8_t)number, count,
                   scale_mm, block,         delta,           (const float(*)[3])point_mm };
    memset(m->motion, 0, 3 * (size_t)stride * sizeof *m->motion);
    return FAP_OK;
}

/* Each run of recipe rows becomes a key. */
static fap_err add_models(maker *m)
{
    fap_recipe_row r;
    fap_err err = FAP_OK;

    for (int i = 0; !err && fap_recipe_get(i, &r); i++) {
        cage_unit_add(m->face, cage_unit_find(r.unit), r.weight, m->motion, m->bank->mesh.stride);
        if (r.last)
            err = add_key(m, r.name, r.kind, r.number);
    }
    return err;
}

static fap_err add_units(maker *m)
{
    fap_err err = FAP_OK;

    for (int u = 0; !err && u < cage_unit_count(); u++) {
        cage_unit_add(m->face, u, 1, m->motion, m->bank->mesh.stride);
        err = add_key(m, cage_unit_name(u), FAP_KEY_UNIT, 0);
    }
    return err;
}

static int key_count(void)
{
    fap_recipe_row r;
    int count = cage_unit_count();

    for (int i = 0; fap_recipe_get(i, &r); i++)
        count += r.last;
    return count;
}

static fap_err make(maker *m)
{
    m->bank->key = fap_bank_keep(m->bank, (size_t)key_count(), sizeof *m->bank->key);
    if (!m->bank->key)
        return FAP_E_NOMEM;
    strcpy(m->bank->name, "built-in");
    cage_build(m->face);
    set_eyes(m->bank);
    fap_err err = set_mesh(m);
    if (!err)
        err = set_points(m);
    if (!err)
        err = measure(m);
    if (!err)
        err = add_models(m);
    if (!err)
        err = add_units(m);
    return err;
}

fap_err fap_bank_builtin(fap_bank **out, const fap_allocator *alloc)
{
    *out = NULL;
    maker m = { fap_bank_new(alloc), NULL, NULL };
    if (!m.bank)
        return FAP_E_NOMEM;
    const fap_allocator a = m.bank->alloc;
    m.face = fap_mem_calloc(&a, 1, sizeof *m.face);
    m.motion = fap_mem_calloc(&a, 3 * FINE_MAX_VERTICES, sizeof *m.motion);

    const fap_err err = m.face && m.motion ? make(&m) : FAP_E_NOMEM;
    fap_mem_free(&a, m.face);
    fap_mem_free(&a, m.motion);
    if (err)
        fap_bank_close(&m.bank);
    *out = m.bank;
    return err;
}
