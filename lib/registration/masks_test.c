/* SPDX-License-Identifier: BSD-2-Clause */
/* Masks of the built-in face on a bent and finer copy of it, and as a table. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/landmarks.h>
#include <fap/studio/masks.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "registration/loop.h"

static char where[FAP_ERROR_TEXT_SIZE];

typedef struct model {
    fap_bank *bank;
    fap_generic generic;
    fap_surface *other; /* finer, bent, in centimetres; without eyes, teeth and tongue */
    uint8_t *own;       /* masks of the generic face */
    uint8_t *truth;     /* [other vertices] what both ends of an edge have */
    fap_pin pin[FAP_POINT_COUNT];
    uint32_t pins;
} model;

static void bend(const float p[3], float out[3])
{
    out[0] = 0.1F * p[0] * (1.04F - 0.0008F * p[1]);
    out[1] = 0.097F * p[1] + 3;
    out[2] = 0.1F * p[2] + 0.3F * expf(-(p[0] * p[0] + (p[1] + 5) * (p[1] + 5)) / 900);
}

static void make_other(model *m)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const fap_generic *g = &m->generic;
    loop_mesh fine;
    uint32_t kept = 0;

    assert_int_equal(loop_subdivide(&fine, g->position, g->vertex_count, g->triangle, g->triangle_count,
                                    g->part, g->mask, &heap),
                     FAP_OK);
    assert_int_equal(fap_surface_create(&m->other, fine.vertex_count, fine.triangle_count, NULL), FAP_OK);
    m->truth = malloc(fine.vertex_count);
    memcpy(m->truth, fine.mask, fine.vertex_count);
    for (uint32_t v = 0; v < fine.vertex_count; v++)
        bend(fine.position[v], m->other->position[v]);
    for (uint32_t t = 0; t < fine.triangle_count; t++)
        if (fine.part[fine.triangle[t][0]] == FAP_PART_SKIN)
            memcpy(m->other->triangle[kept++], fine.triangle[t], sizeof *fine.triangle);
    m->other->triangle_count = kept;
    loop_free(&fine, &heap);
}

static void open_model(model *m)
{
    *m = (model){ 0 };
    assert_int_equal(fap_bank_builtin(&m->bank, NULL), FAP_OK);
    assert_int_equal(fap_generic_of_bank(&m->generic, m->bank, NULL), FAP_OK);
    const fap_allocator heap = fap_mem_allocator(NULL);
    m->own = calloc(fap_bank_mesh(m->bank)->stride, 1);
    assert_int_equal(fap_mask_derive(m->bank, m->own, &heap), 0); /* the built-in face brings none along */
    m->generic.mask = m->own;
    make_other(m);
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *point = fap_bank_point_get(m->bank, p);
        if (!point->present || !point->vertex_count || m->generic.part[point->vertex[0]] != FAP_PART_SKIN)
            continue;
        const uint32_t v = point->vertex[0];
        m->pin[m->pins] = (fap_pin){ .vertex = { v, v, v }, .share = { 1, 0, 0 }, .trust = 1 };
        memcpy(m->pin[m->pins++].at, m->other->position[v], sizeof m->other->position[v]);
    }
}

static void close_model(model *m)
{
    free(m->truth);
    free(m->own);
    fap_surface_close(&m->other);
    fap_generic_free(&m->generic, NULL);
    fap_bank_close(&m->bank);
}

static fap_registration *lay(model *m)
{
    fap_registration_config cfg;
    fap_registration *r;

    fap_registration_config_init(&cfg);
    cfg.method = FAP_REGISTER_LORENZO;
    cfg.control_points = 100;
    const fap_err err = fap_register(&r, &m->generic, m->other, m->pin, m->pins, &cfg, where);
    if (err == FAP_E_UNSUPPORTED) {
        close_model(m);
        skip();
    }
    assert_int_equal(err, FAP_OK);
    return r;
}

TEST(masks, come_to_a_face_of_another_structure)
{
    uint32_t right = 0, of_any = 0, crossed = 0;
    model m;

    open_model(&m);
    fap_registration *r = lay(&m);
    uint8_t *mask = calloc(m.other->vertex_count, 1);
    assert_int_equal(fap_masks_retarget(r, &m.generic, m.other, mask), FAP_OK);
    for (uint32_t v = 0; v < m.other->vertex_count; v++) {
        const uint8_t upper = 0x15,
                      across = (uint8_t)((m.truth[v] & upper) << 1 | (m.truth[v] & ~upper) >> 1);
        if (!m.truth[v])
            continue;
        of_any++;
        right += mask[v] == m.truth[v];
        crossed += (mask[v] & across & ~m.truth[v]) != 0;
    }
    assert_true(of_any > 100);
    assert_true(right > 0.85 * of_any);
    assert_true(crossed <= of_any / 100);
    free(mask);
    fap_registration_close(&r);
    close_model(&m);
}

TEST(masks, need_a_face_that_has_some)
{
    model m;
    uint8_t mask[1];

    open_model(&m);
    fap_registration *r = lay(&m);
    fap_generic bare = m.generic;
    bare.mask = NULL;
    assert_int_equal(fap_masks_retarget(r, &bare, m.other, mask), FAP_E_ARG);
    bare = m.generic;
    bare.vertex_count--;
    assert_int_equal(fap_masks_retarget(r, &bare, m.other, mask), FAP_E_ARG);
    fap_registration_close(&r);
    close_model(&m);
}

/* --- as a table --- */

typedef struct text {
    char bytes[512];
    size_t size;
} text;

static int keep(void *user, const void *data, size_t size)
{
    text *t = user;

    if (size > sizeof t->bytes - t->size)
        return 1;
    memcpy(t->bytes + t->size, data, size);
    t->size += size;
    return 0;
}

TEST(masks, a_table_comes_back_as_it_was)
{
    const uint8_t mask[5] = { 0, FAP_MASK_LIP_UPPER, FAP_MASK_LID_LOWER_RIGHT | FAP_MASK_LIP_LOWER, 0,
                              FAP_MASK_ALL };
    uint8_t again[5];
    text t = { .size = 0 };
    const fap_writer w = { keep, &t };

    assert_int_equal(fap_masks_write(mask, 5, &w), FAP_OK);
    assert_memory_equal(t.bytes, "vertex,side\n1,lip_upper\n", 24);
    assert_int_equal(fap_masks_read(again, 5, t.bytes, t.size, where), FAP_OK);
    assert_memory_equal(again, mask, 5);
    t.size = sizeof t.bytes - 20;
    assert_int_equal(fap_masks_write(mask, 5, &w), FAP_E_IO);
}

static fap_err read_text(const char *table, uint8_t mask[4])
{
    return fap_masks_read(mask, 4, table, strlen(table), where);
}

TEST(masks, what_is_no_table_is_told_with_its_line)
{
    uint8_t mask[4];

    assert_int_equal(read_text("", mask), FAP_OK);
    assert_int_equal(read_text("# mine\r\n3,lid_upper_left\r\n\r\n", mask), FAP_OK);
    assert_int_equal(mask[3], FAP_MASK_LID_UPPER_LEFT);
    assert_int_equal(read_text("vertex,side\n1,lip_upper\n4,lip_upper\n", mask), FAP_E_DATA);
    assert_string_equal(where, "line 3: the face has no such vertex");
    assert_int_equal(read_text("1,lip", mask), FAP_E_SYNTAX);
    assert_int_equal(read_text("1", mask), FAP_E_SYNTAX);
    assert_int_equal(read_text(",lip_upper", mask), FAP_E_SYNTAX);
    assert_int_equal(read_text("-1,lip_upper", mask), FAP_E_SYNTAX);
    assert_int_equal(read_text("99999999999999999999,lip_upper", mask), FAP_E_SYNTAX);
    assert_int_equal(fap_masks_read(mask, 4, "1,lip_upper,", 12, NULL), FAP_E_SYNTAX);
}

TEST(masks, sides_have_names)
{
    assert_string_equal(fap_mask_side_name(0), "lip_upper");
    assert_string_equal(fap_mask_side_name(FAP_MASK_BITS - 1), "lid_lower_right");
    assert_null(fap_mask_side_name(FAP_MASK_BITS));
    assert_null(fap_mask_side_name(-1));
}
