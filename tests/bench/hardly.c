/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Markers that are hidden for nearly the whole take, one at a time: how far the FAPs of their feature points are from those
 * of the whole take. Nothing of the take teaches how such a marker moves; the databank's motion space does.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"
#include "takes.h"

static const char *const takes[] = { "../shared/data/takes/optical_animface/jaw_60hz.c3d",
                                     "../shared/data/takes/optical_animface/eyebrows_60hz_int16.c3d" };
static const double shown_s = 0.5; /* at either end */

typedef struct sums {
    double off, still; /* of the fills; of a face that stays at rest instead */
    uint32_t count;
} sums;

/* A take as it is, and a copy with a marker hidden. */
typedef struct trial {
    fap_take *take;
    fap_capture *whole;
    const fap_capture_report *report;
    fap_bank *bank;
    int64_t neutral_frame;
} trial;

static fap_capture *encode(const trial *t)
{
    fap_capture_config cfg;
    fap_capture *c;

    fap_capture_config_init(&cfg);
    cfg.bank = t->bank;
    cfg.neutral_frame = t->neutral_frame;
    return fap_capture_encode(&c, t->take, &cfg, NULL) == FAP_OK ? c : NULL;
}

/* In frames of FAPs. */
static void compare(const trial *t, const fap_capture *got, int point, sums *s)
{
    const uint32_t shown = (uint32_t)ceil(shown_s * t->report->rate_hz);

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (t->report->fap[fap].point != point || info->motion > FAP_MOTION_Z)
            continue;
        const double mm = (double)fap_fapu_step(&t->report->fapu, (fap_unit)info->unit);
        for (uint32_t f = shown; f + shown < t->report->frames; f++) {
            const int32_t want = fap_capture_frames(t->whole)[f].value[fap];
            s->off += mm * abs(fap_capture_frames(got)[f].value[fap] - want);
            s->still += mm * abs(want);
            s->count++;
        }
    }
}

static void hide_one(trial *t, int point, sums *s)
{
    const uint32_t marker = (uint32_t)t->report->markers.point[point].index[0], n = t->take->point_count;
    const uint32_t first = (uint32_t)(shown_s * t->take->rate_hz), last = t->take->frame_count - first;

    for (uint32_t f = first; f < last; f++)
        t->take->valid[(size_t)f * n + marker] = FAP_SAMPLE_MISSING;
    fap_capture *got = encode(t);
    if (got)
        compare(t, got, point, s);
    fap_capture_close(&got);
    for (uint32_t f = first; f < last; f++)
        t->take->valid[(size_t)f * n + marker] = FAP_SAMPLE_MEASURED;
}

static int is_rigid(const trial *t, int marker)
{
    for (uint32_t i = 0; i < t->report->rigid_count; i++)
        if (t->report->rigid[i] == marker)
            return 1;
    return 0;
}

static int open_trial(trial *t, const char *path)
{
    uint8_t *data = NULL;
    size_t size = 0;

    *t = (trial){ .neutral_frame = -1, .bank = bench_bank() };
    const int ok = file_read(path, 1 << 26, &data, &size) == FAP_OK &&
                   fap_take_read(&t->take, data, size, NULL, NULL) == FAP_OK && (t->whole = encode(t));
    free(data);
    if (!ok)
        return 0;
    t->report = fap_capture_report_get(t->whole);
    t->neutral_frame = (int64_t)(t->report->neutral_s * t->take->rate_hz);
    return 1;
}

static void close_trial(trial *t)
{
    fap_capture_close(&t->whole);
    fap_take_close(&t->take);
    fap_bank_close(&t->bank);
}

static void measure_take(const char *path, sums *s)
{
    trial t;

    if (open_trial(&t, path))
        for (int i = 0; i < FAP_POINT_COUNT; i++)
            if (t.report->markers.point[i].count == 1 && !is_rigid(&t, t.report->markers.point[i].index[0]))
                hide_one(&t, i, s);
    close_trial(&t);
}

double bench_gap_fill_error_mm_hardly(void)
{
    sums s = { 0, 0, 0 };

    for (size_t i = 0; i < sizeof takes / sizeof *takes; i++)
        measure_take(takes[i], &s);
    if (!s.count)
        return -1;
    bench_note("held at rest", s.still / s.count, "mm");
    return s.off / s.count;
}
