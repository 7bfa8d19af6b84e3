/* SPDX-License-Identifier: BSD-2-Clause */
/* See mem.h. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

enum { ALIGNMENT = 32 };

static void *default_alloc(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void default_free(void *user, void *ptr)
{
    (void)user;
    free(ptr);
}

fap_allocator fap_mem_allocator(const fap_allocator *user)
{
    if (user && user->alloc && user->free)
        return *user;
    return (fap_allocator){ default_alloc, default_free, NULL };
}

void *fap_mem_calloc(const fap_allocator *a, size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 2) / size)
        return NULL;
    const size_t bytes = count * size, total = bytes > 0 ? bytes : 1;
    void *p = a->alloc(a->user, total);
    return p ? memset(p, 0, total) : NULL;
}

void fap_mem_free(const fap_allocator *a, void *ptr)
{
    if (ptr)
        a->free(a->user, ptr);
}

/* The block's own address is kept in the slot before the aligned one. */
void *fap_mem_calloc_aligned(const fap_allocator *a, size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 2) / size)
        return NULL;
    char *block = fap_mem_calloc(a, count * size + ALIGNMENT + sizeof(void *), 1);
    if (!block)
        return NULL;
    const uintptr_t start = ((uintptr_t)block + sizeof(void *) + ALIGNMENT - 1) & ~(uintptr_t)(ALIGNMENT - 1);
    void **aligned = (void **)start;
    aligned[-1] = block;
    return aligned;
}

void fap_mem_free_aligned(const fap_allocator *a, void *ptr)
{
    if (ptr)
        a->free(a->user, ((void **)ptr)[-1]);
}
