/* SPDX-License-Identifier: BSD-2-Clause */
/* Fuzzes the zip reader with the inflater behind it. */
#include <stdlib.h>

#include "shape/inflate.h"
#include "shape/zip.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *out;
    size_t out_size;
    fap_zip zip;

    if (fap_zip_open(&zip, data, size) == FAP_OK &&
        fap_zip_extract(&zip, "a", 1 << 20, &out, &out_size) == FAP_OK)
        free(out);
    if (fap_gunzip(data, size, 1 << 20, &out, &out_size) == FAP_OK)
        free(out);
    return 0;
}
