/* SPDX-License-Identifier: BSD-2-Clause */
/* Memory through the caller's allocator, with the overflow checks in one place. */
#ifndef LIB_BASE_MEM_H
#define LIB_BASE_MEM_H

#include <stddef.h>

#include <fap/alloc.h>

/* The allocator to use: @p user's, or malloc and free where it is NULL or empty. */
fap_allocator fap_mem_allocator(const fap_allocator *user);

/* @p count elements of @p size bytes, zeroed; NULL when that overflows or there is no memory. Count 0 gives memory too. */
void *fap_mem_calloc(const fap_allocator *a, size_t count, size_t size);

/* The same on a 32-byte boundary, for vertex arrays. Free with fap_mem_free_aligned(). */
void *fap_mem_calloc_aligned(const fap_allocator *a, size_t count, size_t size);

/* Both accept NULL. */
void fap_mem_free(const fap_allocator *a, void *ptr);
void fap_mem_free_aligned(const fap_allocator *a, void *ptr);

#endif
