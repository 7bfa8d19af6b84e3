/* SPDX-License-Identifier: BSD-2-Clause */
/* The built-in face: complete, sound, and moving the way its units say. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/bank.h>
#include <fap/face.h>

static fap_bank *builtin(void)
{
    fap_bank *bank;
    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    return bank;
}

static const float *point_motion(const fap_bank *bank, const char *unit, const char *point)
{
    const int k = fap_bank_key_find(bank, FAP_KEY_UNIT, unit);
    assert_true(k >= 0);
    return fap_bank_key_get(bank, k)->point_mm[fap_point_by_name(point)];
}

TEST(builtin, carries_every_point_viseme_expression_and_unit)
{
    fap_bank *bank = builtin();
    int units = 0;

    for (int p = 0; p < FAP_POINT_COUNT; p++)
        assert_true(fap_bank_point_get(bank, p)->present);
    for (int v = 1; v <= FAP_VISEME_COUNT; v++)
        assert_true(fap_bank_key_number(bank, FAP_KEY_VISEME, v) >= 0);
    for (int e = 1; e <= FAP_EXPRESSION_COUNT; e++)
        assert_true(fap_bank_key_number(bank, FAP_KEY_EXPRESSION, e) >= 0);
    for (int k = 0; k < fap_bank_key_count(bank); k++)
        units += fap_bank_key_get(bank, k)->kind == FAP_KEY_UNIT;
    assert_int_equal(units, 54);
    assert_int_equal(fap_bank_key_count(bank), 54 + 31);
    assert_true(fap_bank_key_find(bank, FAP_KEY_EXTRA, "blink") >= 0);
    assert_int_equal(fap_bank_key_find(bank, FAP_KEY_UNIT, "blink"), -1);
    fap_bank_close(&bank);
    assert_null(bank);
}

TEST(builtin, every_key_model_moves_something)
{
    fap_bank *bank = builtin();

    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        assert_true(key->block_count > 0);
        assert_true(key->scale_mm > 0);
        for (uint32_t b = 1; b < key->block_count; b++)
            assert_true(key->block[b] > key->block[b - 1]);
    }
    fap_bank_close(&bank);
}

TEST(builtin, mesh_is_sound_and_of_the_promised_size)
{
    fap_bank *bank = builtin();
    const fap_mesh *m = fap_bank_mesh(bank);

    assert_in_range(m->vertex_count, 2000, 2600);
    assert_int_equal(m->stride % FAP_BLOCK, 0);
    assert_int_equal((uintptr_t)m->position % 32, 0);
    for (uint32_t t = 0; t < m->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            assert_true(m->triangle[3 * t + i] < m->vertex_count);
            assert_int_equal(m->part[m->triangle[3 * t + i]], m->part[m->triangle[3 * t]]);
        }
    fap_bank_close(&bank);
}

static int edge_key(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint32_t));
}

TEST(builtin, no_edge_is_used_twice_in_the_same_direction)
{
    fap_bank *bank = builtin();
    const fap_mesh *m = fap_bank_mesh(bank);
    uint32_t(*edge)[2] = malloc(3 * m->triangle_count * sizeof *edge);

    for (uint32_t t = 0; t < m->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            edge[3 * t + i][0] = m->triangle[3 * t + i];
            edge[3 * t + i][1] = m->triangle[3 * t + (i + 1) % 3];
        }
    qsort(edge, 3 * m->triangle_count, sizeof *edge, edge_key);
    for (uint32_t e = 1; e < 3 * m->triangle_count; e++)
        assert_int_not_equal(edge_key(edge[e], edge[e - 1]), 0);
    free(edge);
    fap_bank_close(&bank);
}

TEST(builtin, left_and_right_mirror)
{
    fap_bank *bank = builtin();

    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const float *a = fap_bank_point_get(bank, p)->position_mm;
        const float *b = fap_bank_point_get(bank, fap_point_get(p)->mirror)->position_mm;
        assert_true(fabsf(a[0] + b[0]) < 0.01f);
        assert_true(fabsf(a[1] - b[1]) < 0.01f && fabsf(a[2] - b[2]) < 0.01f);
    }
    fap_bank_close(&bank);
}

TEST(builtin, proportions_are_a_face)
{
    fap_bank *bank = builtin();
    const fap_fapu *u = fap_bank_fapu(bank);
    float centre[3], radius;

    assert_true(u->es_mm > 55 && u->es_mm < 68);
    assert_true(u->ens_mm > 40 && u->ens_mm < 56);
    assert_true(u->mns_mm > 15 && u->mns_mm < 25);
    assert_true(u->mw_mm > 45 && u->mw_mm < 60);
    assert_true(u->irisd_mm > 8 && u->irisd_mm < 13);
    assert_true(fap_bank_eye(bank, 0, centre, &radius) && centre[0] > 0 && radius > 10);
    assert_true(fap_bank_eye(bank, 1, centre, &radius) && centre[0] < 0);
    fap_bank_close(&bank);
}

/* Where the lips meet, two vertices are at one place: how far apart a key takes the furthest of those pairs. */
static float lips_apart(const fap_bank *bank, const float *weight)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    const size_t size = 3 * m->stride * sizeof(float);
    float *at = aligned_alloc(32, size), most = -1;
    fap_face *face;

    assert_int_equal(fap_face_open(&face, bank, NULL), FAP_OK);
    fap_face_pose_keys(face, weight, at, NULL);
    for (uint32_t a = 0; a < m->vertex_count; a++)
        for (uint32_t b = a + 1; b < m->vertex_count; b++) {
            float rest = 0, now = 0;
            for (size_t row = 0; row < 3 * m->stride; row += m->stride) {
                rest = fmaxf(rest, fabsf(m->position[row + a] - m->position[row + b]));
                now = fmaxf(now, fabsf(at[row + a] - at[row + b]));
            }
            if (rest < 1e-4f)
                most = fmaxf(most, now);
        }
    fap_face_close(&face);
    free(at);
    return most;
}

TEST(builtin, lips_touch_all_along_at_rest_and_over_an_open_jaw)
{
    fap_bank *bank = builtin();
    float weight[100] = { 0 };
    const int jaw = fap_bank_key_find(bank, FAP_KEY_UNIT, "jawOpen"),
              shut = fap_bank_key_find(bank, FAP_KEY_UNIT, "mouthClose");

    const float rest = lips_apart(bank, weight);
    assert_true(rest >= 0 && rest < 1e-4f);
    weight[jaw] = 0.5f;
    assert_true(lips_apart(bank, weight) > 10);
    weight[shut] = 0.5f;
    assert_true(lips_apart(bank, weight) < 0.1f);
    fap_bank_close(&bank);
}

TEST(builtin, units_move_their_points_the_right_way)
{
    fap_bank *bank = builtin();

    assert_true(point_motion(bank, "jawOpen", "2.1")[1] < -15);
    assert_true(point_motion(bank, "jawOpen", "2.3")[1] < -15);
    assert_true(fabsf(point_motion(bank, "jawOpen", "2.2")[1]) < 0.5f);
    assert_true(point_motion(bank, "mouthSmileLeft", "8.3")[1] > 5);
    assert_true(fabsf(point_motion(bank, "mouthSmileLeft", "8.4")[1]) < 0.5f);
    assert_true(point_motion(bank, "mouthSmileRight", "8.4")[0] < -2);
    assert_true(point_motion(bank, "browInnerUp", "4.1")[1] > 4);
    assert_true(point_motion(bank, "eyeBlinkLeft", "3.1")[1] < -9);
    assert_true(point_motion(bank, "jawLeft", "2.1")[0] > 5);
    assert_true(point_motion(bank, "mouthPucker", "8.3")[0] < -4);
    assert_true(point_motion(bank, "tongueOut", "6.1")[2] > 15);
    fap_bank_close(&bank);
}

/* Fails the n-th request; the bank must come out NULL and nothing may leak (asan sees to that). */
static void *scarce(void *user, size_t size)
{
    int *left = user;
    return (*left)-- > 0 ? malloc(size) : NULL;
}

static void give_back(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

TEST(builtin, survives_a_failing_allocator)
{
    fap_err err = FAP_E_NOMEM;

    for (int allowed = 0; err == FAP_E_NOMEM; allowed += 1 + allowed / 50) {
        int left = allowed;
        const fap_allocator a = { scarce, give_back, &left };
        fap_bank *bank;
        err = fap_bank_builtin(&bank, &a);
        assert_true((err == FAP_OK) == (bank != NULL));
        fap_bank_close(&bank);
    }
    assert_int_equal(err, FAP_OK);
}
