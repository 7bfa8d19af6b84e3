/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The databank (.fbank): a neutral face and its key models as motion vectors. Loaded once, read only afterwards,
 * shared by any number of faces and threads. Lengths are millimetres, axes the head's (x to the face's left, y up,
 * z forward).
 * Source: Zhu 2006 section 3.1, eq. 3.1 (neutral + motion vectors), section 3.4.3 (feature-point vectors kept apart).
 * File layout: docs/fbank.md.
 */
#ifndef FAP_BANK_H
#define FAP_BANK_H

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/fapu.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_bank fap_bank;

/** What a vertex belongs to. Parts never share a triangle. */
typedef enum fap_part {
    FAP_PART_SKIN,
    FAP_PART_EYE_LEFT,
    FAP_PART_EYE_RIGHT,
    FAP_PART_TEETH_UPPER,
    FAP_PART_TEETH_LOWER,
    FAP_PART_TONGUE,
    FAP_PART_LASHES,
    FAP_PART_COUNT
} fap_part;

/** What a key model is. */
typedef enum fap_key_kind {
    FAP_KEY_VISEME,     /**< number 1..14 */
    FAP_KEY_EXPRESSION, /**< number 1..6 */
    FAP_KEY_EXTRA,      /**< blink, cheek_puff ...: part of the thesis's population, no number */
    FAP_KEY_UNIT, /**< an ARKit-like unit (jawOpen ...): the solver's basis; not part of the population */
} fap_key_kind;

/** Vertices of a key model move in blocks of this many, so that kernels need no tail. */
#define FAP_BLOCK 8

/**
 * The neutral mesh. Per-vertex arrays are padded to @c stride (a multiple of FAP_BLOCK, padding is 0);
 * triangles are counter-clockwise seen from outside. Valid as long as the bank.
 */
typedef struct fap_mesh {
    uint32_t vertex_count, stride, triangle_count;
    const float *position; /**< x[stride] y[stride] z[stride], 32-byte aligned */
    const uint8_t *part;   /**< [stride], a ::fap_part each */
    const uint8_t
        *head_weight;         /**< [stride], 255: follows FAPs 48 to 50 fully; 0: stays with the shoulders */
    const uint8_t *colour;    /**< [stride][4], sRGB and a gloss value (0 matt, 255 wet); never NULL */
    const float *uv;          /**< [stride][2]; NULL where the face has none */
    const uint32_t *triangle; /**< [triangle_count][3] */
} fap_mesh;

/** One key model: motion of block b, axis a, lane i = scale_mm * delta[b][a][i], for vertex block[b] * FAP_BLOCK + i. */
typedef struct fap_key {
    const char *name; /**< "PP", "joy", "blink", "jawOpen" */
    uint8_t kind;     /**< a ::fap_key_kind */
    uint8_t number;   /**< viseme or expression number, else 0 */
    uint32_t block_count;
    float scale_mm;
    const uint16_t *block;      /**< [block_count], ascending */
    const int16_t *delta;       /**< [block_count][3][FAP_BLOCK] */
    const float (*point_mm)[3]; /**< [FAP_POINT_COUNT]: how far each feature point moves */
} fap_key;

/** A feature point on this face. */
typedef struct fap_bank_point {
    float position_mm[3];  /**< on the neutral face */
    uint32_t vertex_count; /**< the point is the mean of these vertices; 0: a fixed place without a vertex */
    const uint32_t *vertex;
    uint8_t present; /**< 0: this face cannot carry the point */
} fap_bank_point;

/** Bits of a vertex's discontinuity mask: on which side of the slit of the mouth or of an eye it is. 0: free. */
typedef enum fap_mask {
    FAP_MASK_LIP_UPPER = 1,
    FAP_MASK_LIP_LOWER = 2,
    FAP_MASK_LID_UPPER_LEFT = 4,
    FAP_MASK_LID_LOWER_LEFT = 8,
    FAP_MASK_LID_UPPER_RIGHT = 16,
    FAP_MASK_LID_LOWER_RIGHT = 32,
    FAP_MASK_ALL = 63
} fap_mask;
#define FAP_MASK_BITS 6

/** Where the face divides into left and right, upper and lower. Index 0: x to the face's left, 1: y up. */
typedef struct fap_region_lines {
    float middle[2];   /**< the borders */
    float extent[2];   /**< width and height of the face, of which an overlap is a share */
    const float *from; /**< x[stride] y[stride]: millimetres each vertex is left of, above the borders */
} fap_region_lines;

/**
 * Principal component of the key models, and the mean model they are counted from. A shape is mean + sum of
 * x[c] * component[c], x in standard deviations, within 3 of them. Source: Yano et al., section 5.2, eq. 2.
 */
typedef struct fap_component {
    float sigma_mm; /**< one standard deviation over the whole surface: root of a sum of squares */
    float ratio;    /**< share of the variance in this component and those before it, 0 to 1 */
    float rest;     /**< where the neutral face is, in standard deviations */
    uint32_t block_count;
    float scale_mm; /**< motion as in ::fap_key, of one standard deviation */
    const uint16_t *block;
    const int16_t *delta;
    const float (*point_mm)[3]; /**< [FAP_POINT_COUNT] of one standard deviation */
    const float *mix;           /**< [model_count]: the same as weights of models */
} fap_component;

/** A bank's principal components. */
typedef struct fap_basis {
    int component_count, model_count;
    const uint32_t *model; /**< [model_count]: key numbers, ascending; the first is the neutral face */
    fap_component mean;    /**< sigma, ratio, rest and mix of no meaning */
    const fap_component *component; /**< [component_count], sigma falling */
} fap_basis;
/** The neutral face among the models of a basis. */
#define FAP_MODEL_NEUTRAL 0xffffffffu

/**
 * Load a bank; every count, offset and index is checked, checksums too.
 * @param alloc  NULL: malloc
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT not a .fbank; FAP_E_UNSUPPORTED newer version; FAP_E_DATA damaged;
 *         FAP_E_LIMIT too large; FAP_E_NOMEM; FAP_E_IO (callbacks only). @p out is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_bank_load(fap_bank **out, const void *data, size_t size,
                                            const fap_allocator *alloc);
FAP_API FAP_NODISCARD fap_err fap_bank_read(fap_bank **out, const fap_reader *in, const fap_allocator *alloc);
/** The hand-written face that the library always carries: a few hundred vertices, all key models of the default face. */
FAP_API FAP_NODISCARD fap_err fap_bank_builtin(fap_bank **out, const fap_allocator *alloc);
/** Frees the bank and sets @p *bank to NULL; accepts NULL. No face may use it any more. */
FAP_API void fap_bank_close(fap_bank **bank);

/** Name of the face, e.g. "makehuman default". Never NULL. */
FAP_API const char *fap_bank_name(const fap_bank *bank);
FAP_API const fap_mesh *fap_bank_mesh(const fap_bank *bank);
FAP_API const fap_fapu *fap_bank_fapu(const fap_bank *bank);
/** @param point 0..83 @return NULL for another number */
FAP_API const fap_bank_point *fap_bank_point_get(const fap_bank *bank, int point);
FAP_API int fap_bank_key_count(const fap_bank *bank);
/** @param key 0..count-1 @return NULL for another number */
FAP_API const fap_key *fap_bank_key_get(const fap_bank *bank, int key);
/** Index of the key of that kind and name, -1: none. Names compare exactly. */
FAP_API int fap_bank_key_find(const fap_bank *bank, fap_key_kind kind, const char *name);
/** Index of the key of that kind and number (visemes, expressions), -1: none. */
FAP_API int fap_bank_key_number(const fap_bank *bank, fap_key_kind kind, int number);
/** Centre of rotation of an eyeball; @p right 0 or 1. @return 0 where the face has no such eye. */
FAP_API int fap_bank_eye(const fap_bank *bank, int right, float centre_mm[3], float *radius_mm);
/** The region map of Zhu 2006 section 3.4.2; NULL: the file has none, a face then draws the borders itself. */
FAP_API const fap_region_lines *fap_bank_regions(const fap_bank *bank);
/** [stride] of ::fap_mask bits; NULL: the file has none. */
FAP_API const uint8_t *fap_bank_masks(const fap_bank *bank);
/** NULL: the file has none, a face that blends by components then finds them itself. */
FAP_API const fap_basis *fap_bank_basis(const fap_bank *bank);

#ifdef __cplusplus
}
#endif
#endif
