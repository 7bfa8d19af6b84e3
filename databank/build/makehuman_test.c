/* SPDX-License-Identifier: BSD-2-Clause */
/* The default face as it comes out of the importer, where its data is at hand; and packages that are none. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "databank/build/import_makehuman.h"
#include "shape/bytes.h"

static int take(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return ((fap_bytes *)user)->failed;
}

static fap_bank *default_face(void)
{
    static char folder[1024];
    char bad[FAP_ERROR_TEXT_SIZE];
    fap_bytes file = { 0 };
    fap_bank_builder *b;
    fap_bank *bank;

    snprintf(folder, sizeof folder, "%s", test_shared("data/faces/makehuman/base.obj"));
    *strrchr(folder, '/') = '\0';
    assert_int_equal(import_makehuman(&b, folder, bad, sizeof bad), FAP_OK);
    assert_int_equal(fap_bank_builder_write(b, &(fap_writer){ take, &file }), FAP_OK);
    fap_bank_builder_close(&b);
    assert_int_equal(fap_bank_load(&bank, file.data, file.size, NULL), FAP_OK);
    fap_bytes_free(&file);
    return bank;
}

static const float *place(const fap_bank *bank, const char *point)
{
    return fap_bank_point_get(bank, fap_point_by_name(point))->position_mm;
}

static const fap_key *key(const fap_bank *bank, fap_key_kind kind, const char *name)
{
    const fap_key *k = fap_bank_key_get(bank, fap_bank_key_find(bank, kind, name));
    assert_non_null(k);
    return k;
}

static float moved_y(const fap_bank *bank, const fap_key *k, const char *point)
{
    return place(bank, point)[1] + k->point_mm[fap_point_by_name(point)][1];
}

TEST(makehuman, default_face_is_complete)
{
    fap_bank *bank = default_face();
    int kinds[4] = { 0 };

    for (int p = 0; p < FAP_POINT_COUNT; p++)
        assert_true(fap_bank_point_get(bank, p)->present);
    for (int k = 0; k < fap_bank_key_count(bank); k++)
        kinds[fap_bank_key_get(bank, k)->kind]++;
    assert_int_equal(kinds[FAP_KEY_VISEME], 14);
    assert_int_equal(kinds[FAP_KEY_EXPRESSION], 6);
    assert_int_equal(kinds[FAP_KEY_EXTRA], 11);
    assert_int_equal(kinds[FAP_KEY_UNIT], 54);
    assert_true(fap_bank_fapu(bank)->es_mm > 55 && fap_bank_fapu(bank)->es_mm < 66);
    assert_true(fap_bank_fapu(bank)->mw_mm > 44 && fap_bank_fapu(bank)->mw_mm < 60);
    fap_bank_close(&bank);
}

TEST(makehuman, lips_are_closed_at_rest_and_in_viseme_1)
{
    fap_bank *bank = default_face();
    const fap_key *pp = fap_bank_key_get(bank, fap_bank_key_number(bank, FAP_KEY_VISEME, 1));

    assert_true(place(bank, "2.2")[1] - place(bank, "2.3")[1] < 0.5f);
    assert_true(moved_y(bank, pp, "2.2") - moved_y(bank, pp, "2.3") < 0.5f);
    fap_bank_close(&bank);
}

TEST(makehuman, units_move_what_they_name)
{
    fap_bank *bank = default_face();
    const int chin = fap_point_by_name("2.1"), corner = fap_point_by_name("8.3"),
              brow = fap_point_by_name("4.1");

    assert_true(key(bank, FAP_KEY_UNIT, "jawOpen")->point_mm[chin][1] < -10);
    assert_true(key(bank, FAP_KEY_UNIT, "mouthSmileLeft")->point_mm[corner][1] > 5);
    assert_true(key(bank, FAP_KEY_UNIT, "browInnerUp")->point_mm[brow][1] > 2);
    assert_true(key(bank, FAP_KEY_UNIT, "_tongueUp")->point_mm[fap_point_by_name("6.1")][1] > 5);
    fap_bank_close(&bank);
}

TEST(makehuman, eyeballs_are_left_to_the_player)
{
    fap_bank *bank = default_face();
    const fap_mesh *m = fap_bank_mesh(bank);
    float centre[3], radius;

    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *q = fap_bank_key_get(bank, k);
        for (uint32_t i = 0; i < q->block_count * 3 * FAP_BLOCK; i++) {
            const uint32_t v = (uint32_t)q->block[i / (3 * FAP_BLOCK)] * FAP_BLOCK + i % FAP_BLOCK;
            if (m->part[v] == FAP_PART_EYE_LEFT || m->part[v] == FAP_PART_EYE_RIGHT)
                assert_int_equal(q->delta[i], 0);
        }
    }
    assert_true(fap_bank_eye(bank, 0, centre, &radius));
    assert_true(radius > 11 && radius < 17);
    assert_float_equal(centre[0], place(bank, "3.5")[0], 0.01);
    fap_bank_close(&bank);
}

/* The face in one key's pose, as [vertex][3]. */
static float (*pose(const fap_bank *bank, const fap_key *k))[3]
{
    const fap_mesh *m = fap_bank_mesh(bank);
    float(*p)[3] = malloc(m->stride * sizeof *p);

    for (uint32_t v = 0; v < m->stride; v++)
        for (uint32_t axis = 0; axis < 3; axis++)
            p[v][axis] = m->position[axis * m->stride + v];
    for (uint32_t i = 0; i < k->block_count * 3 * FAP_BLOCK; i++)
        p[k->block[i / (3 * FAP_BLOCK)] * FAP_BLOCK + i % FAP_BLOCK][i / FAP_BLOCK % 3] +=
            k->scale_mm * k->delta[i];
    return p;
}

/* 1 where some triangle of the skin lies before @p at, seen from the front. */
static int is_covered(const fap_mesh *m, const float (*p)[3], const float at[3])
{
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *i = m->triangle + 3 * t;
        if (m->part[i[0]] != FAP_PART_SKIN)
            continue;
        const float *a = p[i[0]], *b = p[i[1]], *c = p[i[2]];
        const float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        const float u = ((b[0] - at[0]) * (c[1] - at[1]) - (c[0] - at[0]) * (b[1] - at[1])) / area;
        const float v = ((c[0] - at[0]) * (a[1] - at[1]) - (a[0] - at[0]) * (c[1] - at[1])) / area;
        if (u >= 0 && v >= 0 && u + v <= 1 && u * a[2] + v * b[2] + (1 - u - v) * c[2] > at[2])
            return 1;
    }
    return 0;
}

TEST(makehuman, closed_lids_cover_the_eyes)
{
    fap_bank *bank = default_face();
    const fap_mesh *m = fap_bank_mesh(bank);
    float(*shut)[3] = pose(bank, key(bank, FAP_KEY_EXTRA, "blink"));
    const float *left = place(bank, "3.5");
    int seen = 0;

    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const float *q = shut[v];
        if (m->part[v] != FAP_PART_EYE_LEFT || hypotf(q[0] - left[0], q[1] - left[1]) > 8 ||
            q[2] < left[2] - 6)
            continue;
        assert_true(is_covered(m, (const float(*)[3])shut, q));
        seen++;
    }
    assert_true(seen > 100);
    free(shut);
    float(*wink)[3] = pose(bank, key(bank, FAP_KEY_UNIT, "eyeBlinkRight"));
    assert_false(is_covered(m, (const float(*)[3])wink, left));
    free(wink);
    fap_bank_close(&bank);
}

TEST(makehuman, neck_stays_with_the_shoulders)
{
    fap_bank *bank = default_face();
    const fap_mesh *m = fap_bank_mesh(bank);
    uint32_t lowest = 0;

    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (m->position[m->stride + v] < m->position[m->stride + lowest])
            lowest = v;
    assert_int_equal(m->head_weight[lowest], 0);
    assert_int_equal(m->head_weight[fap_bank_point_get(bank, fap_point_by_name("2.1"))->vertex[0]], 255);
    fap_bank_close(&bank);
}

TEST(makehuman, packages_that_are_none_are_refused)
{
    char folder[] = "/tmp/fap_test_XXXXXX", file[64], bad[FAP_ERROR_TEXT_SIZE];
    fap_bank_builder *b;

    assert_int_equal(import_makehuman(&b, "/nonexistent/x.whl", bad, sizeof bad), FAP_E_NOT_FOUND);
    assert_non_null(mkdtemp(folder));
    assert_int_equal(import_makehuman(&b, folder, bad, sizeof bad), FAP_E_NOT_FOUND);
    assert_string_equal(bad, "base.obj");
    snprintf(file, sizeof file, "%s/base.obj", folder);
    FILE *f = fopen(file, "w");
    assert_non_null(f);
    fputs("v 0 0\n", f);
    fclose(f);
    assert_int_equal(import_makehuman(&b, folder, bad, sizeof bad), FAP_E_SYNTAX);
    assert_int_equal(import_makehuman(&b, file, bad, sizeof bad), FAP_E_UNKNOWN_FORMAT);
    assert_null(b);
    unlink(file);
    rmdir(folder);
}
