/* SPDX-License-Identifier: BSD-2-Clause */
/* What feature points can tell about a bank, for fapbank info. */
#ifndef DATABANK_OBSERVED_H
#define DATABANK_OBSERVED_H

#include <fap/bank.h>

#include "common/json.h"

void observed_print(const fap_bank *bank);
void observed_put(json *j, const fap_bank *bank);

#endif
