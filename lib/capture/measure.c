/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The FAPU of the person: measured where the neutral face has the very points of the definition, otherwise
 * typical proportions, scaled by the distances that could be measured. Markers near a point do not measure,
 * they only scale. Source: ISO/IEC 14496-2, Annex C, FAPU definition; fap_tables/proportions.csv.
 */
#include <math.h>

#include "capture/performance.h"
#include "gen/proportions.h"

#define POINT(group, index) group, index

static const struct proportion {
    uint8_t unit, from_group, from_index, to_group, to_index, axis, typical_mm;
} proportions[] = {
#define ROW(unit, fg, fi, tg, ti, axis, mm)                                                                  \
    { FAP_UNIT_##unit, fg, fi, tg, ti, FAP_MOTION_##axis - FAP_MOTION_X, mm },
#define X(...) ROW(__VA_ARGS__)
    PROPORTIONS_ROWS(X)
#undef X
#undef ROW
};

enum { ROWS = sizeof proportions / sizeof *proportions };

/* The pupils are where the eye's corners say, when there is no better. */
static int point_place(const performance *p, int point, float out[3], int *near)
{
    static const struct {
        const char *point, *a, *b;
    } middle[] = { { "3.5", "3.7", "3.11" }, { "3.6", "3.8", "3.12" } };

    if (p->known[point]) {
        *near |= p->report->markers.point[point].near;
        for (int axis = 0; axis < 3; axis++)
            out[axis] = p->neutral[point][axis];
        return 1;
    }
    for (int i = 0; i < 2; i++) {
        const int a = fap_point_by_name(middle[i].a), b = fap_point_by_name(middle[i].b);
        if (point != fap_point_by_name(middle[i].point) || !p->known[a] || !p->known[b])
            continue;
        *near |= p->report->markers.point[a].near | p->report->markers.point[b].near;
        for (int axis = 0; axis < 3; axis++)
            out[axis] = 0.5f * (p->neutral[a][axis] + p->neutral[b][axis]);
        return 1;
    }
    return 0;
}

/* The row's distance on this face; 0 when a point is missing. @p near: measured on markers beside the points.
 */
static float measured(const performance *p, const struct proportion *row, int *near)
{
    float a[3], b[3];

    *near = 0;
    if (!point_place(p, fap_point_index(row->from_group, row->from_index), a, near) ||
        !point_place(p, fap_point_index(row->to_group, row->to_index), b, near))
        return 0;
    const float d = a[row->axis] - b[row->axis];
    return d > 0 ? d : 0;
}

static float *slot(fap_fapu *fapu, int unit)
{
    switch (unit) {
    case FAP_UNIT_IRISD: return &fapu->irisd_mm;
    case FAP_UNIT_ES: return &fapu->es_mm;
    case FAP_UNIT_ENS: return &fapu->ens_mm;
    case FAP_UNIT_MNS: return &fapu->mns_mm;
    case FAP_UNIT_MW: return &fapu->mw_mm;
    default: return NULL;
    }
}

/* The row's distance on the face that proportions are taken from; 0: that face does not have it. */
static double proportion_mm(const performance *p, const struct proportion *row)
{
    if (!p->cfg->bank)
        return row->typical_mm;
    fap_fapu fapu = *fap_bank_fapu(p->cfg->bank);
    const float *unit = slot(&fapu, row->unit);
    const fap_bank_point *a =
        fap_bank_point_get(p->cfg->bank, fap_point_index(row->from_group, row->from_index));
    const fap_bank_point *b = fap_bank_point_get(p->cfg->bank, fap_point_index(row->to_group, row->to_index));
    if (unit)
        return (double)*unit;
    return a->present && b->present ? (double)(a->position_mm[row->axis] - b->position_mm[row->axis]) : 0;
}

/* Across the face, from points if there are any, else from markers near them; the mean of what there is. */
static double find_scale(const performance *p)
{
    for (int allow_near = 0; allow_near < 2; allow_near++) {
        double sum = 0;
        int n = 0;
        for (int i = 0; i < ROWS; i++) {
            int near;
            const float mm = measured(p, &proportions[i], &near);
            const double usual_mm = proportion_mm(p, &proportions[i]);
            /* A mouth is the least reliable measure of a head: markers sit beside its corners. */
            if (mm <= 0 || usual_mm <= 0 || near != allow_near ||
                (near && proportions[i].unit == FAP_UNIT_MW) || proportions[i].unit == FAP_UNIT_IRISD)
                continue;
            sum += mm / usual_mm;
            n++;
        }
        if (n)
            return sum / n;
    }
    return 1;
}

/* Tells when a measure is unlike a face of this size. Lids half closed at rest are no iris: that one is not
 * used. */
static int is_believed(performance *p, const struct proportion *row, float mm)
{
    static const char *const names[] = { "", "IRISD", "ES", "ENS", "MNS", "MW" };
    const double ratio = mm / (proportion_mm(p, row) * p->report->fapu_scale);

    if (ratio >= 0.6 && ratio <= 1.5)
        return 1;
    const int used = row->unit != FAP_UNIT_IRISD;
    performance_note(p,
                     "%s measures %.1f mm, %.2f times what a face of this size usually has%s; --fapu sets it",
                     names[row->unit], (double)mm, ratio, used ? "" : ": not used");
    return used;
}

fap_err fapu_settle(performance *p)
{
    fap_capture_report *r = p->report;
    const fap_origin scaled = p->cfg->bank ? FAP_ORIGIN_BANK : FAP_ORIGIN_SCALED;

    r->fapu_scale = find_scale(p);
    for (int i = 0; i < ROWS; i++) {
        float *out = slot(&r->fapu, proportions[i].unit);
        int near;
        if (!out)
            continue;
        const float mm = measured(p, &proportions[i], &near);
        const int use = mm > 0 && !near && is_believed(p, &proportions[i], mm);
        *out = use ? mm : (float)(proportion_mm(p, &proportions[i]) * r->fapu_scale);
        r->fapu_origin[proportions[i].unit - FAP_UNIT_IRISD] = use ? FAP_ORIGIN_MEASURED : scaled;
    }
    if (p->cfg->fapu) {
        r->fapu = *p->cfg->fapu;
        for (int i = 0; i < 5; i++)
            r->fapu_origin[i] = FAP_ORIGIN_GIVEN;
    }
    const fap_fapu *u = &r->fapu;
    if (!(u->irisd_mm > 0 && u->es_mm > 0 && u->ens_mm > 0 && u->mns_mm > 0 && u->mw_mm > 0))
        return performance_fail(p, FAP_E_ARG, "FAPU must be positive millimetres");
    return FAP_OK;
}
