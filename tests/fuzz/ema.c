/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as articulography: the first one chooses between Carstens' files and MATLAB's, whose head is put in front. */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/take.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAT_HEAD = 128 };
static const char pos_head[] = "AG50xDATA_V003\n";

/* @kind 0: Carstens. */
static size_t put_head(int kind, char head[MAT_HEAD])
{
    if (!kind) {
        memcpy(head, pos_head, sizeof pos_head - 1);
        return sizeof pos_head - 1;
    }
    memset(head, ' ', MAT_HEAD);
    memcpy(head, "MATLAB", 6);
    memcpy(head + MAT_HEAD - 4, kind == 1 ? "\0\1IM" : "\1\0MI", 4);
    return MAT_HEAD;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *file = malloc(MAT_HEAD + size);

    if (size && file) {
        const size_t head = put_head(*data % 3, file);
        memcpy(file + head, data + 1, size - 1);
        fuzz_take(file, head + size - 1);
    }
    free(file);
    return 0;
}
