/* SPDX-License-Identifier: BSD-2-Clause */
/* What a pose owes to the poses before it: nothing, unless temporal_mm2 asks for it. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bank/faces_test.h"

enum { FRAMES = 12 };

typedef struct rig {
    fap_face *face;
    float *position;
    size_t bytes;
} rig;

static void open_rig(rig *r, const fap_bank *bank, const fap_face_config *cfg)
{
    assert_int_equal(fap_face_open(&r->face, bank, cfg), FAP_OK);
    r->bytes = 3 * fap_face_stride(r->face) * sizeof *r->position;
    r->position = aligned_alloc(32, r->bytes);
    assert_non_null(r->position);
}

static void close_rig(rig *r)
{
    free(r->position);
    fap_face_close(&r->face);
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Other FAPs in every frame, visemes and expressions in some. */
static void scattered(fap_frame *frame, uint32_t seed)
{
    *frame = (fap_frame){ .pts_us = 40000 * (int64_t)seed };
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        if (next(&seed) % 3)
            continue;
        frame->state[fap] = FAP_CODED;
        frame->value[fap] = (int32_t)(next(&seed) % 401) - 200;
    }
    if (next(&seed) % 2) {
        frame->state[1] = FAP_CODED;
        frame->viseme = (fap_viseme){ .select1 = (uint8_t)(1 + next(&seed) % 14), .blend = 40 };
    }
    if (next(&seed) % 2) {
        frame->state[2] = FAP_CODED;
        frame->expression = (fap_expression){ .select1 = (uint8_t)(1 + next(&seed) % 6), .intensity1 = 30 };
    }
}

/* What is kept from frame to frame to save time is made anew when it no longer fits. */
static void check_no_history(fap_blend blend, int regions)
{
    fap_bank *bank = test_bank(BUILTIN);
    fap_face_config cfg;
    fap_frame frame;
    rig old, fresh;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.regions = regions;
    open_rig(&old, bank, &cfg);
    for (uint32_t i = 0; i < 3 * FRAMES; i++) {
        scattered(&frame, i / 3 + i % 2); /* some masks twice in a row, some in turns */
        fap_face_pose(old.face, &frame, old.position, NULL);
        open_rig(&fresh, bank, &cfg);
        fap_face_pose(fresh.face, &frame, fresh.position, NULL);
        assert_memory_equal(old.position, fresh.position, old.bytes);
        close_rig(&fresh);
    }
    close_rig(&old);
    fap_bank_close(&bank);
}

TEST(history, a_pose_owes_nothing_to_those_before_it)
{
    for (int blend = 0; fap_blend_name(blend); blend++)
        check_no_history((fap_blend)blend, 1);
}

TEST(history, nor_in_regions)
{
    check_no_history(FAP_BLEND_GA, 4);
    check_no_history(FAP_BLEND_ZHU, 2);
}

/* --- temporal_mm2 --- */

static void trembling(fap_frame *frame, int t)
{
    static const int faps[] = { 3, 4, 5, 6, 7, 12, 13, 19, 20, 31, 32, 53, 54 };
    uint32_t seed = (uint32_t)t + 1;

    *frame = (fap_frame){ .pts_us = 40000 * (int64_t)t };
    for (size_t i = 0; i < sizeof faps / sizeof *faps; i++) {
        frame->state[faps[i]] = FAP_CODED;
        frame->value[faps[i]] = 100 + (int32_t)(next(&seed) % 31) - 15;
    }
}

/* Summed over frames, how far weights go from one to the next. */
static double restlessness(fap_blend blend, float temporal_mm2)
{
    fap_bank *bank = test_bank(BUILTIN);
    const size_t keys = (size_t)fap_bank_key_count(bank);
    float *last = calloc(keys, sizeof *last);
    fap_face_config cfg;
    fap_frame frame;
    double sum = 0;
    rig r;

    fap_face_config_init(&cfg);
    cfg.blend = blend;
    cfg.temporal_mm2 = temporal_mm2;
    open_rig(&r, bank, &cfg);
    for (int t = 0; t < FRAMES; t++) {
        trembling(&frame, t);
        fap_face_pose(r.face, &frame, r.position, NULL);
        const float *weight = fap_face_weights(r.face);
        for (size_t k = 0; k < keys && t; k++)
            sum += fabs(weight[k] - last[k]);
        memcpy(last, weight, keys * sizeof *last);
    }
    close_rig(&r);
    free(last);
    fap_bank_close(&bank);
    return sum;
}

TEST(history, a_temporal_term_calms_the_weights)
{
    static const fap_blend blends[] = { FAP_BLEND_QP, FAP_BLEND_GA };

    for (int i = 0; i < 2; i++) {
        const double free_s = restlessness(blends[i], 0);
        assert_true(free_s > 0);
        assert_true(restlessness(blends[i], 10) < 0.8 * free_s);
        assert_true(restlessness(blends[i], 100) < 0.4 * free_s);
    }
}

TEST(history, a_leap_in_time_forgets)
{
    fap_bank *bank = test_bank(BUILTIN);
    fap_face_config cfg;
    fap_frame frame;
    rig old, fresh;

    fap_face_config_init(&cfg);
    cfg.temporal_mm2 = 100;
    open_rig(&old, bank, &cfg);
    open_rig(&fresh, bank, &cfg);
    trembling(&frame, 1);
    fap_face_pose(old.face, &frame, old.position, NULL);
    trembling(&frame, 9);
    fap_face_pose(fresh.face, &frame, fresh.position, NULL);
    fap_face_pose(old.face, &frame, old.position, NULL); /* 0.32 s later */
    assert_memory_equal(old.position, fresh.position, old.bytes);
    trembling(&frame, 1);
    fap_face_pose(old.face, &frame, old.position, NULL); /* back again */
    close_rig(&fresh);
    open_rig(&fresh, bank, &cfg);
    fap_face_pose(fresh.face, &frame, fresh.position, NULL);
    assert_memory_equal(old.position, fresh.position, old.bytes);
    close_rig(&old);
    close_rig(&fresh);
    fap_bank_close(&bank);
}
