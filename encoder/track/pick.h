/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Showing where the dots are: one label after the other, in the direct view first and then in each mirror. What a click and a key mean is
 * here; the window is in pick_window.h.
 */
#ifndef ENCODER_TRACK_PICK_H
#define ENCODER_TRACK_PICK_H

#include <stdio.h>

#include <fap/studio/tracks.h>

typedef struct pick {
    fap_track_dots dots; /* every label, in the order they are asked for; has: was clicked */
    int mirrors;
    int view, label; /* what is asked for now */
    int finished;
} pick;

/*
 * Feature points that people put dots on, then the ruler's ends. @list: other labels, one a line, or NULL; borrowed for the call.
 * FAP_E_LIMIT: too many; FAP_E_NOT_FOUND: none; FAP_E_NOMEM.
 */
fap_err pick_open(pick *p, const char *list, int mirrors);
void pick_close(pick *p);

/* It is there; on to the next one. */
void pick_click(pick *p, double x, double y);
/* It is not seen in this view; on to the next one. */
void pick_skip(pick *p);
/* Back by one, and what was clicked there is forgotten. */
void pick_back(pick *p);
/* All labels of that view again, from its first that was not clicked. */
void pick_go_to_view(pick *p, int view);

/* "direct", "mirror 1" */
const char *pick_view_name(int view);
/* In how many views a label was clicked. */
int pick_count(const pick *p, int label);
/* What fapenc track --init reads; labels that were never clicked are left out. */
void pick_write(const pick *p, FILE *out);

#endif
