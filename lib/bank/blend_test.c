/* SPDX-License-Identifier: BSD-2-Clause */
/* What blend methods promise: against one another, from points in all three axes, region by region. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bank/faces_test.h"

typedef struct rig {
    fap_face *face;
    size_t stride;
    float *position;
} rig;

/* Feature points in all three axes. */
typedef struct goal {
    float mm[FAP_POINT_COUNT][3];
    uint8_t wanted[FAP_POINT_COUNT][3];
} goal;

static fap_face_config config(fap_blend blend, int regions, int residual)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.regions = regions;
    cfg.residual = residual;
    return cfg;
}

static void open_rig(rig *r, const fap_bank *bank, const fap_face_config *cfg)
{
    assert_int_equal(fap_face_open(&r->face, bank, cfg), FAP_OK);
    r->stride = fap_face_stride(r->face);
    r->position = aligned_alloc(32, 3 * r->stride * sizeof(float));
}

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    free(r->position);
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static float noise(uint32_t *seed)
{
    return (float)((int)(next(seed) % 2001) - 1000) / 1000;
}

static int translates(int fap)
{
    const fap_info *info = fap_info_get(fap);
    return info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z;
}

static void random_frame(fap_frame *frame, uint32_t seed, int range)
{
    memset(frame, 0, sizeof *frame);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (translates(fap) && next(&seed) % 3) {
            frame->state[fap] = FAP_CODED;
            frame->value[fap] = (int32_t)(next(&seed) % (uint32_t)(2 * range + 1)) - range;
        }
}

static void add_key(goal *g, const fap_key *key, float weight)
{
    for (int i = 0; i < 3 * FAP_POINT_COUNT; i++) {
        g->mm[i / 3][i % 3] += weight * key->point_mm[i / 3][i % 3];
        g->wanted[i / 3][i % 3] = 1;
    }
}

/* Four keys, whichever, and a little of what no key does. */
static void random_goal(goal *g, const fap_bank *bank, uint32_t seed)
{
    const uint32_t count = (uint32_t)fap_bank_key_count(bank);

    memset(g, 0, sizeof *g);
    for (int i = 0; i < 4; i++)
        add_key(g, fap_bank_key_get(bank, (int)(next(&seed) % count)), 0.3f + 0.5f * noise(&seed));
    for (int i = 0; i < 3 * FAP_POINT_COUNT && seed % 2; i++)
        g->mm[i / 3][i % 3] += 0.3f * noise(&seed);
}

static void pose_goal(rig *r, const goal *g)
{
    fap_face_pose_points(r->face, (const float(*)[3])g->mm, (const uint8_t(*)[3])g->wanted, r->position,
                         NULL);
}

/* --- the default against the others --- */

typedef struct trio {
    fap_bank *bank;
    rig zhu, qp, ga;
} trio;

static void open_trio(trio *t, int which, int regions)
{
    const fap_face_config zhu = config(FAP_BLEND_ZHU, regions, 0), qp = config(FAP_BLEND_QP, regions, 0),
                          ga = config(FAP_BLEND_GA, regions, 0);

    t->bank = test_bank(which);
    open_rig(&t->zhu, t->bank, &zhu);
    open_rig(&t->qp, t->bank, &qp);
    open_rig(&t->ga, t->bank, &ga);
}

static void close_trio(trio *t)
{
    close_rig(&t->zhu);
    close_rig(&t->qp);
    close_rig(&t->ga);
    fap_bank_close(&t->bank);
}

static void compare(const trio *t, uint32_t seed)
{
    fap_face_stats zhu, qp, ga;

    fap_face_last_stats(t->zhu.face, &zhu);
    fap_face_last_stats(t->qp.face, &qp);
    fap_face_last_stats(t->ga.face, &ga);
    if (ga.fitness < zhu.fitness - 1e-4f)
        fail_msg("target %u: fitness %g, below zhu's %g", seed, ga.fitness, zhu.fitness);
    if (ga.target_error_mm > qp.target_error_mm * 1.0001f + 1e-3f)
        fail_msg("target %u: %g mm, qp has %g", seed, ga.target_error_mm, qp.target_error_mm);
}

static void check_never_worse(int which, int regions, uint32_t count)
{
    trio t;

    open_trio(&t, which, regions);
    for (uint32_t seed = 1; seed <= count; seed++) {
        fap_frame frame;
        goal g;
        random_frame(&frame, seed, seed % 2 ? 300 : 40);
        fap_face_pose(t.zhu.face, &frame, t.zhu.position, NULL);
        fap_face_pose(t.qp.face, &frame, t.qp.position, NULL);
        fap_face_pose(t.ga.face, &frame, t.ga.position, NULL);
        compare(&t, seed);
        random_goal(&g, t.bank, seed);
        pose_goal(&t.zhu, &g), pose_goal(&t.qp, &g), pose_goal(&t.ga, &g);
        compare(&t, seed);
    }
    close_trio(&t);
}

TEST(blend, ga_is_never_worse_than_qp_in_mm_nor_than_zhu_in_fitness)
{
    check_never_worse(BUILTIN, 1, 150);
    check_never_worse(BUILTIN, 2, 50);
    check_never_worse(BUILTIN, 4, 100);
}

TEST(blend, ga_is_never_worse_on_the_default_face)
{
    check_never_worse(DEFAULT_FACE, 1, 100);
    check_never_worse(DEFAULT_FACE, 4, 50);
}

/* --- all three axes --- */

static float farthest_from(rig *r, const fap_bank *bank, const goal *g)
{
    float point[FAP_POINT_COUNT][3], worst = 0;

    pose_goal(r, g);
    fap_face_points(r->face, point);
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *b = fap_bank_point_get(bank, p);
        const int group = fap_point_get(p)->group;
        for (int axis = 0; axis < 3 && b->vertex_count && group != 3 && group != 9; axis++)
            worst = fmaxf(worst, fabsf(point[p][axis] - b->position_mm[axis] - g->mm[p][axis]));
    }
    return worst;
}

/* Lids slide over the eyeball and teeth are clamped: these may end elsewhere. */
static void check_points(fap_blend blend, int regions)
{
    const fap_face_config cfg = config(blend, regions, 1);
    fap_bank *bank = test_bank(BUILTIN);
    rig r;
    goal g = { 0 };

    open_rig(&r, bank, &cfg);
    add_key(&g, fap_bank_key_get(bank, fap_bank_key_number(bank, FAP_KEY_EXPRESSION, 1)), 0.7f);
    add_key(&g, fap_bank_key_get(bank, fap_bank_key_number(bank, FAP_KEY_VISEME, 10)), 0.4f);
    assert_true(farthest_from(&r, bank, &g) < 0.02f);
    close_rig(&r);
    fap_bank_close(&bank);
}

TEST(blend, points_given_in_three_axes_arrive)
{
    check_points(FAP_BLEND_QP, 1);
    check_points(FAP_BLEND_GA, 1);
    check_points(FAP_BLEND_GA, 4);
    check_points(FAP_BLEND_ZHU, 4);
    check_points(FAP_BLEND_PCA, 1);
    check_points(FAP_BLEND_RBF, 1);
}

TEST(blend, what_is_no_number_is_not_wanted)
{
    const fap_face_config cfg = config(FAP_BLEND_GA, 1, 1);
    fap_bank *bank = test_bank(BUILTIN);
    fap_face_stats stats;
    rig r;
    goal g = { 0 };

    open_rig(&r, bank, &cfg);
    for (int i = 0; i < 3 * FAP_POINT_COUNT; i++) {
        g.mm[i / 3][i % 3] = i % 2 ? NAN : INFINITY;
        g.wanted[i / 3][i % 3] = 1;
    }
    pose_goal(&r, &g);
    fap_face_last_stats(r.face, &stats);
    assert_true(stats.target_count > 0 && stats.target_count < 2 * FAP_POINT_COUNT);
    for (size_t i = 0; i < 3 * r.stride; i++)
        assert_true(fabsf(r.position[i]) < 2000);
    close_rig(&r);
    fap_bank_close(&bank);
}

/* --- regions --- */

static float gap_between(rig *r, const fap_bank *bank)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float worst = 0;

    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const uint32_t a = mesh->triangle[i], b = mesh->triangle[i % 3 == 2 ? i - 2 : i + 1];
        float before = 0, after = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const float *rest = mesh->position + axis * r->stride, *now = r->position + axis * r->stride;
            before += powf(rest[a] - rest[b], 2);
            after += powf(now[a] - now[b], 2);
        }
        worst = fmaxf(worst, sqrtf(after) - sqrtf(before));
    }
    return worst;
}

/* Left half smiles, right half frowns: with four regions it does, and no edge of the mesh tears. */
TEST(blend, regions_make_what_no_symmetric_key_shows_and_no_seam)
{
    const fap_face_config whole = config(FAP_BLEND_ZHU, 1, 0), four = config(FAP_BLEND_ZHU, 4, 0);
    fap_bank *bank = test_bank(BUILTIN);
    fap_face_stats a, b;
    rig r, s;
    goal joy = { 0 }, sad = { 0 };

    add_key(&joy, fap_bank_key_get(bank, fap_bank_key_number(bank, FAP_KEY_EXPRESSION, 1)), 1);
    add_key(&sad, fap_bank_key_get(bank, fap_bank_key_number(bank, FAP_KEY_EXPRESSION, 2)), 1);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        if (fap_bank_point_get(bank, p)->position_mm[0] < 0)
            memcpy(joy.mm[p], sad.mm[p], sizeof joy.mm[p]);
    open_rig(&r, bank, &whole);
    open_rig(&s, bank, &four);
    pose_goal(&r, &joy), pose_goal(&s, &joy);
    fap_face_last_stats(r.face, &a);
    fap_face_last_stats(s.face, &b);
    assert_true(b.fitness > a.fitness + 0.02f);
    assert_true(gap_between(&s, bank) < 8);
    close_rig(&r);
    close_rig(&s);
    fap_bank_close(&bank);
}

TEST(blend, methods_without_regions_ignore_them)
{
    const fap_face_config one = config(FAP_BLEND_PCA, 1, 1), four = config(FAP_BLEND_PCA, 4, 1);
    fap_bank *bank = test_bank(BUILTIN);
    fap_frame frame;
    rig r, s;

    random_frame(&frame, 5, 100);
    open_rig(&r, bank, &one);
    open_rig(&s, bank, &four);
    fap_face_pose(r.face, &frame, r.position, NULL);
    fap_face_pose(s.face, &frame, s.position, NULL);
    assert_memory_equal(r.position, s.position, 3 * r.stride * sizeof(float));
    close_rig(&r);
    close_rig(&s);
    fap_bank_close(&bank);
}

TEST(blend, refuses_other_region_counts_and_overlaps)
{
    static const struct {
        int regions;
        float overlap;
    } bad[] = { { 0, 20 }, { 3, 20 }, { 8, 20 }, { -1, 20 }, { 4, -1 }, { 4, 51 }, { 4, NAN } };
    fap_bank *bank = test_bank(BUILTIN);
    fap_face *face;

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fap_face_config cfg = config(FAP_BLEND_GA, bad[i].regions, 1);
        cfg.overlap_percent = bad[i].overlap;
        assert_int_equal(fap_face_open(&face, bank, &cfg), FAP_E_ARG);
    }
    fap_bank_close(&bank);
}

TEST(blend, every_method_has_a_name_and_a_line_about_it)
{
    int count = 0;

    for (; fap_blend_name(count); count++)
        assert_true(fap_blend_summary(count)[0] != '\0');
    assert_int_equal(count, FAP_BLEND_BONES + 1);
    assert_string_equal(fap_blend_name(FAP_BLEND_GA), "ga");
    assert_string_equal(fap_blend_name(FAP_BLEND_ZHU), "zhu");
    assert_null(fap_blend_name(-1));
    assert_null(fap_blend_summary(count));
}

/* --- memory, for every method --- */

typedef struct budget {
    int left, live, calls;
} budget;

static void *count_alloc(void *user, size_t size)
{
    budget *b = user;

    b->calls++;
    if (b->left-- <= 0)
        return NULL;
    b->live++;
    return malloc(size);
}

static void count_free(void *user, void *ptr)
{
    ((budget *)user)->live--;
    free(ptr);
}

static void check_memory(const fap_bank *bank, fap_blend blend)
{
    fap_face_config cfg = config(blend, 4, 1);
    fap_err err = FAP_E_NOMEM;

    for (int left = 0; left < 1500 && err == FAP_E_NOMEM; left += 1 + (left < 150) + left / 300) {
        budget b = { .left = left };
        fap_face *face;
        cfg.alloc = (fap_allocator){ count_alloc, count_free, &b };
        err = fap_face_open(&face, bank, &cfg);
        fap_face_close(&face);
        assert_int_equal(b.live, 0);
    }
    assert_int_equal(err, FAP_OK);
}

TEST(blend, every_method_gives_everything_back_when_memory_runs_out)
{
    fap_bank *bank = test_bank(BUILTIN);

    for (int i = 0; fap_blend_name(i); i++)
        check_memory(bank, (fap_blend)i);
    fap_bank_close(&bank);
}

TEST(blend, no_method_allocates_in_a_pose)
{
    fap_bank *bank = test_bank(BUILTIN);

    for (int i = 0; fap_blend_name(i); i++) {
        budget b = { .left = 1 << 20 };
        fap_face_config cfg = config((fap_blend)i, 4, 1);
        fap_frame frame;
        goal g;
        rig r;
        cfg.alloc = (fap_allocator){ count_alloc, count_free, &b };
        open_rig(&r, bank, &cfg);
        const int before = b.calls;
        random_frame(&frame, 9, 300);
        random_goal(&g, bank, 9);
        fap_face_pose(r.face, &frame, r.position, NULL);
        pose_goal(&r, &g);
        assert_int_equal(b.calls, before);
        close_rig(&r);
    }
    fap_bank_close(&bank);
}
