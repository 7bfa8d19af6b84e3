/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as a C3D file: the key byte is set, so that the sniffer lets them through. */
#include <stdlib.h>
#include <string.h>

#include <fap/studio/take.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + 1);
    fap_take *take;
    char where[FAP_ERROR_TEXT_SIZE];

    if (!copy)
        return 0;
    memcpy(copy, data, size);
    if (size > 1)
        copy[1] = 0x50;
    if (fap_take_read(&take, copy, size, NULL, where) == FAP_OK)
        fap_take_close(&take);
    free(copy);
    return 0;
}
