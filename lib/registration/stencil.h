/* SPDX-License-Identifier: BSD-2-Clause */
/* The part of a face that words do not move. Source: Yano & Harada 2009 section 4.1: shortest paths, and spheres around them. */
#ifndef LIB_REGISTRATION_STENCIL_H
#define LIB_REGISTRATION_STENCIL_H

#include <fap/bank.h>

/*
 * @at   [vertices] the face as it is now
 * @out  [vertices] 1: within a sphere of that radius about a vertex of one of the paths, and skin
 * FAP_E_DATA: the bank has no points for any path; FAP_E_NOMEM.
 */
fap_err stencil_find(const fap_bank *bank, const float (*at)[3], double radius_mm, uint8_t *out,
                     const fap_allocator *alloc);

#endif
