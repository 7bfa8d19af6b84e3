/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What of the scan a vertex of the laid face belongs to: the nearest place that faces as it does, is not across a slit (masks
 * of Sanchez Lorenzo et al. 2003, section 4.3), is skin, and is no rim of a hole.
 */
#ifndef LIB_REGISTRATION_COUNTERPART_H
#define LIB_REGISTRATION_COUNTERPART_H

#include "registration/elastic.h"
#include "registration/laying.h"

typedef struct counterparts {
    const laying *l;
    uint8_t *side;    /* [scan triangles] sides of slits of the face that is laid over them */
    uint8_t *foreign; /* [scan triangles] 1: nearest to something that is no skin */
} counterparts;

/* Both: FAP_E_NOMEM. counterparts_close() in any case. */
fap_err counterparts_open(counterparts *c, const laying *l);
/* After the face has moved: which side of the slits each triangle of the scan is on. */
fap_err counterparts_mark(counterparts *c);
void counterparts_close(counterparts *c);

/* @p facing: least cosine between the normals. The pull's weight falls to 0 at @p reach; 0: there is none. */
void counterpart_find(const counterparts *c, uint32_t vertex, double reach, double facing, elastic_pull *out);
/* 1: the triangle of the scan may belong to the vertex. */
int counterpart_fits(const counterparts *c, uint32_t vertex, uint32_t triangle, double facing);

#endif
