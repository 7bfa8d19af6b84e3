/* SPDX-License-Identifier: BSD-2-Clause */
/* A face being laid: what all methods start from, in the generic face's axes and size. */
#ifndef LIB_REGISTRATION_LAYING_H
#define LIB_REGISTRATION_LAYING_H

#include <fap/studio/registration.h>

#include "capture/rigid.h"
#include "registration/cylinder.h"
#include "registration/elastic.h"
#include "registration/loop.h"
#include "registration/warp.h"
#include "surface/edges.h"
#include "surface/nearest.h"

/* A pin whose place in the scan has been brought over. */
typedef struct laid_pin {
    uint32_t vertex[3];
    double share[3], at[3], weight; /* weight 0: contradicted by the others */
} laid_pin;

typedef struct laying {
    const fap_generic *generic;
    const fap_registration_config *cfg;
    const fap_allocator *alloc;
    fap_registration_report *report;
    char *where;
    rigid_pose pose; /* generic = pose of (scan * scale) */
    double scale;
    /* The scan. */
    const fap_surface *surface; /* as it came */
    uint32_t scan_vertices, scan_triangles;
    float (*scan)[3], (*scan_normal)[3];
    const uint32_t (*scan_triangle)[3];
    uint8_t *scan_border; /* 1: on an edge of one triangle */
    surface_index *index;
    laid_pin *pin;
    uint32_t pin_count;
    /* The generic face. */
    fap_generic fine_generic; /* where it was subdivided: what l->generic is, and ... */
    loop_mesh rest;           /* ... its arrays */
    surface_edges edges;
    float (*at)[3], (*normal)[3]; /* laid so far */
} laying;

static inline int laying_is_skin(const laying *l, uint32_t vertex)
{
    return !l->generic->part || l->generic->part[vertex] == FAP_PART_SKIN;
}
/* Where a pin's place on the generic face is, by @p at. */
void laying_pin_place(const laid_pin *pin, const float (*at)[3], double place[3]);
/* @return FAP_E_END where the caller wants no more. */
fap_err laying_progress(const laying *l, double done);
void laying_note(const laying *l, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* Eyes, teeth, tongue, lashes: turned, moved and scaled as the skin around them was. */
void laying_bring_inside(laying *l);

/*
 * l->at: the generic face where the pins bend it. @slack: how far off, squared, they may stay; then too few of them bend nothing, and
 * without it FAP_E_DATA is noted and returned.
 */
fap_err laying_bend(laying *l, warp_kernel kernel, double slack);
/*
 * One step of Loop's scheme, or @flat one-to-four without rounding: l->generic is a finer one from then on, whose first vertices
 * are those of the one before.
 */
fap_err laying_subdivide(laying *l, int flat);
/* [vertices] 1: skin of the generic face that nothing of it is in front of, seen from outside towards the axis. */
fap_err laying_find_seen(const laying *l, const cylinder *axis, uint8_t *seen);
/* Skin goes where it is pulled (weight 0: nowhere), and the rest of it bends along from where it is, as little as it must. */
fap_err laying_sew(laying *l, const elastic_pull *pull);
fap_err laying_fail(const laying *l, fap_err err, const char *text);

/* The methods: l->at, from where the generic face is. */
fap_err laying_auto(laying *l);
fap_err laying_zhu(laying *l);
fap_err laying_yano(laying *l);
fap_err laying_lorenzo(laying *l);

#endif
