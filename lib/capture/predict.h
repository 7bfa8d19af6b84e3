/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Where a hidden point of a take is, as others tell that are in sight. One file a method, one const struct in it.
 * Everything is said in coordinates from which most of the head's motion is gone: see scene_still().
 */
#ifndef LIB_CAPTURE_PREDICT_H
#define LIB_CAPTURE_PREDICT_H

#include <fap/studio/clean.h>

#include "capture/rigid.h"

/* A take whose head stands still. */
typedef struct scene {
    const fap_take *take;
    rigid_pose *pose;                 /* [frames]; NULL: the take as it is */
    uint8_t *posed;                   /* [frames] */
    rigid_body body;                  /* what the pose is taken from: all points */
    uint8_t in_use[RIGID_MAX_POINTS]; /* but those that scene_focus() found hidden */
} scene;

/* Frames, first and last included. */
typedef struct span {
    uint32_t first, last;
} span;

/* FAP_OK or FAP_E_NOMEM. */
fap_err scene_open(scene *s, const fap_take *take);
void scene_close(scene *s);
/*
 * From now on the pose is taken from points that are seen throughout @p hidden, in all frames: otherwise it would jump
 * where one of them goes and comes back, and the gap's edges would not fit what is filled in.
 */
void scene_focus(scene *s, span hidden);
/* A point without the head's motion; 0: it, or the head, is not seen in that frame. */
int scene_still(const scene *s, uint32_t frame, uint32_t point, double out[3]);
/* And with the motion again; 0: the head is not seen. */
int scene_back(const scene *s, uint32_t frame, const double still[3], double out[3]);

enum { MAX_WITNESSES = 12 };

/* A point that is hidden for a while, and points that are not, the nearest first. */
typedef struct gap {
    const scene *scene;
    uint32_t point;
    span hidden; /* what is to be predicted: never learnt from, even where it is seen */
    uint32_t count;
    uint16_t witness[MAX_WITNESSES];
} gap;

/* Finds the witnesses of gap->hidden: measured, or closed by a spline, in all of its frames. */
void gap_call_witnesses(gap *g);
/* May the frame teach: the point is measured in it and the frame is outside the gap. */
int gap_teaches(const gap *g, uint32_t frame, double out[3]);
/* Frames between two that are looked at when learning. */
uint32_t gap_step(const gap *g, uint32_t most_frames);

typedef struct predictor {
    fap_sample kind;
    size_t state_size;
    /* For the witnesses alone, once for all that is asked of them; NULL: nothing to do. 0: they cannot tell. */
    int (*prepare)(void *state, const gap *g);
    /* For what is hidden. 0: too little to learn from. */
    int (*learn)(void *state, const gap *g);
    int (*at)(const void *state, const gap *g, uint32_t frame, double out[3]);
} predictor;

extern const predictor predictor_rigid, predictor_surface, predictor_motion;

#endif
