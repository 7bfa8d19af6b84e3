/* SPDX-License-Identifier: BSD-2-Clause */
/* MakeHuman's .target: one "vertex dx dy dz" a line, # starts a comment; vertices that are missing do not
 * move. */
#ifndef LIB_SHAPE_TARGET_H
#define LIB_SHAPE_TARGET_H

#include <stdint.h>

#include <fap/error.h>

/* delta[vertex] += weight * (dx dy dz). FAP_E_SYNTAX or an index beyond @p count: FAP_E_DATA; @p line (may be NULL) says
 * where. */
fap_err fap_target_add(const char *text, float weight, float (*delta)[3], uint32_t count, int *line);

#endif
