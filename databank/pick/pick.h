/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fapbank pick: somebody points at 28 places of a scan, 144 more follow (Zhu 2006 section 4.2). What a click and a key mean is here;
 * the pictures are in pick_view.h, the window in pick_window.h.
 */
#ifndef DATABANK_PICK_PICK_H
#define DATABANK_PICK_PICK_H

#include <stdio.h>

#include <fap/studio/labels.h>
#include <fap/studio/take.h>

#include "surface/nearest.h"

typedef struct pick {
    const fap_bank *bank;
    const surface_index *index; /* of the scan */
    fap_labels labels;
    fap_label_place place[FAP_LABELS];
    uint32_t asked;    /* the major label asked for now; FAP_LABELS_MAJOR: none is left */
    int finished;      /* Return was pressed */
    double turn[3][3]; /* screen = turn * scan: x to the right, y up, z to who looks, from the front */
} pick;

fap_err pick_open(pick *p, const fap_bank *bank, const surface_index *index);
/* Landmarks that are known already; those that are labels count as placed. */
void pick_take(pick *p, const fap_take *landmarks);

/* It is there, scan axes; on to the next one that is not placed. */
void pick_place(pick *p, const float at[3]);
void pick_skip(pick *p);
/* Back by one, and what was placed there is forgotten. */
void pick_back(pick *p);
/* A quarter about an axis of the screen: 0 to the right, 1 up, 2 to who looks. */
void pick_turn(pick *p, int axis, int quarters);

uint32_t pick_placed(const pick *p);
/* "3.7", and "left eye, left (outer) corner"; "" where it is no feature point. */
const char *pick_name(const pick *p, uint32_t label);
const char *pick_description(const pick *p, uint32_t label);
/* What fapbank fit --landmarks reads; @minor: feature points that followed onto the scan too. */
void pick_write(const pick *p, int minor, FILE *out);

#endif
