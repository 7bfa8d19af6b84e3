/* SPDX-License-Identifier: BSD-2-Clause */
/* Real takes without their labels, in another order, turned and scaled, must be mapped as they were by label. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

/* --- a take that says nothing --- */

static void turn(const double r[3][3], double scale, float v[3])
{
    double out[3];

    for (int row = 0; row < 3; row++)
        out[row] = scale * (r[row][0] * (double)v[0] + r[row][1] * (double)v[1] + r[row][2] * (double)v[2]);
    for (int axis = 0; axis < 3; axis++)
        v[axis] = (float)(out[axis] + 100 * (axis + 1));
}

/* Somewhere in the middle of nowhere: no axis of the take is an axis of the head. */
static const double askew[3][3] = { { 0.36, 0.48, -0.8 }, { -0.8, 0.6, 0 }, { 0.48, 0.64, 0.6 } };

static uint32_t common_divisor(uint32_t a, uint32_t b)
{
    return b ? common_divisor(b, a % b) : a;
}

/* Point i becomes point i * stride mod count; coprime, so that no two become one. */
static uint32_t new_place(uint32_t i, uint32_t count)
{
    uint32_t stride = 7;

    while (common_divisor(count, stride) != 1)
        stride++;
    return (uint32_t)((uint64_t)i * stride % count);
}

/* A point that a reader has computed on a ball behind the lids is no marker: nobody meets it without its label. */
static int is_marker(const fap_take *take, uint32_t point)
{
    return strncmp(take->name[point], "pupil_", 6) != 0;
}

static fap_take *anonymous(const fap_take *take, const double r[3][3], double scale)
{
    const uint32_t n = take->point_count;
    fap_take *out;

    assert_int_equal(fap_take_create(&out, n, take->frame_count, NULL), FAP_OK);
    out->rate_hz = take->rate_hz;
    for (uint32_t i = 0; i < n; i++)
        snprintf(out->name[new_place(i, n)], FAP_TAKE_NAME_SIZE, "C_%u", (unsigned)new_place(i, n));
    for (uint32_t f = 0; f < take->frame_count; f++)
        for (uint32_t i = 0; i < n; i++) {
            const float *at = fap_take_sample(take, f, i);
            float v[3];
            if (!at || !is_marker(take, i))
                continue;
            memcpy(v, at, sizeof v);
            turn(r, scale, v);
            fap_take_set(out, f, new_place(i, n), v);
        }
    return out;
}

static fap_capture *encode(const fap_take *take)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture *c;

    if (fap_capture_encode(&c, take, NULL, where) != FAP_OK)
        fail_msg("%s", where);
    return c;
}

/* A take with its labels, and without. */
typedef struct pair {
    fap_take *take, *bare;
    fap_capture *named, *found;
} pair;

static void open_pair(pair *p, const char *name, const double r[3][3], double scale)
{
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(test_read_shared(&p->take, name, where), FAP_OK);
    p->bare = anonymous(p->take, r, scale);
    p->named = encode(p->take);
    p->found = encode(p->bare);
    assert_true(fap_capture_report_get(p->found)->fitted > 0);
    assert_int_equal(fap_capture_report_get(p->named)->fitted, 0);
}

static void close_pair(pair *p)
{
    fap_capture_close(&p->named);
    fap_capture_close(&p->found);
    fap_take_close(&p->take);
    fap_take_close(&p->bare);
}

static double apart_mm(const pair *p, uint32_t a, uint32_t b)
{
    float x[3], y[3];

    if (!fap_capture_marker_place(p->named, a, x) || !fap_capture_marker_place(p->named, b, y))
        return INFINITY;
    return sqrt(pow((double)(x[0] - y[0]), 2) + pow((double)(x[1] - y[1]), 2) +
                pow((double)(x[2] - y[2]), 2));
}

static uint32_t old_place(uint32_t place, uint32_t count)
{
    uint32_t i = 0;

    while (new_place(i, count) != place)
        i++;
    return i;
}

/* Is the marker found for a feature point the labelled one, or within @p near_mm of it? */
static int is_same(const pair *p, int point, double near_mm)
{
    const fap_marker_source *want = &fap_capture_report_get(p->named)->markers.point[point];
    const fap_marker_source *got = &fap_capture_report_get(p->found)->markers.point[point];

    if (!got->count)
        return 0;
    const uint32_t marker = old_place((uint32_t)got->index[0], p->take->point_count);
    for (int k = 0; k < want->count; k++)
        if (marker == (uint32_t)want->index[k] || apart_mm(p, marker, (uint32_t)want->index[k]) < near_mm)
            return 1;
    return 0;
}

/* Of the feature points that FAPs move and a label names. Pupils are not looked for. */
static double same_share(const pair *p, double near_mm)
{
    int same = 0, all = 0;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_point_info *info = fap_point_get(i);
        if (!info->moved || !fap_capture_report_get(p->named)->markers.point[i].count ||
            (info->group == 3 && info->index > 4))
            continue;
        all++;
        same += is_same(p, i, near_mm);
    }
    return (double)same / all;
}

TEST(unlabelled, a_set_of_markers_is_mapped_as_by_its_labels)
{
    pair p;

    open_pair(&p, "optical_animface/jaw_60hz.c3d", askew, 1.4);
    assert_true(same_share(&p, 0) >= 0.9);
    close_pair(&p);
    open_pair(&p, "optical_animface/eyebrows_60hz_nexus.csv", askew, 0.7);
    assert_true(same_share(&p, 0) >= 0.9);
    close_pair(&p);
}

/* Of points that are dense, a neighbour does as well. */
TEST(unlabelled, landmarks_are_mapped_as_by_their_labels_or_beside)
{
    pair p;

    open_pair(&p, "openface/openfacer_lara_0001-0600.csv", askew, 1);
    assert_true(same_share(&p, 12) >= 0.9);
    close_pair(&p);
}

TEST(unlabelled, the_jaw_opens_and_left_is_left)
{
    pair p;

    open_pair(&p, "optical_animface/jaw_60hz.c3d", askew, 1);
    const fap_capture_report *a = fap_capture_report_get(p.named), *b = fap_capture_report_get(p.found);
    assert_true(b->fap[3].max > 0.8 * a->fap[3].max && b->fap[3].max < 1.25 * a->fap[3].max);
    assert_true(b->fap[15].max > 0.7 * a->fap[15].max); /* to the right further than to the left */
    assert_int_equal(b->sides_swapped, 0);
    assert_int_equal(b->fap[19].coded, 0); /* skin beside the eye is no lid */
    close_pair(&p);
}

/* --- what is no face --- */

static void assert_refused(const fap_take *take, const char *because)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture *c;

    assert_int_equal(fap_capture_encode(&c, take, NULL, where), FAP_E_NOT_FOUND);
    assert_null(c);
    if (!strstr(where, because) || !strstr(where, "--markers"))
        fail_msg("%s", where);
}

static fap_take *cloud(uint32_t points)
{
    uint32_t seed = 7;
    fap_take *take;

    assert_int_equal(fap_take_create(&take, points, 20, NULL), FAP_OK);
    take->rate_hz = 25;
    for (uint32_t i = 0; i < points; i++) {
        float at[3];
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "*%u", (unsigned)i);
        for (int axis = 0; axis < 3; axis++) {
            seed = seed * 1664525u + 1013904223u;
            at[axis] = (float)(seed >> 16) / 400.0f;
        }
        for (uint32_t f = 0; f < 20; f++)
            fap_take_set(take, f, i, at);
    }
    return take;
}

TEST(unlabelled, points_in_no_order_are_no_face)
{
    fap_take *take = cloud(40);

    assert_refused(take, "does not fit");
    fap_take_close(&take);
    take = cloud(5);
    assert_refused(take, "too few");
    fap_take_close(&take);
}

TEST(unlabelled, a_gait_is_no_face)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;

    assert_int_equal(test_read_shared(&take, "format_samples/nexus_markers.csv", where), FAP_OK);
    fap_take *bare = anonymous(take, askew, 1);
    assert_refused(bare, "no label is known");
    fap_take_close(&bare);
    fap_take_close(&take);
}

TEST(unlabelled, points_all_in_one_place_and_flat_ones_do_no_harm)
{
    fap_take *take = cloud(30);

    for (uint32_t i = 0; i < 30 * 20; i++)
        take->xyz[i][2] = 0;
    assert_refused(take, "no label is known");
    for (uint32_t i = 0; i < 30 * 20; i++)
        take->xyz[i][0] = take->xyz[i][1] = 1;
    assert_refused(take, "no label is known");
    fap_take_close(&take);
}
