/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/studio/speech.h>

enum { PP = 1, SS = 7, AA = 10, OU = 14, OPEN_JAW = 3, LOWER_T = 4, RAISE_B = 5 };

static fap_mouth *speak(const char *lines, fap_mouth_way way)
{
    fap_mouth_config cfg;
    fap_speech *s;
    fap_mouth *m;

    assert_int_equal(fap_speech_read(&s, lines, strlen(lines), NULL, NULL), FAP_OK);
    fap_mouth_config_init(&cfg);
    cfg.way = way;
    assert_int_equal(fap_mouth_open(&m, s, &cfg), FAP_OK);
    fap_speech_close(&s);
    return m;
}

static double share_of(const fap_mouth *m, fap_articulator part, double t, int viseme)
{
    double share[FAP_VISEME_COUNT + 1];

    fap_mouth_shares(m, part, t, share);
    return share[viseme];
}

/* How much the face's lips are apart in the middle, millimetres. */
static double gap_mm(const fap_mouth *m, double t)
{
    fap_bank *bank;
    fap_face *face;
    float points[FAP_POINT_COUNT][3];
    fap_frame frame = { .number = 0 };

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_face_open(&face, bank, NULL), FAP_OK);
    float *position = aligned_alloc(32, 3 * fap_face_stride(face) * sizeof *position);
    assert_non_null(position);
    fap_mouth_at(m, t, &frame);
    fap_face_pose(face, &frame, position, NULL);
    fap_face_points(face, points);
    free(position);
    fap_face_close(&face);
    fap_bank_close(&bank);
    return points[fap_point_by_name("2.2")][1] - points[fap_point_by_name("2.3")][1];
}

static const char ama[] = "0.5 0.7 a\n0.7 0.78 m\n0.78 1.0 a\n";

TEST(mouth, bilabials_close_the_lips_at_their_time_and_vowels_open_them)
{
    for (int way = FAP_MOUTH_VISEMES; way <= FAP_MOUTH_LIPS; way++) {
        fap_mouth *m = speak(ama, (fap_mouth_way)way);
        assert_true(gap_mm(m, 0.74) < 0.6);
        assert_true(gap_mm(m, 0.6) > 4);
        assert_true(gap_mm(m, 0.9) > 4);
        fap_mouth_close(&m);
        assert_null(m);
    }
}

TEST(mouth, a_short_bilabial_is_closed_in_some_frame_of_25_a_second_wherever_it_falls)
{
    for (double shift = 0; shift < 0.04; shift += 0.005) {
        fap_mouth *m = speak(ama, FAP_MOUTH_VISEMES);
        fap_frame f = { .number = 0 };
        int closed = 0;
        for (int i = 0; i < 40; i++) {
            fap_mouth_at(m, i * 0.04 + shift, &f);
            closed |= f.viseme.select1 == PP && f.viseme.blend >= 57;
        }
        assert_true(closed);
        fap_mouth_close(&m);
    }
}

TEST(mouth, silence_returns_to_rest)
{
    fap_frame f = { .number = 7, .pts_us = 9 };

    for (int way = FAP_MOUTH_VISEMES; way <= FAP_MOUTH_LIPS; way++) {
        fap_mouth *m = speak(ama, (fap_mouth_way)way);
        static const double still[] = { -100, 0, 0.2, 1.4, 50, 1e9 };
        for (size_t i = 0; i < sizeof still / sizeof *still; i++) {
            fap_mouth_at(m, still[i], &f);
            assert_int_equal(f.number, 7);
            assert_int_equal(f.pts_us, 9);
            assert_true(way == FAP_MOUTH_VISEMES ? !f.viseme.select1 && f.viseme.blend >= 61
                                                 : abs(f.value[OPEN_JAW]) < 30);
        }
        assert_int_equal(fap_mouth_report_get(m)->silences, 2);
        fap_mouth_close(&m);
    }
}

TEST(mouth, lips_move_before_the_sound_and_round_earlier_than_they_open)
{
    fap_mouth *open = speak("0.5 0.8 a\n", FAP_MOUTH_LIPS), *round = speak("0.5 0.8 u\n", FAP_MOUTH_LIPS);

    assert_true(share_of(open, FAP_LIPS, 0.46, AA) > 0.3);
    assert_true(share_of(round, FAP_LIPS, 0.45, OU) > share_of(open, FAP_LIPS, 0.45, AA) + 0.1);
    assert_true(share_of(round, FAP_LIPS, 0.35, OU) > 0.15);
    fap_mouth_close(&open);
    fap_mouth_close(&round);
}

TEST(mouth, a_consonant_takes_its_lips_from_the_vowel_beside_it)
{
    fap_mouth *tu = speak("0.5 0.6 t\n0.6 0.8 u\n", FAP_MOUTH_LIPS),
              *ta = speak("0.5 0.6 t\n0.6 0.8 a\n", FAP_MOUTH_LIPS);
    fap_frame u = { .number = 0 }, a = u;

    fap_mouth_at(tu, 0.55, &u);
    fap_mouth_at(ta, 0.55, &a);
    assert_true(share_of(tu, FAP_LIPS, 0.55, OU) > share_of(tu, FAP_LIPS, 0.55, 4));
    assert_true(share_of(tu, FAP_TONGUE, 0.55, 4) > 0.7);
    assert_true(u.value[53] < a.value[53] - 20); /* corners come together */
    fap_mouth_close(&tu);
    fap_mouth_close(&ta);
}

TEST(mouth, the_jaw_shuts_for_s_while_the_lips_do_not_care)
{
    fap_mouth *m = speak("0.5 0.7 a\n0.7 0.8 s\n0.8 1 a\n", FAP_MOUTH_LIPS);

    assert_true(share_of(m, FAP_JAW, 0.75, SS) > share_of(m, FAP_LIPS, 0.75, SS) + 0.2);
    fap_mouth_close(&m);
}

TEST(mouth, shares_sum_to_one_and_go_smoothly)
{
    fap_mouth *m = speak("0.5 0.55 p\n0.55 0.6 t\n0.6 0.72 aɪ\n0.72 0.74 h\n0.74 0.8 m\n0.83 0.9 u\n",
                         FAP_MOUTH_VISEMES);
    double last[FAP_VISEME_COUNT + 1] = { 1 }, all[FAP_VISEME_COUNT + 1],
                                   before[FAP_VISEME_COUNT + 1] = { 1 };

    for (double t = 0; t < 1.5; t += 0.0001) {
        double sum = 0;
        fap_frame f = { .number = 0 };
        fap_mouth_shares(m, FAP_LIPS, t, all);
        for (int v = 0; v <= FAP_VISEME_COUNT; v++) {
            sum += all[v];
            assert_true(fabs(all[v] - last[v]) < 0.06);
            last[v] = all[v];
        }
        assert_float_equal(sum, 1, 1e-9);
        memset(all, 0, sizeof all);
        fap_mouth_at(m, t, &f);
        all[f.viseme.select1] += f.viseme.blend / 63.0;
        all[f.viseme.select2] += 1 - f.viseme.blend / 63.0;
        for (int v = 0; v <= FAP_VISEME_COUNT; v++) {
            assert_true(fabs(all[v] - before[v]) < 0.15);
            before[v] = all[v];
        }
    }
    fap_mouth_close(&m);
}

TEST(mouth, a_long_vowel_does_not_sag)
{
    fap_mouth *m = speak("0.5 2 a\n", FAP_MOUTH_LIPS);

    for (double t = 0.6; t < 1.9; t += 0.05)
        assert_true(share_of(m, FAP_LIPS, t, AA) > 0.8);
    fap_mouth_close(&m);
}

TEST(mouth, names_without_a_viseme_are_reported_once_and_change_nothing)
{
    fap_mouth *m = speak("0.5 0.7 a\n0.7 0.72 qqq\n0.72 0.73 qqq\n0.73 0.9 a\n", FAP_MOUTH_LIPS);
    const fap_mouth_report *r = fap_mouth_report_get(m);

    assert_int_equal(r->unknown, 2);
    assert_int_equal(r->unknown_names, 1);
    assert_string_equal(r->unknown_name[0], "qqq");
    assert_true(share_of(m, FAP_LIPS, 0.715, AA) > 0.9);
    fap_mouth_close(&m);
}

TEST(mouth, a_diphthong_goes_from_one_viseme_to_another)
{
    fap_mouth *m = speak("0.5 0.9 aʊ\n", FAP_MOUTH_LIPS);

    assert_true(share_of(m, FAP_LIPS, 0.58, AA) > 0.6);
    assert_true(share_of(m, FAP_LIPS, 0.85, OU) > 0.6);
    fap_mouth_close(&m);
}
