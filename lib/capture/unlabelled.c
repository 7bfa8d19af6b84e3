/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Takes whose labels mean nothing: the bank's face is looked for among the points, and each of its feature points takes the
 * point that is nearest to it, one to one. Lids and inner lips are only believed where a point is right on them: a marker
 * below the eye is not a lid. What does not convince is refused, since a face mapped wrongly moves wrongly.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "capture/cloud.h"
#include "capture/performance.h"

/* How often markers are put there, against other places; and how far from it one may be, millimetres of the face. */
typedef struct habit {
    double share, gate_mm;
} habit;

static habit habit_of(int point)
{
    static const habit never = { 0, 0 }, usual = { 1, 18 }, rare = { 0.3, 8 }, hardly = { 0.15, 4 },
                       lid = { 0.15, 6 }, elsewhere = { 1, 10 };
    if (point < 0)
        return elsewhere;
    const int group = fap_point_get(point)->group, index = fap_point_get(point)->index;

    switch (group) {
    case 2:
        return index == 10                                ? usual
               : index == 1 || index == 11 || index == 12 ? rare
               : index > 12                               ? never
                                                          : hardly;
    case 3:
        return index == 5 || index == 6                 ? never
               : index < 5                              ? lid
               : index == 7 || index == 8 || index > 10 ? rare
                                                        : hardly;
    case 4:
    case 5: return usual;
    case 8: return index <= 8 ? usual : hardly;
    case 9: return index <= 3 ? usual : index == 12 || index == 15 ? rare : never;
    default: return never;
    }
}

/* Where markers are often put although no feature point is there: between two of them, and off by so much. Right side: mirrored. */
static const struct place {
    const char *a, *b;
    double share; /* of b */
    double by[3];
} places[] = {
    { "3.3", "5.3", 0.4, { 0, 0, 0 } },   /* below the eye */
    { "3.1", "4.3", 0.5, { 0, 0, 0 } },   /* above it */
    { "4.3", "4.3", 0, { 0, 25, -8 } },   /* forehead */
    { "5.3", "5.3", 0, { 13, -8, -25 } }, /* before the ear */
    { "4.1", "4.2", 0.5, { 0, 28, -3 } }, /* forehead, middle */
    { "4.1", "4.2", 0.5, { 0, 0, 0 } },   /* between the brows */
};

enum { PLACES = sizeof places / sizeof *places, MIDDLE_PLACES = 2 };

static int is_usual(int point)
{
    return point >= 0 && habit_of(point).share > 0.5;
}

/* The points of one frame. */
typedef struct cloud {
    uint32_t frame, count;
    double (*at)[3], (*face)[3];
    uint32_t *point; /* of the take */
} cloud;

static int open_cloud(const performance *p, cloud *c)
{
    const fap_allocator *a = &p->take->alloc;

    c->at = fap_mem_calloc(a, p->take->point_count, sizeof *c->at);
    c->face = fap_mem_calloc(a, p->take->point_count, sizeof *c->face);
    c->point = fap_mem_calloc(a, p->take->point_count, sizeof *c->point);
    return c->at && c->face && c->point;
}

static void close_cloud(const performance *p, cloud *c)
{
    const fap_allocator *a = &p->take->alloc;

    fap_mem_free(a, c->at);
    fap_mem_free(a, c->face);
    fap_mem_free(a, c->point);
}

static uint32_t seen_in(const performance *p, uint32_t frame)
{
    uint32_t seen = 0;

    for (uint32_t i = 0; i < p->take->point_count; i++)
        seen += fap_take_sample(p->take, frame, i) != NULL;
    return seen;
}

/* A point that the user has named is not asked for again. */
static void fill_cloud(const performance *p, uint32_t frame, cloud *c)
{
    c->frame = frame;
    c->count = 0;
    for (uint32_t i = 0; i < p->take->point_count; i++) {
        const float *at = fap_take_sample(p->take, frame, i);
        if (!at || p->report->markers.role[i])
            continue;
        for (int axis = 0; axis < 3; axis++)
            c->at[c->count][axis] = at[axis];
        c->point[c->count++] = i;
    }
}

/* --- the moment --- */

enum { MOMENTS = 8 };

/* Frames over the take in which most points are seen. */
static int list_moments(const performance *p, uint32_t out[MOMENTS])
{
    uint32_t most = 0, good = 0, listed = 0;

    for (uint32_t f = 0; f < p->frames; f++)
        most = seen_in(p, f) > most ? seen_in(p, f) : most;
    for (uint32_t f = 0; f < p->frames; f++)
        good += seen_in(p, f) >= most - most / 20;
    for (uint32_t f = 0, k = 0; f < p->frames && listed < MOMENTS; f++) {
        if (seen_in(p, f) < most - most / 20)
            continue;
        if ((uint64_t)k * MOMENTS >= (uint64_t)listed * good)
            out[listed++] = f;
        k++;
    }
    return (int)listed;
}

/* Found in one moment, followed through the others; the one that is most like the face at rest stays. */
static int find_face(const performance *p, const cloud_model *model, cloud *c, cloud_fit *fit)
{
    uint32_t moment[MOMENTS], best = 0;
    const int count = list_moments(p, moment);

    if (!count)
        return 0;
    fill_cloud(p, moment[0], c);
    if (!cloud_align(model, (const double(*)[3])c->at, c->count, fit))
        return 0;
    for (int i = 1; i < count; i++) {
        cloud_fit now = *fit;
        fill_cloud(p, moment[i], c);
        cloud_refine(model, (const double(*)[3])c->at, c->count, &now);
        if (now.likelihood <= fit->likelihood)
            continue;
        now.rival = fit->rival;
        *fit = now;
        best = (uint32_t)i;
    }
    fill_cloud(p, moment[best], c);
    return 1;
}

/* --- which is which --- */

static void add_feature(cloud_model *model, int point, const double at[3])
{
    model->point[model->count] = point;
    model->share[model->count] = habit_of(point).share;
    memcpy(model->at[model->count++], at, sizeof *model->at);
}

static void add_place(const performance *p, cloud_model *model, const struct place *place, int right)
{
    const int left_a = fap_point_by_name(place->a), left_b = fap_point_by_name(place->b);
    const fap_bank_point *a =
        fap_bank_point_get(p->face.bank, right ? fap_point_get(left_a)->mirror : left_a);
    const fap_bank_point *b =
        fap_bank_point_get(p->face.bank, right ? fap_point_get(left_b)->mirror : left_b);
    double at[3];

    for (int axis = 0; axis < 3; axis++)
        at[axis] = (1 - place->share) * (double)a->position_mm[axis] +
                   place->share * (double)b->position_mm[axis] + (right && !axis ? -1 : 1) * place->by[axis];
    if (a->present && b->present && model->count < FAP_POINT_COUNT)
        add_feature(model, -1, at);
}

static void make_model(const performance *p, cloud_model *model)
{
    model->count = 0;
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_bank_point *b = fap_bank_point_get(p->face.bank, i);
        if (b->present && habit_of(i).share > 0)
            add_feature(model, i,
                        (const double[3]){ b->position_mm[0], b->position_mm[1], b->position_mm[2] });
    }
    for (int i = 0; i < PLACES; i++)
        for (int right = 0; right < (i < PLACES - MIDDLE_PLACES ? 2 : 1); right++)
            add_place(p, model, &places[i], right);
}

static int feature_of(const cloud_model *model, const char *point)
{
    for (int m = 0; m < model->count; m++)
        if (model->point[m] == fap_point_by_name(point))
            return m;
    return -1;
}

/* Lids are near one another; two dots above and below an eye are not. One lid alone cannot be told from skin. */
static void doubt_lids(const cloud_model *model, const cloud *c, int *index)
{
    static const char *const lids[][2] = { { "3.1", "3.3" }, { "3.2", "3.4" } };
    static const double most_open = 1.5;

    for (size_t i = 0; i < sizeof lids / sizeof *lids; i++) {
        const int upper = feature_of(model, lids[i][0]), lower = feature_of(model, lids[i][1]);
        if (upper < 0 || lower < 0)
            continue;
        const double open_mm = model->at[upper][1] - model->at[lower][1];
        if (index[upper] >= 0 && index[lower] >= 0 &&
            c->face[index[upper]][1] - c->face[index[lower]][1] < most_open * open_mm)
            continue;
        index[upper] = index[lower] = -1;
    }
}

/* Lips that touch are in one place: the upper one of two points is the upper lip's. */
static void order_lips(const cloud_model *model, const cloud *c, int *index)
{
    static const char *const facing[][2] = { { "2.2", "2.3" }, { "2.6", "2.8" }, { "2.7", "2.9" } };

    for (size_t i = 0; i < sizeof facing / sizeof *facing; i++) {
        const int at[2] = { feature_of(model, facing[i][0]), feature_of(model, facing[i][1]) };
        if (at[0] < 0 || at[1] < 0 || index[at[0]] < 0 || index[at[1]] < 0 ||
            c->face[index[at[0]]][1] >= c->face[index[at[1]]][1])
            continue;
        const int upper = index[at[1]];
        index[at[1]] = index[at[0]];
        index[at[0]] = upper;
    }
}

static void give_point(performance *p, int point, uint32_t marker)
{
    fap_markers *map = &p->report->markers;

    map->point[point] = (fap_marker_source){ .count = 1, .near = 1, .index = { (int16_t)marker } };
    map->role[marker] = FAP_MARKER_POINT;
    map->used++;
    p->report->fitted++;
    p->report->fitted_usual += is_usual(point) != 0;
}

static fap_err assign(performance *p, cloud_model *model, cloud *c, const cloud_fit *fit)
{
    double gate[FAP_POINT_COUNT], square = 0;
    const cloud_model rest = *model;
    int index[FAP_POINT_COUNT];

    for (uint32_t i = 0; i < c->count; i++)
        cloud_to_face(fit, c->at[i], c->face[i]);
    cloud_bend(model, (const double(*)[3])c->face, c->count);
    for (int m = 0; m < model->count; m++)
        gate[m] = habit_of(model->point[m]).gate_mm;
    if (!cloud_assign(model, (const double(*)[3])c->face, c->count, gate, index, &p->take->alloc))
        return FAP_E_NOMEM;
    order_lips(model, c, index);
    doubt_lids(&rest, c, index);
    for (int m = 0; m < model->count; m++) {
        if (index[m] < 0 || model->point[m] < 0)
            continue;
        give_point(p, model->point[m], c->point[index[m]]);
        for (int axis = 0; axis < 3; axis++)
            square += pow(c->face[index[m]][axis] - model->at[m][axis], 2);
    }
    p->report->fit_mm = p->report->fitted ? sqrt(square / p->report->fitted) : 0;
    return FAP_OK;
}

/* --- does it convince? --- */

static fap_err judge(performance *p, const cloud *c, const cloud_fit *fit)
{
    static const double least_lead = 0.15, most_mm = 8, least_size = 0.4, most_size = 2.5;
    enum { LEAST_USUAL = 12 };
    const fap_capture_report *r = p->report;
    const double lead = fit->likelihood - fit->rival;
    const double time_s = p->cfg->start_s + c->frame / r->rate_hz;
    const int is_sized = fit->scale > least_size && fit->scale < most_size;

    if (!is_sized || r->fitted_usual < LEAST_USUAL || r->fit_mm > most_mm)
        return performance_fail(
            p, FAP_E_NOT_FOUND,
            "no label is known, and the face does not fit the %u points at %.2f s: %u of them are "
            "near a feature point, %.1f mm off. Name them with --markers FILE",
            (unsigned)c->count, time_s, (unsigned)r->fitted, r->fit_mm);
    if (lead < least_lead)
        return performance_fail(
            p, FAP_E_NOT_FOUND,
            "no label is known, and the face fits the %u points at %.2f s in more than one way. Name some "
            "with --markers FILE",
            (unsigned)c->count, time_s);
    performance_note(p,
                     "no label is known: %u of %u points were mapped by fitting the face to those at %.2f s, "
                     "%.1f mm RMS off; see --plot, and --markers to correct it",
                     (unsigned)r->fitted, (unsigned)p->take->point_count, time_s, r->fit_mm);
    return FAP_OK;
}

fap_err unlabelled_map(performance *p)
{
    cloud c = { 0 };
    cloud_model model;
    cloud_fit fit;
    fap_err err = face_open(p);

    if (err != FAP_OK)
        return err;
    if (!open_cloud(p, &c)) {
        close_cloud(p, &c);
        return FAP_E_NOMEM;
    }
    make_model(p, &model);
    if (!find_face(p, &model, &c, &fit))
        err = performance_fail(
            p, FAP_E_NOT_FOUND,
            "no label is known, and %u points are too few to find a face among them. Name them with "
            "--markers FILE",
            (unsigned)p->take->point_count);
    if (err == FAP_OK)
        err = assign(p, &model, &c, &fit);
    if (err == FAP_OK)
        err = judge(p, &c, &fit);
    close_cloud(p, &c);
    return err;
}
