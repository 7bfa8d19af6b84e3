/* SPDX-License-Identifier: BSD-2-Clause */
/* How well a face lies. */
#ifndef LIB_REGISTRATION_MEASURE_H
#define LIB_REGISTRATION_MEASURE_H

#include "registration/laying.h"

/* Distances to the scan and the pins, and folds, into the report; in the generic face's size. */
void laying_measure(laying *l);

#endif
