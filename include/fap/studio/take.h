/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * A capture take in memory: named points over time, and the readers and writers of its files. Every format
 * ends up here: millimetres, one rate, missing points as flags and never as numbers. Sources: the C3D file
 * format as described at c3d.org; TRC, Nexus and Motive exports as real files have them. What the readers
 * tolerate is listed in docs/markers.md.
 */
#ifndef FAP_STUDIO_TAKE_H
#define FAP_STUDIO_TAKE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/api.h>
#include <fap/error.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_TAKE_NAME_SIZE   64 /**< bytes of a point's name, its NUL included; longer names are cut */
#define FAP_TAKE_NOTE_SIZE   192
#define FAP_TAKE_MAX_NOTES   24
#define FAP_TAKE_MAX_POINTS  4096      /**< more points than this are refused with FAP_E_LIMIT */
#define FAP_TAKE_MAX_SAMPLES (1 << 25) /**< points times frames */

typedef struct fap_take fap_take;

/**
 * A take. Plain data, free to change in place; fap_take_close() frees it. Samples are indexed
 * [frame * point_count + point].
 */
struct fap_take {
    const char *format;  /**< "c3d", "trc" ...; static. "" for a take made in memory */
    double rate_hz;      /**< frames a second; 0: the file does not say */
    int64_t first_frame; /**< number of the first frame in the file; for reports only */
    uint32_t frame_count, point_count;
    char (*name)[FAP_TAKE_NAME_SIZE]; /**< [point_count], unique, blanks cut, subject prefix kept */
    float (*xyz)[3];    /**< [frame_count * point_count], millimetres, axes of the file; 0 where missing */
    uint8_t *valid;     /**< [frame_count * point_count], 1: measured; fap/studio/clean.h has the rest */
    double mm_per_unit; /**< what the file's numbers were multiplied with */
    uint8_t unit_known; /**< 0: guessed from the size of the point cloud */
    char screen[2][4];  /**< what was right and up on the operator's screen ("+X", "+Z"); "" unknown */
    uint32_t note_count;
    char note[FAP_TAKE_MAX_NOTES][FAP_TAKE_NOTE_SIZE]; /**< deviations that were tolerated, in words */
    fap_allocator alloc;
};

/** What to believe instead of the file; start from fap_take_config_init(). */
typedef struct fap_take_config {
    size_t struct_size;
    double rate_hz;     /**< 0: as the file says */
    double mm_per_unit; /**< 0: as the file says, or guessed */
    fap_allocator alloc;
} fap_take_config;
FAP_API void fap_take_config_init(fap_take_config *cfg);

/**
 * An empty take: every sample missing, every name "".
 * @return FAP_OK, FAP_E_ARG (no points or no frames), FAP_E_LIMIT, FAP_E_NOMEM. *take is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_take_create(fap_take **take, uint32_t point_count, uint32_t frame_count,
                                              const fap_allocator *alloc);
/** Sets @p *take to NULL; accepts NULL. */
FAP_API void fap_take_close(fap_take **take);

/**
 * Read a take of any known format; the content decides which.
 * @param cfg    NULL: defaults
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL: what was looked for and what was found
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_SYNTAX or FAP_E_DATA damaged; FAP_E_NOT_FOUND no usable point;
 *         FAP_E_UNSUPPORTED a format without points; FAP_E_LIMIT; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_take_read(fap_take **take, const void *data, size_t size,
                                            const fap_take_config *cfg, char *where);

/** Position of a point in a frame; NULL where it is missing. */
FAP_API const float *fap_take_sample(const fap_take *take, uint32_t frame, uint32_t point);
/** Put a measured position there. */
FAP_API void fap_take_set(fap_take *take, uint32_t frame, uint32_t point, const float xyz_mm[3]);
/** The point of that name without regard to case, a subject prefix up to the last ':' removable; -1: none. */
FAP_API int fap_take_find(const fap_take *take, const char *name);
/** Millimetres in one "mm", "cm", "m", "Meters", "mete" ...; 0: not a unit of length. */
FAP_API double fap_take_unit_mm(const char *unit);

/** Byte order and floats of a C3D file; the values are the format's own. */
typedef enum fap_c3d_processor { FAP_C3D_INTEL = 84, FAP_C3D_DEC = 85, FAP_C3D_SGI = 86 } fap_c3d_processor;

/**
 * Write a take as C3D: one float or 16-bit quadruple a point, no analog channels.
 * @param integer  1: 16-bit numbers, scaled so that the largest coordinate just fits
 * @return FAP_OK, FAP_E_LIMIT (names do not fit the format's 255 parameter blocks), FAP_E_IO
 */
FAP_API FAP_NODISCARD fap_err fap_take_write_c3d(const fap_take *take, const fap_writer *out,
                                                 fap_c3d_processor processor, int integer);
/**
 * Write a take as TRC, a table that people can read: millimetres, an empty cell where a point is missing.
 * @param title  what stands in the first line: the file's name
 * @return FAP_OK, FAP_E_ARG (the take has no rate), FAP_E_IO
 */
FAP_API FAP_NODISCARD fap_err fap_take_write_trc(const fap_take *take, const char *title,
                                                 const fap_writer *out);

#ifdef __cplusplus
}
#endif
#endif
