/* SPDX-License-Identifier: BSD-2-Clause */
/* The exact answer, bounded least squares on the units, as a method of its own. */
#include "bank/face.h"

static int open_qp(void *state, const fap_face *face)
{
    return fap_least_squares_open(state, face);
}

static void close_qp(void *state, const fap_face *face)
{
    fap_least_squares_close(state, face);
}

static void solve_qp(void *state, fap_face *face)
{
    fap_least_squares_solve(state, face, face->weight);
}

const fap_blend_method fap_blend_qp = {
    .name = "qp",
    .summary = "exact bounded least squares on the units",
    .state_size = sizeof(fap_least_squares),
    .open = open_qp,
    .close = close_qp,
    .solve = solve_qp,
};
