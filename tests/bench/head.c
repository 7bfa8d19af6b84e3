/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What is left of the head's motion when it is taken out: how far rigid markers still move, in real takes, and in one that
 * is made up, where noise is added, a marker of the cap slips, the face talks, and the truth is known.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/derive.h>
#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"

static const struct source {
    const char *path;
    double rate_hz; /* where the file says none */
    int optical; /* markers: they count for the figure; landmarks of a video are guessed anew in each picture */
} sources[] = {
    { "../shared/data/takes/optical_animface/jaw_60hz.c3d", 0, 1 },
    { "../shared/data/takes/optical_animface/eyebrows_60hz_nexus.csv", 0, 1 },
    { "../shared/data/takes/optical_blenderface/Subject_01.csv", 25, 1 },
    { "../shared/data/takes/openface/openfacer_lara_0001-0600.csv", 0, 0 },
    { "../shared/data/takes/mediapipe/wolfgang_facemesh478_24fps.csv", 0, 0 },
};

typedef struct squares {
    double sum;
    uint32_t count;
} squares;

static double rms_of(const squares *s)
{
    return s->count ? sqrt(s->sum / s->count) : -1;
}

static void add_squares(squares *s, const squares *other)
{
    s->sum += other->sum;
    s->count += other->count;
}

/* --- a take that is made up --- */

enum { CAP = 6, FACE = 24, POINTS = CAP + FACE, FRAMES = 600 };

static const char *const face_names[FACE] = { "2.1", "2.10", "8.1", "8.2", "8.3", "8.4", "8.5", "8.6",
                                              "8.7", "8.8",  "4.1", "4.2", "4.3", "4.4", "4.5", "4.6",
                                              "5.1", "5.2",  "5.3", "5.4", "9.1", "9.2", "9.3", "9.12" };
static const float face_places[FACE][3] = {
    { 0, -60, 80 },  { 0, -50, 88 },   { 0, -14, 97 },  { 0, -28, 96 },   { 25, -20, 83 }, { -25, -20, 83 },
    { 12, -15, 93 }, { -12, -15, 93 }, { 12, -27, 92 }, { -12, -27, 92 }, { 12, 60, 88 },  { -12, 60, 88 },
    { 32, 66, 84 },  { -32, 66, 84 },  { 52, 60, 66 },  { -52, 60, 66 },  { 45, -5, 70 },  { -45, -5, 70 },
    { 48, 12, 72 },  { -48, 12, 72 },  { 15, 3, 88 },   { -15, 3, 88 },   { 0, 8, 105 },   { 0, 40, 92 }
};
static const float cap_places[CAP][3] = { { 70, 110, 20 }, { -70, 110, 20 }, { 0, 130, 60 },
                                          { 0, 100, -60 }, { 75, 60, 0 },    { -75, 60, 0 } };

typedef struct truth {
    float moved[FRAMES][POINTS][3]; /* without the head, the noise and the slip */
} truth;

static double noise(uint32_t *seed)
{
    double sum = 0;

    for (int i = 0; i < 12; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        sum += (*seed >> 8) / 16777216.0;
    }
    return sum - 6;
}

/* The lower a point, the more it takes part in speech; brows and cheeks move by themselves. */
static void talk(uint32_t frame, uint32_t point, float out[3])
{
    const float *place = face_places[point];
    const float share = place[1] < -10 ? -place[1] / 60 : 0.1f, t = (float)frame;

    out[0] = share * 4 * (place[0] > 0 ? 1.0f : -1.0f) * (1 - cosf(0.31f * t));
    out[1] = -share * 9 * (1 - cosf(0.43f * t)) + (place[1] > 50 ? 3 * (1 - cosf(0.05f * t)) : 0);
    out[2] = share * 3 * (1 - cosf(0.23f * t));
}

static void place_point(fap_take *take, uint32_t f, uint32_t i, const float rest[3], const float moved[3],
                        const float turn[3][3], uint32_t *seed)
{
    static const double noise_mm = 0.1;
    float out[3];

    for (int a = 0; a < 3; a++) {
        out[a] = 100 * (float)(a + 1) * (1 - cosf(0.02f * (float)f)) + (float)(noise_mm * noise(seed));
        for (int b = 0; b < 3; b++)
            out[a] += turn[a][b] * (rest[b] + moved[b]);
    }
    fap_take_set(take, f, i, out);
}

static void make_frame(fap_take *take, truth *t, uint32_t f, uint32_t *seed)
{
    const double swing = 1 - cos(0.07 * f);
    float turn[3][3];

    fap_head_rotation((int32_t)(15000 * swing), (int32_t)(-20000 * swing), (int32_t)(8000 * swing), turn);
    for (uint32_t i = 0; i < FACE; i++) {
        talk(f, i, t->moved[f][CAP + i]);
        place_point(take, f, CAP + i, face_places[i], t->moved[f][CAP + i], (const float(*)[3])turn, seed);
    }
    for (uint32_t i = 0; i < CAP; i++) {
        const float slip = i == 0 && f > FRAMES / 2 ? 6 : 0;
        const float rest[3] = { cap_places[i][0] + slip, cap_places[i][1] - slip, cap_places[i][2] };
        place_point(take, f, i, rest, t->moved[f][i], (const float(*)[3])turn, seed);
    }
}

static fap_take *make_take(truth *t)
{
    fap_take *take;
    uint32_t seed = 1;

    if (fap_take_create(&take, POINTS, FRAMES, NULL) != FAP_OK)
        return NULL;
    take->rate_hz = 60;
    for (uint32_t i = 0; i < POINTS; i++)
        snprintf(take->name[i], FAP_TAKE_NAME_SIZE, "%s%u", i < CAP ? "Cap" : "", i < CAP ? (unsigned)i : 0);
    for (uint32_t i = 0; i < FACE; i++)
        snprintf(take->name[CAP + i], FAP_TAKE_NAME_SIZE, "%s", face_names[i]);
    for (uint32_t f = 0; f < FRAMES; f++)
        make_frame(take, t, f, &seed);
    return take;
}

/* --- what is left --- */

/* How far a marker is from its mean, over the frames that show it; less what it should move. */
static squares residual(const fap_capture *c, uint32_t point, const truth *t)
{
    const uint32_t frames = fap_capture_report_get(c)->frames;
    double sum[3] = { 0 }, square = 0;
    uint32_t n = 0;

    for (uint32_t f = 0; f < frames; f++) {
        float v[3];
        if (!fap_capture_marker_moved(c, f, point, v))
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const double d = (double)(v[axis] - (t && f < FRAMES ? t->moved[f][point][axis] : 0));
            sum[axis] += d;
            square += d * d;
        }
        n++;
    }
    for (int axis = 0; axis < 3 && n; axis++)
        square -= sum[axis] * sum[axis] / n;
    return (squares){ fmax(square, 0), n };
}

static squares rigid_residual(const fap_capture *c)
{
    const fap_capture_report *r = fap_capture_report_get(c);
    squares all = { 0, 0 };

    for (uint32_t i = 0; i < r->rigid_count; i++) {
        const squares one = residual(c, (uint32_t)r->rigid[i], NULL);
        add_squares(&all, &one);
    }
    return all;
}

static squares truth_residual(const fap_capture *c, const truth *t)
{
    squares all = { 0, 0 };

    for (uint32_t i = CAP; i < POINTS; i++) {
        const squares one = residual(c, i, t);
        add_squares(&all, &one);
    }
    return all;
}

static void measure_made_up(fap_head head, const char *name)
{
    fap_capture_config cfg;
    fap_capture *c = NULL;
    truth *t = calloc(1, sizeof *t);
    fap_take *take = t ? make_take(t) : NULL;

    fap_capture_config_init(&cfg);
    cfg.head = head;
    cfg.axes = "xyz";
    cfg.rate_hz = 60;
    cfg.smooth_hz = -1;
    cfg.neutral_frame = 0;
    if (take && fap_capture_encode(&c, take, &cfg, NULL) == FAP_OK) {
        const squares left = truth_residual(c, t);
        bench_note(name, rms_of(&left), "mm");
    }
    fap_capture_close(&c);
    fap_take_close(&take);
    free(t);
}

static int measure_take(const struct source *s, fap_head head, squares *out)
{
    fap_capture_config cfg;
    fap_capture *c = NULL;
    fap_take *take = NULL;
    uint8_t *data = NULL;
    size_t size = 0;

    fap_capture_config_init(&cfg);
    cfg.head = head;
    int ok = file_read(s->path, 1 << 26, &data, &size) == FAP_OK &&
             fap_take_read(&take, data, size, NULL, NULL) == FAP_OK;
    if (ok && !(take->rate_hz > 0))
        take->rate_hz = s->rate_hz;
    ok = ok && fap_capture_encode(&c, take, &cfg, NULL) == FAP_OK;
    if (ok)
        *out = rigid_residual(c);
    fap_capture_close(&c);
    fap_take_close(&take);
    free(data);
    return ok;
}

static void note_take(const struct source *s, const char *what, const squares *left)
{
    char name[96];

    snprintf(name, sizeof name, "%.60s%s", strrchr(s->path, '/') + 1, what);
    bench_note(name, rms_of(left), "mm");
}

double bench_head_residual_mm(void)
{
    squares all = { 0, 0 }, left;

    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        if (measure_take(&sources[i], FAP_HEAD_RIGID, &left) && left.count) {
            note_take(&sources[i], "", &left);
            if (sources[i].optical)
                add_squares(&all, &left);
        }
        if (sources[i].optical && measure_take(&sources[i], FAP_HEAD_NOSE, &left) && left.count)
            note_take(&sources[i], ", carried by the nose", &left);
    }
    measure_made_up(FAP_HEAD_RIGID, "made up, the face's markers against the truth");
    measure_made_up(FAP_HEAD_NOSE, "made up, carried by the nose, against the truth");
    return rms_of(&all);
}
