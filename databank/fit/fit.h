/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank fit: a generic face onto a scan. */
#ifndef DATABANK_FIT_FIT_H
#define DATABANK_FIT_FIT_H

#include <fap/studio/labels.h>
#include <fap/studio/landmarks.h>
#include <fap/studio/retarget.h>

#include "common/fault.h"
#include "databank/fit/fit_options.h"

/* What is read and made on the way. */
typedef struct fit_work {
    const fit_options *opt;
    fap_bank *bank; /* the generic face */
    fap_generic generic;
    fap_surface *scan;
    fap_take *landmarks;
    fap_pin pin[FAP_POINT_COUNT + FAP_LABELS];
    uint32_t pin_count, followed; /* followed: of these, minor points that were not given */
    fap_registration *registration;
    fap_bank_builder *face; /* the generic face's motions on the scanned one */
    float (*uv)[2];         /* of the scan's picture, one a vertex of the laid face; NULL: it has none */
    uint8_t (*colour)[4];   /* the same; the fourth is 0 where nothing was scanned */
    fap_retarget_scale scale;
    double seconds;
} fit_work;

/* @argv[0] is "fit". @return the exit status */
int fit_run(int argc, char **argv);

#endif
