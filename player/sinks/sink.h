/* SPDX-License-Identifier: BSD-2-Clause */
/* A place to send poses: one file and one const struct each. sinks.c holds the array; nobody else names them.
 */
#ifndef PLAYER_SINKS_SINK_H
#define PLAYER_SINKS_SINK_H

#include <stddef.h>
#include <stdint.h>

#include <fap/bank.h>
#include <fap/face.h>

#include "common/fault.h"
#include "player/render/image.h"

struct csv_kind;

/* What a sink is told once. Strings are borrowed and outlive it. */
typedef struct sink_setup {
    const char *output;    /* behind -o; NULL: none */
    const char *golden;    /* folder of golden pictures; NULL: none */
    const char *audio;     /* a sound that was found to be one; NULL: none */
    int update, tolerance; /* golden */
    int width, height;
    double rate_hz;      /* of the output */
    int64_t from, count; /* the first shown frame, and how many are */
    const fap_bank *bank;
    const struct csv_kind *csv; /* what the columns of a table are */
    const char *texture;        /* of the skin, a PNG file; NULL: none */
} sink_setup;

/* One instant. */
typedef struct shown_frame {
    int64_t number; /* output frame, its time is number / rate */
    double time_s;
    const float (*point)[3]; /* [FAP_POINT_COUNT], head axes of the room, millimetres */
    const image *picture;    /* NULL unless the sink needs pictures */
    /* Of the pose; NULL where the sink needs pictures: the next frame is posed while one is drawn. */
    const fap_frame *frame;
    const float *position; /* as fap_face_pose() fills it */
    const float *weight;   /* [key count] */
    int pass;              /* 0, and on for sinks that are shown all frames again */
} shown_frame;

enum { SINK_PATH_SIZE = 4096 + 32 };

/* What became of it, for the report. */
typedef struct sink_result {
    int64_t same, different;   /* golden pictures */
    int64_t missing;           /* of those that are different: there is no golden one */
    int64_t updated;           /* written anew or for the first time */
    int64_t stale;             /* golden pictures of frames that were not shown */
    int worst;                 /* largest difference of a channel */
    double structure;          /* the least of image_structure() */
    char left[SINK_PATH_SIZE]; /* the page that shows what differs; "": nothing does */
    int has_error; /* an export tells how far off it leaves vertices: the farthest of all frames, and root mean square */
    double worst_error_mm, rms_error_mm;
} sink_result;

typedef enum sink_choice { SINK_ALL_FRAMES, SINK_FIRST_FRAME, SINK_MOMENTS } sink_choice;

typedef struct play_sink {
    const char *name, *summary; /* for reports and --help */
    int needs_picture;
    sink_choice choice; /* which frames of the range it is shown */
    int passes;         /* how often it is shown all of them; 0 is once. Not for sinks that need pictures */
    size_t state_size;  /* allocated by the player, zeroed */
    /* All return 0 and set the fault when they fail. */
    int (*open)(void *state, const sink_setup *setup, fault *f);
    int (*show)(void *state, const shown_frame *shown, fault *f);
    int (*finish)(void *state, sink_result *result, fault *f); /* the output becomes visible here */
    void (*close)(void *state);                                /* always; undoes what was not finished */
} play_sink;

extern const play_sink sink_png, sink_png_sequence, sink_video, sink_csv, sink_glb, sink_sheet, sink_golden,
    sink_null, sink_y4m;
/* All of them, then NULL. */
extern const play_sink *const play_sinks[];

/* The sink that @output's name asks for; NULL: none does. --sheet and --golden do not go through names. */
const play_sink *sink_by_name(const char *output);

#endif
