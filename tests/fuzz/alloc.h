/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * An allocator for fuzz targets: the n-th allocation fails, every block must come back to the allocator it is
 * from, and none may be left. Blocks that are written past their end are the sanitizer's to find, not ours.
 *
 *     fuzz_memory m = { .fail_at = data[0] & 7 };
 *     const fap_allocator alloc = fuzz_allocator(&m);
 *     ... open with alloc, use, close ...
 *     fuzz_memory_check(&m);
 */
#ifndef TESTS_FUZZ_ALLOC_H
#define TESTS_FUZZ_ALLOC_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/alloc.h>
#include <fap/error.h>

typedef struct fuzz_memory {
    long fail_at; /* which allocation fails, from 1; 0: none */
    long asked;   /* allocations so far; asked >= fail_at says that the failure has happened */
    long live;    /* blocks not yet freed */
} fuzz_memory;

/* In front of each block; as large as the strictest alignment, so that the block keeps it. */
typedef union fuzz_block {
    fuzz_memory *owner;
    max_align_t align;
} fuzz_block;

static inline void *fuzz_memory_alloc(void *user, size_t size)
{
    fuzz_memory *m = user;

    if (++m->asked == m->fail_at || size > SIZE_MAX - sizeof(fuzz_block))
        return NULL;
    fuzz_block *b = malloc(sizeof *b + size);
    if (!b)
        return NULL;
    b->owner = m;
    m->live++;
    return b + 1;
}

static inline void fuzz_memory_free(void *user, void *ptr)
{
    fuzz_memory *m = user;

    if (!ptr || ((fuzz_block *)ptr)[-1].owner != m)
        abort();
    m->live--;
    free((fuzz_block *)ptr - 1);
}

static inline fap_allocator fuzz_allocator(fuzz_memory *m)
{
    return (fap_allocator){ fuzz_memory_alloc, fuzz_memory_free, m };
}

/* 1: the allocation that was to fail has been asked for. */
static inline int fuzz_memory_failed(const fuzz_memory *m)
{
    return m->fail_at && m->asked >= m->fail_at;
}

/* Everything is freed, or it is a bug. */
static inline void fuzz_memory_check(const fuzz_memory *m)
{
    if (m->live)
        abort();
}

/* What is sound fails for the memory alone; what is not may fail for either. */
static inline void fuzz_memory_error(fap_err whole, fap_err without)
{
    if (whole == FAP_OK ? without != FAP_E_NOMEM : without == FAP_OK)
        abort();
}

/*
 * Loads a sealed copy of the input with all the memory there is, and then once more for every allocation, which fails.
 */
static inline void fuzz_every_allocation(const uint8_t *data, size_t size,
                                         void (*seal)(uint8_t *data, size_t size),
                                         fap_err (*load)(const uint8_t *data, size_t size, fuzz_memory *m))
{
    fuzz_memory all = { 0 };
    uint8_t *copy = malloc(size + 1);

    if (!copy)
        return;
    if (size)
        memcpy(copy, data, size);
    seal(copy, size);
    const fap_err whole = load(copy, size, &all);
    for (long n = 1; n <= all.asked; n++)
        fuzz_memory_error(whole, load(copy, size, &(fuzz_memory){ .fail_at = n }));
    free(copy);
}

#endif
