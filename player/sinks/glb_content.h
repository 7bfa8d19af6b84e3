/* SPDX-License-Identifier: BSD-2-Clause */
/* A face and its motion as glTF: one mesh with morph targets, joints, one animation. */
#ifndef PLAYER_SINKS_GLB_CONTENT_H
#define PLAYER_SINKS_GLB_CONTENT_H

#include <stdio.h>

#include "player/sinks/glb_rig.h"
#include "player/sinks/glb_shape.h"

/* What moves: frame after frame. */
typedef struct glb_track {
    uint32_t frame_count;
    int target_count;
    float *time_s;                 /* [frame_count] */
    float *weight;                 /* [frame_count][target_count] */
    float (*turn[JOINT_COUNT])[4]; /* [frame_count]: quaternions x y z w against the parent */
    float (*move[JOINT_COUNT])[3]; /* [frame_count]: metres from where the joint rests */
} glb_track;

/* 0: no memory. Close in either case. */
int glb_track_open(glb_track *t, uint32_t frame_count, int target_count);
void glb_track_close(glb_track *t);
void glb_track_set(glb_track *t, uint32_t frame, double time_s, const glb_motion motion[JOINT_COUNT]);

/* Bytes of a file, roughly and rather too many: known before anything is posed. */
double glb_estimate(const fap_bank *bank, int64_t frame_count);
/* What is said of a file, and what lies on the skin. */
typedef struct glb_about {
    const char *generator;
    double worst_mm, rms_mm;
    const uint8_t *texture; /* a PNG file; NULL: the face has its own colours */
    size_t texture_size;
} glb_about;

/* Writes the file. @return 0: no memory, or @out has its error set. */
int glb_write_face(const glb_rig *rig, const glb_shape *shape, const glb_track *track, const glb_about *about,
                   FILE *out);

#endif
