/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The inside of a face, shared by its files: face.c (life and order of work), face_base.c (visemes,
 * expressions, gaze, blink), face_targets.c (what is asked), blend*.c (how it is reached), face_rigid.c (eyes,
 * lids, teeth, tongue, head), face_residual.c (exact points).
 */
#ifndef LIB_BANK_FACE_H
#define LIB_BANK_FACE_H

#include <fap/face.h>

#include "bank/blend.h"
#include "bank/face_normals.h"
#include "bank/least_squares.h"
#include "bank/region.h"
#include "bank/residual.h"
#include "base/lanes.h"
#include "dsp/dsp.h"

enum { FAP_ROWS = FAP_POINT_COUNT * 3, FAP_BASE_MAX = 4, FAP_LIP_SLITS = 3, FAP_SLITS = 5 };

/* Keys with a part of their own, by bank index; -1 where the bank has none. */
typedef struct fap_face_keys {
    int jaw_open, mouth_close, cheek_puff;
    int blink[2], blink_both; /* left, right; the extra key of both */
    int look_up[2], look_down[2], look_in[2], look_out[2];
} fap_face_keys;

typedef struct fap_face_list {
    uint32_t *vertex, count;
} fap_face_list;

typedef struct fap_face_eye {
    int present;
    float centre[3], radius;
    fap_face_list ball;          /* vertices of the eyeball */
    float (*rest)[3][FAP_LANES]; /* [ball.count in blocks of lanes]: where they are, from the centre */
    fap_face_list lid;           /* skin that must stay outside the eyeball ... */
    float *lid_radius;           /* ... at least this far from its centre */
} fap_face_eye;

struct fap_face {
    fap_allocator alloc;
    fap_face_config cfg;
    const fap_bank *bank;
    const fap_mesh *mesh;
    fap_dsp dsp;

    /* made at open */
    int key_count;
    const fap_key **key;
    float *motion;                     /* [FAP_ROWS][key_count]: millimetres per unit of weight */
    uint8_t *population;               /* [key_count]: one of the thesis's population */
    uint8_t solvable[FAP_POINT_COUNT]; /* moved by blending and residual; eyeballs are not */
    float neutral[FAP_POINT_COUNT][3];
    fap_face_keys known;
    fap_face_eye eye[2]; /* left, right */
    fap_face_list lower_teeth, tongue, lash;
    float tongue_middle, tongue_half; /* its middle line's x, and how far its border is from there */
    uint32_t *follows;                /* [vertex_count]: nearest skin vertex of a lash, itself for the rest */
    int *block_level; /* [stride / FAP_BLOCK]: the head weight all lanes share, -1: they differ */
    int chin_row;
    int slit[FAP_SLITS][2]; /* points that must not pass each other: upper, lower; lips, then lids */
    float spine[3];
    fap_normals normals;
    fap_residual residual;
    fap_regions regions;
    const fap_blend_method *method;
    void *state; /* the method's */

    /* the pose before */
    int has_posed;
    int64_t last_pts_us;

    /* this frame */
    int follows_on;                     /* temporal_mm2 counts: the pose before is near */
    float asked[FAP_POINT_COUNT][3];    /* from neutral, millimetres */
    float target[FAP_POINT_COUNT][3];   /* the same as far as lids can follow */
    uint8_t wanted[FAP_POINT_COUNT][3]; /* of solvable points only */
    int row_count;
    uint16_t row[FAP_ROWS]; /* commanded rows: 3 * point + axis */
    int base_count, base_key[FAP_BASE_MAX];
    float base_weight[FAP_BASE_MAX]; /* viseme and expression: yield to low-level FAPs */
    float *fixed;                    /* [key_count]: gaze and blink: do not yield */
    float fixed_motion[FAP_ROWS];
    float *weight; /* [FAP_REGION_MAX][key_count]: the answer */
    float
        field_share; /* how much of what weights leave over the residual's fields take up as part of the method */
    float field[3][FAP_POINT_COUNT], field_motion[FAP_ROWS]; /* those fields at a share of 1 */
    float *shown;                    /* [key_count]: the mean of the regions' weights, for callers */
    float *lift;                     /* [stride]: how far each lid vertex was pushed out */
    float point[FAP_POINT_COUNT][3]; /* in head coordinates while posing, the room's afterwards */
    fap_face_stats stats;
};

/* Visemes, expressions, lids that follow the gaze, blinks: base_* and fixed of this frame. */
void fap_face_lay_base(fap_face *face, const fap_frame *frame);
/* Targets and commanded rows of this frame, or of points given outright. */
void fap_face_read_targets(fap_face *face, const fap_frame *frame);
void fap_face_take_targets(fap_face *face, const float target_mm[FAP_POINT_COUNT][3],
                           const uint8_t wanted[FAP_POINT_COUNT][3]);

/* Feature points of @p position: means of their vertices. */
void fap_face_measure(const fap_face *face, const float *position, float point[FAP_POINT_COUNT][3]);
/* slit of this face. */
void fap_face_find_slits(fap_face *face);
/* Put every commanded point where it should be, lips and lids apart; face->point must be measured. */
void fap_face_correct(fap_face *face, float *position);
/* field and field_motion: what would take up all that the weights leave over. */
void fap_face_plan_fields(fap_face *face);
/* field_share of them. */
void fap_face_apply_fields(const fap_face *face, float *position);

fap_err fap_face_open_parts(fap_face *face);
void fap_face_close_parts(fap_face *face);
void fap_face_turn_eyes(const fap_face *face, const fap_frame *frame, float *position);
void fap_face_clamp_teeth(const fap_face *face, float *position);
void fap_face_curl_tongue(const fap_face *face, const fap_frame *frame, float *position);
void fap_face_slide_lids(fap_face *face, const fap_frame *frame, float *position);
void fap_face_turn_head(fap_face *face, const fap_frame *frame, float *position);

#endif
