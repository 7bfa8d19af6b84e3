/* SPDX-License-Identifier: BSD-2-Clause */
/* Key frames: joints as quaternions and moves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "player/sinks/glb_content.h"

int glb_track_open(glb_track *t, uint32_t frame_count, int target_count)
{
    int ok = 1;

    *t = (glb_track){ .frame_count = frame_count, .target_count = target_count };
    t->time_s = calloc(frame_count, sizeof *t->time_s);
    t->weight = calloc((size_t)frame_count * (size_t)target_count, sizeof *t->weight);
    for (int j = 0; j < JOINT_COUNT; j++) {
        t->turn[j] = calloc(frame_count, sizeof *t->turn[j]);
        t->move[j] = calloc(frame_count, sizeof *t->move[j]);
        ok = ok && t->turn[j] && t->move[j];
    }
    return ok && t->time_s && t->weight;
}

void glb_track_close(glb_track *t)
{
    free(t->time_s);
    free(t->weight);
    for (int j = 0; j < JOINT_COUNT; j++) {
        free(t->turn[j]);
        free(t->move[j]);
    }
    *t = (glb_track){ 0 };
}

/* Four times the square of a component of the quaternion: 0 to 2 are x, y, z, 3 is w. */
static float square_of(const float m[3][3], int i)
{
    const float x = m[0][0], y = m[1][1], z = m[2][2];
    const float square[4] = { 1 + x - y - z, 1 - x + y - z, 1 - x - y + z, 1 + x + y + z };
    return square[i];
}

/* From the largest component, the others. */
static void quaternion_of(const float m[3][3], float q[4])
{
    const float xy = m[0][1] + m[1][0], xz = m[0][2] + m[2][0], yz = m[1][2] + m[2][1];
    const float wx = m[2][1] - m[1][2], wy = m[0][2] - m[2][0], wz = m[1][0] - m[0][1];
    const float off[4][4] = { { 0, xy, xz, wx }, { xy, 0, yz, wy }, { xz, yz, 0, wz }, { wx, wy, wz, 0 } };
    int best = 0;
    float norm = 0;

    for (int i = 1; i < 4; i++)
        if (square_of(m, i) > square_of(m, best))
            best = i;
    for (int i = 0; i < 4; i++) {
        q[i] = i == best ? square_of(m, i) : off[best][i];
        norm += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrtf(norm);
}

/* q and -q are the same turn; from one frame to the next the way should be short. */
static void keep_side(float q[4], const float before[4])
{
    const float side = q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3];

    for (int i = 0; side < 0 && i < 4; i++)
        q[i] = -q[i];
}

void glb_track_set(glb_track *t, uint32_t frame, double time_s, const glb_motion motion[JOINT_COUNT])
{
    t->time_s[frame] = (float)time_s;
    for (int j = 0; j < JOINT_COUNT; j++) {
        static const float still[4] = { 0, 0, 0, 1 };
        quaternion_of(motion[j].turn, t->turn[j][frame]);
        keep_side(t->turn[j][frame], frame ? t->turn[j][frame - 1] : still);
        for (int axis = 0; axis < 3; axis++)
            t->move[j][frame][axis] = motion[j].move_mm[axis] * 1e-3f;
    }
}
