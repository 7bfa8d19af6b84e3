/* SPDX-License-Identifier: BSD-2-Clause */
/* The mesh of a face and its morph targets as accessors of a glTF file. Metres; x to the face's left, y up, z forward. */
#ifndef PLAYER_SINKS_GLB_MESH_H
#define PLAYER_SINKS_GLB_MESH_H

#include "player/sinks/glb_file.h"
#include "player/sinks/glb_rig.h"
#include "player/sinks/glb_shape.h"

/* What has a material of its own. Parts never share a triangle. */
typedef enum glb_group { GROUP_SKIN, GROUP_EYES, GROUP_MOUTH, GROUP_LASHES, GROUP_COUNT } glb_group;

/* Accessors of a group. */
typedef struct glb_primitive {
    uint32_t vertex_count, triangle_count; /* nothing is written of a group without triangles */
    uint32_t *vertex;                      /* [vertex_count]: numbers in the bank, ascending */
    float gloss;                           /* mean, 0 to 1 */
    int triangles, position, normal, colour, uv, number, joints, shares;
    int *target_position, *target_normal; /* [target_count] */
} glb_primitive;

typedef struct glb_mesh {
    glb_primitive group[GROUP_COUNT];
    int target_count;
} glb_mesh;

glb_group glb_group_of(fap_part part);
/* Adds everything to @g. @joint_number: of each joint in the skin. @textured: skin comes without colours. 0: no memory. Close in either case. */
int glb_mesh_open(glb_mesh *m, glb_file *g, const glb_rig *rig, const glb_shape *shape,
                  const int joint_number[JOINT_COUNT], int textured);
void glb_mesh_close(glb_mesh *m);

#endif
