/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method yano: a template in the plane of a range image, as Yano & Harada 2009 have it, section 3.1. The front of the generic face,
 * unrolled, is the template; a thin plate through the landmarks lays it over the image; each vertex takes the place that the image
 * has there. Three things are ours. The plate may stay off landmarks by what they are off themselves; with --pin-error 0.01 it meets
 * them, as the paper's does. Any scan is made an image, unrolled about the head, where it is none. And what the template
 * does not have (ears and the back of the head, the inside of lips and nostrils) or the image does not show goes where space is bent
 * to by the landmarks, drawn to the sampled skin at the seam.
 */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "registration/elastic.h"
#include "registration/range_image.h"

/* Gaps that are filled, in samples to either side. */
enum { FILL_ROUNDS = 6 };
/* Landmarks nearer than this to each other in the plane are one: a plate has one height there. */
static const double one_place_mm = 0.4;
/* How far the plate may stay off landmarks that are a millimetre off; with --pin-error 0.01 it meets them, as the paper's does. */
static const double slack_per_mm2 = 300;
/* Landmarks are off by about this, and so may the other side of a slit be. */
static const double rim_mm = 2;

typedef struct yano {
    laying *l;
    range_image image;
    cylinder axis; /* of the generic face */
    warp plate;
    uint8_t *seen;      /* [vertices] skin that the image may show */
    elastic_pull *pull; /* [vertices] weight 0: not sampled */
    uint32_t sampled;
} yano;

/* Millimetres around the head's axis, and upwards. */
static void unroll(const yano *y, const float at[3], double out[3])
{
    double angle[3];

    cylinder_unroll(&y->axis, at, angle);
    out[0] = angle[0] * 85;
    out[1] = angle[1];
    out[2] = 0;
}

/* --- the plate --- */

typedef struct pairs {
    double (*from)[3], (*move)[3];
    uint32_t *merged, count;
} pairs;

static void add_pair(pairs *p, const double from[3], const double to[2])
{
    uint32_t k = 0;

    while (k < p->count && hypot(p->from[k][0] - from[0], p->from[k][1] - from[1]) > one_place_mm)
        k++;
    if (k == p->count)
        memcpy(p->from[p->count++], from, 3 * sizeof *from);
    p->merged[k]++;
    for (int a = 0; a < 2; a++)
        p->move[k][a] += (to[a] - p->from[k][a] - p->move[k][a]) / p->merged[k];
}

static void collect(const yano *y, pairs *p)
{
    const laying *l = y->l;

    for (uint32_t i = 0; i < l->pin_count; i++) {
        double place[3], from[3], to[2];
        if (l->pin[i].weight <= 0)
            continue;
        laying_pin_place(&l->pin[i], l->generic->position, place);
        const float at[3] = { (float)place[0], (float)place[1], (float)place[2] };
        if (!range_image_find(&y->image, l, l->pin[i].at, to))
            continue;
        unroll(y, at, from);
        add_pair(p, from, to);
    }
}

static fap_err open_plate(yano *y)
{
    const double slack = slack_per_mm2 * y->l->cfg->pin_error_mm * y->l->cfg->pin_error_mm;
    const laying *l = y->l;
    pairs p = { .from = fap_mem_calloc(l->alloc, l->pin_count, sizeof *p.from),
                .move = fap_mem_calloc(l->alloc, l->pin_count, sizeof *p.move),
                .merged = fap_mem_calloc(l->alloc, l->pin_count, sizeof *p.merged) };
    fap_err err = p.from && p.move && p.merged ? FAP_OK : FAP_E_NOMEM;

    if (err == FAP_OK) {
        collect(y, &p);
        err = warp_open(&y->plate, WARP_THIN_PLATE, (const double(*)[3])p.from, (const double(*)[3])p.move,
                        NULL, p.count, slack, l->alloc);
    }
    fap_mem_free(l->alloc, p.from);
    fap_mem_free(l->alloc, p.move);
    fap_mem_free(l->alloc, p.merged);
    return err == FAP_E_DATA
               ? laying_fail(l, err,
                             "too few landmarks on the face, or all on one line, to lay a template by")
               : err;
}

/* --- sampling --- */

/*
 * The rim of a slit: what the image shows there is one lip or the other, and nobody can tell by it which. The sides of a slit come
 * from what is sampled behind its rim, each from its own.
 */
static int is_at_slit(const yano *y, uint32_t i)
{
    const fap_generic *g = y->l->generic;
    const uint8_t own = g->mask ? g->mask[i] : 0;
    uint8_t across = 0;

    for (uint8_t bit = 1; bit <= FAP_MASK_LID_LOWER_RIGHT; bit = (uint8_t)(bit << 1))
        across |= own & bit ? fap_mask_across(bit) : 0;
    for (uint32_t k = 0; across && k < g->vertex_count; k++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)g->position[i][a] - (double)g->position[k][a], 2);
        if (g->mask[k] & across && d < rim_mm * rim_mm)
            return 1;
    }
    return 0;
}

static void sample(yano *y, uint32_t i)
{
    const laying *l = y->l;
    elastic_pull *p = &y->pull[i];
    double flat[3], move[3], far = 0;
    float at[3];

    unroll(y, l->generic->position[i], flat);
    warp_move(&y->plate, flat, move);
    const double pixel[2] = { flat[0] + move[0], flat[1] + move[1] };
    if (!range_image_sample(&y->image, pixel, at))
        return;
    for (int a = 0; a < 3; a++) {
        p->to[a] = (double)at[a];
        p->normal[a] = (double)l->normal[i][a];
        far += pow((double)at[a] - (double)l->at[i][a], 2);
    }
    if (far > l->cfg->limit_mm * l->cfg->limit_mm)
        return; /* hair, or a hand */
    p->weight = 1;
    y->sampled++;
}

static fap_err sample_all(yano *y)
{
    const fap_err err = laying_find_seen(y->l, &y->axis, y->seen);

    for (uint32_t i = 0; err == FAP_OK && i < y->l->generic->vertex_count; i++)
        if (y->seen[i] && !is_at_slit(y, i))
            sample(y, i);
    if (err == FAP_OK && !y->sampled)
        return laying_fail(y->l, FAP_E_DATA, "nothing was scanned where the landmarks say that the face is");
    return err;
}

/* --- the whole --- */

static fap_err open(yano *y)
{
    const laying *l = y->l;
    const uint32_t n = l->generic->vertex_count;

    y->axis = cylinder_around(l->generic->position, n);
    y->seen = fap_mem_calloc(l->alloc, n, 1);
    y->pull = fap_mem_calloc(l->alloc, n, sizeof *y->pull);
    if (!y->seen || !y->pull)
        return FAP_E_NOMEM;
    const fap_err err = range_image_open(&y->image, l);
    return err == FAP_OK ? range_image_fill(&y->image, FILL_ROUNDS, l->alloc) : err;
}

static void close(yano *y)
{
    const fap_allocator *a = y->l->alloc;

    range_image_close(&y->image, a);
    warp_close(&y->plate, a);
    fap_mem_free(a, y->seen);
    fap_mem_free(a, y->pull);
}

fap_err laying_yano(laying *l)
{
    yano y = { .l = l };
    fap_err err = laying_bend(l, WARP_BIHARMONIC, 3 * l->cfg->pin_error_mm * l->cfg->pin_error_mm);

    for (int step = 0; step < l->cfg->subdivisions && err == FAP_OK; step++)
        err = laying_subdivide(l, 1);
    if (err == FAP_OK)
        err = open(&y);
    if (err == FAP_OK)
        err = laying_progress(l, 0.4);
    if (err == FAP_OK)
        err = open_plate(&y);
    if (err == FAP_OK)
        err = sample_all(&y);
    if (err == FAP_OK)
        err = laying_progress(l, 0.8);
    if (err == FAP_OK)
        err = laying_sew(l, y.pull);
    if (err == FAP_OK)
        laying_bring_inside(l);
    if (err == FAP_OK && y.image.filled)
        laying_note(l, "%u samples of the range image were filled from around them",
                    (unsigned)y.image.filled);
    close(&y);
    return err;
}
