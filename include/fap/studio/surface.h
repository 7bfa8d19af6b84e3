/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * A triangle surface in memory: a scan, a modelled face, a range image that was meshed; and the readers and writers of its
 * files. Numbers stay in the file's unit and axes: what lays a face onto it finds both out. Part of libfap-studio.
 */
#ifndef FAP_STUDIO_SURFACE_H
#define FAP_STUDIO_SURFACE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/api.h>
#include <fap/error.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_SURFACE_MAX_VERTICES  (1 << 23) /**< more are refused with FAP_E_LIMIT */
#define FAP_SURFACE_MAX_TRIANGLES (1 << 24)
#define FAP_SURFACE_MAX_TARGETS   512
#define FAP_SURFACE_NAME_SIZE     64
#define FAP_SURFACE_NOTE_SIZE     192
#define FAP_SURFACE_MAX_NOTES     16

/** A morph target: where every vertex goes. */
typedef struct fap_surface_target {
    char name[FAP_SURFACE_NAME_SIZE]; /**< "" where the file has none */
    float (*delta)[3];                /**< [vertex_count] */
} fap_surface_target;

/** Plain data, free to change in place; fap_surface_close() frees it. */
typedef struct fap_surface {
    const char *format; /**< "obj", "ply", "gltf"; static. "" for one made in memory */
    uint32_t vertex_count, triangle_count, target_count;
    float (*position)[3];
    float (*uv)[2];          /**< NULL: none */
    uint8_t (*colour)[4];    /**< sRGB and opacity; NULL: none */
    uint32_t (*triangle)[3]; /**< counter-clockwise seen from outside; three different vertices each */
    fap_surface_target *target;
    uint32_t columns, rows; /**< of a range image: vertex of sample [row][column] ... */
    uint32_t *grid;         /**< ... [rows * columns], UINT32_MAX: nothing seen; NULL: no range image */
    uint32_t dropped;       /**< triangles without an area that were left out */
    uint32_t note_count;
    char note[FAP_SURFACE_MAX_NOTES][FAP_SURFACE_NOTE_SIZE]; /**< what was tolerated, in words */
    fap_allocator alloc;
} fap_surface;

/**
 * A surface with room for that much, all zero.
 * @param alloc  NULL: malloc
 * @return FAP_OK, FAP_E_ARG no vertex, FAP_E_LIMIT, FAP_E_NOMEM; @p *out is NULL on error
 */
FAP_API FAP_NODISCARD fap_err fap_surface_create(fap_surface **out, uint32_t vertex_count,
                                                 uint32_t triangle_count, const fap_allocator *alloc);
/** Sets @p *surface to NULL; accepts NULL. */
FAP_API void fap_surface_close(fap_surface **surface);

/**
 * Read a file of any known format, found by its content: Wavefront OBJ, PLY (ASCII and binary), glTF 2.0 binary. Polygons
 * become triangles; triangles without an area are left out and counted.
 * @param alloc  NULL: malloc
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL: the place, and what is wrong with it
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_SYNTAX, FAP_E_DATA damaged; FAP_E_UNSUPPORTED a relative of a known format;
 *         FAP_E_LIMIT; FAP_E_NOMEM. @p *out is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_surface_read(fap_surface **out, const void *data, size_t size,
                                               const fap_allocator *alloc, char *where);
/** Wavefront OBJ; texture coordinates too where there are any. @return FAP_OK, FAP_E_IO */
FAP_API FAP_NODISCARD fap_err fap_surface_write_obj(const fap_surface *surface, const fap_writer *out);
/** Binary little-endian PLY; colours too where there are any. @return FAP_OK, FAP_E_IO */
FAP_API FAP_NODISCARD fap_err fap_surface_write_ply(const fap_surface *surface, const fap_writer *out);

/** How the triangles hang together; nothing of it is an error. */
typedef struct fap_surface_census {
    uint32_t pieces;        /**< connected */
    uint32_t border_edges;  /**< of one triangle */
    uint32_t crowded_edges; /**< of more than two: not a manifold there */
    uint32_t turned_edges;  /**< whose two triangles face different ways */
    uint32_t loose;         /**< vertices of no triangle */
    double area, edge_mean; /**< in the surface's unit, squared and plain */
} fap_surface_census;
/** @return FAP_OK, FAP_E_NOMEM */
FAP_API FAP_NODISCARD fap_err fap_surface_count(const fap_surface *surface, fap_surface_census *out);

#ifdef __cplusplus
}
#endif
#endif
