/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick.h. */
#include <string.h>

#include "databank/pick/pick.h"
#include "registration/labels.h"

static const char nameless[] = "";

fap_err pick_open(pick *p, const fap_bank *bank, const surface_index *index)
{
    *p = (pick){ .bank = bank, .index = index, .turn = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    return fap_labels_of_bank(&p->labels, bank);
}

static void follow(pick *p)
{
    if (labels_follow(&p->labels, p->bank, p->index, p->place) == FAP_OK)
        return;
    for (uint32_t i = 0; i < p->labels.count; i++)
        if (p->place[i].state != FAP_LABEL_PLACED)
            p->place[i].state = FAP_LABEL_UNKNOWN;
}

static void ask_next(pick *p)
{
    while (p->asked < FAP_LABELS_MAJOR && p->place[p->asked].state == FAP_LABEL_PLACED)
        p->asked++;
}

const char *pick_name(const pick *p, uint32_t label)
{
    return p->labels.point[label] < 0 ? nameless : fap_point_get(p->labels.point[label])->name;
}

const char *pick_description(const pick *p, uint32_t label)
{
    return p->labels.point[label] < 0 ? nameless : fap_point_get(p->labels.point[label])->description;
}

void pick_take(pick *p, const fap_take *landmarks)
{
    for (uint32_t i = 0; i < p->labels.count; i++) {
        const int found = *pick_name(p, i) ? fap_take_find(landmarks, pick_name(p, i)) : -1;
        if (found < 0)
            continue;
        memcpy(p->place[i].at, landmarks->xyz[found], sizeof p->place[i].at);
        p->place[i].state = FAP_LABEL_PLACED;
    }
    ask_next(p);
    follow(p);
}

/* --- steps --- */

void pick_place(pick *p, const float at[3])
{
    if (p->asked >= FAP_LABELS_MAJOR)
        return;
    memcpy(p->place[p->asked].at, at, sizeof p->place[p->asked].at);
    p->place[p->asked++].state = FAP_LABEL_PLACED;
    ask_next(p);
    follow(p);
}

void pick_skip(pick *p)
{
    if (p->asked < FAP_LABELS_MAJOR)
        p->asked++;
    ask_next(p);
}

void pick_back(pick *p)
{
    if (!p->asked)
        return;
    p->place[--p->asked].state = FAP_LABEL_UNKNOWN;
    follow(p);
}

void pick_turn(pick *p, int axis, int quarters)
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;

    for (int q = 0; q < (quarters % 4 + 4) % 4; q++)
        for (int k = 0; k < 3; k++) {
            const double from = p->turn[a][k];
            p->turn[a][k] = -p->turn[b][k];
            p->turn[b][k] = from;
        }
}

uint32_t pick_placed(const pick *p)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < p->labels.count; i++)
        count += p->place[i].state == FAP_LABEL_PLACED;
    return count;
}

/* --- what came of it --- */

void pick_write(const pick *p, int minor, FILE *out)
{
    fputs("name,x,y,z\n", out);
    for (uint32_t i = 0; i < p->labels.count; i++) {
        const fap_label_place *at = &p->place[i];
        if (*pick_name(p, i) && (at->state == FAP_LABEL_PLACED || (minor && at->state == FAP_LABEL_MET)))
            fprintf(out, "%s,%.9g,%.9g,%.9g\n", pick_name(p, i), (double)at->at[0], (double)at->at[1],
                    (double)at->at[2]);
    }
}
