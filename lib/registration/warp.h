/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Space bent so that some places go where they should: radial functions and an affine part, solved once. Sources: Zhu 2006
 * section 4.3, eq. 4.2 and 4.3 (Hardy's multiquadric, each centre's stiffness its distance to the nearest other); Yano and
 * Harada 2009 section 3.1 (thin plate, r^2 log r).
 */
#ifndef LIB_REGISTRATION_WARP_H
#define LIB_REGISTRATION_WARP_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>

typedef enum warp_kernel {
    WARP_HARDY,      /* sqrt(r^2 + s_i^2) */
    WARP_THIN_PLATE, /* r^2 log r: the least bending in a plane; z is not looked at */
    WARP_BIHARMONIC  /* r: the least bending in space */
} warp_kernel;

typedef struct warp {
    warp_kernel kernel;
    uint32_t count;
    double (*centre)[3], *stiffness, (*weight)[3];
    double affine[4][3]; /* of 1, x, y, z */
} warp;

/*
 * @p slack: how far, squared, a centre of weight 1 may stay off; 0: all are met exactly. @p weight: NULL: all 1.
 * FAP_E_DATA: two centres in one place, or all in one plane (thin plate: on one line). FAP_E_NOMEM.
 */
fap_err warp_open(warp *w, warp_kernel kernel, const double (*centre)[3], const double (*move)[3],
                  const double *weight, uint32_t count, double slack, const fap_allocator *alloc);
void warp_close(warp *w, const fap_allocator *alloc);
/* How far a place moves. */
void warp_move(const warp *w, const double at[3], double move[3]);

#endif
