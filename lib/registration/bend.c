/* SPDX-License-Identifier: BSD-2-Clause */
/* Landmarks bend space, and the generic face in it: how every method begins (Zhu 2006 section 4.3). */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/laying.h"

/* Lips that are shut have two landmarks in one place, and no function takes two values there: they share the mean. */
static const double one_place_mm = 0.2;

typedef struct bending {
    double (*centre)[3], (*move)[3];
    uint32_t *merged, count;
    double slack;
} bending;

static uint32_t find_centre(const bending *b, const double at[3])
{
    if (b->slack > 0)
        return b->count;
    for (uint32_t i = 0; i < b->count; i++)
        if (pow(at[0] - b->centre[i][0], 2) + pow(at[1] - b->centre[i][1], 2) +
                pow(at[2] - b->centre[i][2], 2) <
            one_place_mm * one_place_mm)
            return i;
    return b->count;
}

static void collect(const laying *l, bending *b)
{
    for (uint32_t i = 0; i < l->pin_count; i++) {
        double at[3];
        if (l->pin[i].weight <= 0)
            continue;
        laying_pin_place(&l->pin[i], l->generic->position, at);
        const uint32_t k = find_centre(b, at);
        if (k == b->count)
            memcpy(b->centre[b->count++], at, sizeof at);
        b->merged[k]++;
        for (int a = 0; a < 3; a++)
            b->move[k][a] += (l->pin[i].at[a] - at[a] - b->move[k][a]) / b->merged[k];
    }
}

static void bend_face(laying *l, const warp *w)
{
    for (uint32_t i = 0; i < l->generic->vertex_count; i++) {
        double at[3], moved[3];
        for (int a = 0; a < 3; a++)
            at[a] = (double)l->generic->position[i][a];
        warp_move(w, at, moved);
        for (int a = 0; a < 3; a++)
            l->at[i][a] = (float)(at[a] + moved[a]);
    }
}

fap_err laying_bend(laying *l, warp_kernel kernel, double slack)
{
    bending b = { .centre = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.centre),
                  .move = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.move),
                  .merged = fap_mem_calloc(l->alloc, l->pin_count, sizeof *b.merged),
                  .slack = slack };
    fap_err err = b.centre && b.move && b.merged ? FAP_OK : FAP_E_NOMEM;
    warp w;

    if (err == FAP_OK) {
        collect(l, &b);
        err = warp_open(&w, kernel, (const double(*)[3])b.centre, (const double(*)[3])b.move, NULL, b.count,
                        slack, l->alloc);
    }
    if (err == FAP_OK) {
        bend_face(l, &w);
        warp_close(&w, l->alloc);
    }
    fap_mem_free(l->alloc, b.centre);
    fap_mem_free(l->alloc, b.move);
    fap_mem_free(l->alloc, b.merged);
    if (err == FAP_E_DATA)
        return slack > 0
                   ? FAP_OK
                   : laying_fail(l, err, "the landmarks are too few, or all in one plane, to bend space by");
    return err;
}
