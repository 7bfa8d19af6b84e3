/* SPDX-License-Identifier: BSD-2-Clause */
/* From tracks to a take: everything that was projected is found again, and what cannot be is refused in words. */
#include "tests/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/tracks.h>

#include "track/vector.h"

enum { DOTS = 30, LABELS = DOTS + 2, FRAMES = 25, RULER_A = DOTS, RULER_B = DOTS + 1 };
static const double ruler_mm = 80;

/* What a perfect tracker would tell of a face between two mirrors. */
typedef struct scene {
    char text[LABELS][16];
    const char *name[LABELS];
    uint8_t has[LABELS * FAP_TRACKS_VIEWS];
    fap_track_point point[FRAMES][LABELS * FAP_TRACKS_VIEWS];
    double truth[FRAMES][LABELS][3]; /* camera axes */
    fap_mirror_plane mirror[2];
    fap_tracks tracks;
    fap_tracks_config cfg;
} scene;

static void place_of(int label, int frame, double at[3])
{
    const double turn = 2.4 * label, size = 70 * sqrt((label + 0.5) / DOTS), yaw = 0.15 * sin(0.4 * frame);
    const double x = size * cos(turn), y = 1.3 * size * sin(turn), z = 0.008 * (x * x + 0.3 * y * y) - 20;

    at[0] = x * cos(yaw) + z * sin(yaw) + 10 * sin(0.3 * frame);
    at[1] = y + 5 * cos(0.5 * frame);
    at[2] = 600 + z * cos(yaw) - x * sin(yaw);
    if (label < DOTS)
        return;
    at[0] = label == RULER_A ? -30 : 34;
    at[1] = 120;
    at[2] = label == RULER_A ? 560 : 608; /* 64 by 48: 80 apart */
}

static scene *make_scene(int mirrors)
{
    scene *s = calloc(1, sizeof *s);

    assert_non_null(s);
    s->mirror[0] = (fap_mirror_plane){ { 0.74, 0.05, -0.64 }, -400 };
    s->mirror[1] = (fap_mirror_plane){ { -0.77, 0.05, -0.64 }, -390 };
    fap_tracks_config_init(&s->cfg);
    s->cfg.camera = (fap_camera){ 1280, 960, 900, 900, 640, 480, { 0 } };
    s->cfg.ruler[0] = RULER_A;
    s->cfg.ruler[1] = RULER_B;
    s->cfg.ruler_mm = ruler_mm;
    for (int i = 0; i < 2; i++)
        unit3(s->mirror[i].normal);
    for (int l = 0; l < LABELS; l++) {
        snprintf(s->text[l], sizeof s->text[l], "p%d", l);
        s->name[l] = s->text[l];
        for (int view = 0; view <= mirrors; view++)
            s->has[l * FAP_TRACKS_VIEWS + view] = 1;
    }
    for (int f = 0; f < FRAMES; f++)
        for (int l = 0; l < LABELS; l++) {
            place_of(l, f, s->truth[f][l]);
            for (int view = 0; view <= mirrors; view++) {
                double image[3], pixel[2];
                memcpy(image, s->truth[f][l], sizeof image);
                if (view)
                    fap_mirror_reflect(&s->mirror[view - 1], s->truth[f][l], image);
                assert_true(fap_camera_project(&s->cfg.camera, image, pixel));
                s->point[f][l * FAP_TRACKS_VIEWS + view] =
                    (fap_track_point){ .x_px = pixel[0], .y_px = pixel[1], .state = FAP_TRACK_SEEN };
            }
        }
    s->tracks = (fap_tracks){ .labels = LABELS,
                              .mirrors = mirrors,
                              .frames = FRAMES,
                              .rate_hz = 30,
                              .name = s->name,
                              .has = s->has,
                              .point = s->point[0] };
    return s;
}

/* The worst error of what is placed, head motion between camera and take axes apart. */
static double worst_mm(const scene *s, const fap_take *take)
{
    double worst = 0;

    for (uint32_t f = 0; f < take->frame_count; f++)
        for (uint32_t i = 0; i < take->point_count; i++) {
            const float *at = fap_take_sample(take, f, i);
            const double *t = s->truth[f][i];
            if (at)
                worst = fmax(worst, sqrt(pow((double)at[0] - t[0], 2) + pow((double)at[1] + t[1], 2) +
                                         pow((double)at[2] + t[2], 2)));
        }
    return worst;
}

static uint32_t placed_frames(const fap_take *take, uint32_t point)
{
    uint32_t count = 0;

    for (uint32_t f = 0; f < take->frame_count; f++)
        count += fap_take_sample(take, f, point) != NULL;
    return count;
}

TEST(tracks, places_come_back_with_one_and_two_mirrors)
{
    for (int mirrors = 1; mirrors <= 2; mirrors++) {
        scene *s = make_scene(mirrors);
        char where[FAP_ERROR_TEXT_SIZE];
        fap_tracks_report report = { .label = NULL };
        fap_take *take;
        assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_OK);
        assert_int_equal(take->point_count, DOTS);
        assert_int_equal(take->frame_count, FRAMES);
        assert_string_equal(take->name[3], "p3");
        assert_true(take->unit_known);
        assert_int_equal(placed_frames(take, 7), FRAMES);
        assert_true(worst_mm(s, take) < 0.01);
        assert_int_equal(report.ruler_frames, FRAMES);
        assert_true(report.rms_px < 1e-3);
        for (int i = 0; i < mirrors; i++)
            assert_float_equal(report.mirror[i].distance, s->mirror[i].distance, 0.05);
        fap_take_close(&take);
        free(s);
    }
}

TEST(tracks, without_a_mirror_places_are_flat)
{
    scene *s = make_scene(0);
    char where[FAP_ERROR_TEXT_SIZE];
    fap_tracks_report report = { .label = NULL };
    fap_take *take;

    s->cfg.ruler[0] = s->cfg.ruler[1] = -1;
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_OK);
    assert_int_equal(take->point_count, LABELS);
    assert_false(take->unit_known);
    for (uint32_t i = 0; i < DOTS; i++)
        assert_float_equal(fap_take_sample(take, 4, i)[2], 0, 0);
    /* Right is right and up is up. */
    assert_true(fap_take_sample(take, 0, RULER_B)[0] > fap_take_sample(take, 0, RULER_A)[0]);
    assert_true(fap_take_sample(take, 0, RULER_A)[1] < fap_take_sample(take, 0, 0)[1]);
    fap_take_close(&take);
    free(s);
}

TEST(tracks, what_is_hidden_or_contradicts_itself_is_missing)
{
    scene *s = make_scene(2);
    char where[FAP_ERROR_TEXT_SIZE];
    fap_tracks_label label[LABELS];
    fap_tracks_report report = { .label = label };
    fap_take *take;

    for (int f = 5; f < 15; f++)
        for (int view = 0; view < FAP_TRACKS_VIEWS; view++)
            s->point[f][3 * FAP_TRACKS_VIEWS + view].state = FAP_TRACK_PREDICTED;
    s->point[8][5 * FAP_TRACKS_VIEWS].y_px += 40;
    s->has[6 * FAP_TRACKS_VIEWS + 1] = s->has[6 * FAP_TRACKS_VIEWS + 2] = 0;
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_OK);
    assert_int_equal(placed_frames(take, 3), FRAMES - 10);
    assert_int_equal(label[3].placed, FRAMES - 10);
    assert_int_equal(label[3].seen, FRAMES - 10);
    assert_null(fap_take_sample(take, 8, 5));
    assert_int_equal(placed_frames(take, 5), FRAMES - 1);
    assert_int_equal(placed_frames(take, 6), 0);
    assert_int_equal(label[6].seen, FRAMES);
    assert_true(worst_mm(s, take) < 0.05);
    fap_take_close(&take);
    free(s);
}

/* In every view: what sees it sees it there. */
static void put_where_another_is(scene *s, int frame, int label, int other)
{
    memcpy(&s->point[frame][label * FAP_TRACKS_VIEWS], &s->point[frame][other * FAP_TRACKS_VIEWS],
           FAP_TRACKS_VIEWS * sizeof(fap_track_point));
}

TEST(tracks, a_dot_that_was_mistaken_for_another_is_a_stray)
{
    scene *s = make_scene(2);
    char where[FAP_ERROR_TEXT_SIZE];
    fap_tracks_label label[LABELS];
    fap_tracks_report report = { .label = label };
    fap_take *take;

    for (int f = 10; f < 18; f++)
        put_where_another_is(s, f, 4, 17);
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_OK);
    assert_int_equal(label[4].strays, 8);
    assert_int_equal(placed_frames(take, 4), FRAMES - 8);
    assert_int_equal(label[17].strays, 0);
    assert_true(worst_mm(s, take) < 0.05);
    fap_take_close(&take);
    free(s);
}

TEST(tracks, what_cannot_be_is_refused_in_words)
{
    scene *s = make_scene(2);
    char where[FAP_ERROR_TEXT_SIZE];
    fap_tracks_report report = { .label = NULL };
    fap_take *take;

    s->cfg.ruler[1] = LABELS;
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_E_ARG);
    s->cfg.ruler[1] = RULER_B;
    for (int f = 0; f < FRAMES; f++)
        s->point[f][RULER_B * FAP_TRACKS_VIEWS].state = FAP_TRACK_LOST;
    memset(&s->has[RULER_B * FAP_TRACKS_VIEWS + 1], 0, 2);
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_E_DATA);
    assert_non_null(strstr(where, "ruler"));
    /* Each dot in one mirror only: nothing compares the two. */
    for (int l = 0; l < LABELS; l++)
        s->has[l * FAP_TRACKS_VIEWS + 1 + l % 2] = 0;
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_E_DATA);
    assert_non_null(strstr(where, "both mirrors"));
    for (int l = 0; l < LABELS; l++)
        s->has[l * FAP_TRACKS_VIEWS + 2] = 0;
    assert_int_equal(fap_tracks_place(&take, &s->tracks, &s->cfg, &report, where), FAP_E_DATA);
    assert_non_null(strstr(where, "mirror 2"));
    assert_null(take);
    free(s);
}
