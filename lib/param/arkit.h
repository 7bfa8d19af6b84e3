/* SPDX-License-Identifier: BSD-2-Clause */
/* What both ways between FAPs and ARKit share. */
#ifndef LIB_PARAM_ARKIT_H
#define LIB_PARAM_ARKIT_H

#include <fap/arkit.h>

#include "gen/arkit_shapes.h"

enum {
#define X(shape, name) SHAPE_##shape,
    ARKIT_SHAPES_ROWS(X)
#undef X
        SHAPE_END
};

#define FAP_AU_PER_RAD 1e5f

/* What EyeLook... at 1 is: the slope of the angle over the coefficient in two takes, 0.61 and 0.63, 0.56 and 0.52. */
extern const float fap_arkit_full_yaw_rad, fap_arkit_full_pitch_rad;

#endif
