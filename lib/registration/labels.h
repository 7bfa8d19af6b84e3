/* SPDX-License-Identifier: BSD-2-Clause */
/* fap_labels_follow() for somebody who has an index of the scan already. */
#ifndef LIB_REGISTRATION_LABELS_H
#define LIB_REGISTRATION_LABELS_H

#include <fap/studio/labels.h>

#include "surface/nearest.h"

/* @index NULL: nothing is met. */
fap_err labels_follow(const fap_labels *labels, const fap_bank *bank, const surface_index *index,
                      fap_label_place *place);

#endif
