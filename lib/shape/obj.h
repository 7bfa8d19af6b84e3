/* SPDX-License-Identifier: BSD-2-Clause */
/* Wavefront OBJ meshes: positions, texture coordinates, polygons by group. Normals, materials and curves are
 * passed over. */
#ifndef LIB_SHAPE_OBJ_H
#define LIB_SHAPE_OBJ_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

#define FAP_OBJ_NO_UV UINT32_MAX

typedef struct fap_obj_face {
    uint32_t first, count; /* corners */
    uint32_t group;
} fap_obj_face;

typedef struct fap_obj {
    float (*position)[3];
    float (*uv)[2];
    fap_obj_face *face;
    uint32_t *vertex, *corner_uv; /* of each corner */
    char (*group)[64];            /* names; group 0 is that of faces before any g line */
    uint32_t position_count, uv_count, face_count, corner_count, group_count;
} fap_obj;

/* @p text has @p size bytes and a NUL behind them. FAP_E_SYNTAX: @p line (may be NULL) says where. */
fap_err fap_obj_parse(fap_obj *obj, const char *text, size_t size, int *line);
void fap_obj_free(fap_obj *obj);
/* UINT32_MAX: no such group. */
uint32_t fap_obj_group(const fap_obj *obj, const char *name);

#endif
