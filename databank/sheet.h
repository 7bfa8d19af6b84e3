/* SPDX-License-Identifier: BSD-2-Clause */
/* A contact sheet: every key model of a bank, with its name. */
#ifndef DATABANK_SHEET_H
#define DATABANK_SHEET_H

#include <fap/bank.h>

/* @p missing gets the name of a library this build lacks, with FAP_E_UNSUPPORTED. */
fap_err sheet_write(const fap_bank *bank, const char *path, int columns, int tile_px, const char **missing);

#endif
