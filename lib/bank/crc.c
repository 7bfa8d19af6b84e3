/* SPDX-License-Identifier: BSD-2-Clause */
/* CRC-32 (polynomial 0xedb88320, as in zip), four bits at a time: 64 bytes of table, fast enough for once a
 * load. */
#include "bank/format.h"

static const uint32_t nibble[16] = {
    0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
    0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c, 0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c,
};

uint32_t fbank_crc32_add(uint32_t before, const uint8_t *data, size_t size)
{
    uint32_t crc = ~before;

    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
    }
    return ~crc;
}

uint32_t fbank_crc32(const uint8_t *data, size_t size)
{
    return fbank_crc32_add(0, data, size);
}
