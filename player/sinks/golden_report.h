/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a comparison with golden pictures leaves to be looked at: of each picture that differs NNNN.golden.png, NNNN.got.png,
 * NNNN.diff.png and NNNN.side.png, all three in a row, and golden-report.html, a page that shows them, the worst first.
 */
#ifndef PLAYER_SINKS_GOLDEN_REPORT_H
#define PLAYER_SINKS_GOLDEN_REPORT_H

#include <stdint.h>

#include "common/fault.h"
#include "player/render/image.h"

enum { GOLDEN_PATH_SIZE = 4096 };

extern const char golden_page_name[];

typedef enum golden_verdict {
    GOLDEN_SAME,
    GOLDEN_DIFFERS,
    GOLDEN_OTHER_SIZE,
    GOLDEN_DAMAGED, /* no PNG */
    GOLDEN_MISSING,
    GOLDEN_VERDICT_COUNT
} golden_verdict;

typedef struct golden_finding {
    int64_t number; /* of the frame */
    double time_s;
    golden_verdict verdict;
    image_difference difference; /* GOLDEN_DIFFERS */
    int has_pictures;
} golden_finding;

typedef struct golden_report {
    char folder[GOLDEN_PATH_SIZE];
    golden_finding *finding;
    int64_t count, room, pictured;
} golden_report;

/* Makes nothing yet, and takes away what an earlier comparison left. 0: the name is too long. */
int golden_report_open(golden_report *r, const char *folder);
/*
 * Keeps the finding and writes its pictures; of the first few hundred, the others are rows of the page alone.
 * @golden  NULL: there is none that can be read
 * @diff    NULL: there is none
 */
int golden_report_add(golden_report *r, const golden_finding *finding, const image *golden, const image *got,
                      const image *diff, fault *f);
/*
 * Writes the page, where anything was found.
 * @title   what was compared
 * @advice  a sentence for who reads it
 */
int golden_report_finish(golden_report *r, const char *title, const char *advice, int64_t compared, fault *f);
void golden_report_close(golden_report *r);

/* FOLDER/NNNNKIND.png. 0: the name is too long. */
int golden_picture_name(char path[GOLDEN_PATH_SIZE], const char *folder, int64_t number, const char *kind,
                        fault *f);
/* With all folders above it. */
int golden_make_folders(const char *path, fault *f);

#endif
