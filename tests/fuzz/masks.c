/* SPDX-License-Identifier: BSD-2-Clause */
/* Any text as a table of masks: what was taken must come back as it was from a table of our own. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/masks.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { VERTICES = 100, ROOM = 1 << 15 };

typedef struct text {
    char bytes[ROOM];
    size_t size;
} text;

static int keep(void *user, const void *data, size_t size)
{
    text *t = user;

    if (size > ROOM - t->size)
        return 1;
    memcpy(t->bytes + t->size, data, size);
    t->size += size;
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t mask[VERTICES], again[VERTICES];
    char where[FAP_ERROR_TEXT_SIZE];
    static text t;
    const fap_writer w = { keep, &t };

    t.size = 0;
    if (fap_masks_read(mask, VERTICES, data, size, where) != FAP_OK)
        return 0;
    if (fap_masks_write(mask, VERTICES, &w) != FAP_OK ||
        fap_masks_read(again, VERTICES, t.bytes, t.size, where) != FAP_OK || memcmp(mask, again, VERTICES))
        abort();
    return 0;
}
