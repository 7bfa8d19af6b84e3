/* SPDX-License-Identifier: BSD-2-Clause */
/* The shapes of one face: a neutral one and what it can do, from a folder of meshes or from a file with morph targets. */
#ifndef DATABANK_SHAPES_H
#define DATABANK_SHAPES_H

#include <fap/studio/surface.h>

#include "common/fault.h"

enum { SHAPE_NAME_SIZE = 64, SHAPES_MAX = FAP_SURFACE_MAX_TARGETS };

typedef struct shapes {
    fap_surface *neutral;
    int count;
    char name[SHAPES_MAX][SHAPE_NAME_SIZE];
    float (*delta[SHAPES_MAX])[3]; /* [neutral->vertex_count], of shape - neutral */
} shapes;

/*
 * @path  a folder with neutral.obj (or .ply, or a name that has "neutral" in it) and one mesh of the same structure for each shape,
 *        called like it; or a file with morph targets
 */
int shapes_read(shapes *s, const char *path, fault *f);
void shapes_free(shapes *s);

#endif
