/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapenc track. */
#ifndef ENCODER_TRACK_TRACK_OPTIONS_H
#define ENCODER_TRACK_TRACK_OPTIONS_H

#include <fap/studio/take.h>

typedef enum track_fields { FIELDS_AUTO, FIELDS_NONE, FIELDS_TOP_FIRST, FIELDS_BOTTOM_FIRST } track_fields;

typedef struct track_options {
    const char *video, *output;
    const char *init_path, *camera_path; /* camera NULL: view_deg */
    const char *pick_path, *labels_path; /* NULL: nothing is picked; labels NULL: the usual ones */
    int mirrors;                         /* in which dots are picked */
    const char *overlay_path;            /* NULL: none */
    double view_deg;                     /* across the picture */
    double radius_px;                    /* 0: as found */
    char ruler[2][FAP_TAKE_NAME_SIZE];   /* labels at its ends; "": none */
    double ruler_mm;
    double start_s, end_s; /* end 0: to the end */
    track_fields fields;
    int json;
    int exit_status; /* when parsing says to stop */
} track_options;

/* 0: stop with opt->exit_status; help or what is wrong has been printed. */
int track_options_parse(track_options *opt, int argc, char **argv);
/* 1: the output is a .c3d, by its name; else a .trc. */
int track_options_want_c3d(const track_options *opt);

#endif
