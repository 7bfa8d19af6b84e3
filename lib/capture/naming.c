/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fap/studio/naming.h. In each frame the weights w of visemes and expressions, 0 to 1, whose feature-point vectors come
 * nearest to where the FAPs want the points, in square millimetres; and not far from the weights of the frames beside it:
 *   sum over frames |V w_t - target_t|^2 + steadiness |w_t - w_(t+1)|^2
 * by sweeps over the take, one weight at a time (the energy is convex: every sweep lowers it). Targets and vectors are along
 * the axes that FAPs command. Source: Zhu 2006 section 3.2 for the vectors; the smoothing is our own.
 */
#include <math.h>
#include <string.h>

#include <fap/face.h>
#include <fap/studio/naming.h>

#include "base/mem.h"
#include "speech/two_visemes.h"

enum { MOST = FAP_VISEME_COUNT + FAP_EXPRESSION_COUNT, AXES = FAP_COUNT, SWEEPS = 300 };

/* Weights cost this share of a usual key model's square, in proportion to how far they move the face: then no mix of small names
 * is cheaper than the large one it adds up to, and what is as good without a name has none. */
static const double thrift = 0.05;
/* The last sweeps change nothing that is seen. */
static const double still = 1e-3;
/* Less than this of a name is none: a sixty-third is the least that is sent. */
static const double least_weight = 1.0 / 126;

typedef struct name {
    int number, is_expression;
    double vector[AXES];
} name;

typedef struct naming {
    const fap_naming_config *cfg;
    const fap_bank *bank;
    fap_allocator alloc;
    int axis[AXES], axes; /* those that FAPs command: three times the point, and which of its axes */
    name name[MOST];
    int count;
    double *target;  /* [frames][AXES] */
    uint8_t *wanted; /* [frames][AXES] */
    double *weight;  /* [frames][MOST] */
    size_t frames;
    double steadiness, thrift;
    int settled; /* which names a frame has is known, how much of each is not */
} naming;

void fap_naming_config_init(fap_naming_config *cfg)
{
    *cfg = (fap_naming_config){
        .struct_size = sizeof *cfg, .visemes = 1, .expressions = 1, .rate_hz = 25, .steady_s = 0.04
    };
}

/* --- names --- */

static void add_name(naming *n, fap_key_kind kind, int number)
{
    const int index = fap_bank_key_number(n->bank, kind, number);
    name *m = &n->name[n->count];

    if (index < 0)
        return;
    const fap_key *key = fap_bank_key_get(n->bank, index);
    *m = (name){ .number = number, .is_expression = kind == FAP_KEY_EXPRESSION };
    for (int i = 0; i < n->axes; i++)
        m->vector[i] = (double)key->point_mm[n->axis[i] / 3][n->axis[i] % 3];
    n->count++;
}

/* Inner and outer lips, left and right: no two FAPs command one axis. */
static void list_axes(naming *n)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z && info->point >= 0)
            n->axis[n->axes++] = 3 * info->point + info->motion - FAP_MOTION_X;
    }
}

static void add_names(naming *n)
{
    list_axes(n);
    for (int v = 1; v <= FAP_VISEME_COUNT && n->cfg->visemes; v++)
        add_name(n, FAP_KEY_VISEME, v);
    for (int e = 1; e <= FAP_EXPRESSION_COUNT && n->cfg->expressions; e++)
        add_name(n, FAP_KEY_EXPRESSION, e);
}

/* --- frames --- */

/* Jaw, lips, tongue: what visemes are told by when no expression is asked for. */
static int is_mouth(int fap)
{
    const int group = fap_info_get(fap)->group;
    return group == 2 || group == 6 || group == 8;
}

static void take_frame(naming *n, size_t t, const fap_frame *frame)
{
    fap_frame low = *frame;
    float target[FAP_POINT_COUNT][3];
    uint8_t wanted[FAP_POINT_COUNT][3];

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (fap <= 2 || (!n->cfg->expressions && !is_mouth(fap)))
            low.state[fap] = FAP_ABSENT;
    fap_face_targets(fap_bank_fapu(n->bank), &low, target, wanted);
    for (int i = 0; i < n->axes; i++) {
        n->target[t * AXES + (size_t)i] = (double)target[n->axis[i] / 3][n->axis[i] % 3];
        n->wanted[t * AXES + (size_t)i] = wanted[n->axis[i] / 3][n->axis[i] % 3];
    }
}

static int open_naming(naming *n, const fap_frame *frame, size_t count)
{
    n->frames = count;
    n->target = fap_mem_calloc(&n->alloc, count, AXES * sizeof *n->target);
    n->wanted = fap_mem_calloc(&n->alloc, count, AXES);
    n->weight = fap_mem_calloc(&n->alloc, count, MOST * sizeof *n->weight);
    if (!n->target || !n->wanted || !n->weight)
        return 0;
    for (size_t t = 0; t < count; t++)
        take_frame(n, t, &frame[t]);
    return 1;
}

static void close_naming(naming *n)
{
    fap_mem_free(&n->alloc, n->target);
    fap_mem_free(&n->alloc, n->wanted);
    fap_mem_free(&n->alloc, n->weight);
}

/* --- weights --- */

static double mean_square(const naming *n)
{
    double sum = 0;

    for (int k = 0; k < n->count; k++)
        for (int i = 0; i < n->axes; i++)
            sum += n->name[k].vector[i] * n->name[k].vector[i];
    return sum / n->count;
}

/* What the names leave of a frame's targets. */
static void find_rest(const naming *n, size_t t, double rest[AXES])
{
    const double *w = n->weight + t * MOST;

    for (int i = 0; i < n->axes; i++) {
        rest[i] = n->target[t * AXES + (size_t)i];
        for (int k = 0; k < n->count; k++)
            rest[i] -= w[k] * n->name[k].vector[i];
        rest[i] *= n->wanted[t * AXES + (size_t)i];
    }
}

/* How far the weights beside it pull, and how many there are. */
static double beside(const naming *n, size_t t, int k, int *count)
{
    double sum = 0;

    *count = 0;
    if (t > 0)
        sum += n->weight[(t - 1) * MOST + (size_t)k], ++*count;
    if (t + 1 < n->frames)
        sum += n->weight[(t + 1) * MOST + (size_t)k], ++*count;
    return sum;
}

/* The best weight of one name while all others stay. @return how far it went */
static double improve(naming *n, size_t t, int k, double rest[AXES])
{
    const double *vector = n->name[k].vector;
    const uint8_t *wanted = n->wanted + t * AXES;
    double *w = &n->weight[t * MOST + (size_t)k], square = 0, along = 0;
    int neighbours;

    if (n->settled && *w <= 0)
        return 0;
    for (int i = 0; i < n->axes; i++) {
        square += wanted[i] * vector[i] * vector[i];
        along += rest[i] * vector[i]; /* 0 where nothing is wanted */
    }
    const double pull = n->steadiness * beside(n, t, k, &neighbours), hold = n->steadiness * neighbours;
    if (!(square + hold > 0))
        return 0;
    const double best = (along + square * *w + pull - n->thrift * sqrt(square)) / (square + hold);
    const double next = fmax(0, fmin(1, best)), step = next - *w;
    *w = next;
    for (int i = 0; step != 0 && i < n->axes; i++)
        rest[i] -= wanted[i] * step * vector[i];
    return fabs(step);
}

static double sweep(naming *n, int backwards)
{
    double most = 0;

    for (size_t i = 0; i < n->frames; i++) {
        const size_t t = backwards ? n->frames - 1 - i : i;
        double rest[AXES];
        find_rest(n, t, rest);
        for (int k = 0; k < n->count; k++)
            most = fmax(most, improve(n, t, k, rest));
    }
    return most;
}

/* --- two of each are sent --- */

static void name_viseme(const naming *n, size_t t, fap_frame *frame)
{
    double share[FAP_VISEME_COUNT + 1] = { 0 }, sum = 0;

    for (int k = 0; k < n->count; k++) {
        const double w = n->weight[t * MOST + (size_t)k];
        if (n->name[k].is_expression || w < least_weight)
            continue;
        share[n->name[k].number] = w;
        sum += w;
    }
    share[0] = fmax(0, 1 - sum);
    frame->state[1] = FAP_CODED;
    two_visemes(share, &frame->viseme);
}

static uint8_t intensity(double strength, double third)
{
    return (uint8_t)lround(63 * fmin(1, strength * lead_over(strength, third)));
}

static void name_expression(const naming *n, size_t t, fap_frame *frame)
{
    double share[FAP_EXPRESSION_COUNT + 1] = { 0 };
    int best[3];

    for (int k = 0; k < n->count; k++)
        if (n->name[k].is_expression)
            share[n->name[k].number] = n->weight[t * MOST + (size_t)k];
    strongest_three(share, FAP_EXPRESSION_COUNT + 1, best);
    const uint8_t one = intensity(share[best[0]], share[best[2]]),
                  two = intensity(share[best[1]], share[best[2]]);
    frame->state[2] = FAP_CODED;
    frame->expression = (fap_expression){ .select1 = (uint8_t)(one ? best[0] : 0),
                                          .intensity1 = one,
                                          .select2 = (uint8_t)(two ? best[1] : 0),
                                          .intensity2 = two };
}

static void count_frame(fap_naming_report *r, const fap_naming_config *cfg, const fap_frame *f)
{
    const int viseme = f->viseme.blend >= 32 ? f->viseme.select1 : f->viseme.select2;

    if (cfg->visemes)
        r->viseme_frames[viseme]++;
    if (cfg->expressions)
        r->expression_frames[f->expression.select1]++;
    r->frames += (cfg->visemes && (f->viseme.select1 || f->viseme.select2)) ||
                 (cfg->expressions && f->expression.select1);
}

static double left_over(const naming *n)
{
    double left = 0, all = 0;

    for (size_t t = 0; t < n->frames; t++) {
        double rest[AXES];
        find_rest(n, t, rest);
        for (int i = 0; i < n->axes; i++) {
            left += rest[i] * rest[i];
            all += n->target[t * AXES + (size_t)i] * n->target[t * AXES + (size_t)i];
        }
    }
    return all > 0 ? sqrt(left / all) : 0;
}

/* --- the whole --- */

static void run_sweeps(naming *n)
{
    for (int s = 0; s < SWEEPS && sweep(n, s & 1) > still; s++)
        continue;
}

static void solve(naming *n)
{
    const double frames_apart = n->cfg->steady_s * n->cfg->rate_hz;

    n->thrift = thrift * sqrt(mean_square(n));
    n->steadiness = mean_square(n) * frames_apart * frames_apart / 4;
    run_sweeps(n);
    n->thrift = 0; /* what thrift took from the names that are left is given back */
    n->settled = 1;
    run_sweeps(n);
}

static void give_names(const naming *n, fap_frame *frame, fap_naming_report *report)
{
    *report = (fap_naming_report){ .left = left_over(n) };
    for (size_t t = 0; t < n->frames; t++) {
        if (n->cfg->visemes)
            name_viseme(n, t, &frame[t]);
        if (n->cfg->expressions)
            name_expression(n, t, &frame[t]);
        count_frame(report, n->cfg, &frame[t]);
    }
}

fap_err fap_name_frames(fap_frame *frame, size_t count, const fap_naming_config *cfg,
                        fap_naming_report *report)
{
    fap_naming_config defaults;
    fap_naming_report unread;
    fap_bank *builtin = NULL;

    fap_naming_config_init(&defaults);
    naming n = { .cfg = cfg ? cfg : &defaults };
    n.alloc = fap_mem_allocator(&n.cfg->alloc);
    n.bank = n.cfg->bank;
    fap_err err = n.bank ? FAP_OK : fap_bank_builtin(&builtin, &n.alloc);
    if (err != FAP_OK)
        return err;
    n.bank = n.bank ? n.bank : builtin;
    add_names(&n);
    if (!n.count)
        err = FAP_E_NOT_FOUND;
    else if (!open_naming(&n, frame, count))
        err = FAP_E_NOMEM;
    if (err == FAP_OK) {
        solve(&n);
        give_names(&n, frame, report ? report : &unread);
    }
    close_naming(&n);
    fap_bank_close(&builtin);
    return err;
}
