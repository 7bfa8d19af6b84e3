/* SPDX-License-Identifier: BSD-2-Clause */
/* See bytes.h. */
#include <stdlib.h>
#include <string.h>

#include "shape/bytes.h"

static int reserve(fap_bytes *b, size_t size)
{
    if (b->failed || size > SIZE_MAX / 4 - b->size)
        b->failed = 1;
    if (b->failed || b->size + size <= b->room)
        return !b->failed;
    const size_t room = 2 * (b->size + size) + 64;
    uint8_t *grown = realloc(b->data, room);
    if (grown)
        b->data = grown, b->room = room;
    else
        b->failed = 1;
    return !b->failed;
}

void fap_bytes_put(fap_bytes *b, const void *data, size_t size)
{
    if (!size || !reserve(b, size))
        return;
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

void fap_bytes_8(fap_bytes *b, uint8_t value)
{
    fap_bytes_put(b, &value, 1);
}

void fap_bytes_16(fap_bytes *b, uint16_t value)
{
    const uint8_t raw[2] = { (uint8_t)value, (uint8_t)(value >> 8) };
    fap_bytes_put(b, raw, sizeof raw);
}

void fap_bytes_32(fap_bytes *b, uint32_t value)
{
    fap_bytes_16(b, (uint16_t)value);
    fap_bytes_16(b, (uint16_t)(value >> 16));
}

void fap_bytes_float(fap_bytes *b, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    fap_bytes_32(b, bits);
}

void fap_bytes_free(fap_bytes *b)
{
    free(b->data);
    *b = (fap_bytes){ 0 };
}
