/* SPDX-License-Identifier: BSD-2-Clause */
/* Fuzzes the reader of MakeHuman targets. */
#include <stdlib.h>
#include <string.h>

#include "shape/target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    float delta[8][3] = { { 0 } };
    char *text = malloc(size + 1);
    int line;

    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    const fap_err err = fap_target_add(text, 1, delta, 8, &line);
    free(text);
    return err > FAP_OK;
}
