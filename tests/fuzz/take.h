/* SPDX-License-Identifier: BSD-2-Clause */
/* What the targets of all take readers do: read, and read again with one allocation that fails. */
#ifndef TESTS_FUZZ_TAKE_H
#define TESTS_FUZZ_TAKE_H

#include <string.h>

#include <fap/studio/take.h>

#include "tests/fuzz/alloc.h"

static inline fap_err fuzz_take_read(const void *data, size_t size, fuzz_memory *m)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_take_config cfg;
    fap_take *take;

    fap_take_config_init(&cfg);
    cfg.alloc = fuzz_allocator(m);
    const fap_err err = fap_take_read(&take, data, size, &cfg, where);
    if ((err == FAP_OK) != (take != NULL) || !memchr(where, '\0', sizeof where))
        abort();
    fap_take_close(&take);
    fuzz_memory_check(m);
    return err;
}

/* Which allocation fails depends on the input, so that all have their turn. */
static inline void fuzz_take(const void *data, size_t size)
{
    fuzz_memory all = { 0 };

    const fap_err whole = fuzz_take_read(data, size, &all);
    if (!all.asked)
        return;
    const long n = 1 + (long)(size % (size_t)all.asked);
    fuzz_memory_error(whole, fuzz_take_read(data, size, &(fuzz_memory){ .fail_at = n }));
}

#endif
