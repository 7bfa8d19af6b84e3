/* SPDX-License-Identifier: BSD-2-Clause */
/* See rewrite.h. */
#include <stdlib.h>
#include <string.h>

#include "databank/rewrite.h"

typedef struct memory {
    uint8_t *data;
    size_t size, room;
} memory;

static int memory_write(void *user, const void *data, size_t size)
{
    memory *m = user;

    if (m->size + size > m->room) {
        const size_t room = 2 * (m->size + size);
        uint8_t *grown = realloc(m->data, room);
        if (!grown)
            return 1;
        m->data = grown;
        m->room = room;
    }
    memcpy(m->data + m->size, data, size);
    m->size += size;
    return 0;
}

fap_err bank_rewrite(fap_bank **bank, fap_bank_builder *b)
{
    memory m = { 0 };
    const fap_writer w = { memory_write, &m };
    fap_bank *fresh;

    fap_err err = fap_bank_builder_write(b, &w);
    if (!err)
        err = fap_bank_load(&fresh, m.data, m.size, NULL);
    free(m.data);
    if (err)
        return err;
    fap_bank_close(bank);
    *bank = fresh;
    return FAP_OK;
}
