/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAPs to ARKit's coefficients: least squares within 0 and 1, exactly. Going through the coefficients one by one needs
 * no memory, but some make nearly the same face (a press is a smile without its cheek), and after a thousand rounds
 * single ones were still 0.8 off. See fap/arkit.h.
 */
#include <math.h>
#include <string.h>

#include <fap/tables.h>

#include "bank/arkit_fit.h"
#include "base/mem.h"
#include "gen/proportions.h"
#include "param/arkit.h"

enum { MOST_TRIES = 4 };

/* Square millimetres that a coefficient of 1 must earn: of two ways to the same face, the one with less in it. */
static const double price_mm2 = 0.1;

/* --- life --- */

/* Of a typical face: shares matter here, not lengths. */
static float step_mm(int unit)
{
#define ROW(of, fg, fi, tg, ti, axis, mm)                                                                    \
    if (unit == FAP_UNIT_##of && unit != FAP_UNIT_NONE)                                                      \
        return mm / 1024.0f;
#define POINT(group, index) group, index
#define X(...)              ROW(__VA_ARGS__)
    PROPORTIONS_ROWS(X)
#undef X
#undef POINT
#undef ROW
    return 0;
}

/* A mouth or an eye that does not quite close is seen at once. */
static double importance(const fap_info *info)
{
    return info->group == 2 || info->group == 3 || info->group == 8 ? 2 : 1;
}

static void read_tables(fap_arkit_fit *f)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        const double mm = step_mm(info->unit);
        f->price[fap] = importance(info) * mm * mm;
        for (int s = 0; s < FAP_ARKIT_COUNT; s++)
            f->value[s][fap] = (float)fap_arkit_value(s, fap);
    }
    arkit_fit_name(f);
}

fap_err fap_arkit_fit_open(fap_arkit_fit **fit, const fap_allocator *alloc)
{
    const fap_allocator own = fap_mem_allocator(alloc);
    fap_arkit_fit *f = fap_mem_calloc(&own, 1, sizeof *f);

    *fit = NULL;
    if (!f)
        return FAP_E_NOMEM;
    f->alloc = own;
    if (fap_qp_open(&f->qp, FAP_ARKIT_COUNT, &own)) {
        fap_arkit_fit_close(&f);
        return FAP_E_NOMEM;
    }
    read_tables(f);
    *fit = f;
    return FAP_OK;
}

void fap_arkit_fit_close(fap_arkit_fit **fit)
{
    fap_arkit_fit *f = fit ? *fit : NULL;

    if (!f)
        return;
    const fap_allocator alloc = f->alloc;
    fap_qp_close(&f->qp, &alloc);
    fap_mem_free(&alloc, f);
    *fit = NULL;
}

/* --- angles --- */

static float angle_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : (float)frame->value[fap] / FAP_AU_PER_RAD;
}

static void take_angles(const fap_frame *frame, fap_arkit *out)
{
    out->has_head = out->has_eyes = 1;
    out->angle[FAP_ARKIT_HEAD_PITCH] = -angle_of(frame, 48);
    out->angle[FAP_ARKIT_HEAD_YAW] = angle_of(frame, 49);
    out->angle[FAP_ARKIT_HEAD_ROLL] = angle_of(frame, 50);
    out->angle[FAP_ARKIT_LEFT_EYE_YAW] = -angle_of(frame, 23);
    out->angle[FAP_ARKIT_RIGHT_EYE_YAW] = -angle_of(frame, 24);
    out->angle[FAP_ARKIT_LEFT_EYE_PITCH] = angle_of(frame, 25);
    out->angle[FAP_ARKIT_RIGHT_EYE_PITCH] = angle_of(frame, 26);
}

static float share(float x)
{
    return fminf(1, fmaxf(0, x));
}

/* Eyes are known, and lids go with them. */
static void take_gaze(const fap_arkit *in, float *shape)
{
    const float *a = in->angle;
    const float left[2] = { -a[FAP_ARKIT_LEFT_EYE_YAW] / fap_arkit_full_yaw_rad,
                            -a[FAP_ARKIT_RIGHT_EYE_YAW] / fap_arkit_full_yaw_rad };
    const float down[2] = { a[FAP_ARKIT_LEFT_EYE_PITCH] / fap_arkit_full_pitch_rad,
                            a[FAP_ARKIT_RIGHT_EYE_PITCH] / fap_arkit_full_pitch_rad };

    shape[SHAPE_EyeLookOutLeft] = share(left[0]);
    shape[SHAPE_EyeLookInLeft] = share(-left[0]);
    shape[SHAPE_EyeLookInRight] = share(left[1]);
    shape[SHAPE_EyeLookOutRight] = share(-left[1]);
    shape[SHAPE_EyeLookDownLeft] = share(down[0]);
    shape[SHAPE_EyeLookUpLeft] = share(-down[0]);
    shape[SHAPE_EyeLookDownRight] = share(down[1]);
    shape[SHAPE_EyeLookUpRight] = share(-down[1]);
}

static int is_gaze(int shape)
{
    return (shape >= SHAPE_EyeLookDownLeft && shape <= SHAPE_EyeLookUpLeft) ||
           (shape >= SHAPE_EyeLookDownRight && shape <= SHAPE_EyeLookUpRight);
}

/* --- coefficients --- */

static double inner_product(const fap_arkit_fit *f, int s, int t)
{
    double sum = s == t ? price_mm2 : 0;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->asked[fap])
            sum += f->price[fap] * f->value[s][fap] * f->value[t][fap];
    return sum;
}

/* Inner products stay as they are while the stream asks for the same FAPs. */
static void prepare(fap_arkit_fit *f, const fap_frame *frame)
{
    uint8_t asked[FAP_COUNT + 1] = { 0 };

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        asked[fap] = frame->state[fap] != FAP_ABSENT;
    if (f->has_gram && !memcmp(asked, f->asked, sizeof asked))
        return;
    memcpy(f->asked, asked, sizeof asked);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        for (int t = 0; t < FAP_ARKIT_COUNT; t++)
            f->gram[s][t] = inner_product(f, s, t);
    f->has_gram = 1;
}

static void pose_problem(fap_arkit_fit *f, const fap_frame *frame, const float *gaze)
{
    fap_qp_clear(&f->qp, FAP_ARKIT_COUNT);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++) {
        memcpy(f->qp.gram + (size_t)s * (size_t)f->qp.capacity, f->gram[s], sizeof f->gram[s]);
        for (int fap = 3; fap <= FAP_COUNT; fap++)
            if (f->asked[fap])
                f->qp.linear[s] += f->price[fap] * f->value[s][fap] * frame->value[fap];
        f->qp.lo[s] = is_gaze(s) ? (double)gaze[s] : 0;
        f->qp.hi[s] = is_gaze(s) ? (double)gaze[s] : 1;
    }
}

/* MouthClose means nothing beyond JawOpen: a bound that is not known in front. */
static void solve(fap_qp *qp)
{
    for (int i = 0; i < MOST_TRIES; i++) {
        fap_qp_solve(qp);
        if (qp->x[SHAPE_MouthClose] <= qp->x[SHAPE_JawOpen])
            return;
        qp->hi[SHAPE_MouthClose] = fmax(0, qp->x[SHAPE_JawOpen]);
    }
    fap_qp_solve(qp);
    qp->x[SHAPE_MouthClose] = fmin(qp->x[SHAPE_MouthClose], qp->x[SHAPE_JawOpen]);
}

void fap_arkit_from_faps(fap_arkit_fit *fit, const fap_frame *frame, fap_arkit *out)
{
    memset(out, 0, sizeof *out);
    take_angles(frame, out);
    take_gaze(out, out->shape);
    prepare(fit, frame);
    pose_problem(fit, frame, out->shape);
    solve(&fit->qp);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        out->shape[s] = share((float)fit->qp.x[s]);
}
