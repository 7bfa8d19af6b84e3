/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Motion of the feature points that no marker sits on, out of the markers around them. Every marker has its spot on the
 * skin of the bank's face; a feature point is a place on that skin too, and what happens there is mixed from the markers
 * of its neighbourhood, never across the mouth's slit. A point without a marker of its own region near by stays unknown:
 * the cheek is not what the mouth's corner does. Source: Sanchez Lorenzo et al. 2003, sections 4.3 and 5.1.
 */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "capture/performance.h"
#include "capture/rbf.h"

static const double typical_es_mm = 62;
/* A headband's marker is above the skin and says nothing about it. */
static const double off_skin_mm = 15;
/* A marker that lands this near to its point is on it. */
static const double on_point_mm = 3;
/* Two markers on opposite sides may be this many times as far away as one alone. */
static const double between = 1.8;

/* How far a single marker speaks for the skin of a region, on a face of typical size; 0: it does not. */
static double region_reach_mm(int point)
{
    switch (fap_point_get(point)->group) {
    case 2: return fap_point_get(point)->index == 10 ? 12 : 0;
    case 4: return 14;
    case 5: return 16;
    case 8: return fap_point_get(point)->index <= 8 ? 14 : 0;
    case 9: return fap_point_get(point)->index <= 3 ? 8 : 0;
    default: return 0;
    }
}

/* --- centres --- */

/* The feature point of a marker, -1: none. */
static int point_of(const performance *p, uint32_t marker)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_marker_source *s = &p->report->markers.point[i];
        for (int k = 0; k < s->count; k++)
            if (s->index[k] == (int16_t)marker)
                return i;
    }
    return -1;
}

/* Lids, pupils, tongue and teeth move apart from the skin around them. */
static int is_skin(int point)
{
    if (point < 0)
        return 1;
    const int group = fap_point_get(point)->group, index = fap_point_get(point)->index;
    return !(group == 3 && index <= 6) && group != 6 && group != 10 &&
           !(group == 9 && index >= 8 && index <= 11);
}

typedef struct skin {
    rbf_centre *centre; /* [points of the take] */
    int16_t *point;     /* [points of the take]: feature point, -1 none */
    double size;        /* of the bank's face, 1: typical */
} skin;

static int skin_open(const performance *p, skin *s)
{
    const uint32_t n = p->take->point_count;

    s->size = fap_bank_fapu(p->face.bank)->es_mm / typical_es_mm;
    s->centre = fap_mem_calloc(&p->take->alloc, n, sizeof *s->centre);
    s->point = fap_mem_calloc(&p->take->alloc, n, sizeof *s->point);
    if (!s->centre || !s->point)
        return 0;
    for (uint32_t i = 0; i < n; i++) {
        const face_spot *spot = &p->face.spot[i];
        s->point[i] = (int16_t)point_of(p, i);
        s->centre[i].side = spot->side;
        s->centre[i].use = spot->known && spot->off_mm < off_skin_mm * s->size && is_skin(s->point[i]) &&
                           !(p->report->markers.role[i] & FAP_MARKER_INSIDE);
        memcpy(s->centre[i].at, spot->at, sizeof spot->at);
    }
    return 1;
}

static void skin_close(const performance *p, skin *s)
{
    fap_mem_free(&p->take->alloc, s->centre);
    fap_mem_free(&p->take->alloc, s->point);
}

/* --- what is determined --- */

static void place_of(const performance *p, int point, double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = fap_bank_point_get(p->face.bank, point)->position_mm[axis];
}

static int speaks_for(const skin *s, uint32_t marker, int point)
{
    const int own = s->point[marker];
    const uint8_t lip = fap_mask_of_point(point);

    if (lip && !(s->centre[marker].side & lip) && fap_point_get(point)->group == 8 && own < 0)
        return 0;
    return own < 0 || fap_point_get(own)->group == fap_point_get(point)->group;
}

/* Do the directions from the place to two markers point apart? */
static int is_apart(const rbf_centre *a, const rbf_centre *b, const double at[3])
{
    double product = 0;

    for (int axis = 0; axis < 3; axis++)
        product += (a->at[axis] - at[axis]) * (b->at[axis] - at[axis]);
    return product < 0;
}

/* One marker of the region near by, or two a little further with the point between them. */
static int is_determined(const skin *s, const rbf_mix *m, int point, const double at[3])
{
    const double reach = region_reach_mm(point) * s->size;
    const rbf_centre *first = NULL;

    for (uint32_t i = 0; i < m->count; i++) {
        const rbf_centre *c = &s->centre[m->centre[i]];
        if (m->distance[i] > between * reach || !speaks_for(s, m->centre[i], point))
            continue;
        if (m->distance[i] <= reach || (first && is_apart(first, c, at)))
            return 1;
        if (!first)
            first = c;
    }
    return 0;
}

static int sits_on_point(const performance *p, int point)
{
    const fap_marker_source *s = &p->report->markers.point[point];
    double at[3], square = 0;

    if (!s->near)
        return 1;
    if (s->count != 1 || !p->face.spot[s->index[0]].known)
        return 0;
    place_of(p, point, at);
    for (int axis = 0; axis < 3; axis++)
        square += pow(p->face.spot[s->index[0]].at[axis] - at[axis], 2);
    return square < on_point_mm * on_point_mm;
}

/* --- motion --- */

static int sees_all(const performance *p, const rbf_mix *m, uint32_t frame)
{
    static const double matters = 0.02;
    float v[3];

    for (uint32_t i = 0; i < m->count; i++)
        if (fabs(m->weight[i]) > matters && !marker_moved(p, frame, m->centre[i], v))
            return 0;
    return 1;
}

/* The mix without the markers that are hidden. */
static void mix_of_seen(const performance *p, skin *s, uint32_t frame, int point, rbf_mix *out)
{
    double at[3];
    float v[3];

    place_of(p, point, at);
    rbf_mix_at(out, s->centre, p->take->point_count, at, fap_mask_of_point(point));
    for (uint32_t i = 0; i < out->count; i++)
        s->centre[out->centre[i]].use = marker_moved(p, frame, out->centre[i], v) != 0;
    const rbf_mix whole = *out;
    rbf_mix_at(out, s->centre, p->take->point_count, at, fap_mask_of_point(point));
    for (uint32_t i = 0; i < whole.count; i++)
        s->centre[whole.centre[i]].use = 1;
    if (!is_determined(s, out, point, at))
        out->count = 0;
}

static int move(const performance *p, const rbf_mix *m, uint32_t frame, float out[3])
{
    int origin = FAP_SAMPLE_MISSING;
    double sum[3] = { 0 };

    for (uint32_t i = 0; i < m->count; i++) {
        float v[3];
        const int sample = marker_moved(p, frame, m->centre[i], v);
        if (!sample)
            continue;
        origin = sample > origin && fabs(m->weight[i]) > 0.1 ? sample : origin;
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += m->weight[i] * (double)v[axis];
    }
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)sum[axis];
    return m->count && origin == FAP_SAMPLE_MISSING ? FAP_SAMPLE_MEASURED : origin;
}

static void interpolate(performance *p, skin *s, int point, const rbf_mix *m)
{
    for (uint32_t f = 0; f < p->frames; f++) {
        rbf_mix now = *m;
        if (!p->posed[f]) {
            p->seen[f][point] = FAP_SAMPLE_MISSING;
            continue;
        }
        if (!sees_all(p, m, f))
            mix_of_seen(p, s, f, point, &now);
        if (now.count)
            p->seen[f][point] = (uint8_t)move(p, &now, f, p->point[f][point]);
        else if (p->seen[f][point] != FAP_SAMPLE_BANK)
            p->seen[f][point] = FAP_SAMPLE_MISSING;
    }
}

/* --- the account --- */

/* The markers that count most. */
static void name_markers(fap_capture_origin *o, const rbf_mix *m)
{
    uint8_t taken[RBF_MOST] = { 0 };

    for (o->marker_count = 0; o->marker_count < FAP_CAPTURE_MARKERS && o->marker_count < m->count;) {
        uint32_t best = m->count;
        for (uint32_t i = 0; i < m->count; i++)
            if (!taken[i] && (best == m->count || fabs(m->weight[i]) > fabs(m->weight[best])))
                best = i;
        if (o->marker_count && fabs(m->weight[best]) < 0.05)
            break;
        taken[best] = 1;
        o->marker[o->marker_count] = (int16_t)m->centre[best];
        o->share[o->marker_count++] = (float)m->weight[best];
    }
}

static void name_direct(const performance *p, fap_capture_origin *o, int point)
{
    const fap_marker_source *s = &p->report->markers.point[point];

    o->how = FAP_HOW_DIRECT;
    o->marker_count = s->count < FAP_CAPTURE_MARKERS ? s->count : FAP_CAPTURE_MARKERS;
    for (int k = 0; k < o->marker_count; k++) {
        o->marker[k] = s->index[k];
        o->share[k] = 1.0f / s->count;
    }
}

/* --- the whole --- */

static void retarget_point(performance *p, skin *s, int point)
{
    fap_capture_origin *o = &p->origin[point];
    double at[3];
    rbf_mix m;

    if (p->known[point])
        name_direct(p, o, point);
    if ((p->known[point] && sits_on_point(p, point)) || !region_reach_mm(point) ||
        !fap_bank_point_get(p->face.bank, point)->present)
        return;
    place_of(p, point, at);
    rbf_mix_at(&m, s->centre, p->take->point_count, at, fap_mask_of_point(point));
    if (!is_determined(s, &m, point, at))
        return;
    interpolate(p, s, point, &m);
    p->known[point] = 1;
    o->how = FAP_HOW_RBF;
    name_markers(o, &m);
}

fap_err points_retarget(performance *p)
{
    const fap_err err = face_open(p);
    skin s = { 0 };

    if (err != FAP_OK)
        return err;
    face_place_markers(p);
    const int ok = skin_open(p, &s);
    for (int i = 0; i < FAP_POINT_COUNT && ok; i++)
        if (p->face.scale > 0)
            retarget_point(p, &s, i);
        else if (p->known[i])
            name_direct(p, &p->origin[i], i);
    skin_close(p, &s);
    if (!ok)
        return FAP_E_NOMEM;
    if (p->face.scale > 0)
        lips_derive(p);
    return FAP_OK;
}
