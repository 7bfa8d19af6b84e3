/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Making a databank: a neutral mesh, its feature points and its key models go in as plain floats; a .fbank
 * comes out, quantised, sparse and checksummed. Part of libfap-studio.
 */
#ifndef FAP_STUDIO_BANK_BUILD_H
#define FAP_STUDIO_BANK_BUILD_H

#include <fap/bank.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_bank_builder fap_bank_builder;

/** A neutral face as a caller has it: millimetres, head axes, any vertex order. Copied. */
typedef struct fap_build_mesh {
    uint32_t vertex_count, triangle_count;
    const float (*position)[3];
    const float (*uv)[2];          /**< NULL: none */
    const uint8_t *part;           /**< a ::fap_part each */
    const uint8_t *head_weight;    /**< as in ::fap_mesh */
    const uint8_t (*colour)[4];    /**< sRGB and gloss */
    const uint32_t (*triangle)[3]; /**< counter-clockwise seen from outside; never across parts */
} fap_build_mesh;

/**
 * @param name  of the face; cut to 63 bytes
 * @return FAP_OK; FAP_E_DATA an index out of range, a triangle across parts, a position that is no number;
 *         FAP_E_LIMIT; FAP_E_NOMEM. @p out is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_open(fap_bank_builder **out, const char *name,
                                                    const fap_build_mesh *mesh);
/** Start from a bank that is there: its mesh, points, eyes, keys, masks and region map (not
 * its principal components, which other keys would make wrong), to be changed or written. @return as above */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_copy(fap_bank_builder **out, const fap_bank *bank);
/** The same without the keys. */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_still(fap_bank_builder **out, const fap_bank *bank);
/** Sets @p *b to NULL; accepts NULL. */
FAP_API void fap_bank_builder_close(fap_bank_builder **b);

/** The point is the mean of @p vertex[count]; points never set are absent. @return FAP_OK, FAP_E_ARG,
 * FAP_E_NOMEM */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_point(fap_bank_builder *b, int point, const uint32_t *vertex,
                                                     uint32_t count);
/** A point without a vertex, at a fixed place. @return FAP_OK, FAP_E_ARG */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_place(fap_bank_builder *b, int point,
                                                     const float position_mm[3]);
/** An eyeball to turn rigidly. @param right 0 or 1 */
FAP_API void fap_bank_builder_eye(fap_bank_builder *b, int right, const float centre_mm[3], float radius_mm);

/**
 * Add a key model; the vectors are copied. It takes the place of one of its kind and number, or of its kind and name.
 * @param number  of a viseme or expression, else 0
 * @param delta   [vertex_count] motion from neutral to the pose, millimetres
 * @return FAP_OK, FAP_E_ARG (name, kind or number), FAP_E_DATA (not a number), FAP_E_LIMIT, FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_key(fap_bank_builder *b, fap_key_kind kind, int number,
                                                   const char *name, const float (*delta)[3]);
/**
 * Add visemes, expressions and extras as the library's own recipes blend them (fap_tables/key_models.csv)
 * from the units added so far. Units a face has not got are left out of a blend; models that were added before stay.
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_models(fap_bank_builder *b);
/** As if no key had been added. */
FAP_API void fap_bank_builder_forget_keys(fap_bank_builder *b);

/** Other colours for the mesh. @param colour  [vertex_count] */
FAP_API void fap_bank_builder_colours(fap_bank_builder *b, const uint8_t (*colour)[4]);
/**
 * An artist's own discontinuity masks instead of those that write derives. @param mask  [vertex_count] of
 * ::fap_mask bits. @return FAP_OK, FAP_E_ARG, FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_masks(fap_bank_builder *b, const uint8_t *mask);
/**
 * An own region map instead of the one that write derives. @param stride  of @p lines->from; at least vertex_count
 * @return FAP_OK, FAP_E_NOMEM; numbers that are none make fap_bank_load() refuse the file
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_regions(fap_bank_builder *b, const fap_region_lines *lines,
                                                       uint32_t stride);
/**
 * Have write add principal components of the population (visemes, expressions, extras; all keys where a face has none
 * of these). @param components  at most, 1 to 128; 0: none. @return FAP_OK, FAP_E_ARG
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_basis(fap_bank_builder *b, int components);

/**
 * Write the file. Vertices are reordered so that those that move together stand together.
 * @return FAP_OK; FAP_E_DATA the points give no FAPU, or an eye is no eye; FAP_E_IO; FAP_E_NOMEM; FAP_E_LIMIT
 */
FAP_API FAP_NODISCARD fap_err fap_bank_builder_write(fap_bank_builder *b, const fap_writer *out);

#ifdef __cplusplus
}
#endif
#endif
