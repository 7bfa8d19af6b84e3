/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A take on its way to FAPs. Each step has a file of its own, fills its part of the struct and writes its
 * part of the report; capture.c calls them in order.
 */
#ifndef LIB_CAPTURE_PERFORMANCE_H
#define LIB_CAPTURE_PERFORMANCE_H

#include <fap/studio/capture.h>

#include "capture/on_face.h"
#include "capture/rigid.h"

typedef struct performance {
    const fap_capture_config *cfg;
    fap_capture_report *report;
    char *where;    /* FAP_ERROR_TEXT_SIZE bytes */
    fap_take *take; /* cropped, cleaned, at the rate of the FAPs; axes of the file */
    uint32_t frames;
    fap_clean_point *cleaned; /* [take points] */

    /* head.c: where the head is */
    rigid_body body;
    int has_body;
    rigid_pose *pose; /* [frames] */
    uint8_t *posed;   /* [frames] */

    /* neutral.c: the face at rest, as it stood then */
    rigid_pose rest;
    double (*place)[3]; /* [take points], take axes */
    uint8_t *placed;

    /* axes.c: rows are the head's x, y, z in take axes */
    double axes[3][3];

    /* points.c: feature points without head motion, head axes */
    float (*point)[FAP_POINT_COUNT][3]; /* [frames] */
    uint8_t (*seen)[FAP_POINT_COUNT];   /* [frames], a fap_sample each */
    float neutral[FAP_POINT_COUNT][3];
    uint8_t known[FAP_POINT_COUNT];

    /* on_face.c, retarget.c: markers on the bank's face, and how each feature point came to its motion */
    on_face face;
    fap_capture_origin origin[FAP_POINT_COUNT];

    fap_frame *out; /* [frames] */
} performance;

fap_err performance_fail(performance *p, fap_err err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));
void performance_note(performance *p, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Markers without a name that means something, by where they lie; roles that are given stay. */
fap_err unlabelled_map(performance *p);
/* Which markers are rigid, and the head's pose in every frame. */
fap_err head_find(performance *p);
/* A point of the take with the head's motion taken out, as if it were posed at @p rest. 0: not seen. */
int head_still(const performance *p, uint32_t frame, uint32_t point, double out[3]);

/* The feature point that carries the head instead of the rigid markers; -1: none. */
int head_carrier(const performance *p);

fap_err neutral_find(performance *p);
fap_err axes_find(performance *p);
/* Rings of markers get feature points by where they lie. */
void rings_assign(performance *p);
/* Feature points of all frames and of the neutral face. */
void points_place(performance *p);
/* Long gaps, when asked for: by the bank, then with ease. */
fap_err points_by_bank(performance *p);
void points_ease(performance *p);
fap_err fapu_settle(performance *p);
void faps_extract(performance *p);
/* Why it is not sent; static. */
const char *reason_for(const performance *p, int fap);

/* A place at rest in head axes; 0 when it has none. */
int head_place(const performance *p, uint32_t point, float out[3]);
/* How far it is from there in a frame, head axes; a fap_sample. */
int marker_moved(const performance *p, uint32_t frame, uint32_t point, float out[3]);
/* The bank, once; then where the markers are on its face. */
fap_err face_open(performance *p);
void face_place_markers(performance *p);
void face_close(performance *p);
/* Feature points without a marker of their own, from those around them. */
fap_err points_retarget(performance *p);
/* Inner lips from outer ones; after points_retarget(). */
void lips_derive(performance *p);
/* Pupils that can be believed; after points_retarget(). */
void gaze_settle(performance *p);
/* The mean of a feature point's markers at rest, take axes; 0 when one of them has no place. */
int neutral_point(const performance *p, int feature_point, double out[3]);

#endif
