/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Where a handle's memory comes from. Only open and load calls allocate; frame calls never do.
 */
#ifndef FAP_ALLOC_H
#define FAP_ALLOC_H

#include <stddef.h>

/**
 * An allocator. All members NULL means malloc and free.
 * @c alloc returns memory aligned for any C object, or NULL; @c free accepts what @c alloc gave, never NULL.
 */
typedef struct fap_allocator {
    void *(*alloc)(void *user, size_t size);
    void (*free)(void *user, void *ptr);
    void *user;
} fap_allocator;

#endif
