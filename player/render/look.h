/* SPDX-License-Identifier: BSD-2-Clause */
/* What surrounds and covers a face, beyond the face itself. */
#ifndef PLAYER_RENDER_LOOK_H
#define PLAYER_RENDER_LOOK_H

#include "player/render/image.h"

typedef enum render_backdrop {
    BACKDROP_STUDIO,  /* grey, brighter behind the key side */
    BACKDROP_COLOUR,  /* one everywhere */
    BACKDROP_PICTURE, /* fills the frame; cut where its shape is another */
    BACKDROP_NOTHING  /* pictures are transparent round the face */
} render_backdrop;

/* Zeroed: the studio, and the colours of the bank. Pictures are borrowed for the call that takes them. */
typedef struct render_look {
    render_backdrop backdrop;
    uint8_t rgb[3];       /* BACKDROP_COLOUR */
    const image *picture; /* BACKDROP_PICTURE */
    const image *skin;    /* laid on the skin by the mesh's texture coordinates; NULL: none */
} render_look;

#endif
