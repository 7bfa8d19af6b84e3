/* SPDX-License-Identifier: BSD-2-Clause */
/* A stream and a face that plays it: what every picture, film and window is made of. */
#ifndef PLAYER_SCENE_H
#define PLAYER_SCENE_H

#include "player/options.h"
#include "player/report.h"
#include "player/timeline.h"

typedef struct scene {
    timeline line;
    double kbit_s;                   /* of the stream as it was read, on average */
    int32_t farthest[FAP_COUNT + 1]; /* that a FAP goes from 0 */
    fap_fit *fit;
    fap_bank *bank;
    fap_face *face;
    /* The last pose, as fap_face_pose() and fap_face_points() give it. */
    fap_frame frame;
    float *position, *normal; /* normal is NULL where no pictures were asked for */
    float point[FAP_POINT_COUNT][3];
} scene;

/*
 * All return 0 and set the report's fault when they fail, and keep what was there before. What was tolerated becomes a note.
 * The report is told what was loaded.
 */

/* @fit_path: the table for what is not sent; NULL: the one beside the stream, if any. */
int scene_load_stream(scene *s, const char *path, const char *fit_path, play_report *r);
/* @name as find_bank() takes it. The face is opened on it. */
int scene_load_bank(scene *s, const char *name, const fap_face_config *config, int with_normals,
                    play_report *r);
/* The same bank, another way to pose it. */
int scene_open_face(scene *s, const fap_face_config *config, play_report *r);
void scene_free(scene *s);

/* Poses the face as it is at @time_us. @expression: 0, or an expression of FAP 2 instead of the stream's. */
void scene_pose(scene *s, int64_t time_us, int expression, play_report *r);

#endif
