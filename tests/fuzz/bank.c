/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Fuzzes fap_bank_load. Checksums are made right first, or the fuzzer would never get past them; a bank that loads
 * is then read to the last byte, since posing trusts it without a check. Then once more for every allocation,
 * which fails.
 */
#include <stdlib.h>
#include <string.h>

#include <fap/bank.h>

#include "bank/format.h"
#include "tests/fuzz/alloc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint32_t get32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void put32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(v >> 8 * i);
}

static void seal(uint8_t *data, size_t size)
{
    if (size < FBANK_HEAD_SIZE)
        return;
    const size_t count = get32(data + 12), room = (size - FBANK_HEAD_SIZE) / FBANK_ENTRY_SIZE;
    if (count > room)
        return;
    put32(data + 16, (uint32_t)size);
    for (size_t i = 0; i < count; i++) {
        uint8_t *e = data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE;
        const size_t offset = get32(e + 4), length = get32(e + 8);
        if (offset <= size && length <= size - offset)
            put32(e + 12, fbank_crc32(data + offset, length));
    }
    put32(data + 20, fbank_crc32(data + FBANK_HEAD_SIZE, count * FBANK_ENTRY_SIZE));
}

static long touch_keys(const fap_bank *bank)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    long sum = 0;

    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        sum += (long)strlen(key->name) + key->point_mm[FAP_POINT_COUNT - 1][2] > 0;
        for (uint32_t b = 0; b < key->block_count; b++)
            sum += key->delta[b * 3 * FAP_BLOCK + 23] + m->part[key->block[b] * FAP_BLOCK + 7];
    }
    return sum;
}

static long touch_mesh(const fap_bank *bank)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    long sum = m->position[3 * m->stride - 1] > 0;

    for (uint32_t i = 0; i < 3 * m->triangle_count; i++)
        sum += m->colour[4 * m->triangle[i] + 3] + m->head_weight[m->triangle[i]];
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        for (uint32_t i = 0; i < fap_bank_point_get(bank, p)->vertex_count; i++)
            sum += m->part[fap_bank_point_get(bank, p)->vertex[i]];
    return sum;
}

static long touch_component(const fap_bank *bank, const fap_component *c)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    long sum = c->point_mm[FAP_POINT_COUNT - 1][2] > 0;

    for (uint32_t b = 0; b < c->block_count; b++)
        sum += c->delta[b * 3 * FAP_BLOCK + 23] + m->part[c->block[b] * FAP_BLOCK + 7];
    return sum;
}

static long touch_basis(const fap_bank *bank)
{
    const fap_basis *basis = fap_bank_basis(bank);
    long sum = basis ? touch_component(bank, &basis->mean) : 0;

    for (int i = 0; basis && i < basis->component_count; i++) {
        sum += touch_component(bank, &basis->component[i]);
        sum += basis->component[i].mix[basis->model_count - 1] > 0;
    }
    for (int i = 1; basis && i < basis->model_count; i++)
        sum += fap_bank_key_get(bank, (int)basis->model[i])->name[0];
    return sum;
}

static long touch_maps(const fap_bank *bank)
{
    const uint32_t stride = fap_bank_mesh(bank)->stride;
    long sum = 0;

    if (fap_bank_masks(bank))
        sum += fap_bank_masks(bank)[stride - 1];
    if (fap_bank_regions(bank))
        sum += fap_bank_regions(bank)->from[2 * stride - 1] > 0;
    return sum;
}

/* Loads, looks, closes with the memory there is. */
static fap_err load(const uint8_t *data, size_t size, fuzz_memory *m)
{
    const fap_allocator alloc = fuzz_allocator(m);
    volatile long sink = 0;
    fap_bank *bank;

    const fap_err err = fap_bank_load(&bank, data, size, &alloc);
    if ((err == FAP_OK) != (bank != NULL))
        abort();
    if (bank)
        sink += touch_keys(bank) + touch_mesh(bank) + touch_maps(bank) + touch_basis(bank);
    (void)sink;
    fap_bank_close(&bank);
    fuzz_memory_check(m);
    return err;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_every_allocation(data, size, seal, load);
    return 0;
}
