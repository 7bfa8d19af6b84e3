/* SPDX-License-Identifier: BSD-2-Clause */
/* Face animation tables: near what the solver does where FAPs are few, the same after writing and reading, safe to load. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/fat.h>

typedef struct bytes {
    uint8_t *data;
    size_t size, room;
} bytes;

static int append(void *user, const void *data, size_t size)
{
    bytes *b = user;

    if (b->size + size > b->room) {
        b->room = 2 * (b->room + size);
        b->data = realloc(b->data, b->room);
        if (!b->data)
            return 1;
    }
    memcpy(b->data + b->size, data, size);
    b->size += size;
    return 0;
}

static bytes write_tables(const fap_fat *fat)
{
    bytes b = { 0 };

    assert_int_equal(fap_fat_write(fat, &(fap_writer){ append, &b }), FAP_OK);
    return b;
}

static fap_fat *bake(void)
{
    fap_bank *bank;
    fap_fat *fat;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_fat_bake(&fat, bank, NULL), FAP_OK);
    fap_bank_close(&bank);
    return fat;
}

typedef float (*points)[3];

static points pose(const fap_fat *fat, const fap_frame *f)
{
    points p = calloc(fap_fat_vertex_count(fat), sizeof *p);

    assert_non_null(p);
    fap_fat_pose(fat, f, p);
    return p;
}

typedef struct rig {
    fap_fat *fat;
    fap_bank *bank;
    fap_face *face;
    float *xyz, *weight;
} rig;

static rig open_rig(void)
{
    rig r = { .fat = bake() };
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = FAP_BLEND_QP;
    assert_int_equal(fap_bank_builtin(&r.bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&r.face, r.bank, &cfg), FAP_OK);
    r.xyz = aligned_alloc(32, 3 * fap_face_stride(r.face) * sizeof *r.xyz);
    r.weight = calloc((size_t)fap_bank_key_count(r.bank), sizeof *r.weight);
    assert_true(r.xyz && r.weight);
    return r;
}

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    fap_bank_close(&r->bank);
    fap_fat_close(&r->fat);
    free(r->xyz);
    free(r->weight);
}

typedef struct distance {
    double mean, most, moved; /* moved: the mean way of the same vertices from neutral */
} distance;

/* From where the solver puts the vertices, over those that it moves. */
static distance from_solver(rig *r, const fap_frame *f)
{
    const size_t stride = fap_face_stride(r->face);
    const float(*neutral)[3] = fap_fat_neutral(r->fat);
    points p = pose(r->fat, f);
    distance d = { 0 };
    int count = 0;

    fap_face_pose(r->face, f, r->xyz, NULL);
    for (uint32_t v = 0; v < fap_fat_vertex_count(r->fat); v++) {
        double off = 0, way = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const double at = (double)r->xyz[axis * stride + v];
            off += pow((double)p[v][axis] - at, 2);
            way += pow(at - (double)neutral[v][axis], 2);
        }
        if (off < 0.0025 && way < 0.0025)
            continue;
        d.mean += sqrt(off);
        d.moved += sqrt(way);
        d.most = fmax(d.most, sqrt(off));
        count++;
    }
    free(p);
    d.mean /= count ? count : 1;
    d.moved /= count ? count : 1;
    return d;
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Four units at up to half their strength; lips close over a jaw that is open. */
static void mix_units(rig *r, uint32_t *seed)
{
    const int count = fap_bank_key_count(r->bank);
    const int jaw = fap_bank_key_find(r->bank, FAP_KEY_UNIT, "jawOpen");
    const int close = fap_bank_key_find(r->bank, FAP_KEY_UNIT, "mouthClose");

    memset(r->weight, 0, (size_t)count * sizeof *r->weight);
    for (int units = 0; units < 4;) {
        const int k = (int)(next(seed) % (uint32_t)count);
        const fap_key *key = fap_bank_key_get(r->bank, k);
        if (key->kind != FAP_KEY_UNIT || !strncmp(key->name, "eyeLook", 7))
            continue;
        r->weight[k] += 0.0005f * (float)(next(seed) % 1000);
        units++;
    }
    r->weight[jaw] += r->weight[close];
}

/* The FAPs of that mixture, all of them. */
static fap_frame mixture(rig *r, uint32_t *seed)
{
    fap_frame f = { 0 };

    mix_units(r, seed);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        double mm = 0;
        if (info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z)
            continue;
        for (int k = 0; k < fap_bank_key_count(r->bank); k++)
            mm += (double)r->weight[k] *
                  (double)fap_bank_key_get(r->bank, k)->point_mm[info->point][info->motion - FAP_MOTION_X];
        f.state[fap] = FAP_CODED;
        f.value[fap] = (int32_t)lrint(info->sign * mm /
                                      (double)fap_fapu_step(fap_bank_fapu(r->bank), (fap_unit)info->unit));
    }
    return f;
}

static fap_frame all_at_rest(void)
{
    fap_frame f = { 0 };

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        f.state[fap] = FAP_CODED;
    return f;
}

TEST(fat, natural_mixtures_are_near_what_the_solver_does)
{
    rig r = open_rig();
    distance all = { 0 };
    uint32_t seed = 1;
    const int count = 100;

    for (int i = 0; i < count; i++) {
        const fap_frame f = mixture(&r, &seed);
        const distance d = from_solver(&r, &f);
        all.mean += d.mean / count;
        all.moved += d.moved / count;
        all.most = fmax(all.most, d.most);
    }
    print_message("fat: mean %.3f mm, at most %.2f mm, where vertices move %.2f mm\n", all.mean, all.most,
                  all.moved);
    assert_true(all.mean < 0.2);
    assert_true(all.most < 3);
    assert_true(all.moved > 1); /* else the above says nothing */
    close_rig(&r);
}

/* How far the commanded points are off along their axes. */
static double points_off(const rig *r, const fap_frame *f)
{
    points p = pose(r->fat, f);
    double most = 0;

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z)
            continue;
        const fap_bank_point *at = fap_bank_point_get(r->bank, info->point);
        const int axis = info->motion - FAP_MOTION_X;
        const double step = (double)fap_fapu_step(fap_bank_fapu(r->bank), (fap_unit)info->unit);
        double sum = -(double)at->position_mm[axis] - info->sign * f->value[fap] * step;
        for (uint32_t i = 0; i < at->vertex_count; i++)
            sum += (double)p[at->vertex[i]][axis] / at->vertex_count;
        if (at->vertex_count && fap != 27 && fap != 28) /* eyeballs are bodies */
            most = fmax(most, fabs(sum));
    }
    free(p);
    return most;
}

TEST(fat, every_commanded_point_arrives_where_its_fap_says)
{
    rig r = open_rig();
    uint32_t seed = 7;

    for (int i = 0; i < 50; i++) {
        const fap_frame f = mixture(&r, &seed);
        assert_true(points_off(&r, &f) < 0.02);
    }
    for (int i = 0; i < 50; i++) { /* no key models do this */
        fap_frame f = all_at_rest();
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            f.value[fap] = fap < 23 || fap > 30 ? (int32_t)(next(&seed) % 100) - 50 : 0;
        for (int fap = 48; fap <= 50; fap++)
            f.value[fap] = 0;
        f.value[3] += 50; /* teeth are no point, but a jaw shut too far is not asked for here */
        assert_true(points_off(&r, &f) < 0.02);
    }
    close_rig(&r);
}

TEST(fat, lids_slide_over_the_eyes)
{
    rig r = open_rig();

    for (int value = 0; value <= 1000; value += 100) {
        fap_frame f = all_at_rest();
        f.value[19] = f.value[20] = value;
        assert_true(from_solver(&r, &f).most < 1.5);
    }
    close_rig(&r);
}

TEST(fat, heads_and_eyes_turn_as_the_solver_turns_them)
{
    rig r = open_rig();
    fap_frame f = all_at_rest();

    f.value[48] = 10000, f.value[49] = -20000, f.value[50] = 5000;
    f.value[23] = 15000, f.value[24] = 15000, f.value[25] = f.value[26] = -8000;
    assert_true(from_solver(&r, &f).most < 1.5);
    close_rig(&r);
}

TEST(fat, tables_are_the_same_after_writing_and_reading)
{
    fap_fat *fat = bake(), *again;
    bytes first = write_tables(fat);
    fap_frame f = all_at_rest();

    assert_int_equal(fap_fat_load(&again, first.data, first.size, NULL), FAP_OK);
    bytes second = write_tables(again);
    assert_int_equal(first.size, second.size);
    assert_memory_equal(first.data, second.data, first.size);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        f.value[fap] = fap * 7 - 200;
    points a = pose(fat, &f), b = pose(again, &f);
    assert_memory_equal(a, b, fap_fat_vertex_count(fat) * sizeof *a);
    free(a), free(b), free(first.data), free(second.data);
    fap_fat_close(&fat);
    fap_fat_close(&again);
    fap_fat_close(&again);
}

TEST(fat, damage_is_found)
{
    fap_fat *fat = bake(), *again;
    bytes b = write_tables(fat);

    fap_fat_close(&fat);
    for (size_t i = 0; i < b.size; i += i < 2000 ? 97 : b.size / 250) {
        b.data[i] ^= 0x10;
        assert_true(fap_fat_load(&again, b.data, b.size, NULL) != FAP_OK);
        assert_null(again);
        b.data[i] ^= 0x10;
    }
    for (size_t size = 0; size < b.size; size += size < 2000 ? 101 : b.size / 250)
        assert_true(fap_fat_load(&again, b.data, size, NULL) != FAP_OK);
    free(b.data);
}

/* Nothing speaks of the lips: they go with the jaw. Once something does, they go where it says. */
TEST(fat, lips_follow_a_jaw_that_is_alone)
{
    rig r = open_rig();
    fap_frame alone = { 0 }, held = all_at_rest();
    const int lip = fap_point_by_name("2.3");
    const uint32_t v = fap_bank_point_get(r.bank, lip)->vertex[0];

    alone.state[3] = FAP_CODED;
    alone.value[3] = held.value[3] = 500;
    assert_true(from_solver(&r, &alone).most < 1.5);
    points a = pose(r.fat, &alone), b = pose(r.fat, &held);
    assert_true(a[v][1] < fap_fat_neutral(r.fat)[v][1] - 5);
    assert_true(fabsf(b[v][1] - fap_fat_neutral(r.fat)[v][1]) < 0.02f);
    free(a), free(b);
    close_rig(&r);
}

TEST(fat, is_a_blend_method)
{
    rig r = open_rig();
    fap_face_config cfg;
    fap_face *face;
    uint32_t seed = 3;

    fap_face_config_init(&cfg);
    cfg.blend = FAP_BLEND_FAT;
    cfg.residual = 0;
    assert_int_equal(fap_face_open(&face, r.bank, &cfg), FAP_OK);
    const fap_frame f = mixture(&r, &seed);
    points p = pose(r.fat, &f);
    fap_face_pose(face, &f, r.xyz, NULL);
    const fap_mesh *mesh = fap_bank_mesh(r.bank);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) /* teeth and lids are held by bodies on top */
        assert_true(mesh->part[v] != FAP_PART_SKIN || fabsf(p[v][1] - r.xyz[mesh->stride + v]) < 0.05f);
    free(p);
    fap_face_close(&face);
    close_rig(&r);
}

TEST(fat, visemes_give_way_to_lips_that_are_spoken_of)
{
    fap_fat *fat = bake();
    fap_frame rest = { 0 }, says = { 0 };

    says.state[1] = FAP_CODED;
    says.viseme = (fap_viseme){ 10, 0, 63, 0 };
    points a = pose(fat, &rest), b = pose(fat, &says);
    assert_true(memcmp(a, b, fap_fat_vertex_count(fat) * sizeof *a) != 0);
    free(b);
    says.state[51] = FAP_CODED;
    b = pose(fat, &says);
    assert_memory_equal(a, b, fap_fat_vertex_count(fat) * sizeof *a);
    free(a), free(b);
    fap_fat_close(&fat);
}

TEST(fat, absurd_values_do_no_harm)
{
    fap_fat *fat = bake();
    fap_frame f = all_at_rest();

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        f.value[fap] = fap % 2 ? INT32_MAX : INT32_MIN;
    points p = pose(fat, &f);
    for (uint32_t v = 0; v < fap_fat_vertex_count(fat); v++)
        assert_true(isfinite(p[v][0]) && isfinite(p[v][1]) && isfinite(p[v][2]));
    free(p);
    fap_fat_close(&fat);
}
