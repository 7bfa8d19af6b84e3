/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes behind the word that makes a file a TRC. */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/take.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char head[] = "PathFileType\t4\t(X/Y/Z)\tx\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t total = sizeof head - 1 + size;
    char *text = malloc(total);

    if (!text)
        return 0;
    memcpy(text, head, sizeof head - 1);
    if (size)
        memcpy(text + sizeof head - 1, data, size);
    fuzz_take(text, total);
    free(text);
    return 0;
}
