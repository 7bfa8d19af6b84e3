/* SPDX-License-Identifier: BSD-2-Clause */
/* The control surface of the planar bones, and what it does to lips. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "bank/bones.h"
#include "bank/faces_test.h"

static int shares_two_corners(const uint8_t a[3], const uint8_t b[3])
{
    int shared = 0;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            shared += a[i] == b[j];
    return shared >= 2;
}

TEST(bones, every_bone_is_a_triangle_of_its_own_with_a_neighbour)
{
    uint8_t corner[FAP_BONES_MAX][3];
    const int count = fap_bones_list(corner);

    assert_true(count > 90 && count <= FAP_BONES_MAX);
    for (int i = 0; i < count; i++) {
        const uint8_t *c = corner[i];
        int neighbours = 0;
        assert_true(c[0] != c[1] && c[1] != c[2] && c[2] != c[0]);
        for (int k = 0; k < 3; k++)
            assert_true(c[k] < FAP_BONE_CORNERS);
        for (int j = 0; j < count; j++)
            neighbours += j != i && shares_two_corners(c, corner[j]);
        assert_true(neighbours >= 1 && neighbours <= 4);
    }
}

/* No triangle spans the slit of the mouth or of an eye. */
TEST(bones, no_bone_joins_two_lips_or_two_lids)
{
    static const char *const sides[2][8] = {
        { "2.2", "2.6", "2.7", "8.1", "8.5", "8.6", "3.1", "3.2" },
        { "2.3", "2.8", "2.9", "8.2", "8.7", "8.8", "3.3", "3.4" },
    };
    uint8_t corner[FAP_BONES_MAX][3];
    const int count = fap_bones_list(corner);

    for (int i = 0; i < count; i++) {
        int on[2] = { 0 };
        for (int side = 0; side < 2; side++)
            for (int n = 0; n < 8; n++)
                for (int k = 0; k < 3; k++)
                    on[side] += corner[i][k] == fap_point_by_name(sides[side][n]);
        assert_true(!on[0] || !on[1]);
    }
}

TEST(bones, followers_follow_others_and_not_too_far)
{
    fap_bone_follower f[FAP_BONES_MAX];
    const int count = fap_bones_followers(f);

    assert_true(count > 20 && count <= FAP_BONES_MAX);
    for (int i = 0; i < count; i++) {
        assert_true(f[i].point < FAP_POINT_COUNT && f[i].leader < FAP_POINT_COUNT &&
                    f[i].point != f[i].leader);
        assert_true(f[i].share > 0 && f[i].share <= 1);
    }
}

/* --- on a face --- */

static const float *posed(fap_face *face, float *position, int fap, int value)
{
    fap_frame frame = { 0 };

    frame.state[fap] = FAP_CODED;
    frame.value[fap] = value;
    fap_face_pose(face, &frame, position, NULL);
    return position;
}

static double moved(const fap_bank *bank, const float *position, const char *point)
{
    const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(point));
    const fap_mesh *m = fap_bank_mesh(bank);
    double sum = 0;

    for (size_t axis = 0; axis < 3; axis++) {
        const size_t i = axis * m->stride + p->vertex[0];
        sum += pow(position[i] - m->position[i], 2);
    }
    return sqrt(sum);
}

/* FAP 16 pushes the lower lip forward, FAP 5 raises it. */
static void check_masks(int which)
{
    fap_bank *bank = test_bank(which);
    fap_face_config cfg;
    fap_face *face;

    fap_face_config_init(&cfg);
    cfg.blend = FAP_BLEND_BONES;
    cfg.residual = 0;
    assert_int_equal(fap_face_open(&face, bank, &cfg), FAP_OK);
    float *position = aligned_alloc(32, 3 * fap_face_stride(face) * sizeof *position);
    assert_non_null(position);
    posed(face, position, 16, 200);
    assert_true(moved(bank, position, "2.3") > 4 * moved(bank, position, "2.2"));
    assert_true(moved(bank, position, "8.2") > 4 * moved(bank, position, "8.1"));
    posed(face, position, 19, 500);
    assert_true(moved(bank, position, "3.1") > 4 * moved(bank, position, "3.3"));
    assert_true(moved(bank, position, "3.1") > 4 * moved(bank, position, "4.3"));
    free(position);
    fap_face_close(&face);
    fap_bank_close(&bank);
}

TEST(bones, one_lip_leaves_the_other_alone_and_so_do_lids)
{
    check_masks(BUILTIN);
}

TEST(bones, one_lip_leaves_the_other_alone_on_the_default_face)
{
    check_masks(DEFAULT_FACE);
}
