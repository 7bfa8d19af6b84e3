/* SPDX-License-Identifier: BSD-2-Clause */
/* A bank's inside, shared by the loader and the built-in face; posing sees only <fap/bank.h>. */
#ifndef LIB_BANK_BANK_H
#define LIB_BANK_BANK_H

#include <fap/bank.h>

#define FAP_BANK_NAME_SIZE 64

struct fap_bank_block; /* memory that lives as long as the bank */

typedef struct fap_bank_eye_place {
    float centre_mm[3], radius_mm; /* radius 0: the face has no such eye */
} fap_bank_eye_place;

struct fap_bank {
    fap_allocator alloc;
    struct fap_bank_block *blocks;
    char name[FAP_BANK_NAME_SIZE];
    fap_mesh mesh;
    fap_fapu fapu;
    fap_bank_point point[FAP_POINT_COUNT];
    fap_bank_eye_place eye[2]; /* left, right */
    int key_count;
    fap_key *key;
    fap_region_lines regions; /* from NULL: none */
    const uint8_t *mask;      /* NULL: none */
    fap_basis basis;          /* component NULL: none */
};

/* An empty bank, to be filled and in the end given to fap_bank_close(). NULL: out of memory. */
fap_bank *fap_bank_new(const fap_allocator *alloc);

/* @p count zeroed elements on a 32-byte boundary, freed with the bank; NULL: out of memory. */
void *fap_bank_keep(fap_bank *bank, size_t count, size_t size);

#endif
