/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The bank as an object: its memory and its accessors. How it comes into being is bank_load.c's and
 * builtin.c's business.
 */
#include <string.h>

#include "bank/bank.h"
#include "base/mem.h"

/* Blocks hang on a list; the payload follows at the next 32-byte boundary. */
typedef struct fap_bank_block {
    struct fap_bank_block *next;
} block;

enum { BLOCK_HEAD = 32 };
_Static_assert(sizeof(block) <= BLOCK_HEAD, "payload would lose its alignment");

fap_bank *fap_bank_new(const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    fap_bank *bank = fap_mem_calloc(&a, 1, sizeof *bank);

    if (bank)
        bank->alloc = a;
    return bank;
}

void *fap_bank_keep(fap_bank *bank, size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 4) / size)
        return NULL;
    block *b = fap_mem_calloc_aligned(&bank->alloc, BLOCK_HEAD + count * size, 1);
    if (!b)
        return NULL;
    b->next = bank->blocks;
    bank->blocks = b;
    return (char *)b + BLOCK_HEAD;
}

void fap_bank_close(fap_bank **bank)
{
    if (!bank || !*bank)
        return;
    const fap_allocator a = (*bank)->alloc;
    for (block *b = (*bank)->blocks, *next; b; b = next) {
        next = b->next;
        fap_mem_free_aligned(&a, b);
    }
    fap_mem_free(&a, *bank);
    *bank = NULL;
}

const char *fap_bank_name(const fap_bank *bank)
{
    return bank->name;
}

const fap_mesh *fap_bank_mesh(const fap_bank *bank)
{
    return &bank->mesh;
}

const fap_fapu *fap_bank_fapu(const fap_bank *bank)
{
    return &bank->fapu;
}

const fap_bank_point *fap_bank_point_get(const fap_bank *bank, int point)
{
    return point >= 0 && point < FAP_POINT_COUNT ? &bank->point[point] : NULL;
}

int fap_bank_key_count(const fap_bank *bank)
{
    return bank->key_count;
}

const fap_key *fap_bank_key_get(const fap_bank *bank, int key)
{
    return key >= 0 && key < bank->key_count ? &bank->key[key] : NULL;
}

int fap_bank_key_find(const fap_bank *bank, fap_key_kind kind, const char *name)
{
    for (int k = 0; k < bank->key_count; k++)
        if (bank->key[k].kind == kind && !strcmp(bank->key[k].name, name))
            return k;
    return -1;
}

int fap_bank_key_number(const fap_bank *bank, fap_key_kind kind, int number)
{
    for (int k = 0; k < bank->key_count; k++)
        if (bank->key[k].kind == kind && bank->key[k].number == number)
            return k;
    return -1;
}

int fap_bank_eye(const fap_bank *bank, int right, float centre_mm[3], float *radius_mm)
{
    const fap_bank_eye_place *eye = &bank->eye[right != 0];

    if (!(eye->radius_mm > 0))
        return 0;
    memcpy(centre_mm, eye->centre_mm, sizeof eye->centre_mm);
    *radius_mm = eye->radius_mm;
    return 1;
}

const fap_region_lines *fap_bank_regions(const fap_bank *bank)
{
    return bank->regions.from ? &bank->regions : NULL;
}

const uint8_t *fap_bank_masks(const fap_bank *bank)
{
    return bank->mask;
}

const fap_basis *fap_bank_basis(const fap_bank *bank)
{
    return bank->basis.component ? &bank->basis : NULL;
}
