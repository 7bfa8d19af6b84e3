/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A skin that bends as little as it can while its vertices are drawn to planes and places: the sparse linear least squares of
 * one round of registration, solved by conjugate gradients.
 */
#ifndef LIB_REGISTRATION_ELASTIC_H
#define LIB_REGISTRATION_ELASTIC_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>

#include "surface/edges.h"

/* What draws one vertex: weight * |x - to|^2 along the normal, weight * slide * |x - to|^2 across it. */
typedef struct elastic_pull {
    double to[3], normal[3], weight;
} elastic_pull;

/* A place on the skin, mixed of three vertices, that is drawn to another. */
typedef struct elastic_pin {
    uint32_t vertex[3];
    double share[3], to[3], weight;
} elastic_pin;

typedef struct elastic elastic;

/*
 * @p rest  shape from which bending counts; borrowed
 * @p use   [count] 0: the vertex takes no part. FAP_E_NOMEM.
 */
fap_err elastic_open(elastic **out, const float (*rest)[3], uint32_t count, const uint32_t (*triangle)[3],
                     uint32_t triangle_count, const surface_edges *edges, const uint8_t *use,
                     const fap_allocator *alloc);
void elastic_close(elastic **e);

typedef struct elastic_task {
    const elastic_pull *pull; /* [count] */
    const elastic_pin *pin;
    uint32_t pin_count;
    double slide;     /* share of a pull across its normal */
    double stiffness; /* of bending, against pulls of weight 1: its fourth root is in vertices */
    double stretch;   /* the same of stretching */
    int rounds;       /* conjugate gradients at most */
    double enough;    /* ends when the residual has shrunk to this share */
} elastic_task;
/* @p at: [count] in: where to begin; out: the answer. Returns the rounds taken. */
int elastic_solve(elastic *e, const elastic_task *task, float (*at)[3]);

#endif
