/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * A range image: depth and colour as one camera saw them, made a surface that keeps its grid. What Yano & Harada 2009 begin
 * with. Part of libfap-studio; docs/shape.md.
 */
#ifndef FAP_STUDIO_RANGE_H
#define FAP_STUDIO_RANGE_H

#include <fap/studio/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_RANGE_MAX_SIDE 4096
#define FAP_RANGE_NAME     128

/** A pinhole camera without distortion, and how its pictures are stored. */
typedef struct fap_range_camera {
    double fx, fy, cx, cy; /**< pixels of the depth picture; (0, 0) is the middle of its first pixel */
    double unit_mm;        /**< one step of depth */
    char depth[FAP_RANGE_NAME],
        colour[FAP_RANGE_NAME]; /**< names of the pictures, in the same folder; colour: "" none */
} fap_range_camera;

/**
 * Read a camera: JSON, an object with "depth", "fx", "fy", "cx", "cy", "unit_mm" and perhaps "colour"; other keys are passed over.
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT no JSON object with "depth" in it; FAP_E_SYNTAX; FAP_E_DATA a number that is none for a
 *         camera, or a name that leaves the folder
 */
FAP_API FAP_NODISCARD fap_err fap_range_camera_read(fap_range_camera *out, const void *data, size_t size,
                                                    char *where);

/** Pictures of one camera; rows from the top. */
typedef struct fap_range_image {
    uint32_t columns, rows;
    const float
        *depth; /**< [rows * columns] steps along the line of sight's axis; 0, less, or no number: not seen */
    const uint8_t (*rgb)[3]; /**< [colour_rows * colour_columns] of the same view; NULL: none */
    uint32_t colour_columns, colour_rows;
} fap_range_image;

/**
 * A surface in millimetres: x to the right of the picture, y up, z towards the camera, which is at the origin. It has the grid,
 * texture coordinates, and colours where there are any. Neighbours whose depths differ by more than a surface seen at 83 degrees
 * would are not joined.
 * @param alloc  NULL: malloc
 * @return FAP_OK; FAP_E_ARG; FAP_E_NOT_FOUND nothing was seen; FAP_E_LIMIT; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_range_surface(fap_surface **out, const fap_range_image *image,
                                                const fap_range_camera *camera, const fap_allocator *alloc);

/**
 * A depth picture as Portable Float Map ("Pf": one channel), rows turned to run from the top.
 * @param depth  malloc'ed by @p alloc
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_DATA; FAP_E_LIMIT; FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_range_read_pfm(float **depth, uint32_t *columns, uint32_t *rows,
                                                 const void *data, size_t size, const fap_allocator *alloc);

#ifdef __cplusplus
}
#endif
#endif
