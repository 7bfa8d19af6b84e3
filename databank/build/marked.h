/* SPDX-License-Identifier: BSD-2-Clause */
/* A face of any structure on its way into a bank: a mesh, what each vertex is, where the feature points are, what it can do. */
#ifndef DATABANK_BUILD_MARKED_H
#define DATABANK_BUILD_MARKED_H

#include <fap/studio/bank_build.h>
#include <fap/studio/surface.h>

enum { MARKED_NONE = -1 };

typedef struct marked {
    const fap_surface *mesh;        /* millimetres, head axes */
    uint8_t *part, *weight;         /* [vertices], as in fap_build_mesh */
    uint8_t (*colour)[4];           /* [vertices] */
    int64_t point[FAP_POINT_COUNT]; /* a vertex, or MARKED_NONE: place, or nothing */
    float place[FAP_POINT_COUNT][3];
    uint8_t has_place[FAP_POINT_COUNT];
} marked;

/* Arrays of the mesh's size; nothing is marked, all is skin of the head. 0: out of memory. Close in either case. */
int marked_open(marked *m, const fap_surface *mesh);
void marked_close(marked *m);
/* Eyeballs, teeth, tongue, lashes in colours of their own; iris and pupil where an eyeball faces forward. */
void marked_paint(marked *m);
/* Mesh, points and eyeballs; keys are the caller's. Triangles across parts are left out. */
fap_err marked_begin(fap_bank_builder **out, const marked *m, const char *name);
/*
 * A shape by its own name: ARKit's, those of fapplay -o NAME.glb, visemes and expressions as the library calls them; any other is a
 * unit of its own.
 */
fap_err marked_add_shape(fap_bank_builder *b, const char *name, const float (*delta)[3]);

#endif
