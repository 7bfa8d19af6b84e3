/* SPDX-License-Identifier: BSD-2-Clause */
/* From where a face is looked at. The fixed views are constants of the orbit that a window's mouse moves on. */
#ifndef PLAYER_RENDER_VIEW_H
#define PLAYER_RENDER_VIEW_H

typedef enum render_camera {
    CAMERA_FRONT,
    CAMERA_LEFT,
    CAMERA_RIGHT,
    CAMERA_THREE_QUARTER,
    CAMERA_COUNT
} render_camera;

/* "front", "left", "right", "three-quarter"; -1: no such camera. */
int render_camera_by_name(const char *name);
const char *render_camera_name(render_camera camera);

/* The camera looks at the middle of the head, moved by @right and @up, from @distance. */
typedef struct render_view {
    float yaw_degrees;   /* positive shows the face's left side */
    float pitch_degrees; /* positive looks down at it; -89 to 89 */
    float distance;      /* 1 shows the whole head, 0.5 stands half as far away; 0.05 to 10 */
    float right, up;     /* along the picture's sides, in halves of the height that distance 1 shows */
} render_view;

/* One of the fixed views. */
render_view render_view_of(render_camera camera);

#endif
