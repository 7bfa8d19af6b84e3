/* SPDX-License-Identifier: BSD-2-Clause */
/* A made-up face with known FAPs on a moving head must give those FAPs back. */
#include "take/take_test.h"

#include <math.h>

#include <fap/studio/capture.h>

/* Places on a symmetric neutral face, millimetres: ES 60, ENS 40, MNS 20, MW 50, IRISD 10. */
static const struct place {
    const char *name;
    float x, y, z;
} places[] = {
    { "3.5", 30, 40, 75 },  { "3.6", -30, 40, 75 },  { "3.1", 30, 45, 76 },   { "3.2", -30, 45, 76 },
    { "3.3", 30, 35, 76 },  { "3.4", -30, 35, 76 },  { "9.15", 0, 0, 95 },    { "9.3", 0, 8, 105 },
    { "2.2", 0, -20, 96 },  { "2.3", 0, -20, 95 },   { "2.4", 24, -20, 84 },  { "2.5", -24, -20, 84 },
    { "8.3", 25, -20, 83 }, { "8.4", -25, -20, 83 }, { "8.1", 0, -14, 97 },   { "8.2", 0, -28, 96 },
    { "2.1", 0, -60, 80 },  { "2.10", 0, -50, 88 },  { "4.1", 12, 60, 88 },   { "4.2", -12, 60, 88 },
    { "4.3", 32, 66, 84 },  { "4.4", -32, 66, 84 },  { "4.5", 52, 60, 66 },   { "4.6", -52, 60, 66 },
    { "5.1", 45, -5, 70 },  { "5.2", -45, -5, 70 },  { "5.3", 48, 12, 72 },   { "5.4", -48, 12, 72 },
    { "9.1", 15, 3, 88 },   { "9.2", -15, 3, 88 },   { "Cap1", 70, 110, 20 }, { "Cap2", -70, 110, 20 },
    { "Cap3", 0, 130, 60 }, { "Cap4", 0, 100, -60 },
};

enum { PLACES = sizeof places / sizeof *places, FRAMES = 60 };

static const char rigid_names[] = "Cap1,Cap2,Cap3,Cap4";
static const fap_fapu true_fapu = { 10, 60, 40, 20, 50 };

/* What the FAPs are in each frame: 0 in the first, then a wave of its own for each. */
static int32_t wanted(int fap, int frame)
{
    const float size = fap_info_get(fap)->unit == FAP_UNIT_AU ? 10000 : 100;
    return (int32_t)(size * (sinf((float)fap + 0.2f * (float)frame) - sinf((float)fap)));
}

static int is_pupil(const char *name)
{
    return !strcmp(name, "3.5") || !strcmp(name, "3.6");
}

static void displace(int fap, int frame, const char *name, float v[3])
{
    const fap_info *info = fap_info_get(fap);
    const float amount =
        info->sign * fap_fapu_step(&true_fapu, (fap_unit)info->unit) * (float)wanted(fap, frame);

    if (info->point < 0 || strcmp(fap_point_get(info->point)->name, name) != 0)
        return;
    if (info->motion == FAP_MOTION_YAW)
        v[0] += 12 * sinf(amount);
    else if (info->motion == FAP_MOTION_PITCH)
        v[1] -= 12 * sinf(amount);
    else if (info->motion <= FAP_MOTION_Z && !is_pupil(name))
        v[info->motion - FAP_MOTION_X] += amount;
}

/* @p order: which axis of the head becomes x, y, z of the take, with signs. */
static void place_marker(fap_take *take, uint32_t frame, uint32_t i, const int8_t order[3])
{
    float v[3] = { places[i].x, places[i].y, places[i].z }, r[3][3], posed[3], out[3];

    for (int fap = 3; fap <= 47; fap++)
        displace(fap, (int)frame, places[i].name, v);
    for (int fap = 51; fap <= FAP_COUNT; fap++)
        displace(fap, (int)frame, places[i].name, v);
    fap_head_rotation(wanted(48, (int)frame), wanted(49, (int)frame), wanted(50, (int)frame), r);
    for (int a = 0; a < 3; a++)
        posed[a] = r[a][0] * v[0] + r[a][1] * v[1] + r[a][2] * v[2] + 20 * sinf(0.1f * (float)frame);
    for (int a = 0; a < 3; a++)
        out[a] = (order[a] < 0 ? -1.0f : 1.0f) * posed[abs(order[a]) - 1];
    fap_take_set(take, frame, i, out);
}

static fap_take *make_take(const int8_t order[3])
{
    fap_take *take;

    assert_int_equal(fap_take_create(&take, PLACES, FRAMES, NULL), FAP_OK);
    take->rate_hz = 25;
    for (uint32_t i = 0; i < PLACES; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "Anna:%s", places[i].name);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t i = 0; i < PLACES; i++)
            place_marker(take, f, i, order);
    return take;
}

static const int8_t straight[3] = { 1, 2, 3 };

static fap_capture *encode(const fap_take *take, void (*change)(fap_capture_config *))
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture_config cfg;
    fap_capture *c;

    fap_capture_config_init(&cfg);
    cfg.neutral_frame = 0;
    cfg.rigid = rigid_names;
    cfg.fill = FAP_FILL_NONE;
    if (change)
        change(&cfg);
    if (fap_capture_encode(&c, take, &cfg, where) != FAP_OK)
        fail_msg("%s", where);
    return c;
}

static void assert_near(int fap, int frame, int32_t got, int32_t want)
{
    if (abs(got - want) > (fap_info_get(fap)->unit == FAP_UNIT_AU ? 12 : 1))
        fail_msg("FAP %d, frame %d: %d, not %d", fap, frame, (int)got, (int)want);
}

static void assert_all_faps(const fap_capture *c)
{
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_int_equal(r->frames, FRAMES);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        for (int f = 0; r->fap[fap].coded && r->fap[fap].origin.how == FAP_HOW_DIRECT && f < FRAMES; f++)
            assert_near(fap, f, fap_capture_frames(c)[f].value[fap], wanted(fap, f));
    /* Nothing that a marker determines may be left out: eyes, lids, lips, brows, cheeks, nose, jaw, head. */
    static const int expected[] = { 3,  4,  5,  6,  12, 14, 15, 16, 17, 18, 19, 22,
                                    23, 26, 31, 37, 40, 42, 48, 50, 51, 60, 64 };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_int_equal(r->fap[expected[i]].coded, FRAMES);
}

TEST(capture, known_faps_on_a_moving_head_come_back)
{
    fap_take *take = make_take(straight);
    fap_capture *c = encode(take, NULL);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_all_faps(c);
    assert_int_equal(r->rigid_origin, FAP_ORIGIN_GIVEN);
    assert_int_equal(r->fapu_origin[0], FAP_ORIGIN_MEASURED);
    assert_float_equal(r->fapu.mw_mm, 50, 1e-3);
    assert_float_equal(r->fapu.irisd_mm, 10, 1e-3);
    assert_int_equal(r->fap[27].coded, 0);
    fap_capture_close(&c);
    fap_take_close(&take);
}

TEST(capture, axes_are_found_whichever_way_the_take_has_them)
{
    static const int8_t orders[][3] = { { 1, -3, 2 }, { 3, 1, 2 }, { -1, 2, -3 }, { -2, 1, 3 } };

    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        fap_take *take = make_take(orders[i]);
        fap_capture *c = encode(take, NULL);
        assert_all_faps(c);
        assert_true(fap_capture_report_get(c)->axes_found);
        fap_capture_close(&c);
        fap_take_close(&take);
    }
}

static void give_axes(fap_capture_config *cfg)
{
    cfg->axes = "xz-y";
}

TEST(capture, given_axes_are_taken_as_they_are)
{
    static const int8_t z_up[3] = { 1, -3, 2 };
    fap_take *take = make_take(z_up);
    fap_capture *c = encode(take, give_axes);

    assert_all_faps(c);
    assert_string_equal(fap_capture_report_get(c)->axes, "+x+z-y");
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void find_rigid(fap_capture_config *cfg)
{
    cfg->rigid = NULL;
}

TEST(capture, markers_that_keep_their_distances_are_found)
{
    fap_take *take = make_take(straight);
    fap_capture *c = encode(take, find_rigid);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_int_equal(r->rigid_origin, FAP_ORIGIN_FOUND);
    assert_true(r->rigid_count >= 4);
    assert_all_faps(c);
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void swap_names(fap_take *take)
{
    for (uint32_t i = 0; i < PLACES; i++) {
        const int point = fap_point_by_name(places[i].name);
        if (point >= 0)
            snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "%s",
                     fap_point_get(fap_point_get(point)->mirror)->name);
    }
}

TEST(capture, names_on_the_wrong_side_are_noticed)
{
    fap_take *take = make_take(straight);

    swap_names(take);
    fap_capture *c = encode(take, NULL);
    assert_true(fap_capture_report_get(c)->sides_swapped);
    assert_all_faps(c);
    fap_capture_close(&c);
    fap_take_close(&take);
}

/* Hides a marker from @p first to @p last. */
static void hide(fap_take *take, const char *name, uint32_t first, uint32_t last)
{
    const int p = fap_take_find(take, name);

    for (uint32_t f = first; f <= last; f++)
        take->valid[f * take->point_count + (uint32_t)p] = 0;
}

TEST(capture, a_gap_is_masked_out_or_eased_but_never_invented)
{
    fap_take *take = make_take(straight);

    hide(take, "8.3", 20, 39);
    hide(take, "9.3", 50, 59);
    fap_capture *c = encode(take, NULL);
    assert_int_equal(fap_capture_frames(c)[30].state[53], FAP_HELD);
    assert_int_equal(fap_capture_frames(c)[30].value[53], fap_capture_frames(c)[19].value[53]);
    assert_int_equal(fap_capture_frames(c)[30].state[54], FAP_CODED);
    assert_int_equal(fap_capture_fill_of(c, 30, 53), FAP_SAMPLE_MISSING);
    assert_int_equal(fap_capture_fill_of(c, 19, 53), FAP_SAMPLE_MEASURED);
    assert_int_equal(fap_capture_fill_of(c, 30, 48), FAP_SAMPLE_MEASURED);
    assert_int_equal(fap_capture_fill_of(c, FRAMES, 53), FAP_SAMPLE_MISSING);
    assert_int_equal(fap_capture_fill_of(c, 0, FAP_COUNT + 1), FAP_SAMPLE_MISSING);
    fap_capture_close(&c);

    fap_capture_config cfg;
    fap_capture_config_init(&cfg);
    cfg.neutral_frame = 0;
    cfg.rigid = rigid_names;
    assert_int_equal(fap_capture_encode(&c, take, &cfg, NULL), FAP_OK);
    assert_int_equal(fap_capture_frames(c)[30].state[53], FAP_CODED);
    assert_true(fap_capture_fill_of(c, 30, 53) > FAP_SAMPLE_MEASURED);
    assert_int_equal(fap_capture_fill_of(c, 45, 53), FAP_SAMPLE_MEASURED);
    /* All points move in time here, so the others tell where it is, at the end of the take, too. */
    for (int f = 20; f < 40; f++)
        assert_in_range(fap_capture_frames(c)[f].value[53] - wanted(53, f) + 15, 0, 30);
    for (int f = 50; f < 60; f++)
        assert_in_range(fap_capture_frames(c)[f].value[63] - wanted(63, f) + 15, 0, 30);
    assert_int_equal(fap_capture_fill_of(c, 55, 63), FAP_SAMPLE_MOTION);
    const int hidden = fap_take_find(take, "8.3");
    assert_int_equal(fap_capture_clean_points(c)[hidden].gaps, 1);
    assert_int_equal(fap_capture_clean_points(c)[hidden].longest_gap, 20);
    assert_int_equal(fap_capture_clean_points(c)[hidden].unfilled, 0);
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void given_fapu(fap_capture_config *cfg)
{
    static const fap_fapu twice = { 20, 120, 80, 40, 100 };
    cfg->fapu = &twice;
}

TEST(capture, given_fapu_scale_the_values)
{
    fap_take *take = make_take(straight);
    fap_capture *c = encode(take, given_fapu);

    assert_in_range(2 * fap_capture_frames(c)[9].value[51] - wanted(51, 9) + 2, 0, 4);
    assert_int_equal(fap_capture_report_get(c)->fapu_origin[3], FAP_ORIGIN_GIVEN);
    fap_capture_close(&c);
    fap_take_close(&take);
}

/* Keeps only the named markers. */
static fap_take *only(const fap_take *take, const char *const *names, uint32_t count)
{
    fap_take *out;

    assert_int_equal(fap_take_create(&out, count, take->frame_count, NULL), FAP_OK);
    out->rate_hz = take->rate_hz;
    for (uint32_t i = 0; i < count; i++) {
        const int p = fap_take_find(take, names[i]);
        snprintf(out->name[i], FAP_TAKE_NAME_SIZE, "%s", names[i]);
        for (uint32_t f = 0; f < take->frame_count; f++)
            fap_take_set(out, f, i, fap_take_sample(take, f, (uint32_t)p));
    }
    return out;
}

TEST(capture, one_chin_marker_gives_the_jaw_and_not_the_chin)
{
    static const char *const names[] = { "Cap1", "Cap2", "Cap3", "Cap4", "2.10", "4.1", "4.2", "8.3", "8.4" };
    fap_take *all = make_take(straight), *take = only(all, names, 9);
    fap_capture *c = encode(take, NULL);
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_int_equal(r->fap[3].coded, FRAMES);
    assert_int_equal(r->fap[18].coded, 0);
    assert_int_equal(r->fap[19].coded, 0);
    assert_int_equal(r->fap[4].coded, 0);
    assert_int_equal(r->fapu_origin[4], FAP_ORIGIN_MEASURED);
    assert_int_equal(r->fapu_origin[0], FAP_ORIGIN_SCALED);
    fap_capture_close(&c);
    fap_take_close(&take);
    fap_take_close(&all);
}

TEST(capture, what_cannot_be_encoded_says_why)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take = make_take(straight);
    fap_capture_config cfg;
    fap_capture *c;

    fap_capture_config_init(&cfg);
    cfg.rigid = "Cap1,Nobody";
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "Nobody"));
    cfg.rigid = "Cap1,Cap2";
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_ARG);
    cfg.rigid = NULL;
    cfg.axes = "xxz";
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_ARG);
    cfg.axes = NULL;
    cfg.neutral_frame = FRAMES;
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_ARG);
    cfg.neutral_frame = -1;
    cfg.start_s = 99;
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_ARG);
    cfg.start_s = 0;
    take->rate_hz = 0;
    assert_int_equal(fap_capture_encode(&c, take, &cfg, where), FAP_E_ARG);
    assert_null(c);
    fap_take_close(&take);
}

/* A still, closed second in the middle of a take that moves all the time. */
TEST(capture, the_neutral_frame_is_a_still_one)
{
    fap_take *take = make_take(straight);
    fap_capture_config cfg;
    fap_capture *c;

    for (uint32_t f = 30; f < 42; f++)
        for (uint32_t i = 0; i < PLACES; i++)
            fap_take_set(take, f, i, take->xyz[i]);
    fap_capture_config_init(&cfg);
    cfg.rigid = rigid_names;
    cfg.smooth_hz = -1;
    assert_int_equal(fap_capture_encode(&c, take, &cfg, NULL), FAP_OK);
    assert_in_range((int)(fap_capture_report_get(c)->neutral_s * 25 + 0.5), 31, 40);
    fap_capture_close(&c);
    fap_take_close(&take);
}

static double largest(const fap_capture_report *r, int first, int last)
{
    double most = 0;

    for (int fap = first; fap <= last; fap++)
        most = fmax(most, fmax(abs(r->fap[fap].min), abs(r->fap[fap].max)));
    return most;
}

static fap_capture *encode_shared(const char *name)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take *take;
    fap_capture *c;

    assert_int_equal(test_read_shared(&take, name, where), FAP_OK);
    if (fap_capture_encode(&c, take, NULL, where) != FAP_OK)
        fail_msg("%s: %s", name, where);
    fap_take_close(&take);
    return c;
}

TEST(capture, the_jaw_take_opens_the_mouth_and_leaves_the_brows)
{
    fap_capture *c = encode_shared("optical_animface/jaw_60hz.c3d");
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_true(r->fap[3].max > 900);
    assert_true(r->fap[52].min < -1000); /* the lower lip follows */
    assert_true(largest(r, 33, 36) < 60);
    assert_int_equal(r->fap[19].coded, 0);
    assert_string_equal(r->markers.set, "ANIMFACE");
    fap_capture_close(&c);
}

TEST(capture, the_brow_take_moves_the_brows_and_leaves_the_mouth)
{
    fap_capture *c = encode_shared("optical_animface/eyebrows_60hz_nexus.csv");
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_true(r->fap[32].max > 150 && r->fap[32].min < -80);
    assert_true(r->fap[37].max > 40); /* frowning draws them together */
    assert_true(largest(r, 53, 54) < 60);
    assert_true(r->fap[3].max < 250);
    fap_capture_close(&c);
}

TEST(capture, places_of_markers_are_those_of_the_face_at_rest)
{
    static const int8_t turned[3] = { 3, 1, 2 };
    fap_take *take = make_take(turned);
    fap_capture *c = encode(take, NULL);
    float chin[3], lip[3];

    assert_true(fap_capture_marker_place(c, (uint32_t)fap_take_find(take, "2.1"), chin));
    assert_true(fap_capture_marker_place(c, (uint32_t)fap_take_find(take, "8.3"), lip));
    assert_float_equal(lip[0] - chin[0], 25, 0.5);
    assert_float_equal(lip[1] - chin[1], 40, 0.5);
    assert_float_equal(lip[2] - chin[2], 3, 0.5);
    assert_false(fap_capture_marker_place(c, take->point_count, chin));
    fap_capture_close(&c);
    fap_take_close(&take);
}

TEST(capture, what_is_sent_names_its_markers_and_what_is_not_a_reason)
{
    fap_take *take = make_take(straight);
    fap_capture *c = encode(take, NULL);
    const fap_capture_report *r = fap_capture_report_get(c);
    int with_markers = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        assert_int_equal(r->fap[fap].reason != NULL, r->fap[fap].coded == 0);
        with_markers += r->fap[fap].origin.marker_count > 0;
        if (r->fap[fap].coded && r->fap[fap].point >= 0) {
            assert_int_not_equal(r->fap[fap].origin.how, FAP_HOW_NONE);
            assert_true(r->fap[fap].origin.marker_count > 0);
        }
    }
    assert_true(with_markers > 30);
    assert_string_equal(take->name[r->fap[53].origin.marker[0]], "Anna:8.3");
    assert_string_equal(fap_how_name((fap_how)r->fap[53].origin.how), "direct");
    assert_non_null(strstr(r->fap[43].reason, "tongue"));
    assert_non_null(strstr(r->fap[27].reason, "depth"));
    fap_capture_close(&c);
    fap_take_close(&take);
}

TEST(capture, skin_beside_the_eye_is_no_lid_and_the_chin_stands_in_for_the_jaw)
{
    fap_capture *c = encode_shared("optical_animface/jaw_60hz.c3d");
    const fap_capture_report *r = fap_capture_report_get(c);

    for (int fap = 19; fap <= 22; fap++)
        assert_non_null(strstr(r->fap[fap].reason, "lid"));
    assert_non_null(strstr(r->fap[18].reason, "jaw"));
    assert_int_equal(r->fap[3].origin.how, FAP_HOW_COPIED);
    assert_int_equal(r->fap[5].origin.how, FAP_HOW_DERIVED);
    assert_int_equal(r->fap[31].origin.how, FAP_HOW_DIRECT);
    fap_capture_close(&c);
}

/* Half a second at rest, then two seconds of one broad smile: it is the smile that is FAPs. */
TEST(capture, a_long_smile_is_not_the_neutral_face)
{
    fap_capture *c = encode_shared("mediapipe/face_noface_facemesh478.csv");
    const fap_capture_report *r = fap_capture_report_get(c);

    assert_true(r->neutral_s < 0.6);
    for (int fap = 59; fap <= 60; fap++) {
        assert_true(abs(fap_capture_frames(c)[8].value[fap]) < 60);
        assert_true(fap_capture_frames(c)[50].value[fap] > 200);
    }
    assert_true(fap_capture_frames(c)[50].value[53] > 100);
    fap_capture_close(&c);
}

/* --- the head --- */

/* Knocked half way through the take. */
static void slip(fap_take *take, const char *name, float mm)
{
    const uint32_t p = (uint32_t)fap_take_find(take, name);

    for (uint32_t f = take->frame_count / 2; f < take->frame_count; f++) {
        take->xyz[f * take->point_count + p][0] += mm;
        take->xyz[f * take->point_count + p][1] -= mm;
    }
}

static int says(const fap_capture_report *r, const char *text)
{
    for (uint32_t i = 0; i < r->note_count; i++)
        if (strstr(r->note[i], text))
            return 1;
    return 0;
}

TEST(capture, a_rigid_marker_that_slips_does_not_turn_the_head_while_the_face_talks)
{
    fap_take *take = make_take(straight);

    slip(take, "Cap2", 6);
    fap_capture *c = encode(take, find_rigid);
    const fap_capture_report *r = fap_capture_report_get(c);
    assert_int_equal(r->rigid_origin, FAP_ORIGIN_FOUND);
    for (uint32_t i = 0; i < r->rigid_count; i++)
        assert_string_not_equal(take->name[r->rigid[i]], "Anna:Cap2");
    assert_all_faps(c);
    fap_capture_close(&c);
    fap_take_close(&take);
}

TEST(capture, one_of_the_given_rigid_markers_may_slip)
{
    fap_take *take = make_take(straight);

    slip(take, "Cap2", 6);
    fap_capture *c = encode(take, NULL);
    const fap_capture_report *r = fap_capture_report_get(c);
    assert_int_equal(r->rigid_count, 3);
    assert_true(says(r, "Cap2 does not keep its place"));
    assert_all_faps(c);
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void carry_by_nose(fap_capture_config *cfg)
{
    cfg->head = FAP_HEAD_NOSE;
}

/* The caps as far away as a jig on a helmet that wobbles: only their turning is of use. */
TEST(capture, the_tip_of_the_nose_can_carry_the_head)
{
    fap_take *take = make_take(straight);
    const uint32_t nose = (uint32_t)fap_take_find(take, "9.3"), chin = (uint32_t)fap_take_find(take, "2.1");

    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t i = 0; i < PLACES; i++)
            if (!strncmp(places[i].name, "Cap", 3))
                take->xyz[f * PLACES + i][1] += 4 * sinf((float)f);
    fap_capture *c = encode(take, carry_by_nose);
    const fap_capture_report *r = fap_capture_report_get(c);
    float moved[3];
    assert_int_equal(r->fap[63].coded, 0);
    assert_non_null(strstr(r->fap[63].reason, "--head nose"));
    for (uint32_t f = 0; f < FRAMES; f++) {
        float chin_moved[3] = { 0 }, nose_moved[3] = { 0 };
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            displace(fap, (int)f, "2.1", chin_moved);
            displace(fap, (int)f, "9.3", nose_moved);
        }
        assert_true(fap_capture_marker_moved(c, f, nose, moved));
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(moved[axis], 0, 1e-3);
        assert_true(fap_capture_marker_moved(c, f, chin, moved));
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(moved[axis], chin_moved[axis] - nose_moved[axis], 0.02);
        assert_near(48, (int)f, fap_capture_frames(c)[f].value[48], wanted(48, (int)f));
    }
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void neutral_stretch(fap_capture_config *cfg)
{
    cfg->neutral_frame = 10;
    cfg->neutral_last = 19;
    cfg->smooth_hz = -1;
}

/* What is neutral is the mean: FAPs are what they were, less their mean over the stretch. */
TEST(capture, the_mean_of_a_given_stretch_is_the_face_at_rest)
{
    fap_take *take = make_take(straight);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t i = 0; i < PLACES; i++)
            if (!strncmp(places[i].name, "Cap", 3))
                memcpy(take->xyz[f * PLACES + i], take->xyz[i], sizeof take->xyz[i]);
    fap_capture *c = encode(take, neutral_stretch);
    const fap_capture_report *r = fap_capture_report_get(c);
    double mean = 0;

    assert_false(r->neutral_found);
    assert_float_equal(r->neutral_s, 14 / 25.0, 1e-6);
    assert_float_equal(r->neutral_length_s, 10 / 25.0, 1e-6);
    for (int f = 10; f < 20; f++)
        mean += fap_capture_frames(c)[f].value[53] / 10.0;
    assert_float_equal(mean, 0, 1);
    assert_true(abs(fap_capture_frames(c)[14].value[53]) > 0);
    fap_capture_close(&c);
    fap_take_close(&take);
}

static void without_corners(fap_capture_config *cfg)
{
    cfg->markers = "8.3,none\n8.4,none\n";
    cfg->markers_size = strlen(cfg->markers);
}

/* A mouth without corners is as wide as the bank's, by how much larger the rest of the face is than the bank's. */
TEST(capture, fapu_that_cannot_be_measured_have_the_proportions_of_the_bank)
{
    fap_capture_config cfg;
    fap_capture *c;
    fap_bank *bank;
    fap_take *take = make_take(straight);

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    fap_capture_config_init(&cfg);
    cfg.rigid = rigid_names;
    cfg.neutral_frame = 0;
    cfg.bank = bank;
    without_corners(&cfg);
    assert_int_equal(fap_capture_encode(&c, take, &cfg, NULL), FAP_OK);
    const fap_capture_report *r = fap_capture_report_get(c);
    assert_int_equal(r->fapu_origin[4], FAP_ORIGIN_BANK);
    assert_string_equal(fap_origin_name(r->fapu_origin[4]), "bank, scaled");
    assert_float_equal(r->fapu.mw_mm, fap_bank_fapu(bank)->mw_mm * (float)r->fapu_scale, 1e-3);
    assert_int_equal(r->fapu_origin[1], FAP_ORIGIN_MEASURED);
    fap_capture_close(&c);
    c = encode(take, without_corners);
    assert_int_equal(fap_capture_report_get(c)->fapu_origin[4], FAP_ORIGIN_SCALED);
    fap_capture_close(&c);
    fap_bank_close(&bank);
    fap_take_close(&take);
}
