/* SPDX-License-Identifier: BSD-2-Clause */
/* See dot.h. */
#include <math.h>
#include <string.h>

#include "track/dot.h"

/* --- pixels --- */

static int clamp(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* Beyond the border is what is on it. */
static const uint8_t *pixel(const fap_picture *p, int x, int y)
{
    return p->rgb + (size_t)clamp(y, 0, p->height_px - 1) * p->stride +
           3 * (size_t)clamp(x, 0, p->width_px - 1);
}

/* Between pixels, linearly. */
static void sample(const fap_picture *p, double x, double y, float out[3])
{
    const int left = (int)floor(x), top = (int)floor(y);
    const double fx = x - left, fy = y - top;
    const uint8_t *a = pixel(p, left, top), *b = pixel(p, left + 1, top), *c = pixel(p, left, top + 1),
                  *d = pixel(p, left + 1, top + 1);

    for (int i = 0; i < 3; i++)
        out[i] = (float)((1 - fy) * ((1 - fx) * a[i] + fx * b[i]) + fy * ((1 - fx) * c[i] + fx * d[i]));
}

static void mean_of_ring(const fap_picture *p, const double at[2], double radius, float out[3])
{
    enum { SAMPLES = 24 };
    float sum[3] = { 0 }, one[3];

    for (int i = 0; i < SAMPLES; i++) {
        const double turn = i * (2 * 3.14159265358979323846 / SAMPLES);
        sample(p, at[0] + radius * cos(turn), at[1] + radius * sin(turn), one);
        for (int k = 0; k < 3; k++)
            sum[k] += one[k];
    }
    for (int k = 0; k < 3; k++)
        out[k] = sum[k] / SAMPLES;
}

static float distance2(const float a[3], const float b[3])
{
    float sum = 0;

    for (int i = 0; i < 3; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

/* 1 the dot's colour, 0 the skin's, in between on the way; less for what lies beside the way: it is neither. */
static double likeness(const dot *d, const float rgb[3])
{
    const float all = distance2(d->colour, d->skin);
    float along = 0;

    if (!(all > 0))
        return 0;
    for (int i = 0; i < 3; i++)
        along += (rgb[i] - d->skin[i]) * (d->colour[i] - d->skin[i]) / all;
    const float beside = fmaxf(0, distance2(rgb, d->skin) / all - along * along);
    return fmin(1, fmax(0, along)) * fmax(0, 1 - 4 * beside);
}

/* --- the dot's middle --- */

/* The mean place of the dot's colour within @radius. Returns its area in pixels; 0: too little to have a middle. */
static double middle(const dot *d, const fap_picture *p, double radius, double at[2])
{
    enum { ROUNDS = 3 };
    const int reach = (int)ceil(radius) + 1;
    double area = 0;

    for (int round = 0; round < ROUNDS; round++) {
        const int cx = (int)lround(at[0]), cy = (int)lround(at[1]);
        double sum = 0, x_sum = 0, y_sum = 0;
        for (int y = cy - reach; y <= cy + reach; y++)
            for (int x = cx - reach; x <= cx + reach; x++) {
                /* The edge of the disc takes pixels by halves: whole ones would make the middle jump. */
                const double from = hypot(x - at[0], y - at[1]), edge = fmin(1, fmax(0, radius + 0.5 - from));
                const uint8_t *c = pixel(p, x, y);
                const double like = edge > 0 ? likeness(d, (const float[3]){ c[0], c[1], c[2] }) : 0;
                const double w = edge * (like > 0.25 ? like : 0);
                sum += w;
                x_sum += w * x;
                y_sum += w * y;
            }
        if (!(sum > 0.3 * d->radius * d->radius))
            return 0;
        at[0] = x_sum / sum;
        at[1] = y_sum / sum;
        area = sum;
    }
    return area;
}

/* --- learning --- */

/* Where going out from the middle the colour has become as much skin as dot. */
static double find_radius(dot *d, const fap_picture *p, const double at[2])
{
    float ring[3];

    for (double r = 1; r < DOT_MAX_RADIUS; r += 0.5) {
        mean_of_ring(p, at, r, ring);
        if (likeness(d, ring) < 0.5)
            return r;
    }
    return 4; /* it has no edge: as if it were a small one */
}

/* What surrounds it: of the rings near by, the colour that is least like the dot. */
static void find_skin(dot *d, const fap_picture *p, const double at[2], double least, double most)
{
    float best = -1, ring[3];

    for (double r = least; r <= most; r += 1) {
        mean_of_ring(p, at, r, ring);
        const float far = distance2(ring, d->colour);
        if (far > best) {
            best = far;
            memcpy(d->skin, ring, sizeof ring);
        }
    }
}

static void take_template(dot *d, const fap_picture *p, const double at[2])
{
    const int side = 2 * d->half + 1;

    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            sample(p, at[0] + x - d->half, at[1] + y - d->half, d->rgb[y * side + x]);
}

static void make_weights(dot *d)
{
    const int side = 2 * d->half + 1;
    double sum = 0;

    for (int i = 0; i < side * side; i++) {
        const double from = hypot(i % side - d->half, i / side - d->half);
        d->weight[i] = (float)fmin(1, fmax(0, 1.5 * d->radius + 1.5 - from));
        sum += d->weight[i];
    }
    for (int i = 0; i < side * side; i++)
        d->weight[i] /= (float)sum;
}

static void measure_absence(dot *d)
{
    const int side = 2 * d->half + 1;

    d->absent = 0;
    for (int i = 0; i < side * side; i++)
        d->absent += d->weight[i] * distance2(d->rgb[i], d->skin);
    /* A dot like its skin is never surely seen, but nothing is divided by 0. */
    d->absent = fmaxf(d->absent, 3 * 8 * 8);
}

/* How much the spot at @at differs from the ring around it where they differ least: at an edge that is nothing. */
static double stands_out(const fap_picture *p, const double at[2], double radius)
{
    enum { SAMPLES = 12 };
    float spot[3], around[3], least = INFINITY;

    mean_of_ring(p, at, 0.4 * radius, spot);
    for (int i = 0; i < SAMPLES; i++) {
        const double turn = i * (2 * 3.14159265358979323846 / SAMPLES), ring = 1.6 * radius + 1;
        sample(p, at[0] + ring * cos(turn), at[1] + ring * sin(turn), around);
        least = fminf(least, distance2(spot, around));
    }
    return (double)least;
}

/* The spot near @at that stands out most: people click beside what is three pixels wide. */
static void stand_on_spot(const fap_picture *p, double radius, double at[2])
{
    const double reach = 1.5, step = 0.5, from[2] = { at[0], at[1] };
    double best = 0;

    for (double dy = -reach; dy <= reach; dy += step)
        for (double dx = -reach; dx <= reach; dx += step) {
            const double to[2] = { from[0] + dx, from[1] + dy };
            const double contrast = stands_out(p, to, radius) / (1 + 1.0 * (dx * dx + dy * dy));
            if (contrast <= best)
                continue;
            best = contrast;
            memcpy(at, to, sizeof to);
        }
}

/* Whoever showed the dot showed its inside: what lies farther away is something else of that colour. */
static double middle_near(const dot *d, const fap_picture *p, double at[2])
{
    double to[2] = { at[0], at[1] };
    const double area = middle(d, p, 1.5 * d->radius + 1, to);

    if (hypot(to[0] - at[0], to[1] - at[1]) > d->radius + 0.5)
        return area;
    at[0] = to[0];
    at[1] = to[1];
    return area;
}

void dot_learn(dot *d, const fap_picture *p, double at[2], double radius)
{
    stand_on_spot(p, radius > 0 ? radius : 1.5, at);
    mean_of_ring(p, at, 0.7, d->colour);
    find_skin(d, p, at, fmax(2, 1.6 * radius), radius > 0 ? 2.2 * radius + 1 : DOT_MAX_RADIUS);
    d->radius = radius > 0 ? fmin(radius, DOT_MAX_RADIUS) : find_radius(d, p, at);
    middle_near(d, p, at);
    mean_of_ring(p, at, 0.4 * d->radius, d->colour);
    find_skin(d, p, at, 1.6 * d->radius + 1, 2 * d->radius + 2);
    if (!(radius > 0))
        d->radius = find_radius(d, p, at);
    d->area = middle_near(d, p, at);
    d->half = clamp((int)ceil(1.5 * d->radius + 1), 2, DOT_MAX_HALF);
    take_template(d, p, at);
    make_weights(d);
    measure_absence(d);
}

void dot_follow(dot *d, const fap_picture *p, const double at[2])
{
    const float rate = 0.05F;
    const int side = 2 * d->half + 1;
    float now[3];

    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            float *const was = d->rgb[y * side + x];
            sample(p, at[0] + x - d->half, at[1] + y - d->half, now);
            for (int k = 0; k < 3; k++)
                was[k] += rate * (now[k] - was[k]);
        }
}

/* --- finding --- */

/* Eq. 3 at a whole pixel; stops where it is worse than @p best. */
static float cost_at(const dot *d, const fap_picture *p, int cx, int cy, float best)
{
    const int side = 2 * d->half + 1;
    float sum = 0;

    for (int y = 0; y < side && sum < best; y++)
        for (int x = 0; x < side; x++) {
            const int i = y * side + x;
            const uint8_t *c = pixel(p, cx + x - d->half, cy + y - d->half);
            const float dr = c[0] - d->rgb[i][0], dg = c[1] - d->rgb[i][1], db = c[2] - d->rgb[i][2];
            sum += d->weight[i] * (dr * dr + dg * dg + db * db);
        }
    return sum;
}

/* What is looked for and where it should be. */
typedef struct quest {
    const dot *d;
    const fap_picture *p;
    double from[2];
    float pull;
    int x, y; /* the best place so far */
    float best;
} quest;

/* Costs no less than its distance does: what lies too far need not be looked at. */
static void look_at(quest *q, int x, int y)
{
    const float dx = (float)(x - q->from[0]), dy = (float)(y - q->from[1]),
                far = q->pull * (dx * dx + dy * dy);

    if (x < 0 || y < 0 || x >= q->p->width_px || y >= q->p->height_px || far >= q->best)
        return;
    const float cost = far + cost_at(q->d, q->p, x, y, q->best - far);
    if (cost >= q->best)
        return;
    q->best = cost;
    q->x = x;
    q->y = y;
}

/* Every @step pixels in a square of @reach around the best place. */
static void search_square(quest *q, int reach, int step)
{
    const int cx = q->x, cy = q->y;

    for (int dy = -reach; dy <= reach; dy += step)
        for (int dx = -reach; dx <= reach; dx += step)
            look_at(q, cx + dx, cy + dy);
}

double dot_find(const dot *d, const fap_picture *p, double search, double pull, double at[2])
{
    const int step = d->radius >= 3 ? 2 : 1;
    const int reach = (int)ceil(search) / step * step + step;
    quest q = { d,       p, { at[0], at[1] }, (float)pull * d->absent, (int)lround(at[0]), (int)lround(at[1]),
                INFINITY };

    look_at(&q, q.x, q.y);
    search_square(&q, reach, step);
    if (step > 1)
        search_square(&q, 1, 1);
    if (!(q.best < INFINITY))
        return (double)q.best;
    at[0] = q.x;
    at[1] = q.y;
    const double looks = (double)cost_at(d, p, q.x, q.y, INFINITY);
    /* The middle of what sticks out from behind something is not the dot's. */
    const double area = middle(d, p, 1.5 * d->radius + 1, at);
    const double hidden = d->area > 0 ? fmax(0, 0.9 - area / d->area) : 0;
    return looks / d->absent + hidden;
}
