/* SPDX-License-Identifier: BSD-2-Clause */
/* How much of the sky each vertex sees, from depth pictures of the face out of many directions. Done once a face. */
#ifndef PLAYER_RENDER_OCCLUSION_H
#define PLAYER_RENDER_OCCLUSION_H

#include <fap/bank.h>

#include "player/render/gl.h"

/*
 * @index_buffer  the mesh's triangles, already on the GL side
 * @open          [vertex_count], 0: sees nothing of the sky, 1: nothing in the way
 * @key           the same for the key lamp, which is as wide as a window; 1 where the face turns away from it too
 */
fap_err occlusion_measure(const gl_functions *gl, const fap_bank *bank, GLuint index_buffer, GLuint program,
                          float *open, float *key);

#endif
