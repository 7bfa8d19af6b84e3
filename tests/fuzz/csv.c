/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as a text take: the first byte chooses the head that the sniffer looks for. */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/take.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const heads[] = { "confidence,X_67,Y_67,Z_67,", "Trajectories\n100\n",
                                     "Format Version,1.23,Export Frame Rate,120\n", "a_x,a_y,a_z,", "" };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{

    if (!size)
        return 0;
    const char *head = heads[data[0] % 5];
    const size_t head_size = strlen(head), total = head_size + size - 1;
    char *text = malloc(total + 1);
    if (!text)
        return 0;
    memcpy(text, head, head_size);
    memcpy(text + head_size, data + 1, size - 1);
    fuzz_take(text, total);
    free(text);
    return 0;
}
