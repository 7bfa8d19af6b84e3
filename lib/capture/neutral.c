/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The neutral frame, which all FAPs are measured from. By itself: a still moment with the mouth closed, near
 * the posture that the take most often returns to. Frame 0 is often still someone else's neutral: a T-pose of
 * the face, or a slate.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "capture/performance.h"

/* What the choice is made from, a number a frame; NAN where the head is not seen. */
typedef struct moments {
    double *speed, *mouth, *lids, *distance, *scratch;
    double pressed_mm;
    uint32_t frames;
} moments;

static const double half_window_s = 0.12;

static uint32_t window(const performance *p)
{
    return (uint32_t)(half_window_s * p->report->rate_hz + 0.5);
}

static int is_of_face(const performance *p, uint32_t point)
{
    return (p->report->markers.role[point] & ~(FAP_MARKER_RIGID | FAP_MARKER_IDLE | FAP_MARKER_INSIDE)) != 0;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The value that a share of the numbers lies below; NAN when there is none. */
static double quantile(const double *v, uint32_t n, double share, double *scratch)
{
    uint32_t used = 0;

    for (uint32_t i = 0; i < n; i++)
        if (isfinite(v[i]))
            scratch[used++] = v[i];
    if (!used)
        return NAN;
    qsort(scratch, used, sizeof *scratch, by_value);
    return scratch[(uint32_t)(share * (used - 1))];
}

/* --- what is measured in each frame --- */

/* Root mean square over the face's markers of how far they move from one frame to another, mm. */
static double change(const performance *p, uint32_t a, uint32_t b)
{
    double sum = 0;
    uint32_t n = 0;

    for (uint32_t i = 0; i < p->take->point_count; i++) {
        double x[3], y[3];
        if (!is_of_face(p, i) || !head_still(p, a, i, x) || !head_still(p, b, i, y))
            continue;
        sum += pow(x[0] - y[0], 2) + pow(x[1] - y[1], 2) + pow(x[2] - y[2], 2);
        n++;
    }
    return n ? sqrt(sum / n) : NAN;
}

/* Motion within the window around the frame. */
static double speed_at(const performance *p, uint32_t frame)
{
    const uint32_t w = window(p) ? window(p) : 1;
    const uint32_t first = frame > w ? frame - w : 0,
                   last = frame + w < p->frames ? frame + w : p->frames - 1;

    /* Cut windows would look still. */
    if (last - first < 2 * w && p->frames > 4 * w)
        return NAN;
    return last > first ? change(p, first, frame) + change(p, frame, last) : 0;
}

/* Two feature points whose distance says something. */
typedef struct point_pair {
    const char *upper, *lower;
    double pressed_mm; /* how much nearer than at rest they can come */
} point_pair;

/* Distances that grow when the mouth opens, and when the eyes do; the first that the take has is used. */
static const point_pair mouth_pairs[] = { { "2.2", "2.3", 0 }, { "8.1", "8.2", 3 },  { "9.3", "2.10", 3 },
                                          { "9.3", "2.1", 3 }, { "8.1", "2.10", 3 }, { "8.1", "2.1", 3 } };
static const point_pair lid_pairs[] = { { "3.1", "3.3", 0 }, { "3.2", "3.4", 0 } };

static int still_point(const performance *p, uint32_t frame, int feature_point, double out[3])
{
    const fap_marker_source *s = &p->report->markers.point[feature_point];
    double v[3];

    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < s->count; k++) {
        if (!head_still(p, frame, (uint32_t)s->index[k], v))
            return 0;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += v[axis] / s->count;
    }
    return s->count > 0;
}

/* The first pair that the take has; NULL: none. */
static const point_pair *pair_of(const performance *p, const point_pair *pair, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (p->report->markers.point[fap_point_by_name(pair[i].upper)].count &&
            p->report->markers.point[fap_point_by_name(pair[i].lower)].count)
            return &pair[i];
    return NULL;
}

/* 0 when there is no pair; NAN when it is hidden. */
static double distance_at(const performance *p, uint32_t frame, const point_pair *pair)
{
    double a[3], b[3];

    if (!pair)
        return 0;
    if (!still_point(p, frame, fap_point_by_name(pair->upper), a) ||
        !still_point(p, frame, fap_point_by_name(pair->lower), b))
        return NAN;
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* The posture that is nearest to all others, among a sample of frames. */
static uint32_t usual_frame(const performance *p)
{
    enum { SAMPLE = 48 };
    uint32_t best = 0;
    double least = INFINITY;
    const uint32_t step = p->frames / SAMPLE + 1;

    for (uint32_t a = 0; a < p->frames; a += step) {
        double sum = 0;
        for (uint32_t b = 0; b < p->frames; b += step) {
            const double d = change(p, a, b);
            sum += isfinite(d) ? sqrt(d)
                               : 10; /* the root: being near to many counts more than being far from a few */
        }
        if (sum < least) {
            least = sum;
            best = a;
        }
    }
    return best;
}

static void measure(const performance *p, moments *m)
{
    const uint32_t usual = usual_frame(p);
    const point_pair *mouth = pair_of(p, mouth_pairs, sizeof mouth_pairs / sizeof *mouth_pairs);
    const point_pair *lids = pair_of(p, lid_pairs, sizeof lid_pairs / sizeof *lid_pairs);

    m->pressed_mm = mouth ? mouth->pressed_mm : 0;
    for (uint32_t f = 0; f < m->frames; f++) {
        m->speed[f] = speed_at(p, f);
        m->mouth[f] = distance_at(p, f, mouth);
        m->lids[f] = distance_at(p, f, lids);
        m->distance[f] = change(p, f, usual);
    }
}

/* --- the choice --- */

/*
 * Each part is 1 at what is usual in this take; a mouth open by 2 mm more than its closed state counts like that, markers on the
 * outer lips come nearer than at rest when lips are pressed for a p. What is
 * usual counts up to a limit: most of a short take may be one long smile, and the closed mouth before it is still at rest.
 */
static uint32_t best_frame(const moments *m)
{
    static const double most_unusual = 3;
    const double speed = quantile(m->speed, m->frames, 0.5, m->scratch) + 0.1;
    const double distance = quantile(m->distance, m->frames, 0.5, m->scratch) + 0.5;
    const double closed = quantile(m->mouth, m->frames, 0.1, m->scratch);
    const double awake = quantile(m->lids, m->frames, 0.7, m->scratch);
    double least = INFINITY;
    uint32_t best = 0;

    for (uint32_t f = 0; f < m->frames; f++) {
        const double open = fmax(0, fabs(m->mouth[f] - closed) - m->pressed_mm) / 2,
                     asleep = fabs(m->lids[f] - awake) / 2;
        const double unusual = fmin(m->distance[f] / distance, most_unusual);
        const double score = m->speed[f] / speed + unusual + open + asleep;
        if (score < least) {
            least = score;
            best = f;
        }
    }
    return best;
}

static fap_err choose(performance *p, uint32_t *frame)
{
    const fap_allocator *a = &p->take->alloc;
    double *v = fap_mem_calloc(a, p->frames, 5 * sizeof *v);

    if (!v)
        return FAP_E_NOMEM;
    const size_t n = p->frames;
    moments m = { v, v + n, v + 2 * n, v + 3 * n, v + 4 * n, 0, p->frames };
    measure(p, &m);
    *frame = best_frame(&m);
    fap_mem_free(a, v);
    return FAP_OK;
}

/* Frames of the FAPs; @p middle is where the head's pose at rest is from. */
typedef struct stretch {
    uint32_t first, middle, last;
} stretch;

/* The frame of the FAPs nearest to one of the take; may lie outside of them. */
static double own_frame(const performance *p, int64_t frame)
{
    const fap_capture_report *r = p->report;
    return nearbyint(((double)frame / r->take_rate_hz - p->cfg->start_s) * r->rate_hz);
}

static fap_err outside(performance *p, int64_t frame)
{
    const fap_capture_report *r = p->report;
    return performance_fail(p, FAP_E_ARG, "--neutral %lld: the part that is encoded has frames %.0f to %.0f",
                            (long long)frame, ceil(p->cfg->start_s * r->take_rate_hz),
                            floor((p->cfg->start_s + (p->frames - 1) / r->rate_hz) * r->take_rate_hz));
}

/* The frame nearest to the middle that shows the head. */
static int settle_middle(const performance *p, stretch *s)
{
    const uint32_t middle = s->first + (s->last - s->first) / 2;

    for (uint32_t d = 0; d <= s->last - s->first; d++) {
        s->middle = middle + d <= s->last && p->posed[middle + d] ? middle + d : middle - d;
        if (s->middle >= s->first && s->middle <= s->last && p->posed[s->middle])
            return 1;
    }
    return 0;
}

static fap_err given(performance *p, stretch *s)
{
    const int64_t from = p->cfg->neutral_frame, to = p->cfg->neutral_last < 0 ? from : p->cfg->neutral_last;
    const double first = own_frame(p, from), last = own_frame(p, to);

    if (!(first >= 0 && first < p->frames))
        return outside(p, from);
    if (!(last >= first && last < p->frames))
        return outside(p, to);
    s->first = (uint32_t)first;
    s->last = (uint32_t)last;
    return settle_middle(p, s) ? FAP_OK
                               : performance_fail(p, FAP_E_ARG, "--neutral: the head is not seen there");
}

static fap_err found(performance *p, stretch *s)
{
    const uint32_t w = window(p);
    const fap_err err = choose(p, &s->middle);

    s->first = s->middle > w ? s->middle - w : 0;
    s->last = s->middle + w < p->frames ? s->middle + w : p->frames - 1;
    return err;
}

/* Mean over the frames, so that one noisy frame does not become an offset of all FAPs. */
static void take_places(performance *p, const stretch *s)
{
    for (uint32_t i = 0; i < p->take->point_count; i++) {
        double sum[3] = { 0 }, v[3];
        uint32_t n = 0;
        for (uint32_t f = s->first; f <= s->last; f++) {
            if (!head_still(p, f, i, v))
                continue;
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += v[axis];
            n++;
        }
        p->placed[i] = n > 0;
        for (int axis = 0; axis < 3; axis++)
            p->place[i][axis] = n ? sum[axis] / n : 0;
    }
}

/* A marker that is hidden in the neutral stretch takes its place from the nearest time that shows it. */
static void place_hidden(performance *p, uint32_t middle)
{
    uint32_t late = 0;

    for (uint32_t i = 0; i < p->take->point_count; i++) {
        for (uint32_t d = 1; !p->placed[i] && d < p->frames; d++) {
            const int before = d <= middle && head_still(p, middle - d, i, p->place[i]);
            p->placed[i] = before || (middle + d < p->frames && head_still(p, middle + d, i, p->place[i]));
        }
        late += p->placed[i] && is_of_face(p, i) && !fap_take_sample(p->take, middle, i);
    }
    if (late)
        performance_note(
            p, "%u markers are hidden in the neutral frame; theirs is the nearest frame that shows them",
            late);
}

fap_err neutral_find(performance *p)
{
    const int is_found = p->cfg->neutral_frame < 0;
    stretch s = { 0, 0, 0 };
    const fap_err err = (is_found ? found : given)(p, &s);

    if (err != FAP_OK)
        return err;
    p->report->neutral_found = (uint8_t)is_found;
    p->report->neutral_s = p->cfg->start_s + s.middle / p->report->rate_hz;
    p->report->neutral_length_s = (s.last - s.first + 1) / p->report->rate_hz;
    p->rest = p->pose[s.middle];
    take_places(p, &s);
    place_hidden(p, s.middle);
    return FAP_OK;
}

int neutral_point(const performance *p, int feature_point, double out[3])
{
    const fap_marker_source *s = &p->report->markers.point[feature_point];

    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < s->count; k++) {
        if (!p->placed[s->index[k]])
            return 0;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += p->place[s->index[k]][axis] / s->count;
    }
    return s->count > 0;
}
