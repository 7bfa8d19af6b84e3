/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Another frame rate: a Hann-windowed sinc, evaluated where the new frames lie. Past the end of an unbroken
 * run the signal goes on as its own point reflection, so that a run that ends moving keeps its slope.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/clean.h>

/* Half width in zero crossings: the pass band is flat to 0.1 % up to 0.8 of the cut-off. */
static const double lobes = 8;
static const double pi = 3.14159265358979323846;

typedef struct resampler {
    const fap_take *in;
    double cutoff; /* in cycles per frame of the input; 0: linear interpolation */
} resampler;

/* An unbroken run of valid samples of one point: first to last frame. */
typedef struct stretch {
    int64_t first, last;
} stretch;

static int valid_at(const fap_take *take, int64_t frame, uint32_t point)
{
    return frame >= 0 && frame < take->frame_count && take->valid[(size_t)frame * take->point_count + point];
}

static const float *sample_at(const fap_take *take, int64_t frame, uint32_t point)
{
    return take->xyz[(size_t)frame * take->point_count + point];
}

static double kernel(double x, double cutoff)
{
    const double half = lobes / (2 * cutoff);

    if (fabs(x) >= half)
        return 0;
    const double phase = 2 * pi * cutoff * x;
    const double sinc = fabs(phase) < 1e-9 ? 1 : sin(phase) / phase;
    return sinc * 0.5 * (1 + cos(pi * x / half));
}

/* The signal at any frame: reflected through the end of the run outside it, level beyond that. */
static double extended(const resampler *r, stretch s, int64_t frame, uint32_t point, int axis)
{
    const int64_t edge = frame < s.first ? s.first : frame > s.last ? s.last : frame;
    int64_t mirrored = 2 * edge - frame;

    mirrored = mirrored < s.first ? s.first : mirrored > s.last ? s.last : mirrored;
    const double value = sample_at(r->in, mirrored, point)[axis];
    return edge == frame ? value : 2 * (double)sample_at(r->in, edge, point)[axis] - value;
}

static void filtered(const resampler *r, stretch s, double t, uint32_t point, float out[3])
{
    const double half = lobes / (2 * r->cutoff);
    double sum[3] = { 0 }, weight = 0;

    for (int64_t f = (int64_t)ceil(t - half); f <= (int64_t)floor(t + half); f++) {
        const double w = kernel((double)f - t, r->cutoff);
        weight += w;
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += w * extended(r, s, f, point, axis);
    }
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)(sum[axis] / weight);
}

static void interpolated(const resampler *r, double t, uint32_t point, float out[3])
{
    const int64_t before = (int64_t)floor(t);
    const double part = t - (double)before;
    const float *a = sample_at(r->in, before, point), *b = part > 0 ? sample_at(r->in, before + 1, point) : a;

    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)(a[axis] + part * (b[axis] - a[axis]));
}

/* Extends a run that contains frame @p f, as far as the kernel can see. */
static stretch stretch_around(const resampler *r, int64_t f, uint32_t point)
{
    const int64_t reach = r->cutoff > 0 ? (int64_t)ceil(lobes / (2 * r->cutoff)) * 2 : 1;
    stretch s = { f, f };

    while (s.first > f - reach && valid_at(r->in, s.first - 1, point))
        s.first--;
    while (s.last < f + reach && valid_at(r->in, s.last + 1, point))
        s.last++;
    return s;
}

/* The less sure of the two samples around it. */
static void take_origin(const resampler *r, double t, uint32_t point, fap_take *out, uint32_t frame)
{
    uint8_t *origin = &out->valid[(size_t)frame * out->point_count + point];
    const uint8_t *around = &r->in->valid[(size_t)floor(t) * r->in->point_count + point];
    const uint8_t next = t > floor(t) ? around[r->in->point_count] : 0;

    if (*origin)
        *origin = *around > next ? *around : next;
}

static void resample_point(const resampler *r, double t, uint32_t point, fap_take *out, uint32_t frame)
{
    const int64_t before = (int64_t)floor(t);
    float xyz[3];

    if (!valid_at(r->in, before, point) || (t > (double)before && !valid_at(r->in, before + 1, point)))
        return;
    if (r->cutoff > 0)
        filtered(r, stretch_around(r, before, point), t, point, xyz);
    else
        interpolated(r, t, point, xyz);
    fap_take_set(out, frame, point, xyz);
    take_origin(r, t, point, out, frame);
}

/* Cycles per input frame. */
static double choose_cutoff(double in_hz, double out_hz, double cutoff_hz)
{
    static const double share = 0.4, slowest_hz = 0.5;
    const double highest = share * fmin(in_hz, out_hz);

    if (cutoff_hz < 0 || (cutoff_hz == 0 && in_hz == out_hz))
        return 0;
    return (cutoff_hz > 0 ? fmin(fmax(cutoff_hz, slowest_hz), 0.5 * in_hz) : highest) / in_hz;
}

static void copy_head(const fap_take *in, double rate_hz, fap_take *out)
{
    memcpy(out->name, in->name, in->point_count * sizeof *in->name);
    out->format = in->format;
    out->rate_hz = rate_hz;
    out->mm_per_unit = in->mm_per_unit;
    out->unit_known = in->unit_known;
    memcpy(out->screen, in->screen, sizeof out->screen);
    out->note_count = in->note_count;
    memcpy(out->note, in->note, sizeof out->note);
}

fap_err fap_take_resample(const fap_take *take, double rate_hz, double cutoff_hz, fap_take **out)
{
    *out = NULL;
    if (!(take->rate_hz > 0) || !(rate_hz > 0) || !isfinite(rate_hz))
        return FAP_E_ARG;
    const double frames = floor((take->frame_count - 1) * rate_hz / take->rate_hz + 1e-6) + 1;
    if (frames * take->point_count > FAP_TAKE_MAX_SAMPLES)
        return FAP_E_LIMIT;
    const fap_err err = fap_take_create(out, take->point_count, (uint32_t)frames, &take->alloc);
    if (err != FAP_OK)
        return err;
    const resampler r = { take, choose_cutoff(take->rate_hz, rate_hz, cutoff_hz) };
    copy_head(take, rate_hz, *out);
    for (uint32_t f = 0; f < (*out)->frame_count; f++) {
        const double exact = f * take->rate_hz / rate_hz, whole = nearbyint(exact);
        const double t = fabs(exact - whole) < 1e-6 ? whole : exact;
        for (uint32_t p = 0; p < take->point_count; p++)
            resample_point(&r, fmin(t, take->frame_count - 1.0), p, *out, f);
    }
    return FAP_OK;
}
