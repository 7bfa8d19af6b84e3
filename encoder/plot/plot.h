/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --plot: a sheet with the FAPs of a stream as curves over time, gaps and filled stretches marked; and, of a capture with
 * markers, where they sit on the face and what they are.
 */
#ifndef ENCODER_PLOT_PLOT_H
#define ENCODER_PLOT_PLOT_H

#include <stddef.h>
#include <stdint.h>

#include <fap/bank.h>
#include <fap/frame.h>

/* What a marker is for; the colour of its dot. */
typedef enum plot_role { PLOT_MOVES, PLOT_NEAR, PLOT_RIGID, PLOT_IDLE, PLOT_ROLE_COUNT } plot_role;

typedef struct plot_marker {
    char label[80];
    float place_mm[3]; /* on the face of the map, head axes */
    plot_role role;
} plot_marker;

/* Everything is borrowed for the call. */
typedef struct plot_content {
    const char *title, *subtitle;
    const fap_frame *frame;
    size_t frame_count;
    double rate_hz;
    /* 1: what a FAP says in a frame comes from a filled gap; NULL: nobody knows. */
    int (*filled)(const void *user, size_t frame, int fap);
    const void *user;
    const fap_bank *bank; /* the face of the map; NULL: no map */
    const plot_marker *marker;
    int marker_count;
} plot_content;

/* 0: this build cannot draw. */
int plot_available(void);
/* 1: a name that a plot can have, .png or .svg. */
int plot_name_known(const char *path);
/*
 * @path   .png or .svg; whole or not at all
 * @where  FAP_ERROR_TEXT_SIZE bytes, "" where errno says it
 */
fap_err plot_write(const char *path, const plot_content *content, char *where);

#endif
