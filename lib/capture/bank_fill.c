/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Long gaps of feature points by the databank's motion space: which mix of the bank's units, each between none and all of it,
 * moves the points in sight as they move, and what that mix does to the hidden one. What it gets wrong at the edges of the
 * gap is carried across, so that nothing jumps. For gaps that the take itself could not close (fill.c): a point that is
 * hidden nearly always teaches nothing.
 */
#include <math.h>
#include <string.h>

#include "bank/qp.h"
#include "base/mem.h"
#include "capture/performance.h"

enum { MOST_UNITS = 96 };

typedef struct space {
    const performance *p;
    int units;
    const float (*unit[MOST_UNITS])[3]; /* of each feature point, millimetres of the bank */
    double scale;                       /* millimetres of the bank in one of the take's */
    uint8_t use[FAP_POINT_COUNT];       /* points that are seen throughout the gap */
    fap_qp qp;
} space;

/* A point between two frames that show it; -1 or the number of frames: none does. */
typedef struct hole {
    int point;
    int64_t before, after;
} hole;

static int open_space(space *s, const performance *p)
{
    const fap_bank *bank = p->face.bank;

    *s = (space){ .p = p, .scale = (double)(fap_bank_fapu(bank)->es_mm / p->report->fapu.es_mm) };
    for (int i = 0; i < fap_bank_key_count(bank) && s->units < MOST_UNITS; i++)
        if (fap_bank_key_get(bank, i)->kind == FAP_KEY_UNIT)
            s->unit[s->units++] = fap_bank_key_get(bank, i)->point_mm;
    return s->units && !fap_qp_open(&s->qp, MOST_UNITS, &p->take->alloc);
}

/* The points that tell: seen from edge to edge, and moved by some unit. @return how many */
static int choose_witnesses(space *s, const hole *h)
{
    const performance *p = s->p;
    const int64_t first = h->before < 0 ? 0 : h->before,
                  last = h->after < (int64_t)p->frames ? h->after : (int64_t)p->frames - 1;
    int count = 0;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        s->use[i] = i != h->point && p->known[i];
        for (int64_t f = first; f <= last && s->use[i]; f++)
            s->use[i] = p->seen[f][i] != FAP_SAMPLE_MISSING;
        count += s->use[i];
    }
    return count;
}

static void set_gram(space *s)
{
    static const double ridge_mm2 = 1; /* a unit that nobody sees stays at rest */

    fap_qp_clear(&s->qp, s->units);
    for (int a = 0; a < s->units; a++) {
        for (int b = a; b < s->units; b++) {
            double sum = a == b ? ridge_mm2 : 0;
            for (int i = 0; i < FAP_POINT_COUNT; i++)
                for (int axis = 0; axis < 3 && s->use[i]; axis++)
                    sum += (double)(s->unit[a][i][axis] * s->unit[b][i][axis]);
            s->qp.gram[a * s->qp.capacity + b] = s->qp.gram[b * s->qp.capacity + a] = sum;
        }
        s->qp.hi[a] = 1;
    }
}

/* Where the mix that explains the frame has the point, millimetres of the take from rest. */
static void predict(space *s, uint32_t frame, int point, double out[3])
{
    for (int a = 0; a < s->units; a++) {
        double sum = 0;
        for (int i = 0; i < FAP_POINT_COUNT; i++)
            for (int axis = 0; axis < 3 && s->use[i]; axis++)
                sum += s->scale * (double)(s->unit[a][i][axis] * s->p->point[frame][i][axis]);
        s->qp.linear[a] = sum;
    }
    fap_qp_solve(&s->qp);
    for (int axis = 0; axis < 3; axis++) {
        out[axis] = 0;
        for (int a = 0; a < s->units; a++)
            out[axis] += s->qp.x[a] * (double)s->unit[a][point][axis] / s->scale;
    }
}

/* What the prediction leaves at an edge. */
static int remainder_at(space *s, const hole *h, int64_t frame, double out[3])
{
    if (frame < 0 || frame >= (int64_t)s->p->frames)
        return 0;
    predict(s, (uint32_t)frame, h->point, out);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (double)s->p->point[frame][h->point][axis] - out[axis];
    return 1;
}

static void fill_hole(performance *p, space *s, const hole *h)
{
    double left[3] = { 0 }, right[3] = { 0 }, v[3];
    const int has_left = remainder_at(s, h, h->before, left), has_right = remainder_at(s, h, h->after, right);

    if (!has_left)
        memcpy(left, right, sizeof left);
    if (!has_right)
        memcpy(right, left, sizeof right);
    for (int64_t f = h->before + 1; f < h->after; f++) {
        const double t = (double)(f - h->before) / (double)(h->after - h->before), part = t * t * (3 - 2 * t);
        predict(s, (uint32_t)f, h->point, v);
        for (int axis = 0; axis < 3; axis++)
            p->point[f][h->point][axis] = (float)(v[axis] + left[axis] + part * (right[axis] - left[axis]));
    }
}

static int next_hole(const performance *p, int point, int64_t from, hole *h)
{
    int64_t f = from;

    while (f < (int64_t)p->frames && p->seen[f][point])
        f++;
    if (f >= (int64_t)p->frames)
        return 0;
    *h = (hole){ point, f - 1, f };
    while (h->after < (int64_t)p->frames && !p->seen[h->after][point])
        h->after++;
    return 1;
}

static void fill_point(performance *p, space *s, int point, uint8_t (*filled)[FAP_POINT_COUNT])
{
    enum { LEAST_POINTS = 6 };
    hole h;

    for (int64_t from = 0; next_hole(p, point, from, &h); from = h.after) {
        if ((h.before < 0 && h.after >= (int64_t)p->frames) || choose_witnesses(s, &h) < LEAST_POINTS)
            continue;
        set_gram(s);
        fill_hole(p, s, &h);
        for (int64_t f = h.before + 1; f < h.after; f++)
            filled[f][point] = 1;
        p->report->gaps_by_bank++;
    }
}

/* What is filled is marked at the end: it is no witness for others. */
static void mark(performance *p, const uint8_t (*filled)[FAP_POINT_COUNT])
{
    for (uint32_t f = 0; f < p->frames; f++)
        for (int i = 0; i < FAP_POINT_COUNT; i++)
            if (filled[f][i])
                p->seen[f][i] = FAP_SAMPLE_BANK;
}

fap_err points_by_bank(performance *p)
{
    const fap_allocator *a = &p->take->alloc;
    const fap_err err = face_open(p);
    space s;

    if (p->cfg->fill != FAP_FILL_ALL || err != FAP_OK)
        return err;
    uint8_t(*filled)[FAP_POINT_COUNT] = fap_mem_calloc(a, p->frames, sizeof *filled);
    const int ok = filled && open_space(&s, p);
    for (int i = 0; ok && i < FAP_POINT_COUNT; i++)
        if (p->known[i])
            fill_point(p, &s, i, filled);
    if (ok) {
        mark(p, (const uint8_t(*)[FAP_POINT_COUNT])filled);
        fap_qp_close(&s.qp, a);
    }
    fap_mem_free(a, filled);
    return FAP_OK;
}
