/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Fuzzes fap_fat_load. The checksum is made right first. Tables that load are posed with large and small values, written,
 * and what is written must load again; then once more for every allocation, which fails.
 */
#include <stdlib.h>
#include <string.h>

#include <fap/fat.h>

#include "bank/format.h"
#include "tests/fuzz/alloc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { HEAD_SIZE = 12, CRC_SIZE = 4 };

static void seal(uint8_t *data, size_t size)
{
    if (size < HEAD_SIZE + CRC_SIZE)
        return;
    const uint32_t crc = fbank_crc32(data + HEAD_SIZE, size - HEAD_SIZE - CRC_SIZE);
    for (int i = 0; i < CRC_SIZE; i++)
        data[size - CRC_SIZE + (size_t)i] = (uint8_t)(crc >> 8 * i);
}

typedef struct bytes {
    uint8_t *data;
    size_t size, room;
} bytes;

static int append(void *user, const void *data, size_t size)
{
    bytes *b = user;

    if (size > b->room - b->size)
        return 1;
    memcpy(b->data + b->size, data, size);
    b->size += size;
    return 0;
}

/* Every byte has one meaning: what is written is what was read. */
static void write_again(const fap_fat *fat, const uint8_t *data, size_t size)
{
    bytes b = { malloc(size), 0, size };

    if (b.data && (fap_fat_write(fat, &(fap_writer){ append, &b }) != FAP_OK || b.size != size ||
                   memcmp(b.data, data, size) != 0))
        abort();
    free(b.data);
}

static void pose(const fap_fat *fat)
{
    float(*position)[3] = malloc(fap_fat_vertex_count(fat) * sizeof *position);
    fap_frame f = { 0 };

    for (int64_t size = 1; position && size < 1 << 30; size *= 1000) {
        for (int fap = 1; fap <= FAP_COUNT; fap++) {
            f.state[fap] = fap % 7 ? FAP_CODED : FAP_ABSENT;
            f.value[fap] = (int32_t)(fap % 2 ? size : -size);
        }
        fap_fat_pose(fat, &f, position);
        memset(f.state + 3, 0, sizeof f.state - 3);
        f.viseme = (fap_viseme){ 1, 2, 40, 0 };
        f.expression = (fap_expression){ 1, 63, 2, 63, 0, 0 };
        fap_fat_pose(fat, &f, position);
    }
    free(position);
}

static fap_err load(const uint8_t *data, size_t size, fuzz_memory *m)
{
    const fap_allocator alloc = fuzz_allocator(m);
    fap_fat *fat;

    const fap_err err = fap_fat_load(&fat, data, size, &alloc);
    if ((err == FAP_OK) != (fat != NULL))
        abort();
    if (fat) {
        pose(fat);
        write_again(fat, data, size);
    }
    fap_fat_close(&fat);
    fuzz_memory_check(m);
    return err;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_every_allocation(data, size, seal, load);
    return 0;
}
