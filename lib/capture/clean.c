/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Spikes and short gaps. A spike stands out of the median of its neighbours by more than they themselves
 * scatter; it becomes a gap. A short gap is closed by the cubic that continues both sides. Source: F. R.
 * Hampel, The influence curve and its role in robust estimation, 1974.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/clean.h>

enum { HALF_WINDOW = 4 };

void fap_clean_config_init(fap_clean_config *cfg)
{
    *cfg = (fap_clean_config){ .struct_size = sizeof *cfg, .spike_mm = 3, .gap_s = 0.2 };
}

const char *fap_sample_name(fap_sample sample)
{
    static const char *const names[FAP_SAMPLE_KINDS] = { "missing", "measured", "spline", "rigid",
                                                         "surface", "motion",   "bank",   "eased" };
    return (unsigned)sample < FAP_SAMPLE_KINDS ? names[sample] : "unknown";
}

static size_t at(const fap_take *take, uint32_t frame, uint32_t point)
{
    return (size_t)frame * take->point_count + point;
}

/* --- spikes --- */

static void sort(float *v, int n)
{
    for (int i = 1; i < n; i++) {
        const float x = v[i];
        int j = i;
        for (; j > 0 && v[j - 1] > x; j--)
            v[j] = v[j - 1];
        v[j] = x;
    }
}

static float median(float *v, int n)
{
    sort(v, n);
    return n % 2 ? v[n / 2] : 0.5f * (v[n / 2 - 1] + v[n / 2]);
}

static const float *valid_sample(const fap_take *take, int64_t frame, uint32_t point)
{
    return frame >= 0 && frame < take->frame_count ? fap_take_sample(take, (uint32_t)frame, point) : NULL;
}

/* Where the frames before and after say that a point should be: a pair at equal distance sees any steady
 * motion. */
static int predictions(const fap_take *take, uint32_t frame, uint32_t point, int axis, float *v)
{
    int n = 0;

    for (int k = 1; k <= HALF_WINDOW; k++) {
        const float *a = valid_sample(take, (int64_t)frame - k, point),
                    *b = valid_sample(take, (int64_t)frame + k, point);
        if (a && b)
            v[n++] = 0.5f * (a[axis] + b[axis]);
    }
    return n;
}

/* How far the sample is from the middle of those on one side. */
static float off_side(const fap_take *take, uint32_t frame, uint32_t point, int axis, int direction)
{
    float v[HALF_WINDOW];
    int n = 0;

    for (int k = 1; k <= HALF_WINDOW; k++) {
        const float *x = valid_sample(take, (int64_t)frame + direction * k, point);
        if (x)
            v[n++] = x[axis];
    }
    return n ? fabsf(take->xyz[at(take, frame, point)][axis] - median(v, n)) : 0;
}

/*
 * Off the predictions by more than they differ among themselves: times 1.4826 a median deviation is a
 * standard deviation, and five of those never happen. Off both sides as well: a step belongs to one of them.
 */
static int stands_out(const fap_take *take, uint32_t frame, uint32_t point, int axis, float least_mm)
{
    const float x = take->xyz[at(take, frame, point)][axis];
    float v[HALF_WINDOW], deviation[HALF_WINDOW];
    const int n = predictions(take, frame, point, axis, v);

    if (n < 2)
        return 0;
    const float middle = median(v, n);
    if (fabsf(x - middle) <= least_mm)
        return 0;
    for (int i = 0; i < n; i++)
        deviation[i] = fabsf(v[i] - middle);
    return fabsf(x - middle) > least_mm + 5 * 1.4826f * median(deviation, n) &&
           off_side(take, frame, point, axis, -1) > least_mm &&
           off_side(take, frame, point, axis, 1) > least_mm;
}

/* Judged on what was measured: the medians still see the spikes that were marked, and survive them. */
static uint32_t drop_spikes(fap_take *take, uint32_t point, float least_mm)
{
    uint32_t spikes = 0, pending[HALF_WINDOW + 1];

    memset(pending, 0xff, sizeof pending);
    for (uint32_t f = 0; f < take->frame_count + HALF_WINDOW + 1; f++) {
        uint32_t *slot = &pending[f % (HALF_WINDOW + 1)];
        if (*slot != UINT32_MAX)
            take->valid[at(take, *slot, point)] = 0;
        *slot = UINT32_MAX;
        if (f >= take->frame_count || !take->valid[at(take, f, point)])
            continue;
        for (int axis = 0; axis < 3 && *slot == UINT32_MAX; axis++)
            if (stands_out(take, f, point, axis, least_mm))
                *slot = f;
        spikes += *slot != UINT32_MAX;
    }
    return spikes;
}

/* --- gaps --- */

/* Slope per frame on the outer side of a gap, from the sample one step further out where there is one. */
static float slope(const fap_take *take, uint32_t edge, int step, uint32_t point, int axis)
{
    const int64_t outer = (int64_t)edge + step;

    if (outer < 0 || outer >= take->frame_count || !take->valid[at(take, (uint32_t)outer, point)])
        return 0;
    return (take->xyz[at(take, (uint32_t)outer, point)][axis] - take->xyz[at(take, edge, point)][axis]) /
           (float)step;
}

/* Cubic Hermite curve through both edges with the slopes they have. */
static void close_gap(fap_take *take, uint32_t before, uint32_t after, uint32_t point)
{
    const float span = (float)(after - before);

    for (int axis = 0; axis < 3; axis++) {
        const float a = take->xyz[at(take, before, point)][axis], b = take->xyz[at(take, after, point)][axis];
        const float sa = slope(take, before, -1, point, axis) * span,
                    sb = slope(take, after, 1, point, axis) * span;
        for (uint32_t f = before + 1; f < after; f++) {
            const float t = (float)(f - before) / span, u = 1 - t;
            take->xyz[at(take, f, point)][axis] =
                a * (1 + 2 * t) * u * u + b * (3 - 2 * t) * t * t + sa * t * u * u - sb * t * t * u;
        }
    }
    for (uint32_t f = before + 1; f < after; f++)
        take->valid[at(take, f, point)] = FAP_SAMPLE_SPLINE;
}

static void close_gaps(fap_take *take, uint32_t point, uint32_t longest, fap_clean_report *report)
{
    uint32_t last = UINT32_MAX;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        if (!take->valid[at(take, f, point)])
            continue;
        const uint32_t gap = last == UINT32_MAX ? 0 : f - last - 1;
        if (gap && gap <= longest) {
            close_gap(take, last, f, point);
            report->gaps_closed++;
            report->samples_filled += gap;
        } else if (gap) {
            report->gaps_left++;
        }
        last = f;
    }
}

void fap_take_clean(fap_take *take, const fap_clean_config *cfg, fap_clean_report *report)
{
    fap_clean_config defaults;

    fap_clean_config_init(&defaults);
    if (!cfg)
        cfg = &defaults;
    *report = (fap_clean_report){ 0 };
    const double rate_hz = take->rate_hz > 0 ? take->rate_hz : 60;
    for (uint32_t p = 0; p < take->point_count; p++) {
        if (cfg->spike_mm > 0)
            report->spikes += drop_spikes(take, p, (float)cfg->spike_mm);
        close_gaps(take, p, (uint32_t)(cfg->gap_s * rate_hz + 0.5), report);
    }
}
