/* SPDX-License-Identifier: BSD-2-Clause */
/* See on_face.h. */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "capture/performance.h"
#include "capture/rbf.h"

enum { LEAST_POINTS = 4 };

/* A headband, a bite jig: further from the skin than that, nothing is known about where it would be on another head. */
static const double reach_mm = 25;
/* A marker near a point may be this far from it and still be where it says. */
static const double near_mm = 6, near_weight = 0.25;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void minus(const double a[3], const double b[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = a[axis] - b[axis];
}

/* --- the skin --- */

static void vertex_place(const fap_mesh *mesh, uint32_t v, double out[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = mesh->position[axis * mesh->stride + v];
}

static double clamp01(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* Shares of the ends of the edge from a to b in its point nearest to @p at. */
static void on_edge(const double a[3], const double b[3], const double at[3], double share[2])
{
    double ab[3], ap[3];

    minus(b, a, ab);
    minus(at, a, ap);
    const double square = dot(ab, ab), t = square > 0 ? clamp01(dot(ab, ap) / square) : 0;
    share[0] = 1 - t;
    share[1] = t;
}

static double mix(const double corner[3][3], const double share[3], const double at[3], double out[3])
{
    double square = 0;

    for (int axis = 0; axis < 3; axis++) {
        out[axis] = share[0] * corner[0][axis] + share[1] * corner[1][axis] + share[2] * corner[2][axis];
        square += (out[axis] - at[axis]) * (out[axis] - at[axis]);
    }
    return square;
}

/* Barycentric shares of the foot of the perpendicular; 0 when it is not inside. */
static int inside(const double corner[3][3], const double at[3], double share[3])
{
    double u[3], v[3], w[3];

    minus(corner[1], corner[0], u);
    minus(corner[2], corner[0], v);
    minus(at, corner[0], w);
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
    const double area = uu * vv - uv * uv;
    if (!(area > 1e-12))
        return 0;
    share[1] = (vv * wu - uv * wv) / area;
    share[2] = (uu * wv - uv * wu) / area;
    share[0] = 1 - share[1] - share[2];
    return share[0] >= 0 && share[1] >= 0 && share[2] >= 0;
}

/* Squared distance from the triangle; @p share and @p foot are its nearest point. */
static double nearest_on(const double corner[3][3], const double at[3], double share[3], double foot[3])
{
    double least = INFINITY, two[2], try[3];

    if (inside(corner, at, share))
        return mix(corner, share, at, foot);
    for (int e = 0; e < 3; e++) {
        double s[3] = { 0 };
        on_edge(corner[e], corner[(e + 1) % 3], at, two);
        s[e] = two[0];
        s[(e + 1) % 3] = two[1];
        const double square = mix(corner, s, at, try);
        if (square >= least)
            continue;
        least = square;
        memcpy(share, s, sizeof s);
        memcpy(foot, try, sizeof try);
    }
    return least;
}

/* Beyond the reach in x alone: most triangles are. */
static int is_far(const fap_mesh *mesh, const uint32_t v[3], const double at[3], double reach)
{
    for (size_t axis = 0; axis < 3; axis++) {
        const float *x = mesh->position + axis * mesh->stride;
        const float a = x[v[0]], b = x[v[1]], c = x[v[2]];
        if (fmaxf(a, fmaxf(b, c)) < at[axis] - reach || fminf(a, fminf(b, c)) > at[axis] + reach)
            return 1;
    }
    return 0;
}

int on_face_nearest(const on_face *face, const double at[3], double reach, face_spot *out)
{
    const fap_mesh *mesh = fap_bank_mesh(face->bank);
    double least = reach * reach;

    out->known = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangle + 3 * (size_t)t;
        double corner[3][3], share[3], foot[3];
        if (mesh->part[v[0]] != FAP_PART_SKIN || is_far(mesh, v, at, sqrt(least)))
            continue;
        for (int i = 0; i < 3; i++)
            vertex_place(mesh, v[i], corner[i]);
        const double square = nearest_on((const double(*)[3])corner, at, share, foot);
        if (!(square < least))
            continue;
        least = square;
        *out = (face_spot){ .known = 1, .off_mm = sqrt(square) };
        memcpy(out->at, foot, sizeof foot);
        for (int i = 0; i < 3; i++) {
            out->vertex[i] = v[i];
            out->share[i] = (float)share[i];
            out->side |= share[i] > 0.1 ? face->mask[v[i]] : 0;
        }
    }
    return out->known;
}

/* --- the heads --- */

/* Feature points that the take and the bank both have. */
typedef struct pairs {
    int count, point[FAP_POINT_COUNT];
    double take[FAP_POINT_COUNT][3], bank[FAP_POINT_COUNT][3], weight[FAP_POINT_COUNT];
} pairs;

static int is_on_head(int point)
{
    const int group = fap_point_get(point)->group;
    return group != 6 && group != 7;
}

static void find_pairs(const performance *p, pairs *out)
{
    out->count = 0;
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_bank_point *b = fap_bank_point_get(p->face.bank, i);
        if (!p->known[i] || !b->present || !is_on_head(i))
            continue;
        for (int axis = 0; axis < 3; axis++) {
            out->take[out->count][axis] = p->neutral[i][axis];
            out->bank[out->count][axis] = b->position_mm[axis];
        }
        out->weight[out->count] = p->report->markers.point[i].near ? near_weight : 1;
        out->point[out->count++] = i;
    }
}

/* Root of the weighted sum of squares about the mean. */
static double spread(const double (*at)[3], const double *weight, int n)
{
    double mean[3] = { 0 }, total = 0, sum = 0, from[3];

    for (int i = 0; i < n; i++) {
        total += weight[i];
        for (int axis = 0; axis < 3; axis++)
            mean[axis] += weight[i] * at[i][axis];
    }
    for (int axis = 0; axis < 3; axis++)
        mean[axis] /= total;
    for (int i = 0; i < n; i++) {
        minus(at[i], mean, from);
        sum += weight[i] * dot(from, from);
    }
    return sqrt(sum);
}

static void to_bank(const on_face *f, const double take[3], double out[3])
{
    const double scaled[3] = { f->scale * take[0], f->scale * take[1], f->scale * take[2] };
    rigid_apply(&f->pose, scaled, out);
}

/* 0 when the points are too few, or all on a line. */
static int fit_heads(on_face *f, const pairs *q)
{
    double scaled[FAP_POINT_COUNT][3];

    if (q->count < LEAST_POINTS)
        return 0;
    const double size = spread(q->take, q->weight, q->count);
    if (!(size > 1e-3))
        return 0;
    const double scale = spread(q->bank, q->weight, q->count) / size;
    for (int i = 0; i < q->count; i++)
        for (int axis = 0; axis < 3; axis++)
            scaled[i][axis] = scale * q->take[i][axis];
    if (!rigid_fit((const double(*)[3])scaled, q->bank, q->weight, (uint32_t)q->count, &f->pose))
        return 0;
    f->scale = scale;
    return 1;
}

/* --- the features --- */

/* What the similarity leaves over; a marker near a point keeps its distance from it. */
static void left_over(const on_face *f, const pairs *q, int i, int near, double out[3])
{
    double there[3];

    to_bank(f, q->take[i], there);
    minus(q->bank[i], there, out);
    const double length = sqrt(dot(out, out)), keep = near ? fmax(0, 1 - near_mm / fmax(length, 1e-9)) : 1;
    for (int axis = 0; axis < 3; axis++)
        out[axis] *= keep;
}

typedef struct bend {
    rbf_centre centre[FAP_POINT_COUNT];
    double by[FAP_POINT_COUNT][3];
    uint32_t count;
} bend;

static void find_bend(const performance *p, const pairs *q, bend *out)
{
    out->count = (uint32_t)q->count;
    for (int i = 0; i < q->count; i++) {
        out->centre[i] = (rbf_centre){ .use = 1 };
        to_bank(&p->face, q->take[i], out->centre[i].at);
        left_over(&p->face, q, i, p->report->markers.point[q->point[i]].near, out->by[i]);
    }
}

static void apply_bend(const bend *b, double at[3])
{
    rbf_mix m;
    double by[3] = { 0 };

    rbf_mix_at(&m, b->centre, b->count, at, 0);
    for (uint32_t i = 0; i < m.count; i++)
        for (int axis = 0; axis < 3; axis++)
            by[axis] += m.weight[i] * b->by[m.centre[i]][axis];
    for (int axis = 0; axis < 3; axis++)
        at[axis] += by[axis];
}

/* --- the markers --- */

/* The lip a marker was given for; what lies on a lip tells by itself. */
static uint8_t side_of(const performance *p, uint32_t marker)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_marker_source *s = &p->report->markers.point[i];
        for (int k = 0; k < s->count; k++)
            if (s->index[k] == (int16_t)marker)
                return fap_mask_of_point(i);
    }
    return p->face.spot[marker].side;
}

static void place_marker(performance *p, const bend *b, uint32_t i)
{
    face_spot *spot = &p->face.spot[i];
    float place[3];

    if (!head_place(p, i, place))
        return;
    double at[3] = { place[0], place[1], place[2] }, bent[3];
    to_bank(&p->face, at, bent);
    apply_bend(b, bent);
    if (!on_face_nearest(&p->face, bent, reach_mm, spot)) {
        *spot = (face_spot){ .known = 1, .off_mm = reach_mm };
        memcpy(spot->at, bent, sizeof bent);
    }
    spot->side = side_of(p, i);
}

/* --- the whole --- */

static fap_err open_bank(performance *p)
{
    on_face *f = &p->face;
    const fap_allocator *a = &p->take->alloc;

    f->bank = p->cfg->bank;
    if (!f->bank) {
        const fap_err err = fap_bank_builtin(&f->own, a);
        if (err != FAP_OK)
            return err;
        f->bank = f->own;
    }
    f->mask = fap_mem_calloc(a, fap_bank_mesh(f->bank)->stride, 1);
    f->spot = fap_mem_calloc(a, p->take->point_count, sizeof *f->spot);
    if (!f->mask || !f->spot)
        return FAP_E_NOMEM;
    if (fap_bank_masks(f->bank))
        memcpy(f->mask, fap_bank_masks(f->bank), fap_bank_mesh(f->bank)->stride);
    else if (fap_mask_derive(f->bank, f->mask, a))
        return FAP_E_NOMEM;
    return FAP_OK;
}

fap_err face_open(performance *p)
{
    return p->face.bank ? FAP_OK : open_bank(p);
}

void face_place_markers(performance *p)
{
    pairs q;
    bend b;

    find_pairs(p, &q);
    if (!fit_heads(&p->face, &q))
        return;
    find_bend(p, &q, &b);
    for (uint32_t i = 0; i < p->take->point_count; i++)
        place_marker(p, &b, i);
}

void face_close(performance *p)
{
    if (!p->take)
        return;
    const fap_allocator *a = &p->take->alloc;

    fap_mem_free(a, p->face.mask);
    fap_mem_free(a, p->face.spot);
    fap_bank_close(&p->face.own);
    p->face = (on_face){ 0 };
}
