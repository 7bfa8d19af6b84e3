/* SPDX-License-Identifier: BSD-2-Clause */
/* The chunks of version 1.1: a file may lack them, damage in them is refused, and a face makes the same of them. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/studio/bank_build.h>

#include "bank/format.h"
#include "bank/mask.h"
#include "bank/pca.h"
#include "bank/region.h"
#include "bank/residual.h"
#include "base/mem.h"
#include "shape/bank_file_test.h"

enum { ALL = FBANK_MAX_COMPONENTS };

static const char *const tags[] = { "REGN", "MASK", "PCAC", "PCAM", "PCAW", "PCAP", "PCAB", "PCAD" };
enum { TAGS = sizeof tags / sizeof *tags };

static fap_bank *load_file(const fap_bytes *file)
{
    fap_bank *bank;

    assert_int_equal(fap_bank_load(&bank, file->data, file->size, NULL), FAP_OK);
    return bank;
}

/* A reader passes over what it does not know: the first @p count of the chunks are as good as gone. */
static void hide(fap_bytes *file, int count)
{
    for (int i = 0; i < count; i++)
        test_bank_entry(file, tags[i])[0] = (uint8_t)('a' + i);
    test_bank_seal(file);
}

/* As version 1.0 wrote it. */
static fap_bank *load_old(fap_bytes *file)
{
    hide(file, TAGS);
    file->data[10] = 0;
    return load_file(file);
}

TEST(bank_chunks, a_file_of_version_1_0_has_none_and_loads)
{
    fap_bytes file = test_bank_file(ALL);
    fap_bank *bank = load_old(&file);

    assert_null(fap_bank_masks(bank));
    assert_null(fap_bank_regions(bank));
    assert_null(fap_bank_basis(bank));
    fap_bank_close(&bank);
    fap_bytes_free(&file);
}

TEST(bank_chunks, the_stored_region_map_is_the_one_a_face_draws_itself)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    fap_bytes file = test_bank_file(ALL);
    fap_bank *with = load_file(&file), *without = load_old(&file);
    const size_t size = (size_t)fap_bank_mesh(with)->stride * FAP_REGION_MAX * sizeof(float);

    for (int count = 1; count <= 4; count *= 2)
        for (int overlap = 0; overlap <= 50; overlap += 10) {
            fap_regions a, b;
            assert_int_equal(fap_regions_open(&a, with, count, (float)overlap / 100, &heap), 0);
            assert_int_equal(fap_regions_open(&b, without, count, (float)overlap / 100, &heap), 0);
            assert_memory_equal(a.point, b.point, sizeof a.point);
            if (count > 1)
                assert_memory_equal(a.map, b.map, size);
            fap_regions_close(&a, &heap);
            fap_regions_close(&b, &heap);
        }
    fap_bank_close(&with);
    fap_bank_close(&without);
    fap_bytes_free(&file);
}

TEST(bank_chunks, every_point_of_a_slit_is_on_its_own_side_and_no_vertex_on_both)
{
    fap_bytes file = test_bank_file(0);
    fap_bank *bank = load_file(&file);
    const uint8_t *mask = fap_bank_masks(bank);
    int seen = 0;

    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const uint8_t bit = fap_mask_of_point(p);
        const fap_bank_point *point = fap_bank_point_get(bank, p);
        for (uint32_t i = 0; bit && i < point->vertex_count; i++)
            assert_int_equal(mask[point->vertex[i]], bit);
        seen |= bit;
    }
    assert_int_equal(seen, FAP_MASK_ALL);
    for (uint32_t v = 0; v < fap_bank_mesh(bank)->vertex_count; v++)
        assert_int_equal(mask[v] & (mask[v] - 1), 0);
    fap_bank_close(&bank);
    fap_bytes_free(&file);
}

typedef struct shot {
    fap_face *face;
    float *position;
    size_t count;
} shot;

static void take_shot(shot *s, const fap_bank *bank, fap_blend blend)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    assert_int_equal(fap_face_open(&s->face, bank, &cfg), FAP_OK);
    s->count = 3 * fap_face_stride(s->face);
    s->position = fap_mem_calloc_aligned(&heap, s->count, sizeof *s->position);
    assert_non_null(s->position);
}

static void pose_fap(shot *s, int fap, int value)
{
    fap_frame frame = { .number = 0 };

    frame.state[fap] = FAP_CODED;
    frame.value[fap] = value;
    fap_face_pose(s->face, &frame, s->position, NULL);
}

static float farthest(const shot *a, const shot *b)
{
    float most = 0;

    for (size_t i = 0; i < a->count; i++)
        most = fmaxf(most, fabsf(a->position[i] - b->position[i]));
    return most;
}

static void drop(shot *s)
{
    const fap_allocator heap = fap_mem_allocator(NULL);

    fap_face_close(&s->face);
    fap_mem_free_aligned(&heap, s->position);
}

static fap_bank *with_all_as(const fap_bank *bank, uint8_t bit)
{
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    uint8_t *mask = calloc(n, 1);
    fap_bytes file = { 0 };
    fap_bank_builder *b;

    memset(mask, bit, n);
    assert_int_equal(fap_bank_builder_copy(&b, bank), FAP_OK);
    assert_int_equal(fap_bank_builder_masks(b, mask), FAP_OK);
    assert_int_equal(fap_bank_builder_write(b, &(fap_writer){ test_bank_take, &file }), FAP_OK);
    fap_bank *other = load_file(&file);
    fap_bank_builder_close(&b);
    fap_bytes_free(&file);
    free(mask);
    return other;
}

/* How many blocks the field of a point covers. */
static uint32_t field_size(const fap_bank *bank, const char *point)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    uint32_t *follows = calloc(n, sizeof *follows);
    fap_residual *r = calloc(1, sizeof *r);
    fap_graph graph;

    for (uint32_t v = 0; v < n; v++)
        follows[v] = v;
    assert_int_equal(fap_graph_open(&graph, bank, &heap), 0);
    assert_int_equal(fap_residual_open(r, bank, &graph, follows, &heap), 0);
    const uint32_t size = r->field[fap_point_by_name(point)].block_count;
    fap_residual_close(r, &heap);
    fap_graph_close(&graph, &heap);
    free(r);
    free(follows);
    return size;
}

/* With all the face masked as one lip, the other lip's fields have nowhere to be. */
TEST(bank_chunks, no_field_reaches_across_a_slit)
{
    fap_bytes file = test_bank_file(0);
    fap_bank *bank = load_file(&file), *lower = with_all_as(bank, FAP_MASK_LIP_LOWER);

    assert_true(field_size(bank, "2.2") > 0);
    assert_int_equal(field_size(lower, "2.2"), 0);
    assert_true(field_size(lower, "2.3") >= field_size(bank, "2.3"));
    assert_int_equal(field_size(lower, "8.3"), field_size(bank, "8.3")); /* corners are on no side */
    fap_bank_close(&bank);
    fap_bank_close(&lower);
    fap_bytes_free(&file);
}

TEST(bank_chunks, a_stored_basis_poses_as_one_found_at_open)
{
    fap_bytes file = test_bank_file(0);
    fap_bank *without = load_file(&file);
    const fap_allocator heap = fap_mem_allocator(NULL);
    int key[FAP_PCA_MODELS], used = 0;
    fap_pca pca;
    shot a, b;

    const int count = fap_pca_population(without, key);
    assert_int_equal(fap_pca_open(&pca, without, key, count, 1, &heap), 0);
    while (fap_pca_contribution(&pca, used) < 0.995)
        used++;
    fap_pca_close(&pca, &heap);
    fap_bytes_free(&file);
    file = test_bank_file(used);
    fap_bank *with = load_file(&file);
    assert_int_equal(fap_bank_basis(with)->component_count, used);
    take_shot(&a, with, FAP_BLEND_PCA);
    take_shot(&b, without, FAP_BLEND_PCA);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        pose_fap(&a, fap, 150);
        pose_fap(&b, fap, 150);
        assert_true(farthest(&a, &b) < 0.01f);
    }
    drop(&a);
    drop(&b);
    fap_bank_close(&with);
    fap_bank_close(&without);
    fap_bytes_free(&file);
}

/* Where component @p c takes vertex @p v along an axis: by its blocks, or by models. */
static float by_blocks(const fap_component *c, uint32_t v, uint32_t axis)
{
    for (uint32_t b = 0; b < c->block_count; b++)
        if (c->block[b] == v / FAP_BLOCK)
            return c->scale_mm * c->delta[(b * 3 + axis) * FAP_BLOCK + v % FAP_BLOCK];
    return 0;
}

TEST(bank_chunks, components_move_points_as_they_move_their_vertices)
{
    fap_bytes file = test_bank_file(6);
    fap_bank *bank = load_file(&file);
    const fap_basis *basis = fap_bank_basis(bank);

    assert_int_equal(basis->component_count, 6);
    for (int i = -1; i < basis->component_count; i++) {
        const fap_component *c = i < 0 ? &basis->mean : &basis->component[i];
        for (int p = 0; p < FAP_POINT_COUNT; p++) {
            const fap_bank_point *point = fap_bank_point_get(bank, p);
            for (uint32_t axis = 0; point->vertex_count == 1 && axis < 3; axis++)
                assert_float_equal(by_blocks(c, point->vertex[0], axis), c->point_mm[p][axis], 0.01);
        }
        assert_true(i < 1 || (c->sigma_mm <= c[-1].sigma_mm && c->ratio > c[-1].ratio));
    }
    fap_bank_close(&bank);
    fap_bytes_free(&file);
}

TEST(bank_chunks, own_masks_and_regions_survive_being_written)
{
    fap_bytes file = test_bank_file(0), again = { 0 };
    fap_bank *bank = load_file(&file);
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    uint8_t *mask = calloc(n, 1);
    fap_bank_builder *b;

    memcpy(mask, fap_bank_masks(bank), n);
    for (uint32_t v = 0; v < n; v += 7)
        mask[v] ^= FAP_MASK_LIP_UPPER;
    assert_int_equal(fap_bank_builder_copy(&b, bank), FAP_OK);
    assert_int_equal(fap_bank_builder_masks(b, mask), FAP_OK);
    fap_region_lines lines = *fap_bank_regions(bank);
    lines.extent[0] += 5;
    assert_int_equal(fap_bank_builder_regions(b, &lines, fap_bank_mesh(bank)->stride), FAP_OK);
    assert_int_equal(fap_bank_builder_write(b, &(fap_writer){ test_bank_take, &again }), FAP_OK);
    fap_bank *other = load_file(&again);
    assert_memory_equal(fap_bank_mesh(other)->position, fap_bank_mesh(bank)->position, n * sizeof(float));
    assert_memory_equal(fap_bank_masks(other), mask, n);
    assert_true(fap_bank_regions(other)->extent[0] == lines.extent[0]);
    assert_memory_equal(fap_bank_regions(other)->from, lines.from, n * sizeof(float));
    mask[0] = FAP_MASK_ALL + 1;
    assert_int_equal(fap_bank_builder_masks(b, mask), FAP_E_ARG);
    assert_int_equal(fap_bank_builder_basis(b, ALL + 1), FAP_E_ARG);
    fap_bank_builder_close(&b);
    fap_bank_close(&bank);
    fap_bank_close(&other);
    free(mask);
    fap_bytes_free(&file);
    fap_bytes_free(&again);
}

/* --- damage --- */

TEST(bank_chunks, a_basis_that_lacks_a_part_is_refused)
{
    for (int i = 3; i < TAGS; i++) {
        fap_bytes file = test_bank_file(4);
        test_bank_entry(&file, tags[i])[0] = 'x';
        test_bank_seal(&file);
        assert_int_equal(test_bank_load(file.data, file.size), FAP_E_DATA);
        fap_bytes_free(&file);
    }
}

TEST(bank_chunks, cut_or_grown_by_any_step_is_refused)
{
    fap_bytes file = test_bank_file(4);

    for (int i = 0; i < TAGS; i++) {
        uint8_t *size = test_bank_entry(&file, tags[i]) + 8;
        const uint32_t whole = test_get32(size);
        const uint32_t wrong[] = { 0, 1, whole / 2, whole - 4, whole - 1, whole + 1 };
        for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
            test_put32(size, wrong[k]);
            test_bank_seal(&file);
            assert_int_not_equal(test_bank_load(file.data, file.size), FAP_OK);
        }
        test_put32(size, whole);
    }
    test_bank_seal(&file);
    assert_int_equal(test_bank_load(file.data, file.size), FAP_OK);
    fap_bytes_free(&file);
}

TEST(bank_chunks, one_wrong_bit_is_noticed)
{
    fap_bytes file = test_bank_file(4);

    for (int i = 0; i < TAGS; i++) {
        const uint32_t size = test_get32(test_bank_entry(&file, tags[i]) + 8);
        uint8_t *data = test_bank_chunk(&file, tags[i]);
        for (uint32_t at = 0; at < size; at += size / 16 + 1) {
            data[at] ^= 1 << at % 8;
            assert_int_equal(test_bank_load(file.data, file.size), FAP_E_DATA);
            data[at] ^= 1 << at % 8;
        }
    }
    fap_bytes_free(&file);
}

/* 32-bit values behind good checksums. A record of PCAC: sigma, ratio, rest, step, first, count, 0, 0. */
static const struct damage {
    const char *tag;
    uint32_t offset, value;
} damages[] = {
    { "REGN", 0, 0x7fc00000 },
    { "REGN", 8, 0xbf800000 },
    { "REGN", 12, 0x7f800000 },
    { "REGN", 16, 1 },
    { "REGN", 28, 0x3f800000 },
    { "REGN", 32, 0x7fc00000 },
    { "REGN", 36, 0x7f7fffff },
    { "MASK", 0, 64 },
    { "MASK", 4, 0xff000000 },
    { "PCAC", 0, 0 },
    { "PCAC", 0, 5 },
    { "PCAC", 0, 129 },
    { "PCAC", 0, 0xffffffff },
    { "PCAC", 4, 1 },
    { "PCAC", 4, 0xffffffff },
    { "PCAC", 8, 0xffffffff },
    { "PCAC", 8, 1 },
    { "PCAC", 12, 1 },
    { "PCAC", 16, 0x3f800000 },
    { "PCAC", 16 + 12, 0 },
    { "PCAC", 16 + 12, 0x7fc00000 },
    { "PCAC", 16 + 16, 0xffffffff },
    { "PCAC", 16 + 20, 0xffffffff },
    { "PCAC", 16 + 24, 1 },
    { "PCAC", 16 + 28, 1 },
    { "PCAC", 48, 0 },
    { "PCAC", 48, 0x7fc00000 },
    { "PCAC", 48, 0xbf800000 },
    { "PCAC", 48, 0x3a800000 },
    { "PCAC", 52, 0x40000000 },
    { "PCAC", 52, 0xbf800000 },
    { "PCAC", 56, 0x7fc00000 },
    { "PCAM", 0, 0 },
    { "PCAM", 4, 0xffffffff },
    { "PCAM", 4, 85 },
    { "PCAM", 8, 0 },
    { "PCAW", 0, 0x7fc00000 },
    { "PCAW", 8, 0x3f800001 },
    { "PCAP", 0, 0x7fc00000 },
    { "PCAB", 0, 0xffffffff },
    { "PCAB", 0, 0x00000000 },
};

TEST(bank_chunks, bad_values_behind_good_checksums_are_refused)
{
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        fap_bytes file = test_bank_file(4);
        test_put32(test_bank_chunk(&file, damages[i].tag) + damages[i].offset, damages[i].value);
        test_bank_seal(&file);
        const fap_err err = test_bank_load(file.data, file.size);
        if (err != FAP_E_DATA && err != FAP_E_LIMIT)
            fail_msg("%s + %u: %d", damages[i].tag, damages[i].offset, err);
        fap_bytes_free(&file);
    }
}
