/* SPDX-License-Identifier: BSD-2-Clause */
/* A bank's motions on another face of its structure. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/retarget.h>

#include "shape/bytes.h"

typedef struct model {
    fap_bank *bank;
    float (*position)[3];
} model;

static void open_model(model *m, float wider, float higher)
{
    assert_int_equal(fap_bank_builtin(&m->bank, NULL), FAP_OK);
    const fap_mesh *mesh = fap_bank_mesh(m->bank);
    m->position = malloc(mesh->vertex_count * sizeof *m->position);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (uint32_t a = 0; a < 3; a++)
            m->position[i][a] = mesh->position[a * mesh->stride + i] * (a == 1 ? higher : wider);
}

static void close_model(model *m)
{
    free(m->position);
    fap_bank_close(&m->bank);
}

static int keep(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return 0;
}

static fap_bank *load(fap_bank_builder *b)
{
    fap_bytes file = { 0 };
    const fap_writer w = { keep, &file };
    fap_bank *bank;

    assert_int_equal(fap_bank_builder_write(b, &w), FAP_OK);
    assert_int_equal(fap_bank_load(&bank, file.data, file.size, NULL), FAP_OK);
    fap_bytes_free(&file);
    return bank;
}

TEST(retarget, a_larger_head_makes_larger_motions)
{
    model m;
    fap_bank_builder *b;
    fap_retarget_scale s;

    open_model(&m, 1.2F, 1.2F);
    assert_int_equal(fap_bank_retarget(&b, m.bank, (const float(*)[3])m.position, "large", &s), FAP_OK);
    assert_float_equal(s.scale, 1.2, 1e-5);
    assert_float_equal(s.lips, 1.2, 1e-5);
    fap_bank *large = load(b);
    assert_string_equal(fap_bank_name(large), "large");
    const int joy = fap_bank_key_number(m.bank, FAP_KEY_EXPRESSION, 1);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (int a = 0; a < 3; a++)
            assert_float_equal(fap_bank_key_get(large, joy)->point_mm[p][a],
                               1.2F * fap_bank_key_get(m.bank, joy)->point_mm[p][a], 0.02);
    assert_float_equal(fap_bank_fapu(large)->es_mm, 1.2F * fap_bank_fapu(m.bank)->es_mm, 0.01);
    float centre[3], radius = 0, from[3], from_radius = 0;
    assert_true(fap_bank_eye(large, 0, centre, &radius));
    assert_true(fap_bank_eye(m.bank, 0, from, &from_radius));
    assert_float_equal(radius, 1.2F * from_radius, 1e-3);
    assert_float_equal(centre[0], 1.2F * from[0], 1e-2);
    fap_bank_close(&large);
    fap_bank_builder_close(&b);
    close_model(&m);
}

TEST(retarget, the_scale_is_the_mean_of_four)
{
    model m;
    fap_bank_builder *b;
    fap_retarget_scale s;

    open_model(&m, 1, 1.1F);
    assert_int_equal(fap_bank_retarget(&b, m.bank, (const float(*)[3])m.position, "long", &s), FAP_OK);
    assert_float_equal(s.eyes, 1, 1e-3);
    assert_float_equal(s.mouth, 1, 1e-3);
    assert_true(s.nose > 1.02 && s.nose < 1.1 && s.lips > 1.02 && s.lips <= 1.1);
    assert_float_equal(s.scale, (s.eyes + s.mouth + s.nose + s.lips) / 4, 1e-9);
    fap_bank_builder_close(&b);
    close_model(&m);
}

TEST(retarget, a_face_that_is_a_point_is_refused)
{
    model m;
    fap_bank_builder *b;

    open_model(&m, 0, 0);
    assert_int_equal(fap_bank_retarget(&b, m.bank, (const float(*)[3])m.position, "none", NULL), FAP_E_DATA);
    assert_null(b);
    close_model(&m);
}
