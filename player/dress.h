/* SPDX-License-Identifier: BSD-2-Clause */
/* What --background and --texture ask for, from files to the renderer. */
#ifndef PLAYER_DRESS_H
#define PLAYER_DRESS_H

#include "common/fault.h"
#include "player/render/renderer.h"

typedef struct dress_options {
    render_backdrop backdrop;
    uint8_t rgb[3];
    const char *picture, *skin; /* PNG files; NULL: none */
} dress_options;

/* studio, none, #RRGGBB or a file. 0: a colour that is none. */
int dress_parse_background(dress_options *o, const char *text);

/* Reads the files and dresses the renderer. 0: the fault says why not. */
int dress_renderer(renderer *r, const dress_options *o, fault *f);

#endif
