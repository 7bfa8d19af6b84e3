/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as a C3D file: the key byte is set, so that the sniffer lets them through. */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/take.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + 1);

    if (!copy)
        return 0;
    if (size)
        memcpy(copy, data, size);
    if (size > 1)
        copy[1] = 0x50;
    fuzz_take(copy, size);
    free(copy);
    return 0;
}
