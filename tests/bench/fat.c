/* SPDX-License-Identifier: BSD-2-Clause */
/* Face animation tables: how near they are to the solver, and how fast. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>
#include <fap/fat.h>

#include "bench.h"
#include "takes.h"

enum { MIXTURES = 100, FRAMES = 200 };

typedef struct rig {
    fap_bank *bank;
    fap_fat *fat;
    fap_face *face;
    float *solved, (*posed)[3];
    float *weight; /* of keys */
} rig;

static void close_rig(rig *r)
{
    fap_face_close(&r->face);
    fap_fat_close(&r->fat);
    fap_bank_close(&r->bank);
    free(r->solved);
    free(r->posed);
    free(r->weight);
}

/* @bank becomes the rig's. */
static int open_rig(rig *r, fap_bank *bank)
{
    fap_face_config cfg;

    fap_face_config_init(&cfg);
    cfg.blend = FAP_BLEND_QP;
    *r = (rig){ .bank = bank };
    if (r->bank && fap_face_open(&r->face, r->bank, &cfg) == FAP_OK &&
        fap_fat_bake(&r->fat, r->bank, NULL) == FAP_OK) {
        r->solved = aligned_alloc(32, 3 * fap_face_stride(r->face) * sizeof(float));
        r->posed = calloc(fap_fat_vertex_count(r->fat), sizeof *r->posed);
        r->weight = calloc((size_t)fap_bank_key_count(r->bank), sizeof *r->weight);
    }
    if (r->solved && r->posed && r->weight)
        return 1;
    close_rig(r);
    return 0;
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* --- mixtures, and what is sent of them --- */

typedef struct mixture {
    const char *name;
    int parts;
    int shapes;       /* visemes and expressions instead of units */
    const char *sent; /* the FAPs that are, " 3 4 "; NULL: all of them */
} mixture;

static const mixture mixtures[] = {
    { "four units", 4, 0, NULL },
    { "one unit", 1, 0, NULL },
    { "four visemes or expressions", 4, 1, NULL },
    { "four units, 15 FAPs sent", 4, 0, " 3 4 5 6 7 19 20 21 22 31 32 33 34 35 36 " },
    { "four units, the jaw alone sent", 4, 0, " 3 " },
};

static int is_part(const fap_key *key, int shapes)
{
    if (shapes)
        return key->kind == FAP_KEY_VISEME || key->kind == FAP_KEY_EXPRESSION;
    return key->kind == FAP_KEY_UNIT && strncmp(key->name, "eyeLook", 7) != 0;
}

/* Each part at up to half its strength; lips close over a jaw that is open. */
static void mix(rig *r, const mixture *m, uint32_t *seed)
{
    const int count = fap_bank_key_count(r->bank);
    const int jaw = fap_bank_key_find(r->bank, FAP_KEY_UNIT, "jawOpen");
    const int close = fap_bank_key_find(r->bank, FAP_KEY_UNIT, "mouthClose");

    memset(r->weight, 0, (size_t)count * sizeof *r->weight);
    for (int parts = 0; parts < m->parts;) {
        const uint32_t k = next(seed) % (uint32_t)count;
        if (!is_part(fap_bank_key_get(r->bank, (int)k), m->shapes))
            continue;
        r->weight[k] += 0.0005f * (float)(next(seed) % 1000);
        parts++;
    }
    if (jaw >= 0 && close >= 0)
        r->weight[jaw] += r->weight[close];
}

static int is_sent(const mixture *m, int fap)
{
    char word[8];

    snprintf(word, sizeof word, " %d ", fap);
    return !m->sent || strstr(m->sent, word);
}

static fap_frame as_faps(const rig *r, const mixture *m)
{
    fap_frame f = { 0 };

    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        float mm = 0;
        if (info->motion < FAP_MOTION_X || info->motion > FAP_MOTION_Z || !is_sent(m, fap))
            continue;
        for (int k = 0; k < fap_bank_key_count(r->bank); k++)
            mm += r->weight[k] *
                  fap_bank_key_get(r->bank, k)->point_mm[info->point][info->motion - FAP_MOTION_X];
        f.state[fap] = FAP_CODED;
        f.value[fap] = (int32_t)lrintf((float)info->sign * mm /
                                       fap_fapu_step(fap_bank_fapu(r->bank), (fap_unit)info->unit));
    }
    return f;
}

typedef struct distances {
    double sum, most;
    long count;
} distances;

/* Over the vertices that either of the two moves. */
static void compare(const rig *r, distances *d)
{
    const float(*neutral)[3] = fap_fat_neutral(r->fat);
    const size_t stride = fap_face_stride(r->face);

    for (uint32_t v = 0; v < fap_fat_vertex_count(r->fat); v++) {
        double off = 0, way = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const double at = (double)r->solved[axis * stride + v];
            off += pow((double)r->posed[v][axis] - at, 2);
            way += pow(at - (double)neutral[v][axis], 2);
        }
        if (off < 0.0025 && way < 0.0025)
            continue;
        d->sum += sqrt(off);
        d->most = fmax(d->most, sqrt(off));
        d->count++;
    }
}

/* Mean distance, noted with the largest. */
static double measure(rig *r, const mixture *m, const char *who)
{
    distances d = { 0 };
    uint32_t seed = 1;
    char name[64];

    for (int i = 0; i < MIXTURES; i++) {
        mix(r, m, &seed);
        const fap_frame f = as_faps(r, m);
        fap_face_pose(r->face, &f, r->solved, NULL);
        fap_fat_pose(r->fat, &f, r->posed);
        compare(r, &d);
    }
    const double mean = d.count ? d.sum / (double)d.count : 0;
    snprintf(name, sizeof name, "%s, %s", who, m->name);
    bench_note(name, mean, "mm");
    snprintf(name, sizeof name, "%s, %s, largest", who, m->name);
    bench_note(name, d.most, "mm");
    return mean;
}

/* Of the first mixture. */
static double measure_all(fap_bank *bank, const char *who)
{
    rig r;
    double first = 0;

    if (!open_rig(&r, bank))
        return -1;
    for (size_t i = 0; i < sizeof mixtures / sizeof *mixtures; i++) {
        const double mean = measure(&r, &mixtures[i], who);
        first = i ? first : mean;
    }
    close_rig(&r);
    return first;
}

double bench_fat_mm(void)
{
    fap_bank *builtin = NULL;

    if (fap_bank_builtin(&builtin, NULL) == FAP_OK)
        measure_all(builtin, "built-in face");
    return measure_all(bench_bank(), "default face");
}

/* Microseconds a frame, all FAPs moving. */
static double time_poses(fap_bank *bank)
{
    rig r;
    fap_frame f;

    if (!open_rig(&r, bank))
        return -1;
    const double start = bench_now_s();
    for (int t = 0; t < FRAMES; t++) {
        bench_wave(&f, t, 1);
        fap_fat_pose(r.fat, &f, r.posed);
    }
    const double seconds = bench_now_s() - start;
    close_rig(&r);
    return 1e6 * seconds / FRAMES;
}

double bench_fat_us(void)
{
    fap_bank *builtin = NULL;

    if (fap_bank_builtin(&builtin, NULL) == FAP_OK)
        bench_note("built-in face", time_poses(builtin), "us");
    return time_poses(bench_bank());
}
