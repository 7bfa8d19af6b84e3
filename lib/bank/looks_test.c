/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What one sees of every blend method, measured instead of looked at, on the moments of scripts/method_sheet: lips that
 * close on p, b and m along their whole length, lids that shut, no seam between regions. The face is drawn from the front
 * into a small depth buffer, so what counts is what is in sight, not where feature points are.
 */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/ascii.h>
#include <fap/face.h>

#include "bank/face.h"
#include "bank/faces_test.h"

enum { VISEME_PP, REST, LIPS_PP, AA, SMILE, BLINK, BROWS, SURPRISE, MOMENTS };

static size_t read_file(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

static void read_moments(fap_frame moment[MOMENTS])
{
    FILE *f = fopen("tests/assets/moments.fap", "rb");
    fap_ascii_reader *reader;

    assert_non_null(f);
    const fap_reader in = { read_file, f };
    assert_int_equal(fap_ascii_reader_open(&reader, &in, NULL, NULL), FAP_OK);
    for (int i = 0; i < MOMENTS; i++)
        assert_int_equal(fap_ascii_reader_next(reader, &moment[i]), FAP_OK);
    fap_ascii_reader_close(&reader);
    fclose(f);
}

typedef struct rig {
    fap_bank *bank;
    const fap_mesh *mesh;
    fap_face *face;
    float *position;
    float point[FAP_POINT_COUNT][3];
} rig;

static void open_rig(rig *r, int which, fap_blend blend, int regions)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.regions = regions;
    r->bank = test_bank(which);
    r->mesh = fap_bank_mesh(r->bank);
    assert_int_equal(fap_face_open(&r->face, r->bank, &cfg), FAP_OK);
    r->position = aligned_alloc(32, 3 * r->mesh->stride * sizeof(float));
}

static void close_rig(rig *r)
{
    free(r->position);
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
}

static void pose(rig *r, const fap_frame *f)
{
    fap_face_pose(r->face, f, r->position, NULL);
    fap_face_points(r->face, r->point);
}

static const float *point(const rig *r, const char *name)
{
    return r->point[fap_point_by_name(name)];
}

/* --- a window onto the face, from the front --- */

enum { CELLS = 320 };
static const float cell_mm = 0.25f;

typedef struct window {
    float left, bottom;
    float depth[CELLS][CELLS]; /* z of what is in front, [row from below][column] */
    uint8_t part[CELLS][CELLS];
} window;

static void vertex_of(const rig *r, uint32_t v, float out[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = r->position[axis * r->mesh->stride + v];
}

static int cell_of(float mm, float from)
{
    return (int)fminf(CELLS, fmaxf(0, ceilf((mm - from) / cell_mm)));
}

static void draw_cell(window *w, int row, int column, const float p[3][3], int part)
{
    const float x = w->left + (float)column * cell_mm, y = w->bottom + (float)row * cell_mm;
    const float *a = p[0], *b = p[1], *c = p[2];
    const float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    const float u = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area;
    const float v = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area;
    const float z = u * a[2] + v * b[2] + (1 - u - v) * c[2], slack = -1e-3f;

    if (area != 0 && u >= slack && v >= slack && u + v <= 1 - slack && z > w->depth[row][column]) {
        w->depth[row][column] = z;
        w->part[row][column] = (uint8_t)part;
    }
}

static void draw_triangle(window *w, const rig *r, const uint32_t *t)
{
    float p[3][3], lo[2], hi[2];

    for (int i = 0; i < 3; i++)
        vertex_of(r, t[i], p[i]);
    for (int i = 0; i < 2; i++) {
        lo[i] = fminf(p[0][i], fminf(p[1][i], p[2][i]));
        hi[i] = fmaxf(p[0][i], fmaxf(p[1][i], p[2][i]));
    }
    for (int row = cell_of(lo[1], w->bottom); row < cell_of(hi[1], w->bottom); row++)
        for (int column = cell_of(lo[0], w->left); column < cell_of(hi[0], w->left); column++)
            draw_cell(w, row, column, (const float(*)[3])p, r->mesh->part[t[0]]);
}

/* Lashes hide nothing. The caller frees. */
static window *look(const rig *r, float x, float y)
{
    window *w = malloc(sizeof *w);

    w->left = x - CELLS / 2 * cell_mm;
    w->bottom = y - CELLS / 2 * cell_mm;
    memset(w->part, FAP_PART_SKIN, sizeof w->part);
    for (int i = 0; i < CELLS * CELLS; i++)
        w->depth[i / CELLS][i % CELLS] = -1000;
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++)
        if (r->mesh->part[r->mesh->triangle[3 * t]] != FAP_PART_LASHES)
            draw_triangle(w, r, r->mesh->triangle + 3 * t);
    return w;
}

/* --- lips --- */

enum { NEAR_CELLS = 72 };
static const float fold_mm = 6;

static float front_of(const window *w, int row, int column, int step)
{
    float front = -1000;

    for (int i = 1; i <= NEAR_CELLS; i++)
        front = fmaxf(front, w->depth[row + i * step][column]);
    return front;
}

/* Teeth, the tongue, and what lies deeper behind its surroundings above and below than any fold of lips and chin. */
static int sees_inside(const window *w, int row, int column)
{
    const int part = w->part[row][column];
    const float front = fminf(front_of(w, row, column, 1), front_of(w, row, column, -1));

    return part == FAP_PART_TEETH_UPPER || part == FAP_PART_TEETH_LOWER || part == FAP_PART_TONGUE ||
           w->depth[row][column] < front - fold_mm;
}

/* The highest opening between the corners of the mouth, in millimetres. */
static float widest_gap(const rig *r)
{
    const float left = point(r, "2.4")[0], right = point(r, "2.5")[0];
    window *w = look(r, 0, (point(r, "2.2")[1] + point(r, "2.3")[1]) / 2);
    int most = 0;

    for (int column = cell_of(right + 2, w->left); column < cell_of(left - 2, w->left); column++) {
        int open = 0;
        for (int row = NEAR_CELLS; row < CELLS - NEAR_CELLS; row++)
            open += sees_inside(w, row, column);
        most = open > most ? open : most;
    }
    free(w);
    return (float)most * cell_mm;
}

/* --- lids --- */

/* How much of both eyeballs is in sight, in square millimetres. */
static float eyes_in_sight(const rig *r)
{
    float cells = 0;

    for (int right = 0; right < 2; right++) {
        const float *eye = point(r, right ? "3.6" : "3.5");
        window *w = look(r, eye[0], eye[1]);
        for (int i = 0; i < CELLS * CELLS; i++) {
            const int part = w->part[i / CELLS][i % CELLS];
            cells += part == (right ? FAP_PART_EYE_RIGHT : FAP_PART_EYE_LEFT);
        }
        free(w);
    }
    return cells * cell_mm * cell_mm;
}

/* --- seams --- */

static int is_shared(const fap_regions *regions, uint32_t v)
{
    const float *share = regions->map + (size_t)v / FAP_BLOCK * FAP_REGION_MAX * FAP_BLOCK;

    for (size_t i = v % FAP_BLOCK; i < FAP_REGION_MAX * FAP_BLOCK; i += FAP_BLOCK)
        if (share[i] > 0 && share[i] < 1)
            return 1;
    return 0;
}

static float length_of(const float *p, size_t stride, uint32_t a, uint32_t b)
{
    float square = 0;

    for (size_t axis = 0; axis < 3; axis++)
        square += powf(p[axis * stride + a] - p[axis * stride + b], 2);
    return sqrtf(square);
}

/* How many times its length at rest the most stretched edge of skin is, where regions share it. */
static float most_stretch(const rig *r, const fap_regions *where)
{
    const fap_mesh *m = r->mesh;
    float most = 1;

    for (uint32_t i = 0; i < 3 * m->triangle_count; i++) {
        const uint32_t a = m->triangle[i], b = m->triangle[i % 3 == 2 ? i - 2 : i + 1];
        const float rest = length_of(m->position, m->stride, a, b);
        if (m->part[a] == FAP_PART_SKIN && rest > 0.3f && is_shared(where, a) && is_shared(where, b))
            most = fmaxf(most, length_of(r->position, m->stride, a, b) / rest);
    }
    return most;
}

/* --- what is held, for every method on every face --- */

typedef void (*check)(rig *r, const char *who, const fap_frame moment[MOMENTS]);

static void check_blend(int which, fap_blend blend, int regions, const fap_frame moment[MOMENTS], check c)
{
    char who[64];
    rig r;

    snprintf(who, sizeof who, "%s face, %s, %d regions", which == BUILTIN ? "built-in" : "default",
             fap_blend_name((int)blend), regions);
    open_rig(&r, which, blend, regions);
    c(&r, who, moment);
    close_rig(&r);
}

static void check_all(int which, int least_regions, check c)
{
    fap_frame moment[MOMENTS];

    read_moments(moment);
    for (int i = 0; fap_blend_name(i); i++) {
        const int most = i == FAP_BLEND_GA || i == FAP_BLEND_ZHU ? 4 : 1;
        for (int regions = least_regions; regions <= most; regions *= 2)
            check_blend(which, (fap_blend)i, regions, moment, c);
    }
}

/* rbf has no lips to copy: where no point is, they part by up to 2 mm in the folds of the default face. */
static void lips_meet(rig *r, const char *who, const fap_frame moment[MOMENTS])
{
    static const int closed[] = { VISEME_PP, REST, LIPS_PP };
    const float most = r->face->cfg.blend == FAP_BLEND_RBF ? 2.25f : 0.5f;

    for (size_t i = 0; i < sizeof closed / sizeof *closed; i++) {
        pose(r, &moment[closed[i]]);
        const float gap = widest_gap(r), apart = point(r, "2.2")[1] - point(r, "2.3")[1];
        if (gap > most || apart > 0.4f)
            fail_msg("%s: moment %d: lips %g mm apart, their middles %g", who, closed[i], gap, apart);
    }
    pose(r, &moment[AA]);
    if (widest_gap(r) < 15)
        fail_msg("%s: the mouth opens by %g mm for an aa", who, widest_gap(r));
}

TEST(looks, lips_close_on_p_b_and_m)
{
    check_all(BUILTIN, 1, lips_meet);
}

TEST(looks, lips_of_the_default_face_close_on_p_b_and_m)
{
    check_all(DEFAULT_FACE, 1, lips_meet);
}

static void lids_meet(rig *r, const char *who, const fap_frame moment[MOMENTS])
{
    pose(r, &moment[REST]);
    const float open = eyes_in_sight(r);
    pose(r, &moment[BLINK]);
    const float shut = eyes_in_sight(r);
    if (open < 200 || shut > 0.06f * open)
        fail_msg("%s: a blink leaves %g of %g mm2 in sight", who, shut, open);
}

TEST(looks, lids_shut_in_a_blink)
{
    check_all(BUILTIN, 1, lids_meet);
}

TEST(looks, lids_of_the_default_face_shut_in_a_blink)
{
    check_all(DEFAULT_FACE, 1, lids_meet);
}

/* Held against the same method without regions, in the same skin. zhu finds another face in each region, ga hardly. */
static void no_seam(rig *r, const char *who, const fap_frame moment[MOMENTS])
{
    const float most = r->face->cfg.blend == FAP_BLEND_GA ? 1.1f : 1.5f;
    fap_face_config cfg = r->face->cfg;
    rig whole = *r;

    cfg.regions = 1;
    assert_int_equal(fap_face_open(&whole.face, r->bank, &cfg), FAP_OK);
    for (int i = 0; i < MOMENTS; i++) {
        pose(r, &moment[i]);
        const float parted = most_stretch(r, &r->face->regions);
        pose(&whole, &moment[i]);
        const float one = most_stretch(&whole, &r->face->regions);
        if (parted > most * one)
            fail_msg("%s: moment %d: skin between regions is stretched %g times, %g in one region", who, i,
                     parted, one);
    }
    fap_face_close(&whole.face);
}

TEST(looks, no_seam_between_regions)
{
    check_all(BUILTIN, 2, no_seam);
}

TEST(looks, no_seam_between_regions_of_the_default_face)
{
    check_all(DEFAULT_FACE, 2, no_seam);
}
