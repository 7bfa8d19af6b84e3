/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * FAPs onto a face: feature-point targets, blend weights, one weighted sum of motion vectors, residual, rigid parts.
 * A face is opened on a shared bank, owns fixed memory, and poses without allocating. One thread per face.
 * Source: Zhu 2006 chapter 3; DESIGN.md section 5.
 */
#ifndef FAP_FACE_H
#define FAP_FACE_H

#include <fap/bank.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_face fap_face;

/** How blend weights are found. */
typedef enum fap_blend {
    FAP_BLEND_ZHU, /**< the thesis's genetic algorithm, to the letter, on visemes, expressions and extra keys */
    FAP_BLEND_QP,  /**< bounded least squares on the units, per axis; on all keys where a bank has no units */
    FAP_BLEND_GA,  /**< the GA started from the least-squares solution; never worse than it in millimetres */
    FAP_BLEND_PCA, /**< principal components of the key models, coefficients within 3 standard deviations */
    FAP_BLEND_RBF, /**< no key models: a smooth field through the feature points (Hardy's multiquadrics) */
    FAP_BLEND_FAT, /**< face animation tables baked from the key models: see fap/fat.h */
    FAP_BLEND_BONES, /**< no key models: planar bones between the feature points (Sanchez Lorenzo et al. 2003) */
} fap_blend;

/** The method's name ("ga") and a line about it, for options and their help. NULL: no such method. */
FAP_API const char *fap_blend_name(int blend);
FAP_API const char *fap_blend_summary(int blend);

/** Crossover of the GA; BLX with alpha 0.2. Source: Zhu 2006 eq. 3.4 to 3.6. */
typedef enum fap_crossover { FAP_CROSSOVER_MIDPOINT, FAP_CROSSOVER_LINE, FAP_CROSSOVER_BLX } fap_crossover;

/** Options; start from fap_face_config_init(). */
typedef struct fap_face_config {
    size_t struct_size;
    fap_blend blend;         /**< FAP_BLEND_GA */
    fap_crossover crossover; /**< FAP_CROSSOVER_LINE */
    int generations;         /**< 70 (Zhu 2006 section 3.3); 0 to 100000 */
    float emphasis;          /**< c of section 3.4.1: targets times c before blending, 0 to 10; 1 */
    uint64_t seed;           /**< 1; equal seeds give equal bits */
    int residual;            /**< 1: put every commanded point exactly where the FAPs say */
    int blink; /**< 0; 1: blink by itself while the stream drives no lids (Lin et al. 2001 section 5.2) */
    fap_allocator alloc;
    int regions; /**< 1, or 2 (left, right) or 4 (each half upper and lower): ZHU and GA solve each by itself */
    float
        overlap_percent; /**< 20: of the face's width, on either side of a border, shaped by both; 0 to 50 */
    /**
     * 0; else QP and GA charge this many square millimetres for changing a weight by one since the pose before: noise in the
     * targets shows less, quick motion comes later. 1 is a little, 100 is a lot; up to 1e6. A pose then depends on the one
     * before it, if that was at most 0.1 s earlier.
     */
    float temporal_mm2;
} fap_face_config;

/** Sets every default. */
FAP_API void fap_face_config_init(fap_face_config *cfg);

/** What the last pose did. */
typedef struct fap_face_stats {
    float target_error_mm;   /**< RMS over commanded axes before the residual */
    float residual_error_mm; /**< the same afterwards */
    float
        fitness; /**< mean cosine of Zhu 2006 eq. 3.2 over the points that move, along commanded axes, before
                                   the residual; 1 when none moves */
    int target_count; /**< commanded point axes */
} fap_face_stats;

/**
 * @param bank  kept until close; may be shared
 * @param cfg   NULL: defaults
 * @return FAP_OK, FAP_E_ARG (bad config), FAP_E_DATA (the bank lacks what posing needs), FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_face_open(fap_face **face, const fap_bank *bank,
                                            const fap_face_config *cfg);
/** Sets @p *face to NULL; accepts NULL. */
FAP_API void fap_face_close(fap_face **face);
/** Floats between the x, y and z rows of position and normal arrays: the mesh's stride. */
FAP_API size_t fap_face_stride(const fap_face *face);

/**
 * Pose the face. Depends on @p frame alone, not on earlier calls, unless temporal_mm2 is set: seeking and pausing need no
 * care.
 * FAPs of state FAP_ABSENT leave their axis free; all others are targets, absolute from neutral. Visemes and expressions
 * are laid down first, low-level FAPs override them where both speak. Every value is accepted: absurd ones end in a
 * distorted face, not in a broken one. With cfg.residual a commanded point is off by no more than rounding, except where
 * lips or lids would pass each other: lips meet in the middle, an upper lid stops on the lower one.
 * @param position  x[stride] y[stride] z[stride], millimetres, 32-byte aligned
 * @param normal    the same layout, unit length; NULL: not wanted
 */
FAP_API void fap_face_pose(fap_face *face, const fap_frame *frame, float *position, float *normal);
/**
 * Pose the face from feature points given in all three axes, as another face's motion or a capture has them. The same
 * way as for FAPs; head, eyes and tongue's curl stay at rest.
 * @param target_mm  displacement from neutral, head axes, millimetres, before emphasis; what is no number is not wanted
 * @param wanted     1 where that axis is commanded; others are free
 */
FAP_API void fap_face_pose_points(fap_face *face, const float target_mm[FAP_POINT_COUNT][3],
                                  const uint8_t wanted[FAP_POINT_COUNT][3], float *position, float *normal);
/** Show key models directly: @p weight[key_count] (bank order), any value; head, eyes and residual stay neutral. */
FAP_API void fap_face_pose_keys(fap_face *face, const float *weight, float *position, float *normal);
/**
 * Feature points after the last pose (neutral before the first), axes of the room, millimetres. A point is the mean of
 * its vertices; one without vertices follows the head.
 */
FAP_API void fap_face_points(const fap_face *face, float points[FAP_POINT_COUNT][3]);
/** Blend weights of the last pose, bank order, fap_bank_key_count() floats; with regions, their mean. Valid until the
 * next pose. */
FAP_API const float *fap_face_weights(const fap_face *face);
FAP_API void fap_face_last_stats(const fap_face *face, fap_face_stats *out);

/**
 * Where the FAPs of @p frame want the feature points, in neutral head coordinates. Translations only: eye and head
 * rotation, pupils and the tongue's curl are no targets.
 * @param target  displacement from neutral along each axis, millimetres
 * @param wanted  1 where that axis is commanded
 */
FAP_API void fap_face_targets(const fap_fapu *fapu, const fap_frame *frame,
                              float target_mm[FAP_POINT_COUNT][3], uint8_t wanted[FAP_POINT_COUNT][3]);

/**
 * The other way round: what the face shows where @p frame asks for nothing, visemes, expressions and what goes along with
 * commanded points among it. FAPs of state FAP_ABSENT that move a point get its place as their value, and FAP_DERIVED.
 * @param points  of the pose that was made of @p frame, as fap_face_points() gives them
 */
FAP_API void fap_face_complete(const fap_bank *bank, const float points[FAP_POINT_COUNT][3], fap_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
