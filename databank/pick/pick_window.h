/* SPDX-License-Identifier: BSD-2-Clause */
/* The window in which a scan is pointed at: from its right, from the front, from its left, and the generic face as a guide. */
#ifndef DATABANK_PICK_PICK_WINDOW_H
#define DATABANK_PICK_PICK_WINDOW_H

#include "common/fault.h"
#include "databank/pick/pick.h"
#include "databank/pick/pick_view.h"

/* Until Return. 0: it was closed before, or there is no window to be had; @f says so. */
int pick_window_run(pick *p, const pick_scene *scan, const pick_scene *guide, fault *f);

#endif
