/* SPDX-License-Identifier: BSD-2-Clause */
/* Anybody's face with its shapes, a folder of meshes or a file with morph targets, as a bank of its own structure. */
#ifndef DATABANK_BUILD_IMPORT_SHAPES_H
#define DATABANK_BUILD_IMPORT_SHAPES_H

#include <fap/studio/bank_build.h>

#include "common/fault.h"

/*
 * What each vertex is, eye, tooth, skin, and where the feature points are, is taken from @like, which is laid onto the face at
 * rest by @landmarks. @unit_mm 0: the unit that makes it a head.
 */
int import_shapes(fap_bank_builder **out, const char *path, const char *landmarks, const char *like,
                  double unit_mm, fault *f);
/* 1: a folder without what makes it another recipe, or a GLB or PLY file. */
int import_shapes_is(const char *path);

#endif
