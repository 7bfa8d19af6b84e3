/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How errors of places grow with noise in the picture, and fall with the number of points that a mirror is found from: Lin, Yeh,
 * Ouhyoung 2001, section 4.3 and fig. 6. An object of their proportions: 1000 x 2000 x 1000, 4000 away from the lens; here 200 mm high.
 */
#ifndef TESTS_TRACK_NOISE_STUDY_H
#define TESTS_TRACK_NOISE_STUDY_H

typedef enum study_method {
    STUDY_TWO_VIEWS, /* the general way: two_view.h */
    STUDY_MIRROR,    /* the paper's */
    STUDY_REFINED,   /* the same, then errors in the picture made least, as fapenc track does */
    STUDY_METHODS
} study_method;

const char *study_method_name(int method);

typedef struct study_setting {
    double variance_px2; /* of the noise in x and in y of every point of a picture 480 pixels high */
    int points;          /* that the mirror, or the second camera, is found from */
    int trials;
} study_setting;

typedef struct study_result {
    double median_mm,
        tenth_mm; /* RMS of 50 other points, noisy too: in the middle trial, and in the worst tenth at least */
    int failed;   /* trials without an answer; counted as infinitely wrong */
} study_result;

/* The same numbers each time. All methods see the same points and noise. */
int study_run(const study_setting *s, study_result result[STUDY_METHODS]); /* 0: no memory */

#endif
