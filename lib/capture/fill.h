/* SPDX-License-Identifier: BSD-2-Clause */
/* Closing the gaps of a take: part of fap_take_clean(). */
#ifndef LIB_CAPTURE_FILL_H
#define LIB_CAPTURE_FILL_H

#include <fap/studio/clean.h>

/* @p points: [point_count], counted up. FAP_OK or FAP_E_NOMEM. */
fap_err fill_gaps(fap_take *take, const fap_clean_config *cfg, fap_clean_point *points);

#endif
